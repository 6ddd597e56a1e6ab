"""Spheres of several sizes: scenes, files, stops, shards and what is refused by name."""

import base64
import json
import random
import re
import unittest

import h5py
import numpy as np

from crafted_files import SEAL, sealed
from support import BAD_INPUT, BROKEN, SOURCE, Case, changed

WIDTH = 6.0
KINDS = [{"name": "small", "count": 60}, {"name": "large", "count": 12, "diameter": 1.5},
         {"name": "intruder", "count": 1, "diameter": 2.5, "density": 2}]
SCENE = {
    "name": "mixture", "seed": 4, "realizations": 3, "container": {"sides": "periodic", "width": WIDTH},
    "spheres": KINDS, "start": {"file": "start.xyz"}, "protocol": [{"tap": {"dilate": 0.1}, "count": 6}],
    "relax": {"polar": {}, "stop": {"mean_height": {"eta": 1e-3, "every_sweeps": 20}}},
    "observe": ["mean_height", "bulk_fraction", {"kind_height": {"kind": "intruder"}}, "segregation",
                {"lacey_index": {"cell": 2, "kind": "large"}}],
    "snapshots": {"taps": [0, 3, 6]},
}

SHORTER = {"protocol": [{"tap": {"dilate": 0.1}, "count": 3}], "snapshots": {"taps": [0, 3]}}
# Soft springs, and a rest that ends after a while: short taps.
ENGINE = {"discrete_element": {"contact": {"walton_braun": {"stiffness": 5e3, "friction": 0.3}},
                               "rest": {"timed": {"seconds": 0.3}}}}


def grains(**changes):
    keep = ["positions", "velocities", "contacts", "forces"]
    scene = changed(SCENE, engine=ENGINE, realizations=2, snapshots={"taps": [0, 2], "keep": keep},
                    protocol=[{"tap": {"lift": 0.5}, "count": 2}])
    del scene["relax"]
    return changed(scene, **changes)


def scattered(unit=1):
    """Spheres of the kinds above, none of which overlap, as extended XYZ; all lengths times `unit`."""
    numbers = random.Random(5)
    spheres = [(kind["name"], kind.get("diameter", 1)) for kind in KINDS for _ in range(kind["count"])]
    placed = {}
    for i in sorted(range(len(spheres)), key=lambda i: -spheres[i][1]):
        d = spheres[i][1]
        while i not in placed:
            r = np.array([numbers.uniform(0, WIDTH), numbers.uniform(0, WIDTH), numbers.uniform(d / 2, 13)])
            ways = [r - other for other in placed.values()]
            for way in ways:
                way[:2] -= WIDTH * np.round(way[:2] / WIDTH)
            reach = [1e-9 + (d + spheres[j][1]) / 2 for j in placed]
            if all(np.linalg.norm(way) > least for way, least in zip(ways, reach)):
                placed[i] = r
    side = unit * WIDTH
    lines = [str(len(spheres)), f'Lattice="{side} 0 0 0 {side} 0 0 0 {unit * 16}" Properties=species:S:1:pos:R:3:'
             "diameter:R:1 container=periodic"]
    return "\n".join(lines + [" ".join([name, *(str(unit * x) for x in placed[i]), str(unit * d)])
                              for i, (name, d) in enumerate(spheres)]) + "\n"


