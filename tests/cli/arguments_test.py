"""Command lines that cannot be meant: each is refused by name, and nothing is computed."""

import shutil
import unittest

from support import BAD_INPUT, BROKEN, SOURCE, STOPPED, TINY, UNFOLDED, Case, changed

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
                ("--replicates", ["cost", "scene.json"]),
                ("--taps", ["cost", "scene.json"]),
                ("--threads", ["run", "scene.json"])):
            self.refused(*arguments, f"{option}=-1", answer=option)

    def test_numbers_out_of_range_are_refused_in_words(self):
        self.results()
        self.write(CURVE, "curve.csv")
        for target in ("0", "-1", "nan", "inf", "x"):
            self.refused("cost", "scene.json", "--target", target, answer="is not a number")
        for words in ("5:2", "nan:4", "4:nan"):
            self.refused("fit", "curve.csv", "--range", words, answer=f"--range {words}")
        self.refused("analyse", "tiny.h5", *STEADY, "--last", 0, answer="--last: 0 is not")
        self.refused("analyse", "tiny.h5", *STEADY, "--last", 5,
                     answer="asks for the last 5 taps; at least 32 are needed")
        self.refused("analyse", "tiny.h5", *STEADY, "--last", 41,
                     answer="asks for the last 41 taps; there are 40")

    def test_no_option_reads_what_is_no_plain_decimal_number(self):
        self.results()
        self.write(CURVE, "curve.csv")
        of_results = ["--observable", "mean_height"]
        for option, arguments in (
                ("--last", ["analyse", "tiny.h5", *STEADY]),
                ("--lags", ["analyse", "tiny.h5", "ageing", *of_results]),
                ("--waiting-times", ["analyse", "tiny.h5", "ageing", *of_results]),
                ("--segment", ["analyse", "tiny.h5", "spectrum", *of_results]),
                ("--band", ["analyse", "tiny.h5", "spectrum", *of_results]),
                ("--threshold", ["analyse", "tiny.h5", "ordering", *of_results]),
                ("--hold", ["analyse", "tiny.h5", "ordering", *of_results]),
                ("--reference", ["analyse", "tiny.h5", "sweep", *of_results]),
                ("--spheres", ["analyse", "tiny.h5", "volumes", *of_results]),
                ("--tap", ["structure", "tiny.h5"]),
                ("--tap", ["export", "tiny.h5", "--format", "vtp"]),
                ("--realization", ["export", "tiny.h5", "--format", "vtp"]),
                ("--columns", ["report", "tiny.h5", "--figures", "figures"]),
                ("--seed", ["fit", "tiny.h5", *of_results]),
                ("--resamples", ["fit", "tiny.h5", *of_results]),
                ("--range", ["fit", "curve.csv"]),
                ("--fix", ["fit", "curve.csv"]),
                ("--target", ["cost", "scene.json"]),
                ("--replicates", ["cost", "scene.json"]),
                ("--taps", ["cost", "scene.json"]),
                ("--budget", ["cost", "scene.json"]),
                ("--hours", ["slurm", "scene.json"]),
                ("--cpus", ["slurm", "scene.json"]),
                ("--jobs", ["slurm", "scene.json"]),
                ("--array-limit", ["slurm", "scene.json"]),
                ("--shard", ["run", "scene.json"]),
                ("--time-limit", ["run", "scene.json"]),
                ("--threads", ["run", "scene.json"])):
            for number in ("0x10", "inf", "1e", "+10", "1_0"):
                text = {"--range": f"{number}:20", "--fix": f"rho_0={number}", "--band": f"{number}:0.4",
                        "--shard": f"1/{number}"}.get(option, number)
                with self.subTest(option=option, number=number):
                    done = self.jostle(*arguments, f"{option}={text}", expect=BAD_INPUT)
                    self.assertIn(option, done.stderr)
                    self.assertEqual(done.stdout, "")

    def test_leading_zeros_are_decimal_not_octal(self):
        self.results()
        self.write(CURVE, "curve.csv")
        fits = [self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--model", "kww", "--no-store",
                            "--resample", "bootstrap", "--resamples", "0010", "--seed", seed).stdout
                for seed in ("010", "10", "8")]
        self.assertEqual(fits[0], fits[1])
        self.assertNotEqual(fits[0], fits[2])
        self.assertIn("10 resamples", fits[0])

    def test_durations_that_may_mean_two_things_are_refused(self):
        self.write(TINY)
        for command, option in (("run", "--time-limit"), ("run", "--checkpoint-every"), ("cost", "--budget")):
            for text in ("1h30", "30m1h", "1e400", "-5s", "inf", "99999999999d", "1h 30m"):
                self.refused(command, "scene.json", f"{option}={text}", answer=f'"{text}" is not a duration')
        self.assertEqual(self.files(), ["scene.json"])

    def test_absurd_numbers_of_a_job_are_refused_before_its_scene_is_run(self):
        self.write(TINY)
        job = {"--hours": "2", "--cpus": "1", "--jobs": "1"}
        for option, texts in {"--hours": ("0", "-1", "1e18", "87601", "1e400", "inf", "nan"),
                              "--cpus": ("0", "-1", "65536", "4294967295", "1e18", "99999999999999999999"),
                              "--jobs": ("0", "-1", "7", "4294967295", "1e18"),
                              "--array-limit": ("0", "-1", "1e18")}.items():
            for text in texts:
                words = [f"{key}={value}" for key, value in {**job, option: text}.items()]
                self.refused("slurm", "scene.json", *words,
                             answer="more than the scene has" if text in ("7", "4294967295")
                             and option == "--jobs" else option)

    def test_absurd_counts_of_analyses_are_refused_by_the_name_of_their_option(self):
        self.results()
        large = ("1e18", "18446744073709551615", "99999999999999999999")
        for option, arguments in (
                ("--last", ["analyse", "tiny.h5", *STEADY, "--no-store"]),
                ("--segment", ["analyse", "tiny.h5", "--no-store", "spectrum", "--observable", "mean_height"]),
                ("--hold", ["analyse", "tiny.h5", "--no-store", "ordering", "--observable", "mean_height",
                            "--threshold", "1"]),
                ("--waiting-times", ["analyse", "tiny.h5", "--no-store", "ageing", "--observable", "mean_height"]),
                ("--lags", ["analyse", "tiny.h5", "--no-store", "ageing", "--observable", "mean_height"]),
                ("--tap", ["structure", "tiny.h5", "--no-store"]),
                ("--tap", ["export", "tiny.h5", "--format", "vtp"]),
                ("--realization", ["export", "tiny.h5", "--format", "vtp"]),
                ("--resamples", ["fit", "tiny.h5", "--observable", "mean_height", "--no-store"]),
                ("--replicates", ["cost", "scene.json"]),
                ("--taps", ["cost", "scene.json"]),
                ("--threads", ["run", "scene.json"])):
            for text in large:
                with self.subTest(option=option, text=text):
                    done = self.jostle(*arguments, f"{option}={text}", expect=BAD_INPUT)
                    self.assertTrue(done.stderr + done.stdout)

    def test_a_band_has_frequencies_of_a_value_per_tap(self):
        self.results()
        spectrum = ("analyse", "tiny.h5", "spectrum", "--observable", "mean_height", "--no-store")
        for band in ("0.1:0.9", "-0.1:0.4", "-2:-1", "0.6:0.9", "0.1:1e300"):
            self.refused(*spectrum, f"--band={band}",
                         answer=f"--band {band}: frequencies are from 0 to 0.5 per tap: keep both ends between")
        told = [self.jostle(*spectrum, "--band", band).stdout for band in ("0.05:0.5", "0.05:")]
        self.assertEqual(told[0], told[1])
        self.jostle(*spectrum, "--band", ":0.4")

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
        self.refused("analyze", answer='analyze: there is no such command; there are new, run, check')
        self.refused("analyze", answer='Did you mean "analyse"?')
        self.refused("analyse", "tiny.h5", "stedy", "--observable", "mean_height",
                     answer="stedy is neither a file nor an analysis; the analyses are steady")
        self.refused("analyse", "steady", "tiny.h5", "--observable", "mean_height",
                     answer="steady is an analysis, and follows the files: jostle analyse FILE st")

    def test_the_nearest_word_is_proposed(self):
        self.results()
        self.write(CURVE, "curve.csv")
        for arguments, answer in (
                (["run", "scene.json", "--treads", 2],
                 '--treads: jostle run has no such option; its --help lists them. Did you mean '
                 '"--threads"?'),
                (["analyse", "tiny.h5", "steady", "--observabel", "mean_height"],
                 "--observabel: jostle analyse steady has no such option"),
                (["analyse", "tiny.h5", "steady", "--observable=mean_height", "--lst=5"],
                 'Did you mean "--last"?'),
                (["analyse", "tiny.h5", "stedy"], 'Did you mean "steady"?'),
                (["analyse", "tiny.h5", "steady", "--observable", "mean_hight"],
                 'Did you mean "mean_height"?'),
                (["fit", "tiny.h5", "--observable", "mean_hight"], 'Did you mean "mean_height"?'),
                (["fit", "curve.csv", "--model", "invers_log"], 'Did you mean "inverse_log"?'),
                (["structure", "tiny.h5", "--part", "profil"], 'Did you mean "profile"?'),
                (["cost", "scene.json", "--observable", "mean_hight"],
                 'Did you mean "mean_height"?')):
            self.refused(*arguments, answer=answer)

    def test_one_of_a_thing_is_one(self):
        self.write(changed(TINY, spheres=1, realizations=1, sweep={},
                           protocol=[{"tap": {"dilate": 0.05}, "count": 1}],
                           snapshots={"taps": [1]}))
        size = self.jostle("check", "scene.json", "--no-pilot").stdout
        self.assertIn("1 sweep point x 1 realization, 1 sphere, 1 tap in all\n", size)
        done = self.run_scene("--threads", 1)
        self.assertIn("1 realization to do on 1 thread\n", done.stderr)
        self.assertRegex(done.stdout, r"this run: .* on 1 thread[;\n]")
        self.assertRegex(self.jostle("info", "tiny.h5", environment=UNFOLDED).stdout,
                         r"made by .*, 1 thread\n")
        self.assertIn("1 file merged", self.jostle("merge", "tiny.h5", "-o", "one.h5").stdout)
        exported = self.jostle("export", "tiny.h5", "--format", "extxyz").stdout
        self.assertIn("tap 1, 1 sphere\n", exported)
        self.write(changed(TINY, spheres=0), "bad.json")
        self.refused("check", "bad.json", answer="bad.json: 1 fault, nothing was run")

    def test_an_observable_of_other_sweep_points_is_found(self):
        self.results()
        asked = ("--observable", "bulk_fraction")
        answer = "It is at sweep point 1: choose one with --sweep-point"
        self.refused("analyse", "tiny.h5", "steady", *asked, answer=answer)
        self.refused("fit", "tiny.h5", *asked, answer=answer)
        self.jostle("analyse", "tiny.h5", "steady", *asked, "--sweep-point", 1)

    def test_what_would_be_ignored_is_refused(self):
        self.write(CURVE, "curve.csv")
        for option in (["--resample", "bootstrap"], ["--resample", "jackknife"]):
            self.refused("fit", "curve.csv", *option, answer="--resample requires --realizations")
        for option in (["--resamples", 10], ["--seed", 3], ["--resample", "jackknife", "--seed", 3]):
            self.refused("fit", "curve.csv", *option, answer="apply only to --resample bootstrap")
        self.write("", "packing.xyz")
        for command, file in (("fit", "curve.csv"), ("structure", "packing.xyz")):
            self.refused(command, file, "--live", answer=f"{file}: --live applies only to results files")
        self.refused("fit", "curve.csv", "--no-store", answer="curve.csv: --no-store applies only to results files")
        self.write(TAPPED)
        self.refused("cost", "scene.json", "--replicates", 2, "--budget", "1m",
                     answer="--budget and --replicates exclude each other")
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
                          ["cost", "scene.json", "--csv"],
                          ["analyse", "tiny.h5", *STEADY, "--csv"]):
            for name in ("", "-"):
                self.refused(*arguments, name, answer=f'"{name}" is no file\'s name')
            self.refused(*arguments, "nowhere/x", code=BROKEN,
                         answer="jostle: nowhere/x: there is no folder nowhere\n")
        self.refused("new", "nowhere/x", code=BROKEN, answer="jostle: nowhere/x.json: there is no folder nowhere\n")
        self.assertEqual(self.files(), ["scene.json", "tiny.h5"])

    def test_bytes_that_are_no_text_are_not_printed_as_they_are(self):
        (self.folder / "image.png").write_bytes(b"1 \x89PNG\x1b[31m\xc2\x9b \xc3\xa9" + bytes(range(1, 10)) * 400)
        done = self.jostle("fit", "image.png", expect=BAD_INPUT)
        self.assertIn(r"1 \x89PNG\x1b[31m\xc2\x9b é\x01\x02", done.stderr)
        self.assertLess(len(done.stderr), 2500)
        self.assertTrue(done.stderr.replace("\n", "").replace("\t", "").isprintable())


