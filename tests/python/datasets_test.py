"""The sweep as one dataset: xarray, its backend, pandas."""

import subprocess
import sys
import unittest

import h5py
import jostle
import numpy as np
import xarray as xr

from support import TINY, Case, changed, made

POINTS = [(0.02, 4), (0.02, 5), (0.1, 4), (0.1, 5)]


class Ensemble(Case):
    def setUp(self):
        super().setUp()
        self.path = made(TINY)

    def check(self, ensemble, raw):
        self.assertEqual(ensemble["mean_height_mean"].dims, ("dilate", "width", "tap"))
        self.assertEqual(ensemble["dilate"].values.tolist(), [0.02, 0.1])
        self.assertEqual(ensemble["width"].values.tolist(), [4, 5])
        self.assertEqual(ensemble["mean_height_error"].attrs["units"], "diameter")
        for number, (dilate, width) in enumerate(POINTS):
            here = ensemble.sel(dilate=dilate, width=width)
            self.assertEqual(str(here["label"].values), f"dilate = {dilate}, width = {width}")
            for name in ("mean_height_mean", "bottom_fraction_sigma", "sweeps_error", "acceptance_count"):
                np.testing.assert_array_equal(here[name], raw[f"ensemble/point_{number:04}/{name}"][()])

    def test_all_points_stand_in_one_dataset(self):
        results = self.open(self.path)
        self.check(results.ensemble, results.file)
        self.assertEqual(len(results.ensemble.data_vars), 6 * 4)

    def test_the_backend_gives_the_same(self):
        with xr.open_dataset(self.path, engine="jostle") as ensemble, h5py.File(self.path) as raw:
            self.check(ensemble, raw)
            first = ensemble["bottom_fraction_mean"]
            np.testing.assert_array_equal(first[1, :, 5:30:5].values, first.values[1, :, 5:30:5])
            np.testing.assert_array_equal(first[[1, 0], -1].values, first.values[[1, 0], -1])
            self.assertEqual(float(first[1, 0, 3]), first.values[1, 0, 3])
            np.testing.assert_array_equal(first.isel(tap=xr.DataArray([3, 1], dims="which")).values,
                                          first.values[:, :, [3, 1]])
        with xr.open_dataset(self.path, engine="jostle", content="series") as series, \
                h5py.File(self.path) as raw:
            self.assertEqual(series["mean_height"].dims, ("dilate", "width", "tap", "realization"))
            np.testing.assert_array_equal(series["mean_height"].sel(dilate=0.1, width=5),
                                          raw["observables/point_0003/mean_height"][()])
            self.assertTrue((series["status"] == 2).all())

    def test_the_backend_drops_variables_and_refuses_bad_files(self):
        with xr.open_dataset(self.path, engine="jostle", drop_variables="capped_mean") as ensemble:
            self.assertNotIn("capped_mean", ensemble)
            self.assertIn("capped_sigma", ensemble)
        with self.assertRaisesRegex(ValueError, "one of ensemble, series"):
            xr.open_dataset(self.path, engine="jostle", content="all")
        with h5py.File("other.h5", "w") as file:
            file["a"] = [1.0, 2.0]
        with self.assertRaises(jostle.ResultsError):
            xr.open_dataset("other.h5", engine="jostle")

    def test_it_is_what_the_documented_way_by_hand_gives(self):
        scene = changed(TINY, sweep={"/protocol/0/tap/dilate": [0.02, 0.1]})
        path = made(scene)
        sweep = xr.open_dataset(path, engine="h5netcdf", group="/sweep")
        points = [xr.open_dataset(path, engine="h5netcdf", group=f"/ensemble/point_{p:04}")
                  for p in sweep["point"].values]
        by_hand = xr.concat(points, dim="point").assign_coords(
            dilate=("point", sweep["dilate"].values)).swap_dims(point="dilate")
        ensemble = self.open(path).ensemble
        self.assertEqual(set(by_hand.data_vars), set(ensemble.data_vars))
        for name in by_hand.data_vars:
            xr.testing.assert_equal(by_hand[name].drop_vars("label", errors="ignore"),
                                    ensemble[name].drop_vars("label"))

    def test_a_scene_without_a_sweep_has_taps_alone(self):
        ensemble = self.open(made(changed(TINY, sweep=None))).ensemble
        self.assertEqual(ensemble["mean_height_mean"].dims, ("tap",))
        self.assertEqual(ensemble["mean_height_mean"].shape, (41,))

    def test_words_objects_and_zipped_values_are_coordinates(self):
        scene = changed(TINY, realizations=1, protocol=[{"tap": {"dilate": 0.05}, "count": 2}],
                        snapshots=None, sweep={
                            "/protocol/0/tap": [{"dilate": 0.02}, {"lift": 0.1}],
                            "/relax/polar/law": ["gaussian", "linear"],
                            "/relax/stop/sweeps": [10, 20],
                            "zip": {"/container/width": [4, 4, 5], "/spheres": [24, 30, 24]}})
        results = self.open(made(scene))
        ensemble, series = results.ensemble, results.series
        self.assertEqual(ensemble["mean_height_mean"].shape, (2, 2, 2, 3, 3))
        self.assertEqual(ensemble["protocol_0_tap"].values.tolist(), ['{"dilate":0.02}', '{"lift":0.1}'])
        self.assertEqual(ensemble["law"].values.tolist(), ["gaussian", "linear"])
        self.assertEqual(series["relax_stop_sweeps"].values.tolist(), [10, 20])  # sweeps is a column
        for place, number in np.ndenumerate(np.arange(24).reshape(2, 2, 2, 3)):
            point = results.points[number]
            here = ensemble.isel(protocol_0_tap=place[0], law=place[1], relax_stop_sweeps=place[2],
                                 width_and_spheres=place[3])
            self.assertEqual(float(here["spheres"]), point.n_spheres)
            np.testing.assert_array_equal(here["mean_height_mean"], point.mean["mean_height"])
        self.assertEqual(ensemble["spheres"].values.tolist(), [24, 30, 24])

    def test_points_that_are_missing_or_shorter_are_nan(self):
        scene = changed(TINY, realizations=1, sweep={"/protocol/0/count": [2, 5, 3]}, snapshots=None)
        results = self.open(made(scene, "--shard", "2/2"))
        ensemble = results.ensemble  # columns of the second point alone
        np.testing.assert_array_equal(ensemble["mean_height_count"].values,
                                      [[0] * 6, [1] * 6, [0] * 6])
        whole = self.open(made(scene)).ensemble
        finite = np.isfinite(whole["mean_height_mean"].values).sum(axis=1)
        self.assertEqual(finite.tolist(), [3, 6, 4])
        frame = self.open(made(scene)).to_pandas()
        self.assertEqual(len(frame), 3 + 6 + 4)

    def test_different_observables_at_different_points(self):
        scene = changed(TINY, sweep={"/observe": [["mean_height"], ["bottom_fraction"]]},
                        protocol=[{"tap": {"dilate": 0.05}, "count": 2}], snapshots=None)
        results = self.open(made(scene))
        ensemble = results.ensemble
        self.assertEqual(np.isfinite(ensemble["mean_height_mean"].values).all(axis=1).tolist(),
                         [True, False])
        self.assertEqual(np.isnan(ensemble["bottom_fraction_mean"].values).all(axis=1).tolist(),
                         [True, False])
        self.assertEqual(len(results.to_pandas()), 6)
        self.assertEqual(len(results.to_pandas("mean_height", "mean_height").columns),
                         len(results.to_pandas("mean_height").columns))