class Mixtures(Case):
    def setUp(self):
        super().setUp()
        self.write(scattered(), "start.xyz")
        self.write(SCENE)

    def same_digests(self, scene, shorter):
        """A run on one thread, on two, in shards and resumed with more taps than `shorter` has."""
        self.write(scene)
        self.run_scene("-o", "one.h5", "--threads", "1")
        expected = self.digest("one.h5")
        self.run_scene("-o", "two.h5", "--threads", "2")
        self.assertEqual(self.digest("two.h5"), expected)
        for share in (1, 2):
            self.run_scene("-o", f"share{share}.h5", "--shard", f"{share}/2")
        self.jostle("merge", "share1.h5", "share2.h5", "-o", "merged.h5")
        self.assertEqual(self.digest("merged.h5"), expected)
        self.write(changed(scene, **shorter))
        self.run_scene("-o", "resumed.h5")
        self.write(scene)
        self.run_scene("-o", "resumed.h5", "--resume")
        self.assertEqual(self.digest("resumed.h5"), expected)

    def test_threads_shards_and_resumes_give_the_same_digest(self):
        self.same_digests(SCENE, SHORTER)

    def test_all_lengths_doubled_give_doubled_centres_to_the_bit(self):
        """Lengths of file, container, moves and lifts; m g dz is 16 times as much, so that beta is a sixteenth."""
        self.write(scattered(2), "doubled.xyz")
        for move, doubled_move in (
                ({"polar": {"max_step": 0.1}}, {"polar": {"max_step": 0.2}}),
                ({"metropolis": {"max_step": 0.1, "beta": 16}}, {"metropolis": {"max_step": 0.2, "beta": 1}})):
            kept = []
            for unit, relax, file in ((1, move, "start.xyz"), (2, doubled_move, "doubled.xyz")):
                kinds = [{**kind, "diameter": unit * kind.get("diameter", 1)} for kind in KINDS]
                self.write(changed(SCENE, spheres=kinds, container={"sides": "periodic", "width": unit * WIDTH},
                                   start={"file": file}, relax={**relax, "stop": SCENE["relax"]["stop"]},
                                   protocol=[{"tap": {"dilate": 0.1}, "count": 4},
                                             {"tap": {"lift": unit * 0.5}, "count": 1}],
                                   observe=["mean_height"], snapshots={"taps": [0, 3, 5]}, realizations=1))
                self.run_scene("-o", "a.h5", "--force")
                with h5py.File(self.folder / "a.h5") as results:
                    kept.append(results["particles/point_0000_realization_00000/position/value"][()])
            np.testing.assert_array_equal(2 * kept[0], kept[1])
            self.assertFalse(np.array_equal(kept[0][0], kept[0][2]))

    def test_kinds_of_diameter_1_give_what_equal_spheres_give(self):
        """Centres to the bit, observables and snapshots to 1e-12: moves, samplers, contact laws, containers."""
        kinds = [{"name": "a", "count": 25}, {"name": "b", "count": 20, "diameter": {"list": [1] * 20}}]
        stop = {"stop": {"sweeps": 150}}
        dashpots = {"linear_spring_dashpot": {"stiffness": 5e3, "friction": 0.3}}
        rest = ENGINE["discrete_element"]["rest"]
        for sides, engine in (({"sides": "periodic", "width": 3.5}, {"relax": {"polar": {}, **stop}}),
                              ({"sides": "walls", "width": 3.5}, {"relax": {"metropolis": {"beta": 9}, **stop}}),
                              ({"sides": "cylinder", "diameter": 4}, {"relax": {
                                  "polar": {}, "sampler": "skipping", "stop": {"sweeps": 2000}}}),
                              ({"sides": "plates", "width": 3.5, "gap": 3}, {"engine": ENGINE}),
                              ({"sides": "periodic", "width": 3.5}, {"engine": {"discrete_element": {
                                  "contact": dashpots, "rest": rest}}})):
            files = []
            for spheres in (45, kinds):
                scene = changed(SCENE, container=sides, start={"pour": "steepest_descent"}, realizations=1, **engine,
                                protocol=[{"tap": {"dilate": 0.1}, "count": 1}, {"tap": {"lift": 0.3}, "count": 1}],
                                snapshots={"taps": [0, 2]},
                                observe=["mean_height", "bulk_fraction", "bottom_fraction"])
                scene = {**scene, "spheres": spheres, **({"pour_order": "as_listed"} if spheres == kinds else {})}
                if "engine" in engine:
                    del scene["relax"]
                self.write(scene)
                self.run_scene("-o", f"{len(files)}.h5", "--force")
                files.append(h5py.File(self.folder / f"{len(files)}.h5"))
            self.same_numbers(*files)

    def same_numbers(self, equal, sized):
        compared = []

        def compare(name, node):
            if not isinstance(node, h5py.Dataset) or node.dtype.kind not in "fiu":
                return
            if name.startswith(("observables", "snapshots", "particles", "ensemble")):
                compared.append(name)
                exact = name.startswith("particles")
                np.testing.assert_allclose(sized[name][()], node[()], rtol=0 if exact else 1e-12,
                                           atol=0 if exact else 1e-12, err_msg=name)

        equal.visititems(compare)
        for file in (equal, sized):
            file.close()
        for name in ("observables/point_0000/bulk_fraction", "snapshots/point_0000/coordination"):
            self.assertIn(name, compared)
        self.assertTrue(any(name.endswith("position/value") for name in compared))

    def test_grains_of_several_sizes_give_the_same_digest_however_they_are_run(self):
        keep = grains()["snapshots"]["keep"]
        shorter = {"protocol": [{"tap": {"lift": 0.5}, "count": 1}], "snapshots": {"taps": [0], "keep": keep}}
        self.same_digests(grains(), shorter)
        expected = self.digest("one.h5")
        self.run_scene("-o", "baseline.h5", environment={"JOSTLE_INSTRUCTION_SET": "baseline"})
        self.assertEqual(self.digest("baseline.h5"), expected)

    def test_contacts_of_grains_are_those_of_their_radii(self):
        self.write(grains())
        self.run_scene("-o", "a.h5")
        with h5py.File(self.folder / "a.h5") as file:
            radius = file["spheres/point_0000/diameter"][()] / 2
            density = file["spheres/point_0000/density"][()][file["spheres/point_0000/kind"][()]]
            weight = (density * (2 * radius) ** 3).sum()
            columns = file["observables/point_0000"]
            self.assertTrue((np.abs(columns["ledger_error"][1:]) < 0.02).all())
            for realization in range(2):
                group = file[f"particles/point_0000_realization_{realization:05}"]
                r, kept = group["position/value"][-1], group["contacts"]
                last = slice(int(kept["offset"][-1]), None)
                first, second = (kept[name][last].astype(int) for name in ("first", "second"))
                walls = second >= len(r)
                way = r[first] - np.where(walls[:, None], r[first] * [1, 1, 0], r[np.minimum(second, len(r) - 1)])
                way[:, :2] -= WIDTH * np.round(way[:, :2] / WIDTH)
                reach = radius[first] + np.where(walls, 0, radius[np.minimum(second, len(r) - 1)])
                np.testing.assert_allclose(kept["overlap"][last], reach - np.linalg.norm(way, axis=1), atol=1e-12)
                self.assertGreater(walls.sum(), 3)
                on_floor = file["snapshots/point_0000/wall_normal_force"][-1, realization, 0]
                self.assertAlmostEqual(on_floor / weight, 1, delta=0.3)
                self.assertAlmostEqual(on_floor, kept["normal_force"][last][walls].sum(), delta=1e-9 * weight)

    def test_grains_are_tapped_from_a_pour_by_a_floor_that_moves(self):
        kinds = [{**KINDS[0], "diameter": {"lognormal": {"mean": 1, "deviation": 0.1}}}, *KINDS[1:]]
        self.write(grains(spheres=kinds, start={"pour": "steepest_descent"},
                          protocol=[{"tap": {"half_sine": {"amplitude": 0.4, "frequency": 7.5}}, "count": 2}]))
        told = self.jostle("check", "scene.json", "--no-pilot").stdout
        self.assertIn("time step", told)
        self.run_scene("-o", "a.h5")
        with h5py.File(self.folder / "a.h5") as file:
            self.assertEqual(np.unique(file["spheres/point_0000/diameter"][:, :60]).size, 120)
            columns = file["observables/point_0000"]
            self.assertTrue((columns["input_energy"][1:] > 0.1).all())
            self.assertTrue((np.abs(columns["ledger_error"][1:]) < 0.02).all())
            self.assertTrue((columns["greatest_overlap"][:] < 0.2).all())

    def test_a_floor_that_the_time_step_of_heavy_spheres_does_not_resolve_is_refused(self):
        tap = [{"tap": {"half_sine": {"amplitude": 0.001, "frequency": 400}}, "count": 2}]
        for diameter, code in ((1, 0), (6, BAD_INPUT)):
            self.write(grains(spheres=[{"name": "only", "count": 9, "diameter": diameter}], observe=["mean_height"],
                              container={"sides": "periodic", "width": 20}, start={"random_settle": {}}, protocol=tap))
            done = self.jostle("check", "scene.json", "--no-pilot", expect=code)
            if code:
                self.assertIn("half a period of the floor takes", done.stderr)

    def test_the_commands_that_a_run_names_next_take_mixtures(self):
        told = self.run_scene("-o", "a.h5").stdout.split("\nnext:\n")[1]
        commands = [line.split()[1:] for line in told.splitlines()]
        self.assertEqual(commands[0][0], "export")
        for words in commands:
            self.jostle(*words)

    def test_labels_name_what_is_stored(self):
        self.run_scene("-o", "a.h5")
        with h5py.File(self.folder / "a.h5") as file:
            height = file["observables/point_0000/mean_height"]
            z = file["particles/point_0000_realization_00000/position/value"][0, :, 2]
            weights = np.array(sum(([kind.get("diameter", 1) ** 3] * kind["count"] for kind in KINDS), []))
            self.assertAlmostEqual(height[0, 0], np.average(z, weights=weights), places=9)
            self.assertIn("weighted by the volumes of the spheres", height.attrs["long_name"])
            mean = file["ensemble/point_0000/mean_height_mean"].attrs["long_name"]
            self.assertIn("weighted by the volumes of the spheres", mean)
            coordination = file["snapshots/point_0000/coordination"].attrs["long_name"]
            self.assertIn("contact_cut times the sum of the two radii", coordination)
            lacey = file["observables/point_0000/lacey_index_large"].attrs["long_name"]
            self.assertIn("of kind large on cells of 2 d", lacey)

    def test_drawn_diameters_are_those_of_their_realizations(self):
        shipped = json.loads((SOURCE / "config/scenes/binary.json").read_text())
        small, large, intruder = shipped["spheres"]
        scene = {**shipped, "name": "mixture", "realizations": 3, "container": {"sides": "periodic", "width": WIDTH},
                 "spheres": [{**small, "count": 60}, {**large, "count": 12}, {**intruder, "place": [3, 3]}],
                 "protocol": [{"tap": {"dilate": 0.1}, "count": 6}], "snapshots": {"taps": [0, 3, 6]}}
        scene.pop("$schema")
        self.same_digests(scene, SHORTER)
        with h5py.File(self.folder / "one.h5") as file:
            diameters = file["spheres/point_0000/diameter"][()]
            self.assertEqual(diameters.shape, (3, 73))
            self.assertEqual(len(np.unique(diameters[:, :60])), 180)
            self.assertTrue((diameters[:, 60:72] == 1.5).all() and (diameters[:, 72] == 2.5).all())
            particles = file["particles/point_0000_realization_00002"]
            positions = particles["position/value"][()]
            np.testing.assert_allclose(positions[0, 72], [3, 3, 1.25], atol=1e-12)
            self.assertEqual(particles["box/edges"][2], (positions[:, :, 2] + diameters[2] / 2).max())

    def test_heights_of_kinds_are_those_of_the_kept_packings(self):
        self.run_scene("-o", "a.h5")
        with h5py.File(self.folder / "a.h5") as file:
            self.assertEqual(file.attrs["jostle_format"], 2)
            spheres = file["spheres/point_0000"]
            self.assertEqual(spheres["name"].asstr()[()].tolist(), [kind["name"] for kind in KINDS])
            self.assertEqual(spheres["density"][()].tolist(), [1, 1, 2])
            kind, volume = spheres["kind"][()], spheres["diameter"][()] ** 3
            particles = file["particles/point_0000_realization_00001"]
            positions = particles["position/value"][()]
            self.assertEqual(particles["box/edges"][2], (positions[:, :, 2] + spheres["diameter"][()] / 2).max())
            series = file["observables/point_0000"]
            for frame, tap in enumerate((0, 3, 6)):
                z = positions[frame][:, 2]
                mean = np.average(z, weights=volume)
                heights = [z[kind == k].mean() for k in range(3)]
                self.assertAlmostEqual(series["mean_height"][tap, 1], mean, delta=1e-12)
                self.assertAlmostEqual(series["height_intruder"][tap, 1], heights[2], delta=1e-12)
                self.assertAlmostEqual(series["segregation"][tap, 1], (heights[2] - heights[0]) / mean, delta=1e-12)
                x = np.floor(positions[frame] / [2, 2, 2 * 1e9]).astype(int)
                self.assertTrue((x[:, :2] < 3).all())

    def test_motion_of_kinds_is_that_of_the_kept_packings(self):
        followed = changed(SCENE, motion={"origins": [0, 3], "lags": [3], "layers": 2})
        self.same_digests(followed, SHORTER)
        with h5py.File(self.folder / "one.h5") as file:
            self.assertEqual(file["sweep/point_0000"].attrs["motion_kinds"], 3)
            group, kind = file["motion/point_0000"], file["spheres/point_0000/kind"][()]
            self.assertEqual(group["kind"].asstr()[()].tolist(), [kind["name"] for kind in KINDS])
            tables = file["analysis/point_0000/motion/kinds"]
            self.assertEqual(tables["rise"].shape, (2, 1, 3))
            rises = np.zeros((2, 3))
            for realization in range(3):
                kept = file[f"particles/point_0000_realization_{realization:05}/position/value"][()]
                for origin in range(2):
                    moved = kept[origin + 1] - kept[origin]
                    for k in range(3):
                        height = moved[kind == k, 2].mean()
                        self.assertAlmostEqual(group["kind_mean_displacement"][origin, 0, k, 2, realization],
                                               height, delta=1e-12)
                        self.assertAlmostEqual(group["kind_square_displacement"][origin, 0, k, 2, realization],
                                               (moved[kind == k, 2]**2).mean(), delta=1e-12)
                        rises[origin, k] += (height - moved[:, 2].mean()) / 3
            np.testing.assert_allclose(tables["rise"][:, 0], rises, atol=1e-12)
        self.jostle("report", "one.h5", "--catalogue", "figures.json")
        figures = json.loads((self.folder / "figures.json").read_text())
        self.assertIn("Rise of the kinds in the bed", json.dumps(figures))
        point = json.loads(self.jostle("analyse", "one.h5", "motion", "--json").stdout)
        self.assertIn("point_0000/motion/kinds", [table["name"] for table in point["tables"]])
        forged = self.folder / "forged.h5"
        forged.write_bytes((self.folder / "one.h5").read_bytes()[:-SEAL])
        with h5py.File(forged, "r+") as file:
            file["sweep/point_0000"].attrs.modify("motion_kinds", np.uint32(2))
        forged.write_bytes(sealed(forged.read_bytes()))
        refused = self.jostle("analyse", "forged.h5", "motion", expect=BROKEN)
        self.assertIn("follows the motion of other kinds than it has", refused.stderr)

    def test_motion_of_one_kind_is_not_followed_by_kind(self):
        one = [{"name": "all", "count": 73, "diameter": {"lognormal": {"mean": 1, "deviation": 0.05}}}]
        self.write(changed(SCENE, spheres=one, start={"pour": "steepest_descent"}, observe=["mean_height"],
                           motion={"origins": [0], "lags": [3]}, realizations=1))
        self.run_scene("-o", "a.h5")
        with h5py.File(self.folder / "a.h5") as file:
            self.assertNotIn("motion_kinds", file["sweep/point_0000"].attrs)
            self.assertNotIn("kind", file["motion/point_0000"])

    def test_densities_matter_in_monte_carlo_only_at_a_finite_temperature(self):
        for move, differs in ({"polar": {}}, False), ({"metropolis": {"max_step": 0.1, "beta": 20}}, True):
            ends = []
            for density in (0.1, 10):
                self.write(changed(SCENE, realizations=1, relax={**move, "stop": SCENE["relax"]["stop"]},
                                   spheres=[*KINDS[:2], {**KINDS[2], "density": density}]))
                self.run_scene("-o", "a.h5", "--force")
                with h5py.File(self.folder / "a.h5") as file:
                    ends.append(file["particles/point_0000_realization_00000/position/value"][-1])
            self.assertNotEqual(np.array_equal(*ends), differs)

    def test_no_tap_makes_an_overlap(self):
        self.run_scene("-o", "a.h5")
        with h5py.File(self.folder / "a.h5") as file:
            radius = file["spheres/point_0000/diameter"][()] / 2
            for realization in range(3):
                for r in file[f"particles/point_0000_realization_{realization:05}/position/value"][()]:
                    way = r[:, None] - r[None]
                    way[..., :2] -= WIDTH * np.round(way[..., :2] / WIDTH)
                    gap = np.linalg.norm(way, axis=-1) - radius[:, None] - radius[None]
                    self.assertGreater(gap[~np.eye(len(r), dtype=bool)].min(), -1e-12)
                    self.assertGreaterEqual((r[:, 2] - radius).min(), -1e-12)

    def test_exports_read_back_as_starts_and_structure_is_refused_by_name(self):
        self.run_scene("-o", "a.h5")
        self.jostle("export", "a.h5", "--format", "extxyz", "-o", "end.xyz")
        for file in ("end.xyz", {"path": "a.h5", "realization": 0, "tap": 6}):
            for spheres in (KINDS, 73):
                self.write(changed(SCENE, start={"file": file}, spheres=spheres, realizations=1))
                self.run_scene("-o", "b.h5", "--force")
                with h5py.File(self.folder / "a.h5") as first, h5py.File(self.folder / "b.h5") as second:
                    name = "particles/point_0000_realization_00000/position/value"
                    np.testing.assert_array_equal(first[name][2], second[name][0])
                    for part in ("name", "density", "kind", "diameter"):
                        np.testing.assert_array_equal(first[f"spheres/point_0000/{part}"][()],
                                                      second[f"spheres/point_0000/{part}"][()])
        for command in (("structure", "a.h5"), ("structure", "end.xyz")):
            refused = self.jostle(*command, expect=None)
            self.assertIn("measures of layers require equal spheres", refused.stdout + refused.stderr)

    def test_volumes_are_refused_by_name(self):
        self.write(changed(SCENE, protocol=[{"tap": {"dilate": 0.01 * k}, "count": 40} for k in (1, 2, 3)]))
        self.run_scene("-o", "a.h5")
        refused = self.jostle("analyse", "a.h5", "volumes", "--observable", "bulk_fraction", expect=None)
        self.assertIn("volumes per sphere are defined for equal spheres", refused.stdout + refused.stderr)

    def test_pages_draw_every_sphere_with_its_size(self):
        self.run_scene("-o", "a.h5")
        self.jostle("report", "a.h5", "-o", "a.html")
        page = (self.folder / "a.html").read_text()
        self.assertNotIn("are not drawn", page)
        data = json.loads(re.search(r'id="report-data"[^>]*>(.*?)</script>', page, re.S)[1])
        packing = data["files"][0]["packings"][0]
        radii = np.frombuffer(base64.b64decode(packing["radius"]), "<u2") / 65535 * packing["greatest_radius"]
        expected = sum(([kind.get("diameter", 1) / 2] * kind["count"] for kind in KINDS), [])
        np.testing.assert_allclose(radii, expected, atol=1e-4)
        self.assertEqual(packing["kinds"], [kind["name"] for kind in KINDS])

    def test_what_a_file_of_sizes_does_not_go_with_is_refused_when_the_scene_is_read(self):
        for changes, says in (({"observe": ["corrected_fraction"]}, "/observe/0: corrected_fraction"),
                              ({"container": {"sides": "periodic", "width": 5}}, "must exceed 5"),
                              ({"observe": [{"kind_height": {"kind": "larg"}}]}, 'named "larg"')):
            for spheres in (KINDS, 73):
                self.write(changed(SCENE, spheres=spheres, **changes))
                refused = self.jostle("check", "scene.json", "--no-pilot", expect=BAD_INPUT)
                self.assertIn(says, refused.stderr, json.dumps(changes))


if __name__ == "__main__":
    unittest.main()
