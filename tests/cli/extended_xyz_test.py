"""Extended XYZ: whatever changes the meaning of positions is read right by every command, or refused by every one."""

import json
import unittest

import h5py
import numpy as np

from support import BAD_INPUT, BROKEN, Case, TINY, changed, some

START = changed(TINY, realizations=1, protocol=[{"tap": {"dilate": 0.02}, "count": 1}],
                relax={"polar": {}, "stop": {"sweeps": 3}}, observe=["mean_height", "bottom_fraction"],
                snapshots={"taps": [0]}, start={"file": "a.xyz"})
del START["sweep"]
REGION = '{"profile": {}, "coordination": {"cut": 1.1}, "region": {"heights": [0.6, 1.5], "from_sides": 0}}'
HEADER = 'Lattice="4 0 0 0 4 0 0 0 5" Properties=species:S:1:pos:R:3 pbc="T T F"'


def frame(rows, header=HEADER, count=None):
    lines = [str(len(rows) if count is None else count), header]
    return "\n".join(lines + [" ".join(str(word) for word in row) for row in rows]) + "\n"


class ExtendedXyz(Case):
    def setUp(self):
        super().setUp()
        self.write(TINY)
        self.run_scene()
        self.jostle("export", "tiny.h5", "--format", "extxyz", "-o", "exported.xyz")
        lines = (self.folder / "exported.xyz").read_text().splitlines()[2:]
        self.centres = [[float(word) for word in line.split()[1:4]] for line in lines]
        self.rows = [["X", *centre] for centre in self.centres]
        self.expected = self.read_by_all(frame(self.rows))

    def read_by_all(self, text, tap=None, frames=1):
        """Results of every command for a file: structure's numbers, an export's centres, a start's."""
        self.write(text, "a.xyz")
        tap = frames - 1 if tap is None else tap
        printed = self.jostle("structure", "a.xyz", "--settings", REGION, "--tap", tap, "--json").stdout
        numbers = {name: np.array(quantity["values"], dtype=float)
                   for table in json.loads(printed)["tables"]
                   for name, quantity in table["quantities"].items()
                   if all(isinstance(value, (int, float, list)) for value in quantity["values"])}
        self.jostle("export", "a.xyz", "--format", "lammps", "-o", "a.dump", "--force", "--tap", tap)
        dump = (self.folder / "a.dump").read_text().splitlines()
        exported = np.array([[float(word) for word in line.split()[2:5]] for line in dump[9:]])
        self.write(changed(START, start={"file": {"path": "a.xyz", "frame": tap}}))
        self.run_scene("-o", "start.h5", "--force")
        with h5py.File(self.folder / "start.h5") as file:
            started = file["particles/point_0000_realization_00000/position/value"][0]
        return numbers, exported, started

    def read_alike(self, text, **which):
        numbers, exported, started = self.read_by_all(text, **which)
        self.assertEqual(numbers.keys(), self.expected[0].keys())
        for name, values in numbers.items():
            np.testing.assert_allclose(values, self.expected[0][name], rtol=0, atol=1e-9, err_msg=name)
        np.testing.assert_allclose(exported, self.centres, rtol=0, atol=1e-12)
        np.testing.assert_allclose(started, self.centres, rtol=0, atol=1e-12)

    def refused_by_all(self, text, says):
        self.write(text, "a.xyz")
        self.write(START)
        commands = [["structure", "a.xyz", "--part", "profile"], ["structure", "a.xyz", "--tap", "0"],
                    ["check", "scene.json", "--no-pilot"], ["run", "scene.json", "-o", "start.h5", "--force"],
                    ["cost", "scene.json", "--replicates", "2", "-o", "c.h5", "--force"]]
        commands += [["export", "a.xyz", "--format", form, "-o", "out", "--force", "--tap", tap]
                     for form in ("extxyz", "lammps", "vtp", "h5md") for tap in ("all", "0")]
        for command in some(commands, 5):
            with self.subTest(command=command, says=says):
                done = self.jostle(*command, expect=None)
                self.assertIn(done.returncode, (BAD_INPUT, BROKEN), command)
                self.assertRegex(done.stderr, rf"a\.xyz: line \d+: .*{says}")
        self.assertFalse((self.folder / "out").exists())

    def test_the_reference_is_what_was_exported(self):
        numbers, exported, started = self.expected
        self.assertTrue(0.4 < numbers["phi_region"].item() < 0.75)
        self.assertTrue(4 < numbers["n_c"].item() < 8)
        np.testing.assert_array_equal(exported, self.centres)
        np.testing.assert_array_equal(started, self.centres)

    def shifted(self, dx, dy, dz):
        return [["X", x + dx, y + dy, z + dz] for x, y, z in self.centres]

    def test_an_origin_moves_the_container_along_each_direction(self):
        for corner in ((0, 0, 2), (-2, -2, 0), (1.5, 0, 0), (0, -3.25, 0), (-2, 3, -1)):
            with self.subTest(corner=corner):
                origin = " ".join(map(str, corner))
                self.read_alike(frame(self.shifted(*corner), f'{HEADER} Origin="{origin}"'))
        self.read_alike(frame(self.shifted(0, 0, 2), f"{HEADER} origin=[0,0,2]"))
        self.refused_by_all(frame(self.rows, HEADER + ' Origin="0 0"'), "Origin has 2 numbers")
        self.refused_by_all(frame(self.rows, HEADER + ' Origin="0 0 x"'), "not a finite number")

    def test_coordinates_any_number_of_periods_away_are_those_of_their_images(self):
        for periods in (1, 2, -3, 1000):
            with self.subTest(periods=periods):
                self.read_alike(frame(self.shifted(4.0 * periods, 0, 0)))
        mixed = [["X", x + 4.0 * (i % 5 - 2), y - 4.0 * (i % 7), z] for i, (x, y, z) in enumerate(self.centres)]
        self.read_alike(frame(mixed))

    def test_layouts_of_columns(self):
        table = [(i, *centre) for i, centre in enumerate(self.centres)]
        layouts = {
            "pos:R:3": [(x, y, z) for _, x, y, z in table],
            "id:I:1:velo:R:3:pos:R:3:radius:R:1": [(i, 9, 8, 7, x, y, z, 0.5) for i, x, y, z in table],
            "species:S:1:pos:R:3:diameter:R:1:fixed:L:1": [("C", x, y, z, 1.0, "T") for _, x, y, z in table],
            "pos:R:3:Radius:R:1:aspherical_shape:R:3": [(x, y, z, "0.5000000", 0, 0, 0) for _, x, y, z in table]}
        for properties, rows in layouts.items():
            with self.subTest(properties=properties):
                self.read_alike(frame(rows, HEADER.replace("species:S:1:pos:R:3", properties)))
                self.read_alike(frame(rows, HEADER.replace("species:S:1:pos:R:3", properties)
                                      .replace("Properties", "properties")))
        self.read_alike(frame(self.rows, HEADER.replace("Properties=species:S:1:pos:R:3 ", "")))
        with_size = [[*row, 0.3] for row in self.rows]
        self.refused_by_all(frame(with_size, HEADER.replace("Properties=species:S:1:pos:R:3 ", "")),
                            "too many columns: 5 and not 4")
        for properties, says in (("species:S:1:pos:R:3:pos:R:3", "pos twice"), ("species:S:1:pos:R:2", "pos:R:2"),
                                 ("species:S:1:pos:I:3", "pos:I:3"), ("species:S:1:pos:R", "not all three"),
                                 ("species:S:1:scaled_pos:R:3", "no pos:R:3"), ("species:Q:1:pos:R:3", "type Q")):
            self.refused_by_all(frame(self.rows, HEADER.replace("species:S:1:pos:R:3", properties)), says)

    def test_sizes_that_the_model_has_not_are_refused(self):
        for name, model in (("radius", 0.5), ("Radius", 0.5), ("diameter", 1.0), ("particle_radius", 0.5),
                            ("aspherical_shape", 0.5)):
            header = HEADER.replace("pos:R:3", f"pos:R:3:{name}:R:1")
            if name == "aspherical_shape":
                several = [[*row, 0.3 if i % 2 else model] for i, row in enumerate(self.rows)]
                last = [[*row, 0.3 if i == 47 else model] for i, row in enumerate(self.rows)]
                for rows in (several, last):
                    self.refused_by_all(frame(rows, header), f"{name} is from 0.3 to {model:g}: sizes of a mixture")
            self.refused_by_all(frame([[*row, 0.3] for row in self.rows], header),
                                f"{name} is 0.3, and the spheres of the model have {model:g}.*Divide all lengths")
        self.refused_by_all(frame(self.rows, HEADER + " radius=0.3"), "radius is 0.3")
        self.refused_by_all(frame(self.rows, HEADER + ' Diameter="0.5"'), "diameter is 0.5")
        self.refused_by_all(frame(self.rows, HEADER + " units=mm"), "must be in diameters")
        self.read_alike(frame(self.rows, HEADER + " radius=0.5 units=diameters"))

    def test_sizes_of_a_mixture_are_read(self):
        """Sizes by radius and by diameter, by every command that takes them; kinds by species."""
        for name, small, large in (("radius", 0.3, 0.5), ("particle_radius", 0.3, 0.5), ("Diameter", 0.6, 1.0)):
            header = HEADER.replace("pos:R:3", f"pos:R:3:{name}:R:1")
            rows = [["s" if i % 2 else "l", *row[1:], small if i % 2 else large] for i, row in enumerate(self.rows)]
            self.write(frame(rows, header), "a.xyz")
            self.jostle("export", "a.xyz", "--format", "extxyz", "-o", "b.xyz", "--force")
            self.assertIn('kinds="l s"', (self.folder / "b.xyz").read_text().splitlines()[1])
            for file in ("a.xyz", "b.xyz"):
                self.write(changed(START, start={"file": file}))
                self.run_scene("-o", "start.h5", "--force")
                with h5py.File(self.folder / "start.h5") as h5:
                    self.assertEqual(h5.attrs["jostle_format"], 2)
                    self.assertEqual(h5["spheres/point_0000/name"].asstr()[()].tolist(), ["l", "s"])
                    np.testing.assert_allclose(h5["spheres/point_0000/diameter"][()], [1.0, 0.6] * 24)
            measured = self.jostle("structure", "a.xyz", "--settings", REGION)
            self.assertIn("n_c_of_pair", measured.stdout)

    def test_packings_of_other_kinds_have_no_mean(self):
        header = HEADER.replace("pos:R:3", "pos:R:3:radius:R:1")
        for file, kinds in (("a.xyz", "ls"), ("b.xyz", "lt")):
            rows = [[kinds[i % 2], *row[1:], 0.3 if i % 2 else 0.5] for i, row in enumerate(self.rows)]
            self.write(frame(rows, header), file)
        refused = self.jostle("structure", "a.xyz", "b.xyz", "--settings", REGION, expect=BAD_INPUT)
        self.assertIn('its kinds of spheres, "l", "t", are not those of a.xyz, "l", "s"', refused.stderr)

    def test_listed_kinds_must_match_those_of_the_file(self):
        header = HEADER.replace("pos:R:3", "pos:R:3:radius:R:1")
        rows = [["s" if i % 2 else "l", *row[1:], 0.3 if i % 2 else 0.5] for i, row in enumerate(self.rows)]
        self.write(frame(rows, header), "a.xyz")
        small, large = {"name": "s", "count": 24, "diameter": 0.6}, {"name": "l", "count": 24}
        observe = ["mean_height", {"kind_height": {"kind": "s"}}, "segregation"]
        self.write(changed(START, spheres=[small, large | {"density": 3}], observe=observe))
        self.run_scene("-o", "start.h5", "--force")
        with h5py.File(self.folder / "start.h5") as h5:
            self.assertEqual(h5["spheres/point_0000/name"].asstr()[()].tolist(), ["s", "l"])
            self.assertEqual(h5["spheres/point_0000/density"][()].tolist(), [1, 3])
            self.assertEqual(h5["spheres/point_0000/kind"][()].tolist(), [1, 0] * 24)
        for spheres, says in (([small | {"count": 23}, large | {"count": 25}], '24 spheres of kind "s"'),
                              ([small | {"diameter": 0.7}, large], "diameter 0.6"),
                              ([small | {"name": "t"}, large], 'kind "l"|kind "s"'),
                              ([small], "24")):
            self.write(changed(START, spheres=spheres, observe=["mean_height"]))
            refused = self.jostle("check", "scene.json", "--no-pilot", expect=BAD_INPUT)
            self.assertRegex(refused.stderr, says)

    def test_sizes_by_their_short_names(self):
        for name, model in (("r", 0.5), ("rad", 0.5), ("d", 1.0), ("diam", 1.0), ("sigma", 1.0), ("R", 0.5)):
            header = HEADER.replace("pos:R:3", f"pos:R:3:{name}:R:1")
            self.read_alike(frame([[*row, model] for row in self.rows], header))
            for rows in ([[*row, 0.3] for row in self.rows],
                         [[*row, 0.3 if i == 47 else model] for i, row in enumerate(self.rows)]):
                self.refused_by_all(frame(rows, header), f"{name} is .*0.3.* Rename the column if it holds no sizes")
        self.read_alike(frame(self.rows, HEADER + " r=3 d=2 sigma=0.1 size=7"))  # any comment of a frame

    def test_names_of_the_corner(self):
        for key in ("cell_origin", "box_origin", "Cell_Origin", "lattice_origin"):
            self.read_alike(frame(self.shifted(0, 0, 2), f'{HEADER} {key}="0 0 2"'))
        self.refused_by_all(frame(self.rows, HEADER + ' Origin="0 0 0" cell_origin="0 0 2"'), "leave one of them out")

    def test_beds_in_other_lengths_are_refused(self):
        fractional = [["X", x / 4, y / 4, z / 5] for x, y, z in self.centres]
        self.refused_by_all(frame(fractional), "apart, and their diameter is 1")
        lattice = [["X", 1.5 + 3 * (i % 5), 1.5 + 3 * (i // 5 % 5), 1.5 + 3 * (i // 25)] for i in range(100)]
        self.refused_by_all(frame(lattice, HEADER.replace("4 0 0 0 4 0 0 0 5", "15 0 0 0 15 0 0 0 15")),
                            "no two spheres are less than 1.5 apart")
        walls = HEADER.replace('pbc="T T F"', "container=walls")
        self.refused_by_all(frame(self.shifted(4, 0, 0), walls), "outside the container")

    def test_containers_that_contradict_themselves_are_refused(self):
        for words, says in (('pbc="T F T" container=periodic', "contradicts container=periodic"),
                            ('pbc="F F F" container=periodic', "contradicts container=periodic"),
                            ('pbc="T T F" container=walls', "contradicts container=walls"),
                            ('pbc="T T T" container=cylinder', "contradicts container=cylinder"),
                            ('pbc="T T F" container=fully_periodic', "contradicts container=fully_periodic"),
                            ('pbc="T F T"', "no container of jostle"), ('pbc="T T"', "three times T or F"),
                            ('pbc="2 1 0"', "three times T or F"), ("container=box", "container=box is not known"),
                            ('pbc="T T F" pbc="F F F"', "names pbc twice"), ("", "neither container")):
            self.refused_by_all(frame(self.rows, HEADER.replace('pbc="T T F"', words)), says)
        for words in ("container=periodic", 'container=periodic pbc="T T F"', "pbc=[true,true,false]",
                      "pbc='1 1 0'", 'PBC = "t t f" note="pbc=F F F"'):
            self.read_alike(frame(self.rows, HEADER.replace('pbc="T T F"', words)))

    def test_lattices_that_no_container_has_are_refused(self):
        for lattice, says in (("4 0.1 0 0 4 0 0 0 5", "right-angled"), ("4 0 0 0 4 0 1 0 5", "right-angled"),
                              ("0 4 0 4 0 0 0 0 5", "right-angled"), ("4 4 5", "3 numbers, not 9"),
                              ("2 0 0 0 4 0 0 0 5", "its own image"), ("-4 0 0 0 4 0 0 0 5", "above 0"),
                              ("4 0 0 0 4 0 0 0 -5", "negative"), ("4 0 0 0 4 0 0 0 inf", "finite")):
            self.refused_by_all(frame(self.rows, HEADER.replace("4 0 0 0 4 0 0 0 5", lattice)), says)
        tube = HEADER.replace('pbc="T T F"', "container=cylinder").replace("4 0 0 0 4", "4 0 0 0 5")
        self.refused_by_all(frame(self.rows, tube), "one diameter")

    def test_wrong_counts_are_refused_in_whichever_frame_they_are(self):
        self.refused_by_all(frame(self.rows, count=47), "is not a count")
        self.refused_by_all(frame(self.rows, count=49), "the file ends after 48 of 49")
        good = frame(self.rows)
        numbered = frame([[i, *row[1:]] for i, row in enumerate(self.rows)], count=47)
        self.refused_by_all(numbered, "alone on the line")
        self.refused_by_all(good + frame(self.rows, count=49), "the file ends after 48 of 49")
        self.refused_by_all(good + frame([[*row, 0.3] for row in self.rows],
                                         HEADER.replace("pos:R:3", "pos:R:3:radius:R:1")), "radius is 0.3")

    def test_each_frame_is_read_by_its_own_header(self):
        frames = (frame(self.shifted(0, 0, 2), HEADER + ' Origin="0 0 2"')
                  + frame([row[1:] for row in self.shifted(8, 0, 0)], HEADER.replace("species:S:1:", "")) + "\n")
        for tap in (0, 1):
            self.read_alike(frames, tap=tap, frames=2)


if __name__ == "__main__":
    unittest.main()
