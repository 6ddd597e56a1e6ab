"""The motion of spheres: what is kept of it is what the positions of every tap give, however the run went."""

import json
import random
import time
import unittest

import h5py
import numpy as np

from support import BAD_INPUT, TINY, Case, changed

FOLLOWED = changed(
    TINY, motion={"origins": [0, 1, 3], "lags": [1, 2, 3], "overlap_lengths": [0.02, 0.1],
                  "layers": 3},
    snapshots={"taps": [0, 1, 2, 3, 4], "keep": ["positions"]})
WIDTH = 4


def unwrapped(positions):
    """Positions of every tap, [tap, sphere, direction], followed through the periodic sides."""
    steps = np.diff(positions, axis=0)
    steps[..., :2] -= WIDTH * np.round(steps[..., :2] / WIDTH)
    return np.concatenate([positions[:1], positions[:1] + np.cumsum(steps, axis=0)])


class Motion(Case):
    def setUp(self):
        super().setUp()
        self.write(FOLLOWED)

    def longer(self):
        return changed(FOLLOWED, protocol=[{"tap": {"dilate": 0.05}, "count": 7}])

    def test_what_is_kept_is_what_positions_give(self):
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as file:
            for point in ("point_0000", "point_0001"):
                group = file["motion"][point]
                for r in range(3):
                    kept = file[f"particles/{point}_realization_{r:05}/position/value"][:]
                    where = unwrapped(kept)
                    for o, origin in enumerate([0, 1, 3]):
                        for k, lag in enumerate([1, 2, 3]):
                            square = group["square_displacement"][o, k, :, r]
                            if origin + lag > 4:
                                self.assertTrue(np.isnan(square).all())
                                continue
                            moved = where[origin + lag] - where[origin]
                            np.testing.assert_allclose(square, (moved**2).mean(axis=0), rtol=1e-9,
                                                       atol=1e-14)
                            np.testing.assert_allclose(
                                group["mean_displacement"][o, k, :, r], moved.mean(axis=0),
                                rtol=1e-9, atol=1e-12)
                            lateral = np.hypot(moved[:, 0], moved[:, 1])
                            for a, length in enumerate([0.02, 0.1]):
                                self.assertAlmostEqual(group["lateral_overlap"][o, k, a, r],
                                                       (lateral < length).mean(), 12)
                self.assertLess(group["largest_step"][:].max(), 0.5)
                dimensions = [d.label or d[0].name for d in group["layer_square_displacement"].dims]
                self.assertEqual([name.rsplit("/", 1)[-1] for name in dimensions],
                                 ["waiting_time", "lag", "layer", "direction", "realization"])

    def test_tables_are_made_when_a_run_ends_and_by_analyse(self):
        self.run_scene()
        stored = self.digest("tiny.h5")
        out = json.loads(self.jostle("analyse", "tiny.h5", "motion", "--json").stdout)
        self.assertEqual(self.digest("tiny.h5"), stored)
        names = [table["name"] for table in out["tables"]]
        self.assertEqual(names, [f"point_000{p}/motion/{kind}" for p in (0, 1)
                                 for kind in ("displacement", "overlap", "layers")])
        with h5py.File(self.folder / "tiny.h5") as file:
            kept = file["motion/point_0001/lateral_overlap"][:]
            table = file["analysis/point_0001/motion/overlap"]
            np.testing.assert_allclose(table["lateral_overlap"][:], kept.mean(axis=-1), rtol=1e-12)
            np.testing.assert_allclose(table["lateral_chi_4"][:], 48 * kept.var(axis=-1, ddof=1),
                                       rtol=1e-9, atol=1e-14)
        text = self.jostle("analyse", "tiny.h5", "--sweep-point", "1", "motion").stdout
        for word in ("msd_lateral", "lateral_chi_4", "largest_step", "unwrapping"):
            self.assertIn(word, text)

    def test_every_group_opens_in_xarray(self):
        try:
            import h5netcdf  # noqa: F401
            import xarray
        except ImportError as missing:
            self.skipTest(str(missing))
        self.run_scene()
        for group in ("motion/point_0001", "sweep/point_0000", "analysis/point_0000/motion/layers"):
            with xarray.open_dataset(self.folder / "tiny.h5", engine="h5netcdf", group=group) as opened:
                opened.load()
                if group.startswith("motion"):
                    self.assertEqual(opened["square_displacement"].dims,
                                     ("waiting_time", "lag", "direction", "realization"))
                    self.assertEqual(opened["direction"].values.tolist(), ["x", "y", "z"])

    def test_a_scene_without_it_keeps_nothing_and_is_refused(self):
        self.run_scene("-o", "with.h5")
        plain = changed(FOLLOWED)
        del plain["motion"]
        self.write(plain)
        self.run_scene("-o", "without.h5")
        with h5py.File(self.folder / "with.h5") as a, h5py.File(self.folder / "without.h5") as b:
            self.assertNotIn("motion", b)
            self.assertFalse([name for name in b["sweep/point_0000"].attrs if "motion" in name])
            self.assertTrue((a["observables/point_0001/mean_height"][:] ==
                             b["observables/point_0001/mean_height"][:]).all())
        err = self.jostle("analyse", "without.h5", "motion", expect=BAD_INPUT).stderr
        self.assertIn('its scene has no key "motion"', err)
        self.write(FOLLOWED)
        err = self.run_scene("-o", "without.h5", "--resume", expect=BAD_INPUT).stderr
        self.assertIn("/motion", err)

    def test_killed_stopped_longer_in_shares_and_on_any_threads_it_is_the_same(self):
        for threads in (1, 3):
            self.run_scene("-o", f"straight{threads}.h5", "--threads", threads)
        straight = self.digest("straight1.h5")
        self.assertEqual(self.digest("straight3.h5"), straight)
        moments = random.Random(2005)
        for _ in range(6):
            process = self.popen("run", "scene.json", "--quiet", "--checkpoint-every", "0",
                                 "--force")
            time.sleep(moments.uniform(0.01, 0.15))
            process.kill()
            process.communicate()
            self.run_scene("--resume")
            self.assertEqual(self.digest("tiny.h5"), straight)
        for share in (1, 2):
            self.run_scene("-o", f"share{share}.h5", "--shard", f"{share}/2")
        self.jostle("merge", "share1.h5", "share2.h5", "-o", "merged.h5")
        self.assertEqual(self.digest("merged.h5"), straight)
        self.write(self.longer(), "longer.json")
        self.run_scene("-o", "longer.h5", scene="longer.json")
        self.run_scene("-o", "tiny.h5", "--resume", scene="longer.json")
        self.assertEqual(self.digest("tiny.h5"), self.digest("longer.h5"))
        with h5py.File(self.folder / "tiny.h5") as file:
            self.assertFalse(np.isnan(file["motion/point_0000/overlap"][:]).any())

    def test_default_grids_grow_with_taps_and_realizations(self):
        def scene(taps, realizations):
            return changed(FOLLOWED, motion={}, protocol=[{"tap": {"dilate": 0.05}, "count": taps}],
                           realizations=realizations)
        self.write(scene(5, 2))
        self.run_scene()
        self.write(scene(14, 3))
        self.run_scene("--resume")
        self.run_scene("-o", "straight.h5")
        self.assertEqual(self.digest("tiny.h5"), self.digest("straight.h5"))
        with h5py.File(self.folder / "tiny.h5") as file:
            self.assertEqual(list(file["motion/point_0000/waiting_time"]), [0, 1, 3, 10])
            self.assertEqual(list(file["motion/point_0000/lag"]), [1, 2, 3, 4, 5, 6, 8, 10, 13])

    def test_a_default_origin_at_the_last_tap_begins_when_the_run_goes_on(self):
        def scene(taps):
            return changed(FOLLOWED, motion={}, protocol=[{"tap": {"dilate": 0.05}, "count": taps}])
        self.write(scene(10))
        self.run_scene()
        self.write(scene(12))
        self.run_scene("--resume")
        self.run_scene("-o", "straight.h5")
        self.assertEqual(self.digest("tiny.h5"), self.digest("straight.h5"))
        with h5py.File(self.folder / "tiny.h5") as file:
            self.assertEqual(list(file["motion/point_0000/waiting_time"]), [0, 1, 3, 10])
            self.assertFalse(np.isnan(file["motion/point_0000/overlap"][3, :2]).any())

    def test_grains_are_followed(self):
        self.write(changed(FOLLOWED, realizations=1, spheres=20,
                           container={"sides": "cylinder", "diameter": 3},
                           engine={"discrete_element": {}}, start={"random_settle": {}},
                           protocol=[{"tap": {"lift": 0.1}, "count": 2}],
                           motion={}, snapshots={"taps": []}))
        text = (self.folder / "scene.json").read_text()
        grains = json.loads(text)
        del grains["relax"], grains["sweep"]
        self.write(grains)
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as file:
            self.assertTrue((file["motion/point_0000/square_displacement"][0, 0, :, 0] > 0).all())
            self.assertEqual(file["motion/point_0000/largest_step"][0], 0)


if __name__ == "__main__":
    unittest.main()
