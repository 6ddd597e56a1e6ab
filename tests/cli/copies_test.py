"""Realizations that repeat one another count once, in analyses, fits and measured curves, and are warned of; p-values
and small numbers are printed with their size."""

import hashlib
import json
import shutil
import unittest

import h5py
import numpy as np
from support import TINY, UNFOLDED, Case, changed

CRYSTAL = {
    "name": "crystal", "seed": 1, "realizations": 3,
    "container": {"sides": "periodic", "width": [3, 2 * 3 ** 0.5]}, "spheres": 24, "start": {"crystal": "hcp"},
    "engine": {"discrete_element": {}}, "protocol": [{"tap": {"half_sine": {}}, "count": 32}],
    "observe": ["mean_height"]}
COPIES = "2 of the 3 realizations repeat the series of another, so 1 realization is used"
WARNING = "nothing is random in this scene"
SINGLE = {key: value for key, value in TINY.items() if key != "sweep"}


class Copies(Case):
    def table(self, *arguments):
        return json.loads(self.jostle("analyse", *arguments, "--no-store", "--json").stdout)["tables"][0]

    def replace(self, series):
        """A results file whose mean height is `series` [taps, realizations]."""
        path = self.folder / "series.h5"
        shutil.copy(self.folder / "tiny.h5", path)
        with h5py.File(path, "r+") as results:
            results["observables/point_0000/mean_height"][...] = series
            del results["provenance/contents"]
        content = path.read_bytes()
        path.write_bytes(content + f"\njostle-sha256 {hashlib.sha256(content).hexdigest()}\n".encode())

    def test_grains_on_a_crystal_are_one_realization(self):
        self.write(CRYSTAL)
        checked = self.jostle("check", "scene.json", "--no-pilot", environment=UNFOLDED)
        self.assertIn(WARNING, checked.stdout + checked.stderr)
        ran = self.run_scene(environment=UNFOLDED)
        self.assertIn(WARNING, ran.stdout + ran.stderr)
        for analysis in (["steady", "--last", "32"], ["spectrum", "--last", "32"],
                         ["ageing", "--waiting-times", "1,5"]):
            table = self.table("crystal.h5", analysis[0], "--observable", "mean_height", *analysis[1:])
            self.assertEqual(table["notes"]["copies"], COPIES, analysis)
            self.assertNotIn("p = 0 ", json.dumps(table["notes"]))
        steady = self.table("crystal.h5", "steady", "--observable", "mean_height", "--last", "32")
        self.assertEqual(steady["notes"]["realizations"], "1")
        with h5py.File(self.folder / "crystal.h5") as results:
            heights = results["observables/point_0000/mean_height"][()]
        self.assertEqual(len({tuple(column) for column in heights.T}), 1)
        self.assertAlmostEqual(steady["quantities"]["value"]["values"], heights[1:, 0].mean())
        fit = self.jostle("fit", "crystal.h5", "--observable", "mean_height", "--model", "kww", "--no-store",
                          environment=UNFOLDED)
        self.assertIn(COPIES + ".", fit.stdout)
        self.assertIn(", 1 realization", fit.stdout)
        found = json.loads(self.jostle("fit", "crystal.h5", "--observable", "mean_height", "--model", "kww",
                                       "--no-store", "--json").stdout)["curves"][0]
        self.assertEqual((found["notes"], found["realizations"]), ([COPIES + "."], 1))

    def test_copies_of_displacements_and_packings_count_once(self):
        self.write(changed(CRYSTAL, protocol=[{"tap": {"half_sine": {}}, "count": 6}], snapshots={"taps": [0, 6]},
                           motion={"origins": [1], "lags": [1, 5]}, structure={"layers": {}}))
        self.run_scene()
        motion = self.table("crystal.h5", "motion")
        structure = json.loads(self.jostle("structure", "crystal.h5", "--part", "layers", "--no-store",
                                           "--json").stdout)["tables"][0]
        for table, name in ((motion, "msd_lateral"), (structure, "grown_layers")):
            self.assertEqual(table["notes"]["copies"], COPIES)
            self.assertEqual({*np.ravel(table["quantities"]["realizations"]["values"]).tolist()}, {1})
            self.assertEqual({*np.ravel(table["quantities"][name + "_dof"]["values"]).tolist()}, {0})
        self.write(changed(SINGLE, motion={"origins": [1], "lags": [1, 2]}, structure={"layers": {}}))
        self.run_scene()
        self.assertNotIn("copies", self.table("tiny.h5", "motion")["notes"])
        with h5py.File(self.folder / "tiny.h5") as results:
            self.assertEqual(results["structure/point_0000/layers/realizations"][:].tolist(), [3, 3])
            self.assertNotIn("note_copies", results["structure/point_0000/layers"].attrs)

    def test_copies_count_once_in_the_table_of_taps_and_its_curve(self):
        self.write(changed(CRYSTAL, protocol=[{"tap": {"half_sine": {}}, "count": 3}]))
        ran = self.run_scene(environment=UNFOLDED).stdout
        shown = self.jostle("info", "crystal.h5", environment=UNFOLDED).stdout
        for text in (ran, shown):
            self.assertIn(COPIES + ".", text)
        # One packing: its height has no error.
        row = next(line for line in ran.splitlines() if line.split()[:1] == ["3"])
        self.assertNotIn("(", row)
        catalogue = self.folder / "catalogue.json"
        self.jostle("report", "crystal.h5", "--catalogue", "catalogue.json")
        self.assertNotIn('"count": 3', catalogue.read_text())
        with h5py.File(self.folder / "crystal.h5") as results:  # the file keeps what was stored of all
            self.assertEqual(results["ensemble/point_0000/mean_height_count"][-1], 3)
        self.write(SINGLE)
        self.assertNotIn("repeat the series", self.run_scene(environment=UNFOLDED).stdout)

    def test_copies_count_once_in_figures_of_snapshots_and_are_no_thin_lines(self):
        def drawn(name):
            """The series of the coordination, and of all thin lines."""
            self.jostle("report", f"{name}.h5", "--catalogue", "catalogue.json", "--force")
            figures = json.loads((self.folder / "catalogue.json").read_text())["figures"]
            series = {figure["name"]: figure["panels"][0]["series"] for figure in figures}
            return (series["coordination-of-the-kept-packings"][0],
                    [line for lines in series.values() for line in lines if line.get("thin")])

        self.write(changed(CRYSTAL, protocol=[{"tap": {"half_sine": {}}, "count": 3}], snapshots={"taps": [0, 3]}))
        self.run_scene()
        coordination, thin = drawn("crystal")
        self.assertEqual(len(coordination["y"]), 2)
        self.assertNotIn("error", coordination)  # one packing has none
        self.assertEqual(thin, [])
        self.write(changed(SINGLE, snapshots={"taps": [0, 2]}))
        self.run_scene()
        coordination, thin = drawn("tiny")
        self.assertGreater(max(coordination["error"]), 0)
        self.assertNotEqual(thin, [])

    def test_copies_meet_no_target_precision_and_none_are_added(self):
        target = {"observable": "mean_height", "standard_error": 0.01}
        self.write(changed(CRYSTAL, protocol=[{"tap": {"half_sine": {}}, "count": 3}],
                           until={"targets": [target], "at_most": 50}))
        done = self.run_scene(environment=UNFOLDED)
        self.assertIn("3 realizations: target precision NOT reached: standard_error of mean_height is not known "
                      f"(fewer than two independent realizations), target at most 0.01; {COPIES}\n", done.stdout)
        with h5py.File(self.folder / "crystal.h5") as results:
            self.assertEqual(results["observables/point_0000/mean_height"].shape[1], 3)
            notes = results["analysis/target_precision"].attrs
            self.assertEqual((notes["note_verdict"], notes["note_copies"]), ("not met", COPIES))

    def test_a_random_start_is_not_warned_of(self):
        self.write(changed(CRYSTAL, start={"pour": "steepest_descent"},
                           container={"sides": "periodic", "width": 3}, spheres=20))
        checked = self.jostle("check", "scene.json", "--no-pilot", environment=UNFOLDED)
        self.assertNotIn(WARNING, checked.stdout + checked.stderr)

    def tapped(self):
        self.write(changed(SINGLE, protocol=[{"tap": {"dilate": 0.05}, "count": 80}], snapshots={"taps": [0]}))
        self.run_scene()
        return np.random.default_rng(20261127).normal(size=(81, 3))

    def test_copies_are_recognised_by_their_series_and_others_are_kept(self):
        noise = self.tapped()
        self.replace(noise)
        others = self.table("series.h5", "steady", "--observable", "mean_height", "--last", "64")
        self.assertNotIn("copies", others["notes"])
        self.assertEqual(others["notes"]["realizations"], "3")
        noise[:, 2] = noise[:, 0]
        self.replace(noise)
        two = self.table("series.h5", "steady", "--observable", "mean_height", "--last", "64")
        self.assertEqual(two["notes"]["copies"],
                         "1 of the 3 realizations repeats the series of another, so 2 realizations are used")
        self.assertAlmostEqual(two["quantities"]["value"]["values"], noise[17:, :2].mean())
        self.assertEqual(two["quantities"]["value_dof"]["values"], 1)
        # Equal by chance: other columns of these realizations differ.
        noise[:, :] = np.arange(81)[:, None] % 3
        self.replace(noise)
        discrete = self.table("series.h5", "steady", "--observable", "mean_height", "--last", "64")
        self.assertNotIn("copies", discrete["notes"])

    def test_small_series_have_the_texts_of_large_ones(self):
        noise = self.tapped()
        texts = []
        for factor in (1, 1e-15):
            self.replace((5 + noise) * factor)
            texts.append(self.jostle("analyse", "series.h5", "steady", "--observable", "mean_height", "--last", "64",
                                     "--no-store", environment=UNFOLDED).stdout)
        for name in ("value", "sigma", "drift"):
            large, small = (next(line for line in text.splitlines() if line.startswith(f"  {name} ")).split()[1]
                            for text in texts)
            self.assertIn("(", small, name)
            self.assertAlmostEqual(float(small.split("(")[0] + "e" + small.split("e")[1]) * 1e15,
                                   float(large.split("(")[0]), delta=0.06, msg=name)

    def test_a_drift_without_doubt_has_no_p_of_0(self):
        noise = self.tapped()
        self.replace(1e-6 * noise + np.arange(81)[:, None])
        table = self.table("series.h5", "steady", "--observable", "mean_height", "--last", "64")
        self.assertIn("p < 1e-16 at the 5 % level", table["notes"]["verdict"])
        shown = self.jostle("analyse", "series.h5", "steady", "--observable", "mean_height", "--last", "64", "--wide",
                            "--no-store", environment=UNFOLDED).stdout
        self.assertRegex(shown, r"drift_p +< 1e-16")
        self.assertNotIn("p = 0 ", shown)