class Order(Refused):
    """Lists of values before and behind the files."""

    def test_a_list_before_a_file_does_not_take_the_file(self):
        self.results()
        shutil.copy(self.folder / "tiny.h5", self.folder / "plain")
        shutil.copy(self.folder / "tiny.h5", self.folder / "other.h5")
        self.write(CURVE, "curve.csv")
        of_results = ("--observable", "mean_height", "--no-store")
        for file in ("tiny.h5", "plain"):
            for arguments in (["fit", "--model", "kww", file, *of_results],
                              ["fit", "--model=kww", file, *of_results],
                              ["fit", "--model", "kww", "inverse_log", file, *of_results],
                              ["export", "--tap", 0, file, "--format", "extxyz", "--force"],
                              ["export", "--tap", 0, 4, file, "--format", "extxyz", "--force"],
                              ["structure", "--part", "profile", "layers", file, "--tap", 0, 4, "--no-store"],
                              ["structure", "--tap", 0, file, "--part", "profile", "--no-store"],
                              ["analyse", "--observable", "mean_height", file, "steady", "--no-store"],
                              ["analyse", "--observable", "mean_height", "sweeps", file, "--last", 33, "steady",
                               "--no-store"],
                              ["analyse", "--no-store", "--observable", "mean_height", file, "other.h5", "steady"],
                              ["analyse", "--lags", 1, 3, file, "ageing", *of_results],
                              ["analyse", "--lags", 1, 3, "--", file, "ageing", *of_results],
                              ["analyse", "--", file, "ageing", *of_results, "--lags", 1, 3],
                              ["analyse", "--", file, "steady", "--observable", "mean_height", "sweeps", "--no-store"],
                              ["analyse", file, "ageing", *of_results, "--lags", 1, 3, "--waiting-times", 0, 9]):
                with self.subTest(arguments=arguments):
                    self.jostle(*arguments)
        for arguments in (["--fix", "rho_inf=0.6", "tau=2", "curve.csv"],
                          ["curve.csv", "--fix", "rho_inf=0.6", "tau=2"],
                          ["--fix", "rho_inf=0.6", "tau=2", "--", "curve.csv"]):
            fit = self.jostle("fit", "--model", "kww", *arguments).stdout
            self.assertRegex(fit, "tau +2 .*fixed")

    def test_a_file_with_the_name_of_a_value_is_none_of_the_files(self):
        self.results()
        self.write(CURVE, "curve.csv")
        for value in ("kww", "layers", "tau=2"):
            (self.folder / value).touch()
        for arguments in (["fit", "--model", "inverse_log", "kww", "curve.csv"],
                          ["structure", "--part", "profile", "layers", "tiny.h5", "--no-store"],
                          ["fit", "--model", "kww", "--fix", "rho_inf=0.6", "tau=2", "curve.csv"]):
            with self.subTest(arguments=arguments):
                self.jostle(*arguments)

    def test_a_list_that_may_hold_the_file_is_named(self):
        self.results()
        for arguments in (["--model", "kww", "gone"], ["--model", "kww", "inverse_log", "gone"]):
            self.refused("fit", *arguments, "--observable", "mean_height",
                         answer=f"no file is given, unless it is in {' '.join(arguments)}: put the file first")
            self.refused("fit", *arguments, code=BROKEN, answer="gone: cannot open")
        self.refused("analyse", "--observable", "mean_height", "gone", "steady",
                     answer="gone is neither a file nor an analysis")
        self.refused("fit", "--model", "kww,inverse_log", "--observable", "mean_height", answer="input is required")
        self.refused("analyse", "tiny.h5", "steady", "--last", "1.5", answer="--last: 1.5 is not a whole number\n")
        self.refused("structure", "--tap", 0, -1, "tiny.h5", answer="--tap -1: neither a whole number from 0 on nor")

    def test_values_after_commas_blanks_and_in_turn_are_one_list(self):
        self.results()
        self.write(CURVE, "curve.csv")
        for command, name, values in (
                (["fit", "curve.csv", "--model", "kww"], "--fix", ("rho_inf=0.6", "tau=2")),
                (["fit", "curve.csv", "--law", "a + b/t", "--range", "1:"], "--start", ("a=1", "b=1")),
                (["analyse", "tiny.h5", "steady", "--no-store"], "--observable", ("mean_height", "sweeps")),
                (["analyse", "tiny.h5", "ageing", "--no-store", "--observable", "mean_height"], "--lags", (1, 3)),
                (["structure", "tiny.h5", "--no-store", "--tap", "all"], "--part", ("profile", "layers")),
                (["structure", "tiny.h5", "--no-store", "--part", "profile"], "--tap", (0, 4))):
            with self.subTest(command=command, name=name):
                told = [self.jostle(*command, *words).stdout
                        for words in ((name, ",".join(map(str, values))), (name, *values),
                                      [word for value in values for word in (name, value)])]
                self.assertEqual(told, told[:1] * 3)
                self.assertNotEqual(told[0], self.jostle(*command, name, values[0], expect=None).stdout)
        self.assertEqual(*(self.jostle("structure", "tiny.h5", "--no-store", *taps).stdout
                           for taps in ((), ("--tap", "all"))))
        self.refused("fit", "tiny.h5", "--observable", "mean_height,sweeps",
                     answer="--observable mean_height,sweeps: a command fits one observable; run it for each")
        self.refused("structure", "tiny.h5", "--tap", "0,x", answer='--tap x: neither a whole number from 0 on nor "all"')
        for command in (["structure", "tiny.h5"], ["export", "tiny.h5", "--format", "extxyz"]):
            self.refused(*command, "--tap", "0,all", answer='--tap: "all" and numbers exclude each other')


