"""Sweeps that grow: a resume takes new values, a merge joins runs of other values."""

import unittest

import h5py

from support import BAD_INPUT, BROKEN, STOPPED, TINY, Case, changed

POINTER = "/protocol/0/tap/dilate"


def swept(*values, **changes):
    return changed(TINY, sweep={POINTER: list(values)}, **changes)


class Grow(Case):
    def digest_at_once(self, scene):
        self.write(scene, "once.json")
        self.run_scene("-o", "once.h5", "--force", scene="once.json")
        return self.digest("once.h5")

    def test_a_resume_with_new_values_ends_as_a_run_that_had_them_from_the_beginning(self):
        grown = swept(0.05, 0.02, 0.3, 0.1)
        expected = self.digest_at_once(grown)
        self.write(swept(0.02, 0.1))
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as file:
            before = file["observables/point_0001/mean_height"][:]
        self.write(grown)
        out = self.run_scene("--resume").stdout
        self.assertIn("dilate = 0.3", out)
        self.assertEqual(self.digest("tiny.h5"), expected)
        with h5py.File(self.folder / "tiny.h5") as file:
            self.assertTrue((file["observables/point_0003/mean_height"][:] == before).all())
            self.assertEqual(file["sweep/dilate"][:].tolist(), [0.05, 0.02, 0.3, 0.1])

    def test_a_stopped_run_grows_with_more_realizations_and_taps_at_once(self):
        grown = swept(0.1, 0.05, 0.02, realizations=4,
                      protocol=[{"tap": {"dilate": 0.05}, "count": 6}],
                      snapshots={"taps": [0, 4, 6]})
        expected = self.digest_at_once(grown)
        self.write(swept(0.02, 0.1))
        self.run_scene("--time-limit", "0s", expect=STOPPED)
        self.write(grown)
        self.run_scene("--resume", "--threads", 2)
        self.assertEqual(self.digest("tiny.h5"), expected)

    def test_values_that_are_taken_away_are_named_and_nothing_is_lost(self):
        self.write(swept(0.02, 0.1))
        self.run_scene()
        digest = self.digest("tiny.h5")
        self.write(swept(0.02, 0.2))
        err = self.run_scene("--resume", expect=BAD_INPUT).stderr
        self.assertIn("/sweep: the point dilate = 0.1 is gone: values can be added", err)
        self.assertEqual(self.digest("tiny.h5"), digest)

    def test_a_share_does_not_grow(self):
        self.write(swept(0.02, 0.1))
        self.run_scene("--shard", "1/2")
        self.write(swept(0.02, 0.1, 0.2))
        err = self.run_scene("--shard", "1/2", "--resume", expect=BROKEN).stderr
        self.assertIn("merge all shares", err)

    def test_runs_of_other_values_merge_into_one_sweep(self):
        for name, values in (("low", (0.02, 0.05)), ("high", (0.2, 0.1))):
            self.write(swept(*values, name=name), f"{name}.json")
            self.run_scene(scene=f"{name}.json")
        done = self.jostle("merge", "low.h5", "high.h5", "-o", "all.h5")
        self.assertIn("all.h5: 2 files merged", done.stdout)
        with h5py.File(self.folder / "all.h5") as file:
            self.assertEqual(file["sweep/dilate"][:].tolist(), [0.02, 0.05, 0.2, 0.1])
            scene = file["scene/verbatim"][()].decode()
        self.assertEqual(self.digest_at_once(scene), self.digest("all.h5"))
        # and it continues like any run
        self.write(swept(0.02, 0.05, 0.2, 0.1, 0.3, name="all"))
        self.run_scene("-o", "all.h5", "--resume")
        self.assertEqual(self.info("all.h5")["points"][4]["values"], {POINTER: 0.3})

    def test_runs_that_differ_in_more_do_not_merge(self):
        self.write(swept(0.02, 0.05), "low.json")
        self.run_scene("-o", "low.h5", scene="low.json")
        others = {"differs in /seed, /spheres": swept(0.2, seed=5, spheres=40),
                  "the same must be swept": changed(TINY, sweep={"/spheres": [40, 48]}),
                  "both hold realization 0": swept(0.02, 0.1),
                  "has 2 realizations per sweep point, not 3": swept(0.1, realizations=2)}
        for answer, scene in others.items():
            with self.subTest(answer=answer):
                self.write(scene, "other.json")
                self.run_scene("-o", "other.h5", "--force", scene="other.json")
                err = self.jostle("merge", "low.h5", "other.h5", "-o", "all.h5",
                                  expect=BROKEN).stderr
                self.assertIn("other.h5", err)
                self.assertIn(answer, err)
                self.assertNotIn("all.h5", self.files())

    def test_a_joined_sweep_without_holes_only(self):
        for name, sweep in (("a", {POINTER: [0.02], "/spheres": [40]}),
                            ("b", {POINTER: [0.05], "/spheres": [48]})):
            self.write(changed(TINY, name=name, sweep=sweep), f"{name}.json")
            self.run_scene(scene=f"{name}.json")
        err = self.jostle("merge", "a.h5", "b.h5", "-o", "all.h5", expect=BROKEN).stderr
        self.assertIn("together the sweeps have the point dilate = 0.02, spheres = 48", err)


if __name__ == "__main__":
    unittest.main()
