"""Small inputs on which neighbouring programs, and earlier versions of this one, went wrong: tests/data/cases, measured
and gr_lattice_*.xyz. Each has its right value here; tests named beside them try others of their kind."""

import json
import unittest

import h5py
import numpy as np

from support import BAD_INPUT, BROKEN, SOURCE, Case

DATA = SOURCE / "tests/data"
FRACTION, NEIGHBOURS, HEIGHT = 0.5780, 6.127, 1.9315  # the spheres of bed.xyz


class SmallInputs(Case):
    def take(self, *names):
        for name in names:
            folder = next(path for path in (DATA / "cases", DATA / "measured", DATA) if (path / name).exists())
            (self.folder / name).write_bytes((folder / name).read_bytes())

    def tables(self, *arguments):
        return {table["name"].split("/")[-1]: table
                for table in json.loads(self.jostle(*arguments, "--json").stdout)["tables"]}

    # Beds in extended XYZ, named as scenes do (kind: extended_xyz_test.py).

    def measured(self, name):
        tables = self.tables("structure", name, "--part", "profile,coordination")
        return (tables["profile"]["quantities"]["phi_region"]["values"][0],
                tables["coordination"]["quantities"]["n_c"]["values"][0])

    def test_a_raised_or_unwrapped_bed_is_the_bed(self):
        self.take("bed.xyz", "origin_z2.xyz", "two_periods_off.xyz", "st_o_z.json", "st_plus2.json")
        expected = self.measured("bed.xyz")
        self.assertAlmostEqual(expected[0], FRACTION, delta=5e-5)
        self.assertAlmostEqual(expected[1], NEIGHBOURS, delta=5e-4)
        for name in ("origin_z2.xyz", "two_periods_off.xyz"):
            np.testing.assert_allclose(self.measured(name), expected, rtol=0, atol=1e-12, err_msg=name)
        for scene in ("st_o_z", "st_plus2"):
            self.run_scene(scene=f"{scene}.json")
            with h5py.File(self.folder / f"{scene}.h5") as file:
                heights = file["observables/point_0000/mean_height"][:, 0]
                fractions = file["observables/point_0000/bottom_fraction"][:, 0]
            self.assertAlmostEqual(heights[0], HEIGHT, delta=5e-5)
            self.assertAlmostEqual(fractions[0], 0.5411, delta=5e-5)
            self.assertLess(heights[1], 1.02 * HEIGHT)

    def test_spheres_of_two_sizes_are_read_or_refused_by_name(self):
        self.take("radius_two_sizes.xyz", "st_o_z.json")
        scene = json.loads((self.folder / "st_o_z.json").read_text())
        scene["start"]["file"] = "radius_two_sizes.xyz"
        self.write(scene)
        done = self.jostle("structure", "radius_two_sizes.xyz", "--part", "layers", expect=None)
        self.assertIn("measures of layers require equal spheres", done.stdout + done.stderr)
        self.jostle("check", "scene.json", "--no-pilot")
        self.jostle("export", "radius_two_sizes.xyz", "--format", "lammps", "-o", "two.dump")
        radii = {line.split()[5] for line in (self.folder / "two.dump").read_text().splitlines()[9:]}
        self.assertEqual(radii, {"0.3", "0.5"})

    # Pairs (kind: order/pair_correlation_test.cpp).

    def test_lattices_have_six_and_twelve_neighbours(self):
        self.take("gr_lattice_walls.xyz", "gr_lattice_periodic.xyz")
        for name in ("gr_lattice_walls.xyz", "gr_lattice_periodic.xyz"):
            for reach in ({}, {"r_max": 1.8}):
                settings = json.dumps({"pair_correlation": reach})
                table = self.tables("structure", name, "--settings", settings)["pair_correlation"]
                ends = np.array(table["axes"]["r_end"]["values"])
                counts = np.array(table["quantities"]["neighbours"]["values"], dtype=float).ravel()
                first, second = (counts[np.argmin(abs(ends - end))] for end in (1.3, 1.76))
                self.assertAlmostEqual(first, 6, delta=1e-9, msg=(name, reach))
                self.assertAlmostEqual(second - first, 12, delta=1e-9, msg=(name, reach))

    # Measured curves (kind: fit_test.py, measured/curve_file_test.cpp).

    def x_inf(self, *arguments):
        curve = json.loads(self.jostle("fit", *arguments, "--model", "inverse_log", "--json").stdout)["curves"][0]
        return curve["fits"][0], curve["fits"][0]["parameters"]["X_inf"]

    def test_columns_go_by_their_names(self):
        self.take("v_named.csv", "v_sigma_first.csv", "v_index.csv", "real.csv", "real_index.csv")
        for name in ("v_named.csv", "v_sigma_first.csv"):
            found, x_inf = self.x_inf(name)
            self.assertTrue(found["sigma_given"], name)
            self.assertEqual((round(x_inf["value"], 4), round(x_inf["error"], 4)), (0.6322, 0.0010), name)
        found, x_inf = self.x_inf("v_index.csv")
        self.assertFalse(found["sigma_given"])
        self.assertLess(abs(x_inf["value"] - 0.6322), x_inf["error"])
        fits = [self.x_inf(name, "--realizations")[0] for name in ("real.csv", "real_index.csv")]
        self.assertEqual(fits[0], fits[1])
        self.assertEqual(fits[0]["realizations"], 4)

    # Sweeps of one scene and seed (kind: files_together_test.py).

    def test_a_point_that_two_sweeps_share_counts_once(self):
        self.take("sweep_a.json", "sweep_b.json")
        for name in ("sweep_a", "sweep_b"):
            self.run_scene(scene=f"{name}.json")
        asked = ("sweep", "--observable", "mean_height", "--json")
        done = self.jostle("analyse", "sweep_a.h5", "sweep_b.h5", *asked, expect=BAD_INPUT)
        refused = json.loads(done.stdout)["tables"][0]["notes"]["refused"]
        self.assertIn("sweep_a.h5, sweep point 1, and sweep_b.h5, sweep point 0, hold the same 3 realizations", refused)
        scene = json.loads((self.folder / "sweep_b.json").read_text())
        scene["sweep"] = {"/protocol/0/tap/dilate": [0.3]}
        self.write(scene, "rest.json")
        self.run_scene("-o", "rest.h5", scene="rest.json")
        table = json.loads(self.jostle("analyse", "sweep_a.h5", "rest.h5", *asked).stdout)["tables"][0]
        self.assertEqual(len(table["axes"]["sqrt_epsilon"]["values"]), 3)
        self.assertEqual(table["quantities"]["pooled_sigma_dof"]["values"], 6)

    # A file that another program opened (kind: seal_test.py).

    def test_a_file_opened_for_writing_and_closed_is_accepted(self):
        self.take("scene.json")
        self.run_scene("-o", "q.h5")
        digest = self.digest("q.h5")
        with h5py.File(self.folder / "q.h5", "r+"):
            pass
        done = self.jostle("info", "q.h5")
        self.assertEqual(done.stderr.count("warning"), 1)
        self.assertIn("another program opened it for writing", " ".join(done.stderr.split()))
        self.assertEqual(self.digest("q.h5"), digest)
        self.jostle("info", "--reseal", "q.h5")
        self.assertEqual(self.jostle("info", "q.h5").stderr, "")
        with h5py.File(self.folder / "q.h5", "r+") as file:
            file["observables/point_0000/mean_height"][7, 1] += 1e-9
        refused = self.jostle("info", "q.h5", expect=BROKEN).stderr
        self.assertIn("/observables/point_0000/mean_height", refused)

    # A series that does not vary (kind: numbers_test.py).

    def test_a_constant_series_has_no_number_that_is_none(self):
        self.take("crystalline.json")
        self.run_scene(scene="crystalline.json")
        with h5py.File(self.folder / "crystalline.h5") as file:
            self.assertFalse(file["observables/point_0000/crystalline_fraction"][...].any())
        for analysis in ("spectrum", "steady", "ageing"):
            text = self.jostle("analyse", "crystalline.h5", analysis, "--observable", "crystalline_fraction",
                               "--no-store").stdout
            self.assertNotRegex(text.lower(), r"(?<![a-z_])(nan|inf)(?![a-z])", analysis)
            if analysis != "ageing":
                self.assertIn("the series is constant", text)


if __name__ == "__main__":
    unittest.main()
