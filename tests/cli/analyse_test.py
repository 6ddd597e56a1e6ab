"""jostle analyse: steady states and spectra of results, for people and for programs."""

import csv
import math
import re
import unittest

import h5py
import numpy as np

from analysed import TAPPED, Analysed
from support import BAD_INPUT, BROKEN, TINY, UNFOLDED, changed


class Analyses(Analysed):
    def test_a_steady_state_of_every_sweep_point(self):
        self.write(TAPPED)
        self.run_scene()
        digest = self.digest("tiny.h5")
        tables = self.analyse("tiny.h5", "steady", "--observable", "mean_height", "--last",
                              "64")["tables"]
        names = [f"point_000{point}/steady/mean_height" for point in (0, 1)]
        self.assertEqual([table["name"] for table in tables], names)
        self.assertEqual(self.tables(), [f"analysis/{name}" for name in names])
        self.assertEqual(self.digest("tiny.h5"), digest)
        for table in tables:
            self.assertEqual(table["notes"]["taps"], "97 to 160")
            self.assertEqual(table["notes"]["realizations"], "3")
            self.assertRegex(table["notes"]["verdict"],
                             "^(reached: |not reached: |cannot decide with 3 realizations: )")
            self.assertEqual(table["quantities"]["value_dof"]["values"], 2)
            value = table["quantities"]["value"]
            self.assertEqual(value["units"], "diameter")
            self.assertGreater(table["quantities"]["value_error"]["values"], 0)
            blocks = table["quantities"]["blocks"]["values"]
            self.assertEqual(blocks, [192, 96, 48, 24, 12, 6])

        # This mean from the ensemble's own curve.
        curve = self.analyse("tiny.h5", "steady", "--observable", "mean_height", "--last", "160",
                             "--no-store", "--sweep-point", "1", "--csv", "out.csv")["tables"]
        self.assertEqual(len(curve), 1)
        for name in ("dilate = 0.1", "dilate=0.1", "tap/dilate=0.1", "/protocol/0/tap/dilate=0.1", "0.1"):
            named = self.analyse("tiny.h5", "steady", "--observable", "mean_height", "--last", "160",
                                 "--no-store", "--sweep-point", name)["tables"]
            self.assertEqual(named, curve)
        lines = (self.folder / "out.csv").read_text().splitlines()
        self.assertIn("# point_0001/steady/mean_height", lines)
        header = next(i for i, line in enumerate(lines) if line.startswith("value,"))
        row = next(csv.DictReader(lines[header:header + 2]))
        self.assertEqual(float(row["value"]), curve[0]["quantities"]["value"]["values"])
        self.assertEqual(self.tables(), [f"analysis/{name}" for name in names])

    def test_a_spectrum_holds_the_variance_of_its_lines(self):
        self.write(TAPPED)
        self.run_scene()
        asked = ["tiny.h5", "spectrum", "--observable", "mean_height", "--last", "128",
                 "--segment", "128", "--window", "boxcar", "--sweep-point", "0"]
        table = self.analyse(*asked)["tables"][0]
        self.assertEqual(table["quantities"]["density"]["units"], "diameter^2 taps")
        lines = table["quantities"]["lines"]["values"]
        self.assertEqual(sum(lines), 64)
        density = table["quantities"]["density"]["values"]
        from_lines = sum(p * n for p, n in zip(density, lines)) / 128
        steady = self.analyse("tiny.h5", "steady", "--observable", "mean_height", "--last", "128",
                              "--sweep-point", "0", "--no-store")["tables"][0]
        # Blocks of one tap: variance of single taps / (n - 1) over all 384 of them.
        error = steady["quantities"]["block_error"]["values"][0]
        self.assertAlmostEqual(from_lines / (error ** 2 * 384 * 127 / 128), 1, places=9)
        self.assertIn("drift", table["notes"]["drift"])
        self.assertRegex(table["notes"]["verdict"], "^no test: the taps are too few to estimate the autocorrelation time")
        self.assertIsNone(table["quantities"]["ar1_slope_p"]["values"])
        other = self.analyse(*asked[:-1], "1")["tables"][0]
        self.assertIn("a stationary AR(1) with the same autocorrelation time", other["notes"]["verdict"])
        band = self.analyse(*asked, "--band", "0.01:0.2")["tables"][0]
        self.assertTrue(band["notes"]["band"].startswith("0.01 to 0.2 per tap"))
        self.assertTrue(math.isfinite(band["quantities"]["slope_error"]["values"]))
        text = self.jostle("analyse", *asked).stdout
        self.assertRegex(text, r"slope +-?\d+\.\d+\(\d")

    def test_options_stand_before_the_name_of_an_analysis_too(self):
        self.write(TAPPED)
        self.run_scene()
        behind = self.analyse("tiny.h5", "steady", "--observable", "mean_height", "--last", "64")
        before = self.analyse("tiny.h5", "--observable", "mean_height", "--last", "64", "steady")
        self.assertEqual(before["tables"], behind["tables"])
        for wrong, said in ((["--band", "0.1:0.2", "steady", "--observable", "mean_height"],
                             "steady has no option --band"),
                            (["--last", "64", "steady", "--last", "65", "--observable",
                              "mean_height"], "--last is there twice"),
                            (["steady", "--segment", "5", "--observable", "mean_height"],
                             "--segment: Value 5 not in range"),
                            (["steady"], "--observable is required")):
            done = self.jostle("analyse", "tiny.h5", *wrong, expect=BAD_INPUT)
            self.assertIn(said, done.stderr)

    def test_people_read_half_widths_and_programs_errors(self):
        self.write(TAPPED)
        self.run_scene()
        asked = ["tiny.h5", "steady", "--observable", "mean_height", "--sweep-point", "0"]
        found = self.analyse(*asked)["tables"][0]["quantities"]
        text = self.jostle("analyse", *asked, environment=UNFOLDED).stdout
        value, digits = re.search(r"^  value +(\S+)\((\d+)\) diameter", text, re.M).groups()
        printed = int(digits) * 10.0 ** -len(value.split(".")[1])
        # Student's t of two degrees of freedom at 68.27 %.
        error = found["value_error"]["values"]
        self.assertAlmostEqual(printed / (1.3213 * error), 1, delta=0.05)
        self.assertNotIn("value_dof", text)
        self.assertIn("half the 68 % interval by Student's t", text)

    def test_differences_between_points_are_paired_where_streams_are_matched(self):
        means = {}
        for streams in ("matched", "independent"):
            self.write(changed(TAPPED, name=streams, streams=streams, realizations=4,
                               sweep={"/protocol/0/tap/dilate": [0.01, 0.04, 0.09]}))
            self.run_scene()
            asked = [f"{streams}.h5", "sweep", "--observable", "mean_height", "--last", "40"]
            table = self.analyse(*asked)["tables"][0]
            means = [self.series("mean_height", point, f"{streams}.h5")[-40:].mean(axis=0)
                     for point in range(3)]
            found = {name: table["quantities"][name]["values"] for name in
                     ("from", "to", "difference", "difference_error", "difference_dof",
                      "difference_p", "difference_p_corrected")}
            for pair in range(2):
                step = means[pair + 1] - means[pair]
                self.assertAlmostEqual(found["difference"][pair] / step.mean(), 1, places=9)
                if streams == "matched":
                    error, dof = step.std(ddof=1) / 2, 3
                else:
                    squares = [means[i].var(ddof=1) / 4 for i in (pair, pair + 1)]
                    error = sum(squares) ** 0.5
                    dof = 3 * sum(squares) ** 2 / (squares[0] ** 2 + squares[1] ** 2)
                self.assertAlmostEqual(found["difference_error"][pair] / error, 1, places=9)
                self.assertAlmostEqual(found["difference_dof"][pair], dof, places=6)
            least = min(found["difference_p"])
            self.assertAlmostEqual(min(found["difference_p_corrected"]), min(1, 2 * least))
            self.assertEqual("matched" in table["notes"]["differences"].split("not")[0],
                             streams == "matched")
            to_one = self.analyse(*asked, "--reference", "0.3")["tables"][0]["quantities"]
            self.assertEqual([round(x, 12) for x in to_one["to"]["values"]], [0.1, 0.2])
        refused = self.jostle("analyse", *asked, "--reference", "0.25", expect=BAD_INPUT,
                              environment=UNFOLDED).stderr
        self.assertIn("there are, of sqrt_epsilon, 0.1, 0.2, 0.3", refused)

    def test_what_cannot_be_analysed_is_refused_in_words(self):
        self.write(TINY)
        self.run_scene()
        steady = ["analyse", "tiny.h5", "steady", "--observable"]
        done = self.jostle(*steady, "mean_heigth", expect=BAD_INPUT)
        self.assertIn("mean_height, bottom_fraction", done.stderr)
        done = self.jostle(*steady, "mean_height", expect=BAD_INPUT)
        self.assertIn("there are 4", done.stderr)
        self.write("no results", "data.csv")
        done = self.jostle("analyse", "data.csv", *steady[2:], "mean_height", expect=BROKEN)
        self.assertIn("not a results file", done.stderr)
        done = self.jostle("analyse", "tiny.h5", "spectrum", "--observable", "mean_height",
                           "--band", "0.3:0.1", expect=BAD_INPUT)
        self.assertIn("--band", done.stderr)

    def test_a_refused_analysis_writes_no_csv(self):
        self.write(TINY)
        self.run_scene()
        steady = ["analyse", "tiny.h5", "steady", "--observable", "mean_height", "--csv", "steady.csv"]
        self.jostle(*steady, expect=BAD_INPUT)
        self.assertFalse((self.folder / "steady.csv").exists())
        self.write("kept", "steady.csv")
        self.jostle(*steady, "--force", expect=BAD_INPUT)
        self.assertEqual((self.folder / "steady.csv").read_text(), "kept")

    def test_a_sweep_has_no_sweep_point(self):
        self.write(TAPPED)
        self.run_scene()
        done = self.jostle("analyse", "tiny.h5", "sweep", "--observable", "mean_height",
                           "--sweep-point", "1", expect=BAD_INPUT)
        self.assertIn("--sweep-point: a sweep compares all points", done.stderr)
        self.assertEqual(self.tables(), [])

    def test_ageing_is_the_mean_squared_change_over_realizations(self):
        self.write(TAPPED)
        self.run_scene()
        asked = ["tiny.h5", "ageing", "--observable", "mean_height", "--waiting-times", "40,0,10",
                 "--lags", "1,5,100,150"]
        table = self.analyse(*asked, "--threads", "1")["tables"][1]
        self.assertEqual(table["axes"]["waiting_time"]["values"], [0, 10, 40])
        z = self.series("mean_height", point=1)
        for i, waiting_time in enumerate((0, 10, 40)):
            for j, lag in enumerate((1, 5, 100, 150)):
                found = table["quantities"]["a"]["values"][i][j]
                if waiting_time + lag > 160:
                    self.assertIsNone(found)
                    continue
                squares = (z[waiting_time + lag] - z[waiting_time]) ** 2
                self.assertAlmostEqual(found / squares.mean(), 1, places=12)
                error = table["quantities"]["a_error"]["values"][i][j]
                # The jackknife of ln A.
                left_out = np.log([np.delete(squares, r).mean() for r in range(3)])
                relative = left_out.std() * 2 ** 0.5
                self.assertAlmostEqual(error / (squares.mean() * relative), 1, places=9)
                high = table["quantities"]["a_high_68"]["values"][i][j]
                self.assertAlmostEqual(np.log(high / found), 1.3213 * relative, delta=1e-4 * relative)
        again = self.analyse(*asked, "--threads", "2")["tables"][1]
        self.assertEqual(again, table)

    def test_an_equilibrium_that_is_not_observed_is_refused(self):
        self.write(TAPPED)
        self.run_scene()
        for point in ((), ("--sweep-point", "0")):
            ended = self.jostle("analyse", "tiny.h5", *point, "ordering", "--observable", "mean_height",
                                "--threshold", "1", "--equilibrium", "nonsense", expect=BAD_INPUT)
            self.assertIn("--equilibrium nonsense: there is none; ", ended.stderr)
            self.assertEqual(ended.stdout, "")
        self.jostle("analyse", "tiny.h5", "ordering", "--observable", "mean_height", "--threshold", "1",
                    "--equilibrium", "bottom_fraction")

    def test_one_realization_has_no_interval_of_the_median(self):
        self.write(changed(TAPPED, realizations=1))
        self.run_scene()
        out = self.analyse("tiny.h5", "ordering", "--observable", "mean_height", "--threshold", "0.5",
                           "--hold", "1")
        verdict = out["tables"][0]["notes"]["verdict"]
        self.assertIn("(68 %: no interval; 95 %: no interval)", verdict)

    def test_a_sweep_over_a_stage_of_several_names_the_stage(self):
        taps = [{"tap": {"dilate": 0.05}, "count": 10}, {"tap": {"dilate": 0.02}, "count": 20}]
        self.write(changed(TAPPED, protocol=taps, sweep={"/protocol/0/tap/dilate": [0.01, 0.04, 0.09]},
                           analyse={"sweep": [{"observable": "mean_height", "last": 10}]}))
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as stored:
            axis = stored["analysis/sweep/mean_height/value/sqrt_epsilon"]
            self.assertEqual(axis.attrs["long_name"], "strength of the taps of stage 1")

    def test_a_sweep_without_any_value_states_what_was_sought_and_why_there_is_none(self):
        # 33 taps of beds that still move are too few for their memory: every sigma is a lower bound.
        scene = changed(TAPPED, protocol=[{"tap": {"dilate": 0.05}, "count": 33}],
                        sweep={"/protocol/0/tap/dilate": [0.0001, 0.0004]},
                        analyse={"steady": [{"observable": "mean_height", "last": 33}],
                                 "sweep": [{"observable": "mean_height", "quantity": "steady/sigma"}]})
        self.write(scene)
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as stored:
            sweep = stored["analysis/sweep/mean_height/steady_sigma"]
            refused = sweep.attrs["note_refused"]
            self.assertEqual([*sweep], [])
        self.assertRegex(refused, "^no sweep point has a value of steady/sigma of mean_height; "
                                  "at sqrt_epsilon = 0.01, 0.02: lower bound of the deviation .*: the taps are too few "
                                  "for their memory. Average over more taps")
        name = "analysis/sweep/mean_height/steady_sigma"
        self.assertEqual(self.info("tiny.h5")["tables_without_results"], [name])
        listed = self.jostle("info", "tiny.h5").stdout
        self.assertIn(f"/{name}: no result\n", listed)
        self.assertIn("/analysis/point_0000/steady/mean_height\n", listed)
        shown = self.jostle("analyse", "tiny.h5", "sweep", "--observable", "mean_height", "--quantity", "steady/sigma",
                            expect=BAD_INPUT)
        self.assertNotIn("0 rows", shown.stdout)
        self.assertIn("no sweep point has a value of steady/sigma", " ".join(shown.stderr.split()))

    def test_a_sweep_is_drawn_against_the_square_root_of_epsilon(self):
        asked = {"steady": [{"observable": "mean_height"}],
                 "sweep": [{"observable": "bottom_fraction", "last": 50},
                           {"observable": "mean_height", "quantity": "steady/sigma"},
                           {"observable": "mean_height", "quantity": "steady/value"},
                           {"observable": "mean_height", "quantity": "inverse_log/dX"},
                           {"observable": "bottom_fraction", "quantity": "inverse_log/X_inf"}]}
        scene = changed(TAPPED, analyse=asked, streams="matched",
                        sweep={"/protocol/0/tap/dilate": [0.09, 0.01, 0.04]},
                        fits=[{"observable": name, "model": "inverse_log"}
                              for name in ("bottom_fraction", "mean_height")])
        self.write(scene)
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as stored:
            # No point has a rise with two limits.
            rise = stored["analysis/sweep/mean_height/inverse_log_dX"].attrs["note_refused"]
            self.assertIn("no sweep point has a value of inverse_log/dX of mean_height; at sqrt_epsilon = ", rise)
            value = stored["analysis/sweep/bottom_fraction/value"]
            self.assertEqual([round(x, 12) for x in value["sqrt_epsilon"][:]], [0.1, 0.2, 0.3])
            means = [self.series("bottom_fraction", point)[-50:].mean() for point in (1, 2, 0)]
            for found, mean in zip(value["bottom_fraction"][:], means):
                self.assertAlmostEqual(found / mean, 1, places=12)
            # Matched streams: the deviation about the level of each realization.
            rows = np.array([self.series("bottom_fraction", point)[-50:].mean(axis=0) for point in (1, 2, 0)])
            rest = rows - rows.mean(axis=0) - rows.mean(axis=1)[:, None] + rows.mean()
            dof = (rows.shape[0] - 1) * (rows.shape[1] - 1)
            self.assertAlmostEqual(value["pooled_sigma"][()] / ((rest ** 2).sum() / dof) ** 0.5, 1, places=9)
            self.assertIn("about its own level", value["pooled_sigma"].attrs["long_name"])
            # A deviation that is only known to be at least its value is no point.
            for point in (1, 2, 0):
                sigma = stored[f"analysis/point_{point:04}/steady/mean_height/sigma"]
                self.assertTrue(sigma.attrs["long_name"].startswith("lower bound"))
            sweep = stored["analysis/sweep/mean_height/steady_sigma"]
            self.assertIn("at sqrt_epsilon = 0.1, 0.2, 0.3: lower bound", sweep.attrs["note_refused"])
            self.assertEqual(
                stored["analysis/sweep/mean_height/steady_value/value"].attrs["units"], "diameter")
            # Points whose fits do not limit the parameter on both sides are no points, and each has its reason.
            drawn = stored["analysis/sweep/bottom_fraction/inverse_log_X_inf"].attrs["note_refused"]
            for x, point in ((0.1, 1), (0.2, 2), (0.3, 0)):
                fit = stored[f"fits/point_{point:04}/bottom_fraction/inverse_log"]
                place = [name.decode() for name in fit["parameter"][:]].index("X_inf")
                self.assertNotIn(fit["identifiability"][place], (b"identified", b"wide"))
                self.assertRegex(drawn, rf"at sqrt_epsilon = [0-9., ]*{x:.4g}[0-9., ]*: ")
                self.assertIn(fit["statement"][place].decode(), drawn)
            self.assertEqual(value.attrs["note_taps"], "111 to 160")

        # A value zipped with the swept value is no sweep of its own; a crossed one is.
        crossed = changed(scene, name="crossed", analyse={}, fits=[], realizations=2, sweep={
            "zip": {"/protocol/0/tap/dilate": [0.01, 0.04], "/protocol/0/count": [20, 24]},
            "/spheres": [48, 40]})
        self.write(crossed)
        self.run_scene()
        tables = self.analyse("crossed.h5", "sweep", "--observable", "bottom_fraction",
                              "--against", "/protocol/0/tap/dilate")["tables"]
        self.assertEqual([table["notes"]["at"] for table in tables],
                         ["/spheres = 48", "/spheres = 40"])
        by_name = self.analyse("crossed.h5", "sweep", "--observable", "bottom_fraction",
                               "--against", "dilate")["tables"]
        self.assertEqual(by_name, tables)
        self.assertEqual(tables[0]["axes"]["sqrt_epsilon"]["values"], [0.1, 0.2])
        for key in ("/relax/stop/sweeps", "/seed"):
            refused = self.jostle("analyse", "crossed.h5", "sweep", "--observable", "bottom_fraction", "--against", key,
                                  expect=BAD_INPUT).stderr
            self.assertIn(f'"{key}" is not swept (swept: /protocol/0/tap/dilate, /protocol/0/count, /spheres)',
                          " ".join(refused.split()))
        self.assertEqual(self.tables("crossed.h5"), ["analysis/sweep/bottom_fraction/value_0000",
                                                     "analysis/sweep/bottom_fraction/value_0001"])

        # Over several files without a sweep of their own, the same curve.
        for index, dilate in enumerate((0.01, 0.04, 0.09)):
            single = changed(scene, name=f"single{index}", analyse={}, fits=[],
                             protocol=[{"tap": {"dilate": dilate}, "count": 160}])
            del single["sweep"]
            self.write(single)
            self.run_scene()
        curve = self.analyse("single0.h5", "single1.h5", "single2.h5", "sweep", "--observable",
                             "bottom_fraction", "--last", "50")["tables"][0]
        self.assertEqual(curve["axes"]["sqrt_epsilon"]["values"], [0.1, 0.2, 0.3])
        self.assertTrue(0.4 < min(curve["quantities"]["bottom_fraction"]["values"]) < 0.7)
        self.assertEqual(self.tables("single0.h5"), [])
        # The last taps are those of the last stage.
        two_stages = changed(scene, name="stages", analyse={}, fits=[],
                             protocol=[{"tap": {"dilate": 0.16}, "count": 4}, {"tap": {"dilate": 0.04}, "count": 60}])
        del two_stages["sweep"]
        self.write(two_stages)
        self.run_scene()
        (curve,) = self.analyse("single0.h5", "stages.h5", "single2.h5", "sweep", "--observable", "bottom_fraction",
                                "--last", "50")["tables"]
        self.assertEqual(curve["axes"]["sqrt_epsilon"]["values"], [0.1, 0.2, 0.3])
        self.jostle("analyse", "single0.h5", "single1.h5", "sweep", "--observable", "bottom_fraction", "--against",
                    "/protocol/0/tap/dilate")
        refused = self.jostle("analyse", "single0.h5", "single1.h5", "sweep", "--observable", "bottom_fraction",
                              "--against", "/spheres", expect=BAD_INPUT).stderr
        self.assertIn('"/spheres" is not swept (swept: none)', " ".join(refused.split()))
        refused = self.jostle("analyse", "single0.h5", "sweep", "--observable", "mean_height",
                              "--quantity", "kww/tau", expect=BAD_INPUT).stderr
        self.assertIn("make the analysis or the fit first", refused)

    def test_a_request_without_any_result_stores_nothing(self):
        self.write(TAPPED)
        self.run_scene()
        self.jostle("analyse", "tiny.h5", "steady", "--observable", "mean_height")
        before = (self.folder / "tiny.h5").read_bytes()

        def refused(*arguments, answer):
            shown = self.jostle("analyse", "tiny.h5", *arguments, expect=BAD_INPUT).stderr
            self.assertIn(answer, " ".join(shown.split()))
            self.assertEqual((self.folder / "tiny.h5").read_bytes(), before)

        sweep = ("sweep", "--observable", "mean_height", "--quantity")
        refused(*sweep, "steady/sigm", answer='Did you mean "steady/sigma"?')
        refused(*sweep, "stedy/sigma", answer='Did you mean "steady/sigma"?')
        refused("sweep", "--observable", "mean_hight", "--quantity", "steady/sigma",
                answer='Did you mean "mean_height"?')
        refused("sweep", "--observable", "mean_height", "mean_hight", answer='Did you mean "mean_height"?')
        refused("hysteresis", "--observable", "mean_height", "--last", "1000", answer="no table could be made")
        refused("memory", "--observable", "mean_height", answer="no table could be made")

    def test_several_files_are_each_given_their_tables(self):
        for name in ("a", "b"):
            self.write(changed(TAPPED, name=name))
            self.run_scene()
        tables = self.analyse("a.h5", "b.h5", "steady", "--observable", "mean_height",
                              "bottom_fraction")["tables"]
        self.assertEqual([table["file"] for table in tables], ["a.h5"] * 4 + ["b.h5"] * 4)
        self.assertEqual(self.tables("a.h5"), self.tables("b.h5"))
        self.assertEqual(len(self.tables("a.h5")), 4)

    def test_a_run_ends_with_the_analyses_of_its_scene(self):
        asked = {"steady": [{"observable": "mean_height", "last": 40}],
                 "spectrum": [{"observable": "bottom_fraction"}]}
        self.write(changed(TAPPED, analyse=asked))
        done = self.run_scene()
        self.assertIn("\nsteady/mean_height\n  dilate = ", done.stdout)
        self.assertIn("slope ", done.stdout.split("\nspectrum/bottom_fraction\n")[1])
        names = [f"analysis/point_000{point}/{kind}" for point in (0, 1)
                 for kind in ("spectrum/bottom_fraction", "steady/mean_height")]
        self.assertEqual(self.tables(), names)
        # A resume accepts other analyses; two threads give the same tables.
        asked["steady"].append({"observable": "bottom_fraction"})
        self.write(changed(TAPPED, analyse=asked))
        self.run_scene("--resume")
        self.assertEqual(len(self.tables()), 6)
        for share in (1, 2):
            self.run_scene("--shard", f"{share}/2", "-o", f"{share}.h5")
            self.assertEqual(self.tables(f"{share}.h5"), [])
        self.jostle("merge", "1.h5", "2.h5", "-o", "all.h5")
        self.assertEqual(self.tables("all.h5"), self.tables())


if __name__ == "__main__":
    unittest.main()
