"""The program from Python: runs, what is derived from them, errors, interrupts, live runs."""

import contextlib
import io
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import textwrap
import time
import unittest
import unittest.mock
import warnings

import h5py
import jostle
import numpy as np

from support import ENDLESS, PROGRAM, SOURCE, TINY, Case, changed, made

SHORT = changed(TINY, sweep=None, protocol=[{"tap": {"dilate": 0.05}, "count": 40}])
BAD = {"seed": -1, "container": {"sides": "periodic", "width": 1}, "spheres": 0,
       "protocol": [{"tap": {"dilat": 0.05}, "count": 2}]}
POINTERS = ["/seed", "/container/width", "/spheres", "/protocol/0/tap/dilat"]


class Run(Case):
    def run_scene(self, *arguments, **keywords):
        results = jostle.run(*arguments, **keywords)
        self.addCleanup(results.close)
        return results

    def test_a_scene_that_begins_with_a_byte_order_mark_has_its_name(self):
        pathlib.Path("marked.json").write_text("\ufeff" + json.dumps(changed(SHORT, name="named")), encoding="utf-8")
        self.assertEqual(pathlib.Path(self.run_scene("marked.json").path).name, "named.h5")

    def test_points_are_numbers_even_where_a_value_is_the_number_of_another(self):
        path = made(changed(SHORT, name="lifts", sweep={"/protocol/0/tap/dilate": [1, 0.1]}))
        results = self.open(path)
        for point in (0, 1):
            file = pathlib.Path(jostle.export(results, f"{point}.xyz", format="extxyz", point=point))
            first = [float(word) for word in file.read_text().splitlines()[2].split()[1:4]]
            np.testing.assert_array_equal(first, results.positions(point)[0])
            jostle.plot.figures(results, point=point)
            curve, = jostle.fit(path, "mean_height", model="kww", sweep_point=point)
            self.assertIn(f"dilate = {(1, 0.1)[point]}", curve.title)
            table, = jostle.analyse(path, "steady", "mean_height", sweep_point=np.int64(point), store=False)
            self.assertIn(f"point_000{point}", table.name)
        jostle.export(results, "named.xyz", format="extxyz", point="dilate=0.1")
        self.assertEqual(pathlib.Path("named.xyz").read_bytes(), pathlib.Path("1.xyz").read_bytes())
        with self.assertRaisesRegex(jostle.JostleError, "write number=1 or dilate=1"):
            jostle.fit(path, "mean_height", sweep_point="1")
        pathlib.Path("curve.csv").write_text("t,X\n1,0.5\n2,0.6\n4,0.65\n8,0.67\n16,0.68\n")
        with self.assertRaisesRegex(jostle.JostleError, "store=False applies only to results files"):
            jostle.fit("curve.csv", model="kww", store=False)

    def test_a_dict_is_run_and_resumed_as_its_file_is(self):
        results = self.run_scene(SHORT, threads=1)
        self.assertEqual(pathlib.Path(results.path), pathlib.Path("tiny.h5"))
        self.assertEqual(sorted(os.listdir(".")), ["tiny.h5"])  # nothing else is left
        self.assertEqual(results.digest(), self.open(made(SHORT)).digest())
        self.assertEqual(json.loads(results.scene_verbatim), SHORT)
        longer = changed(SHORT, realizations=4)
        pathlib.Path("longer.json").write_text(json.dumps(longer, indent=1))
        grown = self.run_scene("longer.json", "tiny.h5", resume=True)
        self.assertEqual(grown.n_realizations, 4)
        self.assertEqual(grown.digest(), self.open(made(longer)).digest())

    def test_numbers_of_numpy_are_numbers_of_the_scene(self):
        scene = changed(SHORT, realizations=np.int64(1), seed=np.uint64(2 ** 64 - 1),
                        snapshots={"taps": np.array([0, 2])}, spheres=np.float64(30),
                        protocol=[{"tap": {"dilate": np.float64(0.05)}, "count": 2}])
        results = self.run_scene(scene, progress=False)
        self.assertEqual((results.points[0].seed, results.points[0].n_spheres), (2 ** 64 - 1, 30))
        self.assertEqual(results.points[0].position_taps().tolist(), [0, 2])
        with self.assertRaisesRegex(TypeError, "JSON values alone"):
            jostle.check(changed(SHORT, seed=object()))

    def test_a_packing_is_named_from_the_current_folder(self):
        before = self.run_scene(SHORT, "before.h5")
        after = self.run_scene(changed(SHORT, realizations=1, protocol=[], snapshots={"taps": [0]},
                                       start={"file": {"path": "before.h5", "realization": 2}}), "after.h5")
        np.testing.assert_array_equal(after.positions(), before.positions(0, 2))
        self.assertEqual(sorted(os.listdir(".")), ["after.h5", "before.h5"])

    def test_a_bad_scene_lists_every_fault(self):
        for ask in (jostle.run, jostle.check, jostle.cost):
            with self.subTest(ask=ask.__name__), self.assertRaises(jostle.SceneError) as raised:
                ask(BAD)
            error = raised.exception
            self.assertEqual([fault.pointer for fault in error.faults], POINTERS)
            self.assertIn('Did you mean "dilate"', error.faults[-1].message)
            self.assertEqual(error.exit_code, 2)
            self.assertEqual(len(str(error).splitlines()), 5)
        with self.assertRaises(jostle.SceneError), contextlib.redirect_stderr(io.StringIO()) as shown:
            jostle.run(BAD, progress=True)
        self.assertIn("/spheres: 0 is out of range", shown.getvalue())
        pathlib.Path("broken.json").write_text('{"a":')
        with self.assertRaises(jostle.SceneError) as raised:
            jostle.run("broken.json")
        self.assertEqual(raised.exception.faults[0].pointer, "")
        self.assertEqual(os.listdir("."), ["broken.json"])

    def test_other_errors_carry_what_the_program_said(self):
        self.run_scene(SHORT)
        for ask, code, pattern in (
                (lambda: jostle.run(SHORT), 2,
                 "tiny.h5 exists and is kept. Continue it with resume=True, write elsewhere with output=FILE, or "
                 "replace it with force=True"),
                (lambda: jostle.run(changed(SHORT, seed=5), resume=True), 2, "another file with output=FILE"),
                (lambda: jostle.run("none.json"), 2, "cannot read the scene: none.json"),
                (lambda: jostle.fit("tiny.h5", "height"), 2, "there is none; tiny.h5 has mean_height"),
                (lambda: jostle.run(SHORT, "no/such/folder.h5"), 4, "no/such")):
            with self.subTest(pattern=pattern), self.assertRaisesRegex(jostle.ProgramError, pattern) as raised:
                ask()
            self.assertEqual(raised.exception.exit_code, code)
            self.assertTrue(raised.exception.stderr and raised.exception.command)

    def test_the_program_is_sought_and_missed(self):
        with unittest.mock.patch.dict(os.environ, {"JOSTLE": "/nowhere/jostle"}):
            with self.assertRaisesRegex(jostle.ProgramMissing, "/nowhere/jostle is no program"):
                jostle.run(SHORT)
            self.assertEqual(jostle.check(SHORT, program=PROGRAM).resolved["name"], "tiny")
        with unittest.mock.patch.dict(os.environ, {"JOSTLE": "", "PATH": str(pathlib.Path(PROGRAM).parent)}):
            self.assertEqual(jostle.program_path(), PROGRAM)
        with unittest.mock.patch.dict(os.environ, {"JOSTLE": "", "PATH": "/nowhere"}):
            with self.assertRaisesRegex(jostle.ProgramMissing, "not on the PATH"):
                jostle.program_path()

    def test_a_time_limit_stops_and_a_resume_goes_on(self):
        with self.assertRaises(jostle.RunStopped) as raised:
            jostle.run(ENDLESS, time_limit="1s")
        self.assertEqual(raised.exception.exit_code, 75)
        self.assertEqual(str(raised.exception),
                         "endless.h5: stopped by the time limit; resume=True continues it")
        results = raised.exception.results
        self.addCleanup(results.close)
        self.assertEqual(results.state, "interrupted")
        rows = results.points[0].rows
        self.assertTrue((rows > 20).all())
        series = results.points[0].series["mean_height"]
        for realization, n in enumerate(rows):
            self.assertTrue(np.isfinite(series[:n, realization]).all())
            self.assertTrue(np.isnan(series[n:, realization]).all())
        self.assertEqual(results.points[0].status, ["unfinished"] * 2)

    def test_an_interrupt_stores_all_taps_and_goes_on_from_here(self):
        script = textwrap.dedent(f"""
            import jostle
            try:
                jostle.run({ENDLESS!r}, checkpoint_every="0s")
            except KeyboardInterrupt:
                print("interrupted", jostle.open("endless.h5").state, flush=True)
        """)
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        parts = pathlib.Path("endless.h5.parts")
        while not (parts.is_dir() and len(list(parts.glob("*.state"))) == 2):
            self.assertIsNone(process.poll())
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=600)
        self.assertEqual(out, "interrupted interrupted\n")
        self.assertFalse(parts.exists())
        self.assertTrue((self.open("endless.h5").points[0].rows > 1).all())


