"""Numbers are equal for any number of threads, for shards, and for extended runs."""

import unittest

from support import BAD_INPUT, BROKEN, TINY, Case, changed

# Realizations of unequal length: the stop rule decides.
UNEQUAL = changed(TINY, realizations=5, sweep={"/protocol/0/tap/dilate": [0.005, 0.15]},
                  relax={"polar": {}, "stop": {"mean_height": {"eta": 1e-4, "every_sweeps": 20}}})
SKIPPING = changed(UNEQUAL, relax={
    "polar": {}, "stop": {"mean_height": {"eta": 1e-6, "every_sweeps": 100}},
    "sampler": "skipping"})


class Threads(Case):
    def digests_of_one_two_and_three_threads(self, scene):
        self.write(scene)
        digests = set()
        for threads in (1, 2, 3):
            self.run_scene("--threads", threads, "-o", f"{threads}.h5", "--force")
            digests.add(self.digest(f"{threads}.h5"))
        self.run_scene("-o", "environment.h5", "--force", environment={"JOSTLE_THREADS": "2"})
        digests.add(self.digest("environment.h5"))
        return digests

    def test_one_two_and_three_threads_give_the_same_digest(self):
        self.assertEqual(len(self.digests_of_one_two_and_three_threads(UNEQUAL)), 1)
        self.assertEqual(len(self.digests_of_one_two_and_three_threads(SKIPPING)), 1)

    def test_another_seed_gives_another_digest(self):
        self.write(TINY)
        self.run_scene("-o", "a.h5")
        self.write(changed(TINY, seed=4712))
        self.run_scene("-o", "b.h5")
        self.assertNotEqual(self.digest("a.h5"), self.digest("b.h5"))


class Shards(Case):
    def setUp(self):
        super().setUp()
        self.write(TINY)

    def shard(self, index, count, **keywords):
        name = f"{index}of{count}.h5"
        self.run_scene("--shard", f"{index}/{count}", "-o", name, **keywords)
        return name

    def test_merged_shards_have_the_digest_of_one_run(self):
        self.run_scene("-o", "whole.h5")
        parts = [self.shard(index, 4) for index in (1, 2, 3, 4)]
        self.jostle("merge", *reversed(parts), "-o", "all.h5")
        self.assertEqual(self.digest("all.h5"), self.digest("whole.h5"))
        self.jostle("merge", *parts, "-o", "all.h5", expect=BAD_INPUT)
        self.jostle("merge", *parts, "-o", "all.h5", "--force")
        self.assertEqual(self.digest("all.h5"), self.digest("whole.h5"))

    def test_overlaps_gaps_and_other_scenes_are_refused_and_named(self):
        first, second = self.shard(1, 3), self.shard(2, 3)
        half = self.shard(2, 2)
        refused = lambda *files: self.jostle("merge", *files, "-o", "all.h5", expect=BROKEN).stderr
        self.assertRegex(refused(first, second), "(?i)realization")
        self.assertIn(half, refused(first, second, half))
        self.write(changed(TINY, seed=1))
        other = self.shard(3, 3)
        self.assertIn(other, refused(first, second, other))
        self.assertNotIn("all.h5", self.files())

    def test_a_resume_must_name_its_own_shard(self):
        name = self.shard(1, 2)
        result = self.run_scene("--resume", "-o", name, "--shard", "2/2", expect=BAD_INPUT)
        self.assertIn("--shard 1/2", result.stderr)


class Extension(Case):
    def test_more_taps_and_realizations_later_equal_a_straight_run(self):
        longer = changed(TINY, realizations=5,
                         protocol=[{"tap": {"dilate": 0.05}, "count": 7}])
        self.write(TINY)
        self.run_scene("-o", "grown.h5")
        self.write(longer)
        self.run_scene("-o", "grown.h5", "--resume")
        self.run_scene("-o", "straight.h5")
        self.assertEqual(self.digest("grown.h5"), self.digest("straight.h5"))

    def test_more_taps_later_equal_a_straight_run_of_the_skipping_sampler(self):
        self.write(changed(SKIPPING, protocol=[{"tap": {"dilate": 0.05}, "count": 2}],
                           snapshots={"taps": [0]}))
        self.run_scene("-o", "grown.h5")
        self.write(changed(SKIPPING, snapshots={"taps": [0, 4]}))
        self.run_scene("-o", "grown.h5", "--resume")
        self.run_scene("-o", "straight.h5")
        self.assertEqual(self.digest("grown.h5"), self.digest("straight.h5"))

    def test_a_resume_of_a_finished_run_changes_nothing(self):
        self.write(TINY)
        self.run_scene()
        digest = self.digest("tiny.h5")
        self.run_scene("--resume")
        self.assertEqual(self.digest("tiny.h5"), digest)

    def test_a_changed_scene_is_refused_and_the_change_named(self):
        self.write(TINY)
        self.run_scene()
        before = (self.folder / "tiny.h5").read_bytes()
        for change, pointer in (({"seed": 5}, "/seed"), ({"spheres": 49}, "/spheres"),
                                ({"realizations": 2}, "/realizations"),
                                ({"relax": {**TINY["relax"], "sampler": "skipping"}},
                                 "/relax/sampler"),
                                ({"sweep": {"/protocol/0/tap/dilate": [0.02, 0.2]}}, "/sweep")):
            with self.subTest(change=change):
                self.write(changed(TINY, **change))
                result = self.run_scene("--resume", expect=BAD_INPUT)
                self.assertRegex(result.stderr, f"(?m)^{pointer}")
                self.assertEqual((self.folder / "tiny.h5").read_bytes(), before)


if __name__ == "__main__":
    unittest.main()
