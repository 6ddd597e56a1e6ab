"""Command lines that cannot be meant: each is refused by name, and nothing is computed."""

import shutil
import unittest

from support import BAD_INPUT, BROKEN, STOPPED, TINY, Case, changed

TAPPED = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}],
                 observe=["mean_height"],
                 sweep={"/observe": [["mean_height"], ["mean_height", "bulk_fraction"]]})
CURVE = "t,X\n" + "".join(f"{t},{0.6 + 0.05 / (1 + t)}\n" for t in range(20))
STEADY = ("steady", "--observable", "mean_height")


class Refused(Case):
    def refused(self, *arguments, answer, code=BAD_INPUT):
        with self.subTest(arguments=arguments):
            done = self.jostle(*arguments, expect=code)
            self.assertIn(answer, done.stderr + done.stdout)
            for line in done.stderr.splitlines():
                self.assertLess(len(line), 300)

    def results(self):
        self.write(TAPPED)
        self.run_scene("--quiet")


class Numbers(Refused):
    def test_negative_counts_are_refused_by_the_name_of_their_option(self):
        self.results()
        self.write(CURVE, "curve.csv")
        for option, arguments in (
                ("--last", ["analyse", "tiny.h5", *STEADY]),
                ("--waiting-times", ["analyse", "tiny.h5", "ageing", "--observable", "mean_height"]),
                ("--lags", ["analyse", "tiny.h5", "ageing", "--observable", "mean_height"]),
                ("--segment", ["analyse", "tiny.h5", "spectrum", "--observable", "mean_height"]),
                ("--tap", ["structure", "tiny.h5"]),
                ("--tap", ["export", "tiny.h5", "--format", "vtp"]),
                ("--realization", ["export", "tiny.h5", "--format", "vtp"]),
                ("--seed", ["fit", "tiny.h5", "--observable", "mean_height"]),
                ("--resamples", ["fit", "tiny.h5", "--observable", "mean_height"]),
                ("--rounds", ["cost", "scene.json"]),
                ("--taps", ["cost", "scene.json"]),
                ("--threads", ["run", "scene.json"])):
            self.refused(*arguments, f"{option}=-1", answer=option)

    def test_numbers_out_of_range_are_refused_in_words(self):
        self.results()
        self.write(CURVE, "curve.csv")
        for target in ("0", "-1", "nan", "inf", "x"):
            self.refused("cost", "scene.json", "--target", target, answer="not a number above 0")
        for words in ("5:2", "nan:4", "4:nan"):
            self.refused("fit", "curve.csv", "--range", words, answer=f"--range {words}")
        self.refused("analyse", "tiny.h5", *STEADY, "--last", 0, answer="--last: 0 is not")
        self.refused("analyse", "tiny.h5", *STEADY, "--last", 5,
                     answer="asks for the last 5 taps; at least 32 are needed")
        self.refused("analyse", "tiny.h5", *STEADY, "--last", 41,
                     answer="asks for the last 41 taps; there are 40")

    def test_waiting_times_are_of_the_run_and_once(self):
        self.results()
        ageing = ("analyse", "tiny.h5", "ageing", "--observable", "mean_height")
        self.refused(*ageing, "--waiting-times", "0,40", answer="waiting time 40 is too late")
        self.refused(*ageing, "--lags", "1,41", answer="lag 41 is too late")
        self.refused(*ageing, "--waiting-times", "3,1,3", answer="--waiting-times: 3 is there twice")
        self.jostle(*ageing, "--waiting-times", "0,39", "--lags", "1,40")