class Once(Refused):
    def test_the_same_run_given_twice_counts_once(self):
        self.results()
        shutil.copy(self.folder / "tiny.h5", self.folder / "copy.h5")
        sweep = ("sweep", "--observable", "mean_height", "--against", "/spheres")
        self.refused("analyse", "tiny.h5", "./tiny.h5", *sweep, answer="given twice")
        self.refused("analyse", "tiny.h5", "./tiny.h5", *STEADY, answer="given twice")
        self.refused("analyse", "tiny.h5", "copy.h5", *sweep, answer="hold the same run")
        self.refused("analyse", "tiny.h5", *sweep[:-1], "spheres",
                     answer="spheres is neither a name of what is swept")

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
                ["report", "tiny.h5", "--force"],
                ["export", "tiny.h5", "--format", "vtp", "--force"])

    def test_a_run_that_was_stopped_is_said_to_be_unfinished(self):
        self.write(TAPPED)
        self.run_scene("--time-limit", "0s", expect=STOPPED)
        for arguments in self.commands:
            done = self.jostle(*arguments, expect=None)
            self.assertIn("tiny.h5: its run is unfinished", done.stderr)
            self.assertIn("jostle run SCENE --resume", done.stderr)


class Doubtful(Case):
    def test_what_a_scene_may_not_mean_is_said_by_check_and_run(self):
        doubtful = changed(TINY, relax={"polar": {"theta0": 45}, "stop": {"sweeps": 2}},
                           protocol=[{"tap": {"dilate": 2}, "count": 1}, {"tap": {"lift": 8}, "count": 1}],
                           snapshots={"taps": []})
        del doubtful["sweep"]
        self.write(doubtful)
        said = ("theta0 is an angle in radians", "45 degrees are 0.7854",
                "dilate 2 stretches the bed to 3 times its height; 2 percent are 0.02",
                "lift 8 drops the bed from 8 diameters")
        checked = self.jostle("check", "scene.json", environment=UNFOLDED).stdout
        logged = self.run_scene().stderr
        for text in said:
            self.assertIn(text, checked)
            self.assertIn(text, logged)
        large = changed(TINY, realizations=10000, spheres=100000,
                        container={"sides": "periodic", "width": 60},
                        protocol=[{"tap": {"dilate": 0.05}, "count": 20000}],
                        snapshots={"taps": {"log": {"from": 1, "to": 20000, "per_decade": 100}}})
        self.write(large)
        self.assertRegex(self.jostle("check", "scene.json", "--no-pilot").stdout,
                         r"the results may take \d+\.\d TiB of disk")

    def test_what_the_papers_do_is_not_doubted(self):
        for path in sorted((SOURCE / "config/scenes").rglob("*.json")):
            with self.subTest(scene=path.name):
                text = self.jostle("check", path, "--no-pilot").stdout
                self.assertNotIn("\nwarnings\n", text)


