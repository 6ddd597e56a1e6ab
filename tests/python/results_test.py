"""Compares the numbers that the package reads with those of h5py, one by one."""

import json
import shutil
import unittest

import h5py
import jostle
import numpy as np

from support import GRAINS, TINY, Case, changed, made


class Read(Case):
    def setUp(self):
        super().setUp()
        self.path = made(TINY)
        self.results = self.open(self.path)
        self.raw = h5py.File(self.path)
        self.addCleanup(self.raw.close)

    def test_points_have_the_stored_numbers(self):
        self.assertEqual(len(self.results.points), 4)
        for number, point in enumerate(self.results.points):
            name = f"point_{number:04}"
            self.assertEqual(point.label, self.raw["sweep/label"].asstr()[number])
            self.assertEqual(point.observables, ["mean_height", "bottom_fraction", "sweeps", "acceptance",
                                                 "capped", "dropped_offsets"])
            for column in point.observables:
                stored = self.raw[f"observables/{name}/{column}"][()]
                np.testing.assert_array_equal(point.series[column], stored)
                self.assertEqual(stored.shape, (41, 3))
                for fold in ("mean", "sigma", "error", "count"):
                    np.testing.assert_array_equal(getattr(point, fold)[column],
                                                  self.raw[f"ensemble/{name}/{column}_{fold}"][()])
            self.assertEqual(point.tap.tolist(), list(range(41)))
            self.assertEqual(point.status, ["done"] * 3)
            self.assertEqual(point.rows.tolist(), [41] * 3)
            self.assertEqual(point.reasons, {})
            np.testing.assert_array_equal(point.timing["seconds"], self.raw[f"timing/{name}/seconds"][()])
            self.assertEqual(point.units("mean_height"), "diameter")
            self.assertEqual((point.n_spheres, point.planned_taps, point.seed), (48, 40, 4711))
            self.assertTrue(np.isnan(point.series["acceptance"][0]).all())  # no relaxation before tap 0

    def test_folds_are_those_of_the_series(self):
        point = self.results.points[2]
        values = point.series["bottom_fraction"]
        np.testing.assert_allclose(point.mean["bottom_fraction"], values.mean(axis=1), rtol=1e-14)
        np.testing.assert_allclose(point.sigma["bottom_fraction"], values.std(axis=1), rtol=1e-9)
        np.testing.assert_allclose(point.error["bottom_fraction"],
                                   values.std(axis=1, ddof=1) / 3 ** 0.5, rtol=1e-9)

    def test_positions_snapshots_and_box(self):
        for realization in (-1, 999):
            with self.assertRaisesRegex(jostle.NotThere, f"no realization {realization}: there are "):
                self.results.points[0].box(realization)
        group = self.raw["particles/point_0003_realization_00002"]
        self.assertEqual(self.results.points[3].position_taps(2).tolist(), [0, 10, 40])
        for frame, tap in enumerate((0, 10, 40)):
            np.testing.assert_array_equal(self.results.positions(3, 2, tap),
                                          group["position/value"][frame])
        self.assertEqual(self.results.positions(3, 2).shape, (48, 3))
        np.testing.assert_array_equal(self.results.positions(3, 2), group["position/value"][2])
        box = self.results.box(3, 2)
        self.assertEqual(box.boundary, ("periodic", "periodic", "none"))
        np.testing.assert_array_equal(box.edges, group["box/edges"][()])
        snapshots = self.results.points[3].snapshots
        self.assertEqual(snapshots["coordination"].shape, (3, 3))
        np.testing.assert_allclose(snapshots["height_histogram"].sum(axis=2), 1, rtol=1e-12)
        with self.assertRaisesRegex(jostle.NotThere, "tap 3; kept: 0, 10, 40"):
            self.results.positions(3, 2, 3)
        with self.assertRaisesRegex(jostle.NotThere, "realization 7; there are those of 0, 1, 2"):
            self.results.positions(3, 7)

    def test_contacts_of_grains_carry_their_weight(self):
        self.assertRaisesRegex(jostle.NotThere, "no contacts of sweep point 0", self.results.contacts)
        results = self.open(made(GRAINS))
        for realization in (0, 1):
            for frame, tap in enumerate((0, 2)):
                contacts = results.contacts(0, realization, tap)
                self.assertEqual(contacts.walls, ("floor",))
                on_floor = contacts.second == 60
                self.assertGreater(on_floor.sum(), 5)
                # A bed that rings a little carries its weight within some per cent.
                self.assertAlmostEqual(contacts.forces()[on_floor, 2].sum(), 60, delta=6)
                moments = contacts.force_moments()
                self.assertEqual(moments.shape, (60, 3, 3))
                stored = results.points[0].snapshots["force_moment"][frame, realization]
                np.testing.assert_allclose(moments.sum(axis=0), stored, rtol=1e-9, atol=1e-9)
                # By hand, of one sphere.
                one = int(contacts.first[0])
                by_hand = np.zeros((3, 3))
                for i, force in enumerate(contacts.forces()):
                    first, second = contacts.first[i], contacts.second[i]
                    reach = 0.5 * (1 - contacts.overlap[i]) if second < 60 else 0.5 - contacts.overlap[i]
                    if one in (first, second):
                        by_hand += reach * np.outer(contacts.normal[i], force)
                np.testing.assert_allclose(moments[one], by_hand, rtol=1e-12)
        np.testing.assert_array_equal(results.contacts().first, results.contacts(0, 0, 2).first)
        self.assertRaisesRegex(jostle.NotThere, "tap 1; kept: 0, 2", results.contacts, 0, 0, 1)

    def test_contacts_are_those_of_the_file_where_the_engine_is_swept(self):
        results = self.open(made(changed(GRAINS, name="engines", engine=None, sweep={
            "/engine": ["monte_carlo", {"discrete_element": {}}]}, protocol=[{"tap": {"lift": 0.1}, "count": 2}])))
        self.assertGreater(len(results.contacts(1).first), 60)
        self.assertRaisesRegex(jostle.NotThere, "no contacts of sweep point 0", results.contacts, 0)

    def test_diameters_are_of_a_realization_that_there_is(self):
        for realization in (-1, 3):
            self.assertRaisesRegex(jostle.NotThere, f"no realization {realization}",
                                   self.results.points[0].diameters, realization)

    def test_force_moments_of_a_mixture_have_the_arms_of_its_radii(self):
        scene = changed(GRAINS, realizations=1, container={"sides": "periodic", "width": 6}, spheres=[
            {"name": "small", "count": 50}, {"name": "large", "count": 8, "diameter": 1.8, "density": 0.5}],
            engine={"discrete_element": {"contact": {"walton_braun": {"stiffness": 1e4}}}})
        results = self.open(made(scene))
        contacts = results.contacts()
        np.testing.assert_array_equal(contacts.diameters, [1] * 50 + [1.8] * 8)
        moments = contacts.force_moments()
        stored = results.points[0].snapshots["force_moment"][1, 0]
        np.testing.assert_allclose(moments.sum(axis=0), stored, rtol=1e-9, atol=1e-9)
        # The trace by hand, of one large sphere.
        one = int(contacts.second[(contacts.second >= 50) & (contacts.second < 58)][0])
        trace = 0
        for i, force in enumerate(contacts.normal_force):
            first, second = contacts.first[i], contacts.second[i]
            if one not in (first, second):
                continue
            reach = 0.5 * contacts.diameters[first] + (0.5 * contacts.diameters[second] if second < 58 else 0)
            trace += force * 0.9 * (1 - contacts.overlap[i] / reach)
        self.assertAlmostEqual(np.trace(moments[one]), trace, delta=1e-9 * abs(trace))

    def test_scene_sweep_and_provenance(self):
        self.assertEqual(json.loads(self.results.scene_verbatim), TINY)
        self.assertEqual(self.results.scene["relax"]["max_sweeps"], 1_000_000)
        self.assertEqual(self.results.points[1].values,
                         {"/protocol/0/tap/dilate": 0.02, "/container/width": 5})
        self.assertEqual(self.results.points[1].coordinates, {"dilate": 0.02, "width": 5})
        scene = self.results.points[2].scene
        self.assertEqual((scene["protocol"][0]["tap"]["dilate"], scene["container"]["width"]), (0.1, 4))
        self.assertNotIn("sweep", scene)
        labelled = changed(TINY, sweep={"/protocol/0/tap/dilate": [0.02, 0.1]}, point_labels=["weak", "strong"],
                           analyse={"sweep": [{"observable": "mean_height"}]})
        self.assertEqual(jostle.check(self.open(made(labelled)).points[1].scene).warnings, [])
        self.assertEqual(self.results.scene["container"]["width"], 4)  # its own is untouched
        (process,) = self.results.provenance
        self.assertEqual(process["version"], jostle.__version__)
        self.assertIn("run", process["command_line"])
        self.assertEqual((self.results.state, self.results.shard), ("complete", (1, 1)))
        self.assertRegex(self.results.run_id, "^[0-9a-f]{32}$")
        self.assertRegex(self.results.digest(), "^[0-9a-f]{64}$")
        self.results.verify()

    def test_a_closed_file_says_so(self):
        closed = jostle.open(self.results.path)
        point = closed.points[0]
        closed.close()
        self.assertRegex(repr(closed), "^<jostle results .*: closed>$")
        for use in (lambda: closed.state, lambda: point.tap, lambda: closed.ensemble):
            with self.assertRaisesRegex(jostle.ResultsError, "closed; jostle.open reads it again"):
                use()

    def test_what_is_not_there_is_answered_with_what_is(self):
        with self.assertRaisesRegex(jostle.NotThere, "no 'height'; it has mean_height, bottom_fraction"):
            self.results.points[0].series["height"]
        with self.assertRaisesRegex(jostle.NotThere, "no 'height'; it has mean_height, bottom_fraction"):
            self.results.points[0].units("height")
        with self.assertRaisesRegex(IndexError, "has 4 sweep points"):
            self.results.points[4]
        self.assertEqual(self.results.points[-1].index, 3)
        self.assertEqual([point.index for point in self.results.points[1:3]], [1, 2])
        with self.assertRaisesRegex(jostle.NotThere, "it has none"):
            self.results.tables["fits/point_0000/mean_height/kww"]