class Words(Refused):
    def test_a_command_that_is_not_there_is_named(self):
        self.results()
        self.refused("analyze", answer='analyze: there is no such command; there are run, check')
        self.refused("analyze", answer='Did you mean "analyse"?')
        self.refused("analyse", "tiny.h5", "stedy", "--observable", "mean_height",
                     answer="stedy: there is no such file, and no such analysis; there are steady")

    def test_an_observable_of_other_sweep_points_is_found(self):
        self.results()
        asked = ("--observable", "bulk_fraction")
        answer = "It is at sweep point 1: choose one with --sweep-point"
        self.refused("analyse", "tiny.h5", "steady", *asked, answer=answer)
        self.refused("fit", "tiny.h5", *asked, answer=answer)
        self.jostle("analyse", "tiny.h5", "steady", *asked, "--sweep-point", 1)

    def test_what_would_be_ignored_is_refused(self):
        self.write(CURVE, "curve.csv")
        for option in (["--resample", "bootstrap"], ["--resample", "jackknife"],
                       ["--resamples", 10], ["--seed", 3]):
            self.refused("fit", "curve.csv", *option, answer="without realizations")
        self.jostle("fit", "curve.csv", "--model", "kww", "--resample", "none")
        self.refused("fit", "curve.csv", "--fix", "tau=1", "--fix", "tau=2",
                     answer="tau is fixed already")
        self.refused("fit", "curve.csv", "--fix", "tau=nan", answer="NAME=NUMBER")

    def test_output_needs_a_name_and_a_folder(self):
        self.results()
        for arguments in (["run", "scene.json", "-o"], ["cost", "scene.json", "-o"],
                          ["merge", "tiny.h5", "-o"], ["export", "tiny.h5", "--format", "vtp", "-o"],
                          ["fit", "tiny.h5", "--observable", "mean_height", "--csv"],
                          ["structure", "tiny.h5", "--csv"],
                          ["cost", "scene.json", "--figure"],
                          ["analyse", "tiny.h5", *STEADY, "--csv"]):
            for name in ("", "-"):
                self.refused(*arguments, name, answer=f'"{name}" is no file\'s name')
            self.refused(*arguments, "nowhere/x", code=BROKEN,
                         answer="jostle: nowhere/x: there is no folder nowhere\n")
        self.assertEqual(self.files(), ["scene.json", "tiny.h5"])

    def test_bytes_that_are_no_text_are_not_printed_as_they_are(self):
        (self.folder / "image.png").write_bytes(b"1 \x89PNG\x1b[31m\xc2\x9b \xc3\xa9" + bytes(range(1, 10)) * 400)
        done = self.jostle("fit", "image.png", expect=BAD_INPUT)
        self.assertIn(r"1 \x89PNG\x1b[31m\xc2\x9b é\x01\x02", done.stderr)
        self.assertLess(len(done.stderr), 2500)
        self.assertTrue(done.stderr.replace("\n", "").replace("\t", "").isprintable())


class Once(Refused):
    def test_the_same_run_given_twice_counts_once(self):
        self.results()
        shutil.copy(self.folder / "tiny.h5", self.folder / "copy.h5")
        sweep = ("sweep", "--observable", "mean_height", "--against", "/spheres")
        self.refused("analyse", "tiny.h5", "./tiny.h5", *sweep, answer="given twice")
        self.refused("analyse", "tiny.h5", "./tiny.h5", *STEADY, answer="given twice")
        self.refused("analyse", "tiny.h5", "copy.h5", *sweep, answer="hold the same run")

    def test_the_same_packing_given_twice_counts_once(self):
        self.results()
        for r in (0, 1):
            self.jostle("export", "tiny.h5", "--format", "extxyz", "--realization", r, "-o",
                        f"{r}.xyz")
        shutil.copy(self.folder / "0.xyz", self.folder / "copy.xyz")
        part = ("--part", "coordination")
        self.refused("structure", "0.xyz", "./0.xyz", *part, answer="given twice")
        self.refused("structure", "0.xyz", "1.xyz", "copy.xyz", *part,
                     answer="copy.xyz: the same packings as in 0.xyz")
        self.jostle("structure", "0.xyz", "1.xyz", *part)


class Unfinished(Refused):
    commands = (["analyse", "tiny.h5", *STEADY], ["structure", "tiny.h5"],
                ["analyse", "tiny.h5", "sweep", "--observable", "mean_height"],
                ["fit", "tiny.h5", "--observable", "mean_height"],
                ["export", "tiny.h5", "--format", "vtp", "--force"])

    def test_a_run_that_was_stopped_is_said_to_be_unfinished(self):
        self.write(TAPPED)
        self.run_scene("--time-limit", "0s", expect=STOPPED)
        for arguments in self.commands:
            done = self.jostle(*arguments, expect=None)
            self.assertIn("tiny.h5: its run is unfinished", done.stderr)
            self.assertIn("jostle run SCENE --resume", done.stderr)


if __name__ == "__main__":
    unittest.main()