class Live(Case):
    def test_a_run_that_goes_on_and_one_that_was_killed_are_read(self):
        pathlib.Path("scene.json").write_text(json.dumps(ENDLESS))
        process = subprocess.Popen([PROGRAM, "run", "scene.json", "--quiet", "--checkpoint-every", "0"])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        while not all(one["taps_recorded"] > 30 for one in self.info()):
            time.sleep(0.05)
        for _ in ("not finished", "killed"):
            with self.assertWarnsRegex(UserWarning, "live=True reads them too"):
                bare = self.open("endless.h5")
            self.assertFalse(bare.points[0].begun)
            self.assertEqual(bare.ensemble["mean_height_mean"].shape, (0,))
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                live = self.open("endless.h5", live=True)
            self.assertEqual(live.state, "running")
            self.assertGreater(len(live.points[0].tap), 30)
            self.assertTrue(np.isfinite(live.points[0].mean["mean_height"][:30]).all())
            self.assertEqual(live.ensemble["mean_height_count"].values[:30].tolist(), [2] * 30)
            self.assertEqual(live.positions(0, 1, 20).shape, (24, 3))
            self.assertNotEqual(live.digest(), bare.digest())
            fitted = jostle.fit(live, "mean_height", model="kww", range="1:30")
            self.assertEqual(len(fitted), 1)
            self.assertEqual(len(jostle.analyse([live], "steady", observable="mean_height", store=False)), 1)
            process.kill()
            process.wait()

    def info(self):
        if not os.path.exists("endless.h5"):
            return [{"taps_recorded": 0}]
        done = subprocess.run([PROGRAM, "info", "endless.h5", "--json"], capture_output=True, text=True)
        return json.loads(done.stdout)["realizations"]

    def test_a_whole_run_needs_no_program(self):
        self.assertEqual(self.open(made(SHORT), live=True, program="/nowhere").state, "complete")


