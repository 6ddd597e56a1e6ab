"""No command destroys its input, its results, or files that it should not replace."""

import unittest

import h5py

from support import BAD_INPUT, BROKEN, FAILED, TINY, Case, changed

TAPPED = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}], snapshots={"taps": [0, 40]})
del TAPPED["sweep"]
CURVE = "t,X\n" + "".join(f"{t},{0.6 + 0.05 / (1 + t)}\n" for t in range(20))


class Kept(Case):
    def content(self):
        return {name: (self.folder / name).read_bytes() for name in self.files()
                if (self.folder / name).is_file()}

    def refused(self, *arguments, answer):
        """Without a trace."""
        before = self.content()
        done = self.jostle(*arguments, expect=BAD_INPUT)
        self.assertIn(answer, done.stderr)
        self.assertEqual(self.content(), before)

    def never_replaced(self, *arguments, answer):
        for force in ((), ("--force",)):
            with self.subTest(arguments=arguments, force=force):
                self.refused(*arguments, *force, answer=answer)


class Rings(Case):
    def test_rings_of_links_and_long_names_are_said_plainly(self):
        self.write(TAPPED)
        (self.folder / "ring.h5").symlink_to("ring.h5")
        for output, answer in (("ring.h5", "ring"), ("x" * 300, "has a name of 300 bytes, and its folder takes up to 255")):
            for options in ((), ("--resume",)):
                with self.subTest(output=output[:9], options=options):
                    err = self.jostle("run", "scene.json", "-o", output, *options, expect=BROKEN).stderr
                    self.assertIn(answer, err)
                    self.assertNotIn("filesystem error", err)


class Text(Kept):
    def setUp(self):
        super().setUp()
        self.write(TAPPED)
        self.run_scene()
        self.write(CURVE, "curve.csv")
        self.write("{}", "settings.json")
        self.write("mine", "kept.csv")

    def test_nothing_that_a_command_works_with_is_replaced(self):
        (self.folder / "link.csv").symlink_to("tiny.h5")
        (self.folder / "folder").mkdir()
        steady = ("analyse", "tiny.h5", "steady", "--observable", "mean_height")
        cost = ("cost", "scene.json", "--replicates", 2, "--taps", 1)
        for arguments in ([*steady, "--csv", "tiny.h5"],
                          [*steady, "--csv", "folder/../tiny.h5"],
                          [*steady, "--csv", "link.csv"],
                          ["fit", "curve.csv", "--csv", "curve.csv"],
                          ["fit", "tiny.h5", "--observable", "mean_height", "--csv", "tiny.h5"],
                          ["structure", "tiny.h5", "--csv", "tiny.h5"],
                          ["structure", "tiny.h5", "--settings", "settings.json", "--csv",
                           "settings.json"],
                          [*cost, "--csv", "scene.json"],
                          [*cost, "--csv", "tiny-cost.h5"]):
            self.never_replaced(*arguments, answer="works with that file")

    def test_a_file_that_exists_is_kept_without_force(self):
        for arguments in (["analyse", "tiny.h5", "steady", "--observable", "mean_height"],
                          ["fit", "curve.csv", "--model", "inverse_log"],
                          ["structure", "tiny.h5", "--part", "profile"],
                          ["cost", "scene.json", "--replicates", 2, "--taps", 1]):
            with self.subTest(arguments=arguments):
                self.write("mine", "kept.csv")
                asked = (*arguments, "--csv", "kept.csv")
                self.refused(*asked, answer="kept.csv exists and is kept")
                self.jostle(*asked, "--force")
                self.assertNotEqual((self.folder / "kept.csv").read_text(), "mine")

    def test_text_can_go_to_a_stream(self):
        done = self.jostle("fit", "curve.csv", "--model", "inverse_log", "--csv", "/dev/stdout")
        self.assertIn("t,X,inverse_log", done.stdout)


class Results(Kept):
    def test_a_run_replaces_neither_its_scene_nor_its_start(self):
        self.write(TAPPED)
        self.run_scene("-o", "first.h5")
        (self.folder / "later").mkdir()
        later = changed(TAPPED, start={"file": {"path": "../first.h5", "tap": 40}})
        self.write(later, "later/scene.json")
        for command in (("run",), ("cost", "--replicates", "2", "--taps", "1")):
            for output in ("later/scene.json", "first.h5", "later/../first.h5"):
                self.never_replaced(*command, "later/scene.json", "--no-progress", "-o", output,
                                    answer="works with that file")

    def test_force_replaces_results_alone(self):
        self.write(TAPPED)
        self.write("mine", "copy.json")
        self.run_scene("-o", "part.h5")
        for command in (["run", "scene.json", "--no-progress"],
                        ["cost", "scene.json", "--replicates", 2, "--taps", 1, "--no-progress"],
                        ["merge", "part.h5"]):
            with self.subTest(command=command):
                self.refused(*command, "-o", "copy.json", answer="exists and is kept")
                self.refused(*command, "-o", "copy.json", "--force", answer="no results file")
                self.write("", "empty")
                self.jostle(*command, "-o", "empty", "--force")
                self.jostle(*command, "-o", "empty", "--force")
                self.assertTrue(h5py.is_hdf5(self.folder / "empty"))

    def test_damaged_results_can_be_replaced(self):
        self.write(TAPPED)
        self.run_scene()
        file = self.folder / "tiny.h5"
        file.write_bytes(file.read_bytes()[:2000])
        self.run_scene("--force")
        self.jostle("info", "tiny.h5")

    def test_a_merge_replaces_no_shard(self):
        self.write(TAPPED)
        for i in (1, 2):
            self.run_scene("--shard", f"{i}/2", "-o", f"{i}.h5")
        self.never_replaced("merge", "1.h5", "2.h5", "-o", "2.h5", answer="works with that file")


class Quiet(Case):
    def test_reasons_of_failures_are_errors(self):
        self.write(changed(TINY, start={"crystal": "hcp"}))
        done = self.jostle("run", "scene.json", "--quiet", expect=FAILED)
        self.assertEqual(done.stdout, "")
        self.assertEqual(len(done.stderr.splitlines()), 6)
        self.assertRegex(done.stderr, r"(?m)^sweep point 1, realization 2 failed \(seed \d+\): \S")


if __name__ == "__main__":
    unittest.main()
