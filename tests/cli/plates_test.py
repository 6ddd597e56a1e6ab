"""Spheres between two plates, periodic along them: through every command that takes a packing."""

import json
import unittest

import h5py
import numpy as np

from support import BAD_INPUT, BROKEN, SOURCE, Case, changed

SCENE = json.loads((SOURCE / "config/scenes/plates.json").read_text()) | {
    "realizations": 2, "container": {"sides": "plates", "width": 6, "gap": 4}, "spheres": 200,
    "protocol": [{"tap": {"dilate": 0.1}, "count": 3}], "snapshots": {"taps": [0, 3]},
    "structure": {"region": {"heights": [0.6, 5], "from_sides": 0.5}, "profile": {}, "sides": {"reach": 1.5},
                  "layers": {}, "voronoi": {}, "pair_correlation": {}, "gaps": {"tolerance": 1e-4}}}
GRAINS = changed(SCENE, start={"random_settle": {"dilute_fraction": 0.2}}, engine={"discrete_element": {}},
                 protocol=[{"tap": {"half_sine": {"amplitude": 0.3, "frequency": 7.5}}, "count": 1}],
                 snapshots={"taps": [0, 1], "keep": ["positions", "contacts", "forces"]}, structure={})
del GRAINS["relax"]


def deepest_overlap(centres, width, gap):
    """The deepest overlap of unit spheres with each other, the floor and the plates, by all pairs."""
    apart = centres[:, None] - centres[None]
    apart[..., 0] -= width * np.round(apart[..., 0] / width)
    distances = np.linalg.norm(apart, axis=-1)[np.triu_indices(len(centres), 1)]
    return max(1 - distances.min(), 0.5 - centres[:, 2].min(), 0.5 - centres[:, 1].min(),
               centres[:, 1].max() - (gap - 0.5))


def frames_of(text):
    """Comment line and centres of each frame of extended XYZ."""
    lines = text.splitlines()
    while lines:
        n = int(lines[0])
        yield lines[1], np.array([[float(x) for x in line.split()[1:4]] for line in lines[2:2 + n]])
        del lines[:2 + n]