class Grains(Case):
    def test_columns_are_those_of_the_engine(self):
        scene = changed(TINY, realizations=1, relax=None, snapshots=None, spheres=24,
                        engine={"discrete_element": {}},
                        container={"sides": "periodic", "width": 3},
                        protocol=[{"tap": {"lift": 0.1}, "count": 1}],
                        sweep={"/engine/discrete_element/contact/walton_braun/friction": [0.1, 0.5]})
        results = self.open(made(scene))
        stored = [name for name in results.file["observables/point_0000"]
                  if name not in ("tap", "realization", "status", "rows", "reason", "trial_key")]
        self.assertIn("kinetic_energy", stored)
        self.assertNotIn("acceptance", stored)
        self.assertEqual(sorted(results.points[1].observables), sorted(stored))
        self.assertEqual(results.ensemble["kinetic_energy_mean"].dims, ("friction", "tap"))
        np.testing.assert_array_equal(results.ensemble["kinetic_energy_mean"].sel(friction=0.5),
                                      results.points[1].mean["kinetic_energy"])
        self.assertEqual(len(results.to_pandas()), 4)


class Frames(Case):
    def test_the_ensemble_is_a_table(self):
        results = self.open(made(TINY))
        frame = results.to_pandas()
        self.assertEqual(frame.index.names, ["dilate", "width", "tap"])
        self.assertEqual(len(frame), 4 * 41)
        for number, place in enumerate(POINTS):
            np.testing.assert_array_equal(frame.loc[place, "mean_height_mean"],
                                          results.points[number].mean["mean_height"])
        self.assertEqual(frame["mean_height_count"].unique().tolist(), [3])
        few = results.to_pandas("sweeps")
        self.assertEqual(list(few), ["sweeps_mean", "sweeps_sigma", "sweeps_error", "sweeps_count"])
        np.testing.assert_array_equal(few["sweeps_mean"], frame["sweeps_mean"])
        with self.assertRaisesRegex(jostle.NotThere, "no 'height'; it has mean_height"):
            results.to_pandas("height")


class WithoutThem(Case):
    def test_numpy_is_enough_and_the_rest_is_named(self):
        """In a Python that has neither xarray nor pandas nor matplotlib."""
        done = subprocess.run([sys.executable, "-c", f"""
import sys
for name in ("xarray", "pandas", "matplotlib"):
    sys.modules[name] = None
import jostle
results = jostle.open({str(made(TINY))!r})
assert results.points[0].mean["mean_height"].shape == (41,)
for ask, name in ((lambda: results.ensemble, "python3-xarray"), (lambda: results.series, "python3-xarray"),
                  (lambda: results.to_pandas(), "python3-pandas"), (lambda: jostle.plot, "python3-matplotlib")):
    try:
        ask()
    except ImportError as error:
        assert name in str(error), error
    else:
        raise AssertionError(name)
print("well")
"""], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, "well\n"), done.stderr)


if __name__ == "__main__":
    unittest.main()
