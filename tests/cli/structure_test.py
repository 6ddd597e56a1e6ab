"""jostle structure: what kept packings look like inside, in results files and in extended XYZ."""

import json
import pathlib
import unittest

import h5py
import numpy as np

from support import BAD_INPUT, BROKEN, FAILED, TINY, Case, changed

PARTS = ["clusters", "coordination", "holes", "layers", "order", "pair_correlation", "pores", "profile", "sides",
         "void_probability", "voronoi"]
SMALL = {"profile": {}, "coordination": {"cut": 1.1}, "pores": {"largest": 2},
         "region": {"heights": [0.6, 1.5], "from_sides": 0}}


class Structure(Case):
    def structure(self, *arguments, expect=0):
        return self.jostle("structure", *arguments, expect=expect)

    def tables(self, *arguments):
        found = json.loads(self.structure(*arguments, "--json").stdout)["tables"]
        return {table["name"]: table for table in found}

    def stored(self, name="tiny.h5"):
        """Every number under /structure."""
        found = {}
        with h5py.File(self.folder / name) as file:
            file["structure"].visititems(
                lambda path, node: found.update({path: node[...]})
                if isinstance(node, h5py.Dataset) else None)
        return found

    def assert_same(self, one, other):
        self.assertEqual(one.keys(), other.keys())
        for path, values in one.items():
            as_text = [values.tolist(), other[path].tolist()]
            self.assertEqual(*map(repr, as_text), path)

    def test_a_run_ends_with_what_its_scene_names_and_nothing_else(self):
        self.write(changed(TINY, structure=SMALL))
        self.assertNotIn("point_0001/pores", self.run_scene().stdout)
        self.assertIn("point_0001/pores", self.run_scene("--force", "--verbose").stdout)
        with h5py.File(self.folder / "tiny.h5") as file:
            self.assertEqual(sorted(file["structure"]), ["comparison", "point_0000", "point_0001"])
            point = file["structure/point_0000"]
            self.assertEqual(sorted(point), ["coordination", "pores", "profile"])
            profile = point["profile"]
            self.assertEqual(profile["tap"][:].tolist(), [0, 4])
            self.assertEqual(profile["phi"].shape, (2, profile["height"].size))
            self.assertEqual(profile["phi"].dims[1][0], profile["height"])
            self.assertEqual(profile["phi"].attrs["units"], "1")
            self.assertTrue((profile["phi_error"][:] >= 0).any())
            self.assertEqual(point["coordination/realizations"][:].tolist(), [3, 3])
            # All of the solids: the profile's integral is the volume of the spheres.
            width = TINY["container"]["width"]
            solids = profile["phi"][:].sum(axis=1) * 0.1 * width**2
            np.testing.assert_allclose(solids, TINY["spheres"] * np.pi / 6, rtol=1e-12)
        kept = self.stored()
        self.structure("tiny.h5", "--threads", 2)
        self.assert_same(kept, self.stored())

    def test_the_same_after_the_fact_for_any_number_of_threads(self):
        self.write(TINY)
        self.run_scene()
        out = self.structure("tiny.h5", "--threads", 1, "--csv", "all.csv").stdout
        for part in PARTS:
            self.assertIn(f"point_0000/{part}", out)
        one = self.stored()
        self.structure("tiny.h5", "--threads", 3)
        self.assert_same(one, self.stored())
        text = (self.folder / "all.csv").read_text()
        self.assertIn("tap,height,phi,phi_error", text)

    def test_mean_and_error_are_those_of_the_realizations(self):
        self.write(TINY)
        self.run_scene()
        whole = self.tables("tiny.h5", "--part", "coordination", "--tap", 4, "--sweep-point", 1,
                            "--no-store")["point_0001/coordination"]["quantities"]
        for r in range(3):
            self.jostle("export", "tiny.h5", "--format", "extxyz", "--sweep-point", 1,
                        "--realization", r, "-o", f"r{r}.xyz")
        single = [self.tables(f"r{r}.xyz", "--part", "coordination")["coordination"]["quantities"]
                  ["n_c_all"] for r in range(3)]
        values = [quantity["values"][0] for quantity in single]
        self.assertAlmostEqual(whole["n_c_all"]["values"][0], np.mean(values), delta=1e-12)
        self.assertAlmostEqual(whole["n_c_all_error"]["values"][0],
                               np.std(values, ddof=1) / np.sqrt(3), delta=1e-12)
        together = self.tables("r0.xyz", "r1.xyz", "r2.xyz", "--part", "coordination")
        for name, quantity in whole.items():
            self.assertEqual(quantity["values"],
                             together["coordination"]["quantities"][name]["values"], name)

    def test_a_part_that_is_not_there_says_so_and_the_rest_is_measured(self):
        self.write_frame("layer.xyz", [[1 + 1.1 * k, 1, 0.5] for k in range(5)])
        found = self.tables("layer.xyz", "--part", "layers,pair_correlation")
        self.assertIn("too few layers", found["pair_correlation"]["notes"]["refused"])
        self.assertNotIn("refused", found["layers"]["notes"])

    def test_pairs_reach_four_diameters_or_half_a_period(self):
        for sides, reach in (("periodic", 2), ("walls", 4)):
            self.write(changed(TINY, container={"sides": sides, "width": 4}, spheres=64))
            self.run_scene("--force")
            found = self.tables("tiny.h5", "--part", "pair_correlation", "--no-store")
            r = found["point_0000/pair_correlation"]["axes"]["r"]["values"]
            self.assertAlmostEqual(r[-1], reach - 0.01)
            with h5py.File(self.folder / "tiny.h5") as file:
                self.assertNotIn("structure", file)

    def test_lattices_have_their_neighbours_and_few_pairs_are_said(self):
        data = pathlib.Path(__file__).parents[1] / "data"
        for name in ("gr_lattice_walls.xyz", "gr_lattice_periodic.xyz"):
            found = self.tables(str(data / name), "--part", "pair_correlation")["pair_correlation"]
            quantities = found["quantities"]
            r, g = np.array(found["axes"]["r"]["values"]), np.array(quantities["g"]["values"]).ravel()
            shell = 4 / 3 * np.pi * ((r + 0.01) ** 3 - (r - 0.01) ** 3) * g / 1.2 ** 3
            self.assertAlmostEqual(shell[(r > 1.15) & (r < 1.25)].sum(), 6, delta=0.12)
            self.assertAlmostEqual(shell[(r > 1.65) & (r < 1.75)].sum(), 12, delta=0.24)
            ends = np.array(found["axes"]["r_end"]["values"])
            neighbours = np.array(quantities["neighbours"]["values"]).ravel()
            self.assertAlmostEqual(neighbours[np.argmin(abs(ends - 1.22))], 6, delta=1e-9)
            self.assertEqual(quantities["packings"]["values"], [1])
            self.assertGreater(quantities["centres"]["values"][0], 100)
        self.write_frame("gas.xyz", [[1 + 2 * (k % 3), 1 + 2 * (k // 3 % 2), 0.6 + 1.3 * k] for k in range(12)])
        found = self.tables("gas.xyz", "--part", "pair_correlation")["pair_correlation"]
        self.assertIn("central spheres in 1 packings", found["notes"]["few_pairs"])

    def write_frame(self, name, centres):
        rows = "".join(f"X {x} {y} {z}\n" for x, y, z in centres)
        (self.folder / name).write_text(
            f'{len(centres)}\nLattice="7 0 0 0 7 0 0 0 20" Properties=species:S:1:pos:R:3 pbc="F F F"\n{rows}')

    def test_columns_that_are_not_printed_are_named(self):
        self.write(TINY)
        self.run_scene()
        text = self.structure("tiny.h5", "--part", "profile,pair_correlation").stdout
        self.assertRegex(text, r"\d+ rows of .*r +in --wide, --csv FILE and --json: g, pairs\n")
        for block in text.strip().split("\n\npoint_")[1:]:
            self.assertRegex(block, r"rows of|\n +\w+ +[\d.-]")

    def test_it_says_what_stands_in_brackets(self):
        self.write(TINY)
        self.run_scene()
        for text in (self.structure("tiny.h5", "--part", "profile").stdout,
                     self.structure("tiny.h5", "--part", "coordination").stdout):
            self.assertRegex(" ".join(text.split()), r"a\(b\) b, in the last digits of a, is half the 68 % interval")
        self.assertRegex(" ".join(text.split()), r"degrees of freedom; a \(x to y\): the 95 % interval")

    def test_shards_are_measured_when_they_are_merged(self):
        self.write(changed(TINY, structure=SMALL))
        self.run_scene()
        straight = self.stored()
        for share in (1, 2):
            self.run_scene("--shard", f"{share}/2", "-o", f"part{share}.h5")
        self.jostle("merge", "part1.h5", "part2.h5", "-o", "all.h5")
        self.assert_same(straight, self.stored("all.h5"))

    def test_a_point_whose_realizations_failed_says_so_and_others_are_measured(self):
        # No crystal fits 4 x 4 unless it is stretched: the first point fails, the second does not.
        scene = changed(TINY, start={"crystal": "hcp"}, structure=SMALL,
                        sweep={"/start/crystal/stretch": [False, True]})
        self.write(scene)
        self.run_scene(expect=FAILED)
        with h5py.File(self.folder / "tiny.h5") as file:
            refused, measured = (file[f"structure/point_000{p}/profile"] for p in (0, 1))
            self.assertIn("no realization has a packing", refused.attrs["note_refused"])
            self.assertEqual(measured["realizations"][:].tolist(), [3, 3])
        scene["sweep"] = {"/start/crystal/stretch": [False]}
        self.write(changed(scene, name="none"))
        self.assertIn("no structure", self.run_scene(expect=FAILED).stderr)

    def test_a_point_that_is_inserted_changes_no_other(self):
        drawn = {"void_probability": {"points": 200}, "region": SMALL["region"]}
        self.write(changed(TINY, structure=drawn))
        self.run_scene()
        before = self.stored()
        self.write(changed(TINY, structure=drawn, name="more",
                           sweep={"/protocol/0/tap/dilate": [0.02, 0.05, 0.1]}))
        self.run_scene()
        after = self.stored("more.h5")
        of_point = {path.replace("point_0001", "point_0002"): values
                    for path, values in before.items() if path.startswith("point_0001")}
        self.assertTrue(of_point)
        for path, values in of_point.items():
            self.assertEqual(repr(values.tolist()), repr(after[path].tolist()), path)

    def test_packings_of_several_containers_have_no_mean(self):
        cell = 'Lattice="{0} 0 0 0 {0} 0 0 0 9" Properties=species:S:1:pos:R:3 pbc="T T F"'
        for width in (4, 5):
            (self.folder / f"{width}.xyz").write_text(
                f"2\n{cell.format(width)}\nX 1 1 0.5\nX 2 1 0.5\n")
        self.assertIn("its container is not that of 4.xyz",
                      self.structure("4.xyz", "5.xyz", expect=BAD_INPUT).stderr)

    def test_tables_tell_what_they_were_measured_with(self):
        self.write(TINY)
        self.run_scene()
        given = '{"coordination": {"cut": 1.3}, "region": {"heights": [0.5, 2]}}'
        notes = self.tables("tiny.h5", "--settings", given, "--sweep-point", 0, "--tap", 4,
                            "--no-store")["point_0000/coordination"]["notes"]
        self.assertEqual(json.loads(notes["settings"]),
                         {"cut": 1.3, "largest_cut": 1.5, "step": 0.01})
        self.assertEqual(json.loads(notes["region"]), {"heights": [0.5, 2], "from_sides": 1})

    def test_tables_name_the_heights_that_they_were_measured_at(self):
        self.write(changed(TINY, container={"sides": "walls", "width": 4.5}))
        self.run_scene()
        parts = {"profile": {}, "sides": {}, "layers": {}, "pair_correlation": {}, "coordination": {}}
        bulk = "heights from 1 d to 10 d, but at most 2<Z> - 1 d, in each packing"
        given = {"profile": "phi_region: heights 0.5 to 2, from side to side",
                 "sides": "of each packing: heights 2 to 0.8 of 2<Z>",
                 "layers": "all heights, from side to side", "coordination": '{"heights":[0.5,2],"from_sides":0}'}
        default = {**given, "profile": f"phi_region: {bulk}, from side to side",
                   "coordination": f"{bulk}, at least 1 d from walls; all of a fully periodic box"}
        for region, expected in (({"heights": [0.5, 2], "from_sides": 0}, given), (None, default)):
            settings = {**parts, **({"region": region} if region else {})}
            found = self.tables("tiny.h5", "--settings", json.dumps(settings), "--sweep-point", 0, "--tap", 4,
                                "--no-store")
            notes = {name.split("/")[1]: table["notes"]["region"] for name, table in found.items()}
            self.assertEqual(next(table["notes"]["R"] for name, table in found.items() if name.endswith("profile")),
                             "radius of a sphere of diameter d = 1")
            pairs = notes.pop("pair_correlation")
            self.assertIn("central spheres from side to side, at heights at least r_max above 1/2", pairs)
            self.assertNotIn("from walls", pairs)
            self.assertEqual({name: note.replace(" ", "") for name, note in notes.items()},
                             {name: note.replace(" ", "") for name, note in expected.items()})

    def test_settings_are_those_of_scenes(self):
        self.write(TINY)
        self.run_scene()
        self.write({"pores": {"bin_width": 0.1}}, "settings.json")
        for given in ("settings.json", '{"pores": {"bin_width": 0.1}}'):
            found = self.tables("tiny.h5", "--settings", given, "--sweep-point", 0, "--no-store")
            self.assertEqual(list(found), ["point_0000/pores"])
            self.assertEqual(len(found["point_0000/pores"]["axes"]["xi"]["values"]), 15)

    def test_bad_requests_are_refused_by_name(self):
        self.write(TINY)
        self.run_scene()
        self.write({"pores": {"bin_widht": 0.1}}, "bad.json")
        (self.folder / "radii.xyz").write_text(
            '2\nLattice="4 0 0 0 4 0 0 0 4" Properties=species:S:1:pos:R:3 pbc="T T F"\n'
            "X 1 1 0.5\nX 1.3 1 0.5\n")
        for arguments, answer in ((["tiny.h5", "--part", "poers"], "there is no such part"),
                                  (["tiny.h5", "--tap", 3], "there are 0, 4"),
                                  (["tiny.h5", "--settings", "bad.json"], 'mean "bin_width"'),
                                  (["tiny.h5", "--settings", "none.json"], "nor is it a JSON"),
                                  (["tiny.h5", "tiny.h5"], "one results file"),
                                  (["tiny.h5", "--sweep-point", 9], "9")):
            with self.subTest(arguments=arguments):
                self.assertIn(answer, self.structure(*arguments, expect=BAD_INPUT).stderr)
        self.assertIn("scene.json: neither a results file", self.structure("scene.json", expect=BROKEN).stderr)
        self.assertIn("must be in diameters", self.structure("radii.xyz", expect=BROKEN).stderr)  # by the reader
        for name, x in (("apart", 2.5), ("inside", 1.3)):
            (self.folder / f"{name}.xyz").write_text(
                '2\nLattice="4 0 0 0 4 0 0 0 4" Properties=species:S:1:pos:R:3:radius:R:1 pbc="T T F"\n'
                f"A 1 1 0.5 0.5\nB {x} 1 0.5 0.6\n")
        done = self.structure("apart.xyz", "inside.xyz", "--part", "pair_correlation", expect=BAD_INPUT)
        self.assertTrue(done.stderr.startswith("jostle: inside.xyz, tap 0: spheres 0 and 1 are 0.3"), done.stderr)
        self.write(changed(TINY, name="bare", snapshots={"taps": [0], "keep": ["coordination"]}))
        self.run_scene()
        self.assertIn("no packings are kept",
                      self.structure("bare.h5", expect=BAD_INPUT).stderr)


if __name__ == "__main__":
    unittest.main()