class Kinds(Refused):
    """Paths that are no results: one exit code for all commands."""

    commands = (["info"], ["info", "--digest"], ["report"], ["merge", "-o", "all.h5"], ["structure"],
                ["export", "--format", "vtp"], ["export", "--format", "vtp", "--sweep-point", "0"],
                ["export", "--format", "results", "-o", "copy.h5"])

    def test_a_folder_and_a_file_of_another_kind_end_every_command_alike(self):
        (self.folder / "folder").mkdir()
        (self.folder / "folder.h5").mkdir()
        self.write("{}", "age.json")
        self.write("no results", "text.h5")
        before = self.files()
        for path in ("folder", "folder/", ".", "folder.h5", "age.json", "text.h5"):
            of_folder = path not in ("age.json", "text.h5")
            for command in self.commands:
                if command[0] != "merge" or not of_folder:  # a folder of shards
                    self.refused(*command, path, code=BROKEN, answer="folder" if of_folder else path)
            self.refused("analyse", path, *STEADY, code=BROKEN, answer=path)
            self.refused("analyse", *STEADY[1:], path, "steady", code=BROKEN, answer=path)
            if path != "age.json":  # a text without columns
                self.refused("fit", path, *STEADY[1:], code=BROKEN, answer=path)
                self.refused("fit", path, code=BROKEN, answer=path)
        self.refused("status", "age.json", code=BROKEN, answer="age.json: not an HDF5 file")
        self.refused("fit", "age.json", answer="age.json: no column is named as t")
        self.refused("fit", "folder", *STEADY[1:], code=BROKEN, answer="it is a folder, not a file: name a file in it")
        self.assertEqual(self.files(), before)