class Measured(Case):
    def test_small_numbers_of_fits_keep_their_errors(self):
        t = np.arange(1, 101)
        noise = np.random.default_rng(20261127).normal(size=100)
        curve = 0.6 - 0.05 * np.exp(-(t / 15) ** 0.7) + 1e-3 * noise
        texts = []
        for factor in (1, 1e-12, 1e-24):
            np.savetxt(self.folder / "curve.csv", np.transpose([t, curve * factor]), delimiter=",", header="t,X",
                       comments="", fmt="%.17g")
            text = self.jostle("fit", "curve.csv", "--model", "kww", environment=UNFOLDED).stdout
            texts.append(next(line for line in text.splitlines() if line.strip().startswith("rho_inf ")).split()[1])
        self.assertIn("(", texts[0])
        for text, power in zip(texts[1:], (12, 24)):
            self.assertIn("(", text)
            self.assertRegex(text, rf"e-{power + 1}$")

    def test_a_range_from_high_to_low_is_named_so(self):
        (self.folder / "curve.csv").write_text("t,X\n" + "".join(f"{t},{1 / t}\n" for t in range(1, 30)))
        for arguments, part in ((["--range", "10:5"], "--range 10:5: 10 is larger than 5"),
                                (["--law", "a*exp(-t/tau)", "--start", "a=1,tau=20", "--bounds", "tau=30:20"],
                                 "--bounds tau=30:20: 30 is larger than 20, and the first number of a range may "
                                 "not exceed the last; write tau=20:30")):
            self.assertIn(part, self.jostle("fit", "curve.csv", *arguments, expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