class OtherFiles(Case):
    def test_a_share_has_points_that_never_begin(self):
        scene = changed(TINY, realizations=1)
        results = self.open(made(scene, "--shard", "2/4"))
        self.assertEqual(results.shard, (2, 4))
        self.assertEqual([point.begun for point in results.points], [False, True, False, False])
        absent = results.points[0]
        self.assertEqual((absent.status, absent.reasons, absent.rows.tolist()), (["missing"], {}, [0]))
        self.assertEqual(absent.series["mean_height"].shape, (0, 1))
        self.assertEqual(absent.mean["mean_height"].shape, (0,))
        with self.assertRaisesRegex(jostle.NotThere, "there are those of none"):
            absent.positions()
        np.testing.assert_array_equal(results.box(0).edges, [4, 4, np.inf])

    def test_failed_realizations_say_why(self):
        # One sweep is not enough to grow to this packing fraction.
        scene = changed(TINY, sweep=None, observe=[], spheres=400, snapshots={"taps": [0]},
                        container={"sides": "fully_periodic", "width": 8, "height": 8},
                        start={"grow": {"max_sweeps": 1}}, protocol=[],
                        relax={"metropolis": {}, "stop": {"sweeps": 5}})
        with self.assertRaises(jostle.RealizationsFailed) as raised:
            jostle.run(scene, "failed.h5")
        self.assertEqual(raised.exception.exit_code, 3)
        results = raised.exception.results
        self.addCleanup(results.close)
        point = results.points[0]
        self.assertEqual(point.status, ["failed"] * 3)
        self.assertEqual(sorted(point.reasons), [0, 1, 2])
        self.assertTrue(all(point.reasons.values()))

    def test_what_was_followed_of_the_motion(self):
        scene = changed(TINY, sweep=None, motion={"origins": [0], "lags": [1, 2], "layers": 2})
        results = self.open(made(scene))
        motion = results.points[0].motion
        self.assertEqual(motion["lateral_overlap"].shape, (1, 2, 2, 3))
        self.assertEqual(motion["lag"].tolist(), [1, 2])
        tables = jostle.analyse(results, "motion", store=False)
        np.testing.assert_allclose(tables[1]["lateral_overlap"], motion["lateral_overlap"].mean(axis=-1))

    def test_what_fitting_did_to_a_pour(self):
        scene = changed(TINY, sweep=None, container={"sides": "walls", "width": 4},
                        start={"pour": "fitted"}, protocol=[], snapshots={"taps": [0]})
        point = self.open(made(scene)).points[0]
        self.assertIn("spheres_moved", point.fitting)
        self.assertEqual(point.fitting["spheres_moved"].shape, (3,))
        self.assertEqual(point.box().boundary, ("none",) * 3)

    def test_boxes_of_every_container(self):
        # With and without snapshots: from the file's boxes, and from its plan.
        for sides, widths, boundary, edges in (
                ("periodic", {"width": [4, 5]}, ("periodic", "periodic", "none"), (4, 5)),
                ("walls", {"width": [4, 5]}, ("none", "none", "none"), (4, 5)),
                ("cylinder", {"diameter": 4}, ("none", "none", "none"), (4, 4)),
                ("plates", {"width": 4, "gap": 3}, ("periodic", "none", "none"), (4, 3))):
            scene = changed(TINY, sweep=None, container={"sides": sides} | widths, protocol=[])
            for keeps in ({"snapshots": {"taps": [0]}}, {"snapshots": None}):
                with self.subTest(sides=sides, **keeps):
                    box = self.open(made(changed(scene, **keeps))).points[0].box()
                    self.assertEqual(box.boundary, boundary)
                    np.testing.assert_array_equal(box.edges[:2], edges)