class Streams(Refused):
    """Errors go to standard error, and standard output stays empty."""

    def test_every_command_says_why_it_refuses(self):
        self.write(changed(TINY, seed="x"))
        self.write("no results", "data.h5")
        for arguments in (["run", "scene.json"], ["check", "scene.json"], ["cost", "scene.json"],
                          ["slurm", "scene.json"], ["run", "gone.json"], ["check", "gone.json"],
                          ["cost", "gone.json"], ["slurm", "gone.json"], ["info", "gone.h5"],
                          ["info", "data.h5"], ["info", "data.h5", "--digest"], ["fit", "gone.csv"],
                          ["fit", "data.h5"], ["analyse", "data.h5", *STEADY], ["structure", "data.h5"],
                          ["export", "data.h5", "--format", "vtp"], ["merge", "data.h5", "-o", "all.h5"],
                          ["report", "data.h5"], ["status", "gone"], ["status", "data.h5"],
                          ["bench", "everything"], ["new", "gone/a"], ["schema", "x"],
                          ["selftest", "--folder", "gone"], ["fitt"], []):
            with self.subTest(arguments=arguments):
                done = self.jostle(*arguments, expect=None)
                self.assertIn(done.returncode, (BAD_INPUT, BROKEN))
                self.assertEqual(done.stdout, "")
                self.assertRegex(done.stderr, r"\w")

    def test_an_analysis_that_none_can_make_says_so(self):
        self.write(TINY)  # four taps
        self.run_scene("--quiet")
        for arguments in (STEADY, ("spectrum", "--observable", "mean_height")):
            with self.subTest(arguments=arguments):
                done = self.jostle("analyse", "tiny.h5", *arguments, expect=BAD_INPUT)
                self.assertEqual(done.stdout, "")
                self.assertIn("no table could be made", done.stderr)
                listed = self.jostle("analyse", "tiny.h5", *arguments, "--json", expect=BAD_INPUT)
                self.assertIn("refused", listed.stdout)
                self.assertIn("no table could be made", listed.stderr)


