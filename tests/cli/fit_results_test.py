"""jostle fit of results: sweep points, errors from realizations, and fits that the file keeps."""

import json
import unittest

import h5py
from support import BAD_INPUT, BROKEN, TINY, Case, changed


class Results(Case):
    def setUp(self):
        super().setUp()
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}]))
        self.run_scene("-o", "tiny.h5")

    def test_every_sweep_point_is_fitted_with_errors_from_its_realizations(self):
        result = self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--resample",
                             "jackknife", "--json")
        curves = json.loads(result.stdout)["curves"]
        self.assertEqual([curve["sweep_point"] for curve in curves], [0, 1])
        for curve in curves:
            self.assertEqual(curve["realizations"], 3)
            self.assertEqual(curve["range"], [1, 40])
            for fit in curve["fits"]:
                self.assertEqual(fit["points"], 40)
                self.assertEqual(fit["resamples"], 3)
                self.assertEqual((fit["realizations"], fit["error_dof"]), (3, 2))
                self.assertFalse(fit["sigma_given"])

    def test_a_point_is_chosen_by_number_or_by_value(self):
        texts = []
        for point in ("1", "/protocol/0/tap/dilate=0.1"):
            texts.append(self.jostle("fit", "tiny.h5", "--observable", "bottom_fraction", "--model",
                                     "kww", "--sweep-point", point, "--range", "2:30").stdout)
            self.assertIn("sweep point 1, 3 realizations", texts[-1])
        self.assertEqual(*texts)

    def test_threads_and_repeats_change_nothing(self):
        texts = {self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--resample",
                             "bootstrap", "--resamples", "40", "--threads", threads).stdout
                 for threads in (1, 2, 3, 1)}
        self.assertEqual(len(texts), 1)

    def test_what_is_not_there_is_refused_with_what_is(self):
        for arguments, message in (
                ([], "--observable"),
                (["--observable", "height"], "mean_height, bottom_fraction"),
                (["--observable", "mean_height", "--sweep-point", "7"],
                 "/protocol/0/tap/dilate=0.02"),
                (["--observable", "mean_height", "--csv", "x.csv"], "--sweep-point")):
            with self.subTest(arguments=arguments):
                self.assertIn(message,
                              self.jostle("fit", "tiny.h5", *arguments, expect=BAD_INPUT).stderr)