class Plates(Case):
    def run_plates(self, scene=None, name="plates.h5", *arguments):
        self.write(scene or SCENE, f"{name}.json")
        self.run_scene("-o", name, *arguments, scene=f"{name}.json")
        return self.digest(name)

    def centres(self, name="plates.h5", tap="all"):
        text = f"{name}.xyz"
        self.jostle("export", name, "--format", "extxyz", "--tap", tap, "-o", text, "--force")
        return list(frames_of((self.folder / text).read_text()))

    def test_no_spheres_overlap_whatever_moves_and_starts_them(self):
        polar = SCENE["relax"]
        metropolis = {"metropolis": {}, "stop": {"sweeps": 60}}
        for start in ({"pour": "steepest_descent"}, {"pour": "fitted"}, {"random_settle": {}},
                      {"crystal": {"lattice": "fcc"}}):
            for relax in (polar, changed(polar, sampler="exhaustive"), metropolis):
                with self.subTest(start=start, relax=relax):
                    self.run_plates(changed(SCENE, start=start, relax=relax, structure={}), "one.h5", "--force")
                    for comment, centres in self.centres("one.h5"):
                        self.assertIn('pbc="T F F"', comment)
                        self.assertEqual(len(centres), SCENE["spheres"])
                        self.assertLess(deepest_overlap(centres, 6, 4), 1e-12)
                        self.assertTrue((centres[:, 0] >= 0).all() and (centres[:, 0] < 6).all())

    def test_grains_lean_on_plates_alone(self):
        self.run_plates(GRAINS, "grains.h5")
        for _, centres in self.centres("grains.h5"):
            self.assertLess(deepest_overlap(centres, 6, 4), 0.01)
        with h5py.File(self.folder / "grains.h5") as file:
            found = []
            file.visititems(lambda path, node: found.append(node.attrs["walls"]) if "walls" in node.attrs else None)
            self.assertGreater(len(found), 0)
            for walls in found:
                self.assertEqual([str(wall) for wall in np.array(walls).astype(str)], ["floor", "y_min", "y_max"])

    def test_the_same_bytes_however_it_is_run(self):
        straight = self.run_plates(SCENE, "one.h5", "--threads", "1")
        self.assertEqual(self.run_plates(SCENE, "two.h5", "--threads", "2"), straight)
        shorter = changed(SCENE, protocol=[{"tap": {"dilate": 0.1}, "count": 2}], snapshots={"taps": [0]})
        longer = changed(SCENE, snapshots={"taps": [0]})
        straight = self.run_plates(longer, "longer.h5")
        self.run_plates(shorter, "resumed.h5")
        self.assertEqual(self.run_plates(longer, "resumed.h5", "--resume"), straight)

    def test_exports_say_which_sides_are_periodic(self):
        self.run_plates()
        comment, centres = self.centres()[-1]
        self.assertIn('container=plates', comment)
        for form in ("lammps", "vtp", "h5md", "results"):
            self.jostle("export", "plates.h5", "--format", form, "-o", f"out.{form}")
        dump = (self.folder / "out.lammps").read_text()
        self.assertIn("ITEM: BOX BOUNDS pp ff ff", dump)
        rows = [line.split() for line in dump.split("ITEM: ATOMS ")[1].splitlines()]
        x, y = rows[0].index("x"), rows[0].index("y")
        got = np.array([[float(row[x]), float(row[y])] for row in rows[1:]])
        np.testing.assert_allclose(got, centres[:, :2], rtol=1e-12)
        with h5py.File(self.folder / "out.h5md") as file:
            box = file["particles"][list(file["particles"])[0]]["box"]
            self.assertEqual([str(side) for side in np.array(box.attrs["boundary"]).astype(str)],
                             ["periodic", "none", "none"])
        self.assertEqual(self.digest("out.results"), self.digest("plates.h5"))

    def test_a_scene_starts_from_its_export_whether_or_not_the_container_is_named(self):
        self.run_plates()
        self.centres(tap="3")
        text = (self.folder / "plates.h5.xyz").read_text()
        (self.folder / "unnamed.xyz").write_text(text.replace("container=plates ", ""))
        again = changed(SCENE, realizations=1, protocol=[{"tap": {"dilate": 0.05}, "count": 1}], structure={},
                        snapshots={"taps": [1]})
        ends = []
        for name in ("plates.h5.xyz", "unnamed.xyz"):
            self.run_plates(changed(again, start={"file": {"path": name}}), "from.h5", "--force")
            ends.append(self.centres("from.h5", "1")[0][1])
        np.testing.assert_array_equal(*ends)
        (self.folder / "other.xyz").write_text(text.replace("container=plates", "container=walls"))
        self.assertIn("contradicts container=walls",
                      self.jostle("structure", "other.xyz", "--part", "profile", expect=BROKEN).stderr)

    def test_structure_counts_what_is_between_the_plates(self):
        self.run_plates()
        with h5py.File(self.folder / "plates.h5") as file:
            point = file["structure/point_0000"]
            solids = point["profile/phi"][:].sum(axis=1) * 0.1 * 6 * 4
            np.testing.assert_allclose(solids, SCENE["spheres"] * np.pi / 6, rtol=1e-12)
            sides = point["sides"]
            # The distance to the nearest plate is y from either side; x has no wall.
            phi_y = sides["phi_y"][:]
            np.testing.assert_allclose(sides["phi_wall"][:], (0.5 * (phi_y + phi_y[:, ::-1]))[:, :20], rtol=1e-9)
            self.assertNotIn("phi_radial", sides)
            self.assertTrue((sides["lateral"][:] > 0).all())
            self.assertEqual(set(point), set(SCENE["structure"]) - {"region"})
        refused = self.jostle("structure", "plates.h5", "--part", "structure_factor", expect=None)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("this container has walls", refused.stderr)

    def test_the_page_draws_the_cell(self):
        self.run_plates()
        self.jostle("report", "plates.h5", "-o", "page.html")
        page = (self.folder / "page.html").read_text()
        self.assertIn("two plates, 6 x 4 diameters", page)
        self.assertRegex(page, r'"kind":"plates","width_x":6(\.0)?,"width_y":4')

    def test_what_plates_cannot_be_is_refused_by_name(self):
        for container, says in (
                ({"sides": "plates", "width": 6}, "/container/gap"),
                ({"sides": "plates", "width": 2, "gap": 4}, "periodic width is 2"),
                ({"sides": "plates", "width": 6, "gap": 0.9}, "width between walls is 0.9"),
                ({"sides": "plates", "width": [6, 4], "gap": 4}, "/container/width"),
                ({"sides": "walls", "width": 6, "gap": 4}, "/container/gap"),
                ({"sides": "plate", "width": 6, "gap": 4}, 'Did you mean "plates"?')):
            with self.subTest(container=container):
                self.write(changed(SCENE, container=container))
                told = self.jostle("check", "scene.json", "--no-pilot", expect=BAD_INPUT)
                self.assertIn(says, told.stderr + told.stdout)
        self.write(changed(SCENE, container={"sides": "plates", "width": 6, "gap": 1.5}, start={"pour": "fitted"}))
        self.assertIn("periodic width is 1.5",
                      self.jostle("check", "scene.json", "--no-pilot", expect=BAD_INPUT).stderr)


if __name__ == "__main__":
    unittest.main()