class OneMessage(Case):
    """An error is one line, for any command line and any width of the terminal."""

    def test_words_with_newlines(self):
        self.write(TINY)
        self.run_scene()
        fit = ("fit", "tiny.h5", "--observable", "mean_height", "--no-store")
        for command in ((*fit[:3], "a\nb"), (*fit, "--sweep-point", "a\nb"), (*fit, "--model", "a\nb"),
                        (*fit, "--range", "a\nb"), (*fit, "--law", "c + a\nb", "--start", "a=1"), ("a\nb",),
                        ("info", "a\nb"), ("info", "tiny.h5", "--a\nb"), ("run", "a\nb"), ("status", "a\nb"),
                        ("export", "tiny.h5", "--format", "a\nb"), ("structure", "tiny.h5", "--part", "a\nb"),
                        ("run", "scene.json", "--time-limit", "a\nb"), ("export", "tiny.h5", "--format", "vtp", "--tap", "a\nb")):
            with self.subTest(command):
                done = self.jostle(*command, expect=None, environment={"COLUMNS": "40"})
                self.assertIn(done.returncode, (BAD_INPUT, BROKEN))
                self.assertIn("a\\x0ab", done.stderr)
                self.assertNotRegex(done.stderr, r"(?m)^b")

    def test_keys_with_newlines(self):
        self.write({**TINY, "a\nb": 1, "spheres": "c\nd"})
        done = self.jostle("check", "scene.json", expect=BAD_INPUT)
        self.assertRegex(done.stderr, r"(?m)^/a\\x0ab: unknown key")
        self.assertEqual(len(done.stderr.splitlines()), 3)

    def test_warnings_of_slurm_are_a_line_each(self):
        self.write(TINY)
        done = self.jostle("slurm", "scene.json", "--hours", 1, "--cpus", 64, "--jobs", 6,
                           environment={"COLUMNS": "40"})
        self.assertTrue(done.stderr)
        for line in done.stderr.splitlines():
            self.assertRegex(line, r"^jostle: |^  \S*(sbatch|jostle) ")  # a command to copy has its own line


if __name__ == "__main__":
    unittest.main()