class BadFiles(Case):
    def refused(self, pattern, path="bad.h5", **keywords):
        with self.assertRaisesRegex(jostle.ResultsError, pattern):
            jostle.open(path, **keywords)

    def test_what_is_no_results_file_is_refused(self):
        self.refused("none.h5: cannot read it: No such file", "none.h5")
        self.refused("not a file", ".")
        (self.folder / "bad.h5").write_text("{}")
        self.refused("bad.h5: not an HDF5 file")
        with h5py.File("bad.h5", "w") as file:
            file["a"] = range(100)
        self.refused("not written by jostle")

    def test_what_was_damaged_or_changed_is_refused(self):
        whole = made(TINY).read_bytes()
        (self.folder / "bad.h5").write_bytes(whole[:-1000])
        self.refused("truncated, changed by another program")
        (self.folder / "bad.h5").write_bytes(whole[:20])
        self.refused("truncated")
        place = whole.index(b"steepest_descent")
        (self.folder / "bad.h5").write_bytes(whole[:place] + b"S" + whole[place + 1:])
        self.refused("checksum is wrong", verify=True)
        results = self.open("bad.h5")
        with self.assertRaisesRegex(jostle.ResultsError, "checksum is wrong"):
            results.verify()

    def test_another_layout_is_refused(self):
        shutil.copy(made(TINY), "bad.h5")
        with h5py.File("bad.h5", "r+") as file:
            file.attrs["jostle_format"] = 99
        data = (self.folder / "bad.h5").read_bytes()
        (self.folder / "bad.h5").write_bytes(data + b"\njostle-sha256 " + b"0" * 64 + b"\n")
        self.refused("of layout 99: this package reads results of jostle of layouts 1 and 2")


if __name__ == "__main__":
    unittest.main()