class Kept(Case):
    """Fits in the results file."""

    def tables(self, file="tiny.h5"):
        return self.info(file)["tables"]

    def test_fits_are_kept_beside_the_data_and_replaced(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}]))
        self.run_scene()
        digest = self.digest("tiny.h5")
        self.assertEqual(self.tables(), [])
        for _ in range(2):
            self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--model", "kww")
        self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--sweep-point", "1")
        laws = ["inverse_log", "kww", "two_exponentials"]
        self.assertEqual(self.tables(), ["fits/point_0000/mean_height/kww"] +
                         [f"fits/point_0001/mean_height/{law}" for law in laws])
        self.assertEqual(self.digest("tiny.h5"), digest)
        with h5py.File(self.folder / "tiny.h5") as file:
            choices = set()
            for law in laws:
                table = file[f"fits/point_0001/mean_height/{law}"]
                choices.add(table.attrs["note_choice"])
                self.assertGreaterEqual(table["held_out_difference"][()], 0)
                self.assertTrue(0 <= table["held_out_p"][()] <= 1)
                self.assertNotIn("aic", table)
            self.assertEqual(len(choices), 1)

    def test_an_own_law_is_kept_with_its_formula(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}]))
        self.run_scene()
        for name in ((), ("--law-name", "line")):
            self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--sweep-point", "0", "--law",
                        "a + b*log(t)", "--start", "a=4,b=-0.1", *name, "--resample", "jackknife")
        self.assertEqual(self.tables(), ["fits/point_0000/mean_height/line",
                                         "fits/point_0000/mean_height/own"])
        with h5py.File(self.folder / "tiny.h5") as file:
            table = file["fits/point_0000/mean_height/own"]
            self.assertEqual(table.attrs["note_law"], "a + b*log(t)")
            self.assertEqual([name.decode() for name in table["parameter"]], ["a", "b"])
            self.assertEqual([unit.decode() for unit in table["units"]], ["X", "X"])

    def test_a_trial_leaves_what_is_kept(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}]))
        self.run_scene()
        asked = ("fit", "tiny.h5", "--observable", "mean_height", "--model", "kww")
        self.jostle(*asked)
        before = (self.folder / "tiny.h5").read_bytes()
        self.jostle(*asked, "--range", "1:20", "--no-store")
        self.assertEqual((self.folder / "tiny.h5").read_bytes(), before)

    def test_a_law_that_cannot_be_fitted_leaves_the_fit_that_is_kept(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}]))
        self.run_scene()
        kept = "point_0001/mean_height/kww"
        asked = ("fit", "tiny.h5", "--observable", "mean_height", "--sweep-point", "1", "--model", "kww")
        self.jostle(*asked)
        with h5py.File(self.folder / "tiny.h5") as file:
            before = file[f"fits/{kept}/value"][:]
        done = self.jostle(*asked, "--fix", "rho=3.6", expect=BAD_INPUT)
        self.assertIn(f"jostle: /fits/{kept} is kept: this request gave no result", done.stderr)
        with h5py.File(self.folder / "tiny.h5") as file:
            self.assertEqual(file[f"fits/{kept}/value"][:].tolist(), before.tolist())
            self.assertNotIn("note_refused", file[f"fits/{kept}"].attrs)

    def test_parameters_of_different_laws_or_ranges_are_not_compared_in_silence(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}]))
        self.run_scene()

        def fit(point, law, taps="1:40", *fixed):
            start = "b=-0.1" if fixed else "a=4,b=-0.1"
            self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--law", law, "--start", start,
                        "--sweep-point", point, "--range", taps, *fixed)

        sweep = ("analyse", "tiny.h5", "sweep", "--observable", "mean_height", "--quantity", "own/b")
        fit("0", "a + b*log(t)")
        fit("1", "a + b*t")
        self.assertRegex(self.jostle(*sweep, expect=BAD_INPUT).stderr,
                         r"different laws, a\+b\*log\(t\) at .*; a\+b\*t at .*: fit one law at every point")
        fit("1", "a + b*log(t)", "10:40")
        notes = json.loads(self.jostle(*sweep, "--json").stdout)["tables"][0]["notes"]
        self.assertRegex(notes["fits"], "^different: 1:40 at .* = .*; 10:40 at ")
        self.assertIn("the fits differ in their range of t", notes["maximum"])
        fit("1", "a + b*log(t)")
        notes = json.loads(self.jostle(*sweep, "--json").stdout)["tables"][0]["notes"]
        self.assertNotIn("fits", notes)
        fit("1", "a+b*log(t)", "1:40", "--fix", "a=4.2")
        notes = json.loads(self.jostle(*sweep, "--json").stdout)["tables"][0]["notes"]
        self.assertRegex(notes["fits"], "^different: 1:40 at .* = .*; 1:40, a = 4.2 at ")

    def test_a_file_that_cannot_be_changed_still_gives_its_fits(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}]))
        self.run_scene()
        (self.folder / "tiny.h5.lock").mkdir()  # no lock can be made there, even by root
        done = self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--model", "kww",
                           expect=BROKEN)
        self.assertIn("not stored", done.stderr)
        self.assertIn("rho_inf", done.stdout)
        self.assertEqual(self.tables(), [])

    def test_a_run_ends_with_the_fits_of_its_scene(self):
        asked = [{"observable": "mean_height", "model": "inverse_log", "range": [1, 30]}]
        protocol = [{"tap": {"dilate": 0.05}, "count": 40}]
        self.write(changed(TINY, protocol=protocol, fits=asked))
        done = self.run_scene()
        rows = done.stdout.split("fits of mean_height\n")[1].split("a(b):")[0].splitlines()
        self.assertEqual(rows[0].split(), ["sweep", "point", "law", "verdict", "asymptote"])  # nothing to compare
        self.assertNotIn("difference", done.stdout)
        self.assertEqual([row.split()[:4] for row in rows[1:]],
                         [["dilate", "=", value, "inverse_log"] for value in ("0.02", "0.1")])
        self.assertNotIn("95 %", done.stdout)
        self.assertIn("95 %", self.run_scene("--force", "--verbose").stdout)
        names = [f"fits/point_000{point}/mean_height/inverse_log" for point in (0, 1)]
        self.assertEqual(self.tables(), names)
        asked[0]["model"] = "kww"
        self.write(changed(TINY, protocol=protocol, fits=asked))
        self.run_scene("--resume")
        self.assertEqual(self.tables(), sorted(names + [name.replace("inverse_log", "kww") for name in names]))
        asked[0]["model"] = ["inverse_log", "kww"]
        self.write(changed(TINY, protocol=protocol, fits=asked))
        done = self.run_scene("--force")
        rows = done.stdout.split("fits of mean_height\n")[1].split("a(b):")[0].splitlines()
        self.assertEqual(rows[0].split(), ["sweep", "point", "law", "verdict", "difference", "asymptote"])
        self.assertEqual([row.split()[3] for row in rows[1:]], ["inverse_log", "kww"] * 2)
        self.assertEqual(len(self.tables()), 4)

    def test_shards_are_fitted_when_they_are_merged(self):
        asked = [{"observable": "mean_height", "model": "kww"}]
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}], fits=asked))
        for share in (1, 2):
            self.run_scene("--shard", f"{share}/2", "-o", f"{share}.h5")
            self.assertEqual(self.tables(f"{share}.h5"), [])
        self.jostle("merge", "1.h5", "2.h5", "-o", "all.h5")
        self.assertEqual(len(self.tables("all.h5")), 2)


if __name__ == "__main__":
    unittest.main()