class Derive(Case):
    def setUp(self):
        super().setUp()
        self.results = jostle.run(SHORT)
        self.addCleanup(self.results.close)

    def test_fits_are_returned_and_stored(self):
        (curve,) = jostle.fit(self.results, "mean_height", model="kww", fix={"beta": 0.5})
        fit = curve["kww"]
        self.assertIsNone(fit.refused)
        self.assertEqual(list(fit.parameters), fit.report["order"])
        self.assertEqual((fit.parameters["beta"].value, fit.parameters["beta"].identifiability),
                         (0.5, "fixed"))
        table = self.open("tiny.h5").tables.one("fits", "mean_height", "kww")
        with h5py.File("tiny.h5") as raw:
            group = raw["fits/point_0000/mean_height/kww"]
            np.testing.assert_array_equal(table["value"], group["value"][()])
            np.testing.assert_array_equal(table["fitted"], group["fitted"][()])
        self.assertEqual(table["parameter"].tolist(), list(fit.parameters))
        np.testing.assert_array_equal(table["value"], [one.value for one in fit.parameters.values()])
        np.testing.assert_array_equal(table["interval_lower"][:, 1][np.isfinite(table["interval_lower"][:, 1])],
                                      [one.interval_95[0] for one in fit.parameters.values()
                                       if np.isfinite(one.interval_95[0])])
        self.assertEqual(table.notes["observable"], "mean_height")
        self.assertEqual(table.made["version"], jostle.__version__)
        self.assertIsNone(curve.choice)

    def test_a_law_is_chosen_by_realizations_alone(self):
        taps = range(1, 60)
        pathlib.Path("one.csv").write_text("t,X\n" + "".join(
            f"{t},{0.6 - 0.05 * np.exp(-t / 9) + 1e-4 * np.sin(9 * t * t)}\n" for t in taps))
        (curve,) = jostle.fit("one.csv")
        self.assertIsNone(curve.choice.law)
        self.assertTrue(curve.choice.verdict.startswith("cannot decide"))
        random = np.random.default_rng(1)
        law = lambda t: 0.64 - 0.06 / (1 + 0.5 * np.log1p(t / 8))
        pathlib.Path("six.csv").write_text("t," + ",".join(f"r{m}" for m in range(6)) + "\n" + "".join(
            f"{t}," + ",".join(map(repr, map(float, law(t) + 1e-5 * random.normal(size=6)))) + "\n" for t in taps))
        (curve,) = jostle.fit("six.csv", realizations=True)
        self.assertEqual((curve.choice.law, curve.choice.candidates), ("inverse_log", ("inverse_log",)))
        self.assertTrue(curve.choice.laws["kww"].worse)
        self.assertGreater(curve.choice.laws["kww"].difference, 0)

    def test_faults_and_warnings_are_whole(self):
        with self.assertRaises(jostle.SceneError) as raised:
            jostle.check({**SHORT, "my key": 1, "spheres": -1})
        self.assertEqual(sorted(fault.pointer for fault in raised.exception.faults), ["/my key", "/spheres"])
        warned = jostle.check(changed(SHORT, relax={"polar": {"theta0": 45}, "stop": {"sweeps": 5}})).warnings
        self.assertEqual(len(warned), 1)

    def test_numbers_of_numpy_are_taken(self):
        tables = jostle.analyse(self.results, "ageing", "mean_height", waiting_times=np.array([1, 4]),
                                lags=np.arange(1, 12), store=False)
        self.assertTrue(tables)
        point = self.results.points[np.int64(0)]
        self.assertEqual((point.tap[0] - 1, point.rows.dtype, point.count["mean_height"].dtype),
                         (-1, np.int64, np.int64))

    def test_a_measured_curve_is_fitted(self):
        pathlib.Path("curve.csv").write_text("t,X\n" + "".join(
            f"{t},{0.62 - 0.05 * math.exp(-(t / 40) ** 0.5)!r}\n" for t in range(1, 200)))
        (curve,) = jostle.fit("curve.csv", model="kww")
        self.assertAlmostEqual(curve["kww"].parameters["tau"].value, 40, places=4)
        jostle.fit("curve.csv", model="kww", page="curve.html")
        with self.assertRaisesRegex(jostle.JostleError, "curve.html exists and is kept.*force=True"):
            jostle.fit("curve.csv", model="kww", page="curve.html")
        jostle.fit("curve.csv", model="kww", page="curve.html", force=True)

    def test_a_refusal_is_told_in_words(self):
        with self.assertRaises(jostle.ProgramError) as raised:
            jostle.fit(self.results, "mean_height", law="X0 + log(-t)", start={"X0": 1})
        self.assertRegex(str(raised.exception), r"(?s)^mean_height.*: no law could be fitted\s+own: the law is not finite where it starts")
        with self.assertRaises(jostle.ProgramError) as raised:
            jostle.analyse(self.results, "steady", "mean_height", last=5)
        self.assertRegex(str(raised.exception), "steady.mean_height: asks for the last 5 taps; at least 32 are needed$")
        self.assertNotIn("{", str(raised.exception))

    def test_a_law_of_ones_own_is_fitted_and_stored(self):
        (curve,) = jostle.fit(self.results, "mean_height", law="-a*log(t/tau)", start={"a": 0.1, "tau": 1e4},
                              bounds={"tau": (0, None)}, law_name="fall")
        fit = curve["fall"]
        self.assertEqual((fit.formula, fit.refused, list(fit.parameters)), ("-a*log(t/tau)", None, ["a", "tau"]))
        table = self.open("tiny.h5").tables.one("fits", "mean_height", "fall")
        self.assertEqual(table.notes["law"], "-a*log(t/tau)")
        taps = self.results.points[0].tap[1:]
        slope, level = np.polyfit(np.log(taps), self.results.points[0].mean["mean_height"][1:], 1)
        self.assertAlmostEqual(fit.parameters["a"].value / -slope, 1, places=6)
        with self.assertRaisesRegex(jostle.ProgramError, "the parameter b has no start"):
            jostle.fit(self.results, "mean_height", law="a*t + b", start={"a": 1})

    def test_analyses_are_the_same_returned_and_stored(self):
        returned = jostle.analyse(self.results, "ageing", "mean_height", waiting_times=[0, 5],
                                  lags=[1, 2, 5, 10])
        returned += jostle.analyse(self.results, "spectrum", "mean_height", last=32)
        stored = self.open("tiny.h5").tables
        self.assertEqual(len(stored), 2)
        for table in returned:
            twin = stored[f"analysis/{table.name}"]
            self.assertEqual(twin.notes, table.notes)
            self.assertEqual(list(twin.quantities), list(table.quantities))
            for name, quantity in {**table.axes, **table.quantities}.items():
                other = {**twin.axes, **twin.quantities}[name]
                self.assertEqual((other.axes, other.units, other.long_name),
                                 (quantity.axes, quantity.units, quantity.long_name))
                np.testing.assert_array_equal(other.values, quantity.values, err_msg=name)
        ageing = returned[0]
        series = self.results.points[0].series["mean_height"]
        by_hand = ((series[5 + 10] - series[5]) ** 2).mean()
        self.assertAlmostEqual(ageing["a"][1, 3], by_hand, places=14)
        self.assertIs(ageing.error("a"), ageing.quantities["a_error"].values)
        dataset = stored["analysis/" + ageing.name].to_dataset()
        self.assertEqual(float(dataset["a"].sel(waiting_time=5, lag=10)), ageing["a"][1, 3])
        frame = ageing.to_pandas()
        self.assertEqual(frame.loc[(5, 10), "a"], ageing["a"][1, 3])
        self.assertIn("tau", ageing.to_pandas("waiting_time"))
        with self.assertRaisesRegex(jostle.NotThere, "no table is hysteresis"):
            stored.one("hysteresis")
        with self.assertRaisesRegex(jostle.NotThere, "has no 'x'; it has waiting_time, lag, a"):
            ageing["x"]

    def test_structure_is_measured(self):
        (table,) = jostle.structure(self.results, part=["coordination"], tap=[0, 40],
                                    settings={"coordination": {"cut": 1.1}})
        self.assertEqual(table["tap"].tolist(), [0, 40])
        self.assertIn('"cut":1.1', table.notes["settings"])
        self.assertEqual(list(self.open("tiny.h5").tables), ["structure/" + table.name])

    def test_packings_are_exported(self):
        self.assertEqual(jostle.export(self.results, "a.xyz", format="extxyz", realization=2, tap="all"),
                         "a.xyz")
        lines = pathlib.Path("a.xyz").read_text().splitlines()
        self.assertEqual(len(lines), 3 * (48 + 2))
        centres = np.array([line.split()[1:4] for line in lines[2:50]], float)
        np.testing.assert_array_equal(centres, self.results.positions(0, 2, 0))

    def test_a_page_is_written(self):
        self.assertEqual(jostle.report(self.results, "page.html"), "page.html")
        self.assertIn("<html", pathlib.Path("page.html").read_text()[:1000])
        with self.assertRaisesRegex(jostle.ProgramError, "page.html exists"):
            jostle.report([self.results], "page.html")

    def test_cost_is_studied(self):
        scene = changed(SHORT, protocol=[{"tap": {"dilate": 0.05}, "count": 2}], snapshots=None)
        results, report = jostle.cost(scene, replicates=2, observable="mean_height")
        self.addCleanup(results.close)
        self.assertEqual(results.path, "tiny-cost.h5")
        self.assertIn("bias", report)
        self.assertTrue(len(results.tables) > 0)


class Check(Case):
    def test_a_good_scene_is_resolved(self):
        checked = jostle.check(TINY)
        self.assertEqual(checked.resolved["relax"]["polar"]["max_step"], 0.1)
        described = {**SHORT, "description": "a bed that is tapped, " * 20 + "and nothing else"}
        self.assertEqual(jostle.check(described, program=PROGRAM).resolved["description"],
                         described["description"])
        self.assertEqual(checked.warnings, [])
        with self.assertRaisesRegex(jostle.JostleError, "threads"):
            jostle.check(TINY, threads=0)
        self.assertIn("4 sweep points x 3 realizations", checked.text)
        warned = jostle.check(changed(SHORT, snapshots=None, protocol=[{"tap": {"dilate": 5}, "count": 1}]))
        self.assertTrue(warned.warnings)

    def test_the_schema_is_asked_where_there_is_no_program(self):
        schema = jostle.schema()
        self.assertEqual(schema, json.loads(subprocess.check_output([PROGRAM, "schema"])))
        try:
            import jsonschema  # noqa: F401
        except ImportError:
            self.skipTest("jsonschema is not installed")
        checked = jostle.check(TINY, program="/nowhere")
        self.assertIsNone(checked.resolved)
        with self.assertRaises(jostle.SceneError) as raised:
            jostle.check(changed(TINY, seed=-1, spheres=0), program="/nowhere")
        self.assertEqual([fault.pointer for fault in raised.exception.faults], ["/seed", "/spheres"])
        with unittest.mock.patch.dict(sys.modules, {"jsonschema": None}):
            with self.assertRaises(jostle.ProgramMissing):
                jostle.check(TINY, program="/nowhere")


if __name__ == "__main__":
    unittest.main()
