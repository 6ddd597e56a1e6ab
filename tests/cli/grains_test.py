"""Discrete elements through the program: the same bytes however they are run, and what they refuse."""

import json
import signal
import time
import unittest

import h5py
import numpy as np

from support import BAD_INPUT, BROKEN, EVERY, FAILED, PORTABLE, STOPPED, UNFOLDED, Case, changed

N = 48
GRAINS = {
    "name": "grains",
    "seed": 2010,
    "realizations": 3,
    "container": {"sides": "periodic", "width": 4},
    "spheres": N,
    "start": {"random_settle": {"dilute_fraction": 0.2}},
    # Ten times softer than the default, and a third of its steps.
    "engine": {"discrete_element": {"contact": {"walton_braun": {"stiffness": 1e4}}}},
    "protocol": [{"tap": {"half_sine": {"amplitude": 0.4413, "frequency": 7.5}}, "count": 2},
                 {"tap": {"lift": 0.1}, "count": 1}],
    "observe": ["mean_height", "bulk_fraction"],
    "snapshots": {"taps": [0, 3]},
}


class Grains(Case):
    def setUp(self):
        super().setUp()
        self.write(GRAINS)

    def test_every_way_to_run_gives_the_same_bytes(self):
        self.run_scene("-o", "one.h5", "--threads", "1")
        straight = self.digest("one.h5")
        for name in ("avx2", "baseline") if EVERY and not PORTABLE else ("baseline",):
            environment = {"JOSTLE_INSTRUCTION_SET": name}
            with self.subTest(instructions=name):
                self.jostle("run", "scene.json", "-o", f"{name}.h5", "--quiet",
                            environment=environment)
                self.assertEqual(self.digest(f"{name}.h5"), straight)
        for threads in ("2", "3", "7") if EVERY else ("3",):
            with self.subTest(threads=threads):
                self.run_scene("-o", f"{threads}.h5", "--threads", threads)
                self.assertEqual(self.digest(f"{threads}.h5"), straight)
        for shard in ("1/2", "2/2"):
            self.jostle("run", "scene.json", "--shard", shard, "-o", f"{shard[0]}of2.h5", "--quiet")
        self.jostle("merge", "1of2.h5", "2of2.h5", "-o", "both.h5")
        self.assertEqual(self.digest("both.h5"), straight)
        # Stopped and killed in the midst of taps.
        arguments = ("run", "scene.json", "-o", "cut.h5", "--quiet", "--checkpoint-every", "0")
        for stop in (signal.SIGTERM, signal.SIGKILL, signal.SIGKILL):
            more = ("--resume",) if (self.folder / "cut.h5").exists() else ()
            process = self.popen(*arguments, *more)
            time.sleep(0.4)
            process.send_signal(stop)
            process.communicate(timeout=60)
            self.assertIn(process.returncode, (0, STOPPED, -signal.SIGKILL))
        self.jostle(*arguments, "--resume")
        self.assertEqual(self.digest("cut.h5"), straight)

    def test_what_is_stored_and_shown(self):
        shown = self.run_scene("--wide").stdout
        for text in ("sphere steps", "kinetic_energy", "contacts", "seconds"):
            self.assertIn(text, shown)
        for text in ("trials", "sweeps", "ledger_error"):
            self.assertNotIn(text, shown)
        with h5py.File(self.folder / "grains.h5") as file:
            point = file["observables/point_0000"]
            self.assertLess(abs(point["ledger_error"][1:, :]).max(), 1e-2)
            self.assertEqual(point["kinetic_energy"].attrs["units"], "m g d per sphere")
            self.assertTrue((point["contacts"][:] > 3).all())
            self.assertTrue((point["input_energy"][1:, :] > 0).all())
        info = json.loads(self.jostle("info", "grains.h5", "--json").stdout)
        self.assertGreater(info["realizations"][0]["sphere_steps"], 1e6)

    def test_snapshots_keep_what_moves_and_acts(self):
        self.write(changed(GRAINS, container={"sides": "walls", "width": 4}))
        shown = self.run_scene().stdout + self.jostle("info", "grains.h5").stdout
        self.assertIn("velocities; contacts; granular_temperature; forces", shown)
        with h5py.File(self.folder / "grains.h5") as file:
            group = file["particles/point_0000_realization_00001"]
            self.assertEqual(group["velocity/value"].shape, (2, N, 3))
            self.assertEqual(group["velocity/value"].attrs["units"], "diameter / s")
            self.assertEqual(group["spin/step"][:].tolist(), [0, 3])
            contacts = group["contacts"]
            for name, axes in (("normal_force", ["contact"]), ("normal", ["contact", "direction"]),
                               ("offset", ["step"])):
                with self.subTest(axes_of=name):
                    named = [axis[0].name.split("/")[-1] for axis in contacts[name].dims]
                    self.assertEqual(named, axes)
            walls = contacts["second"].attrs["walls"].tolist()
            self.assertEqual(walls, ["floor", "x_min", "x_max", "y_min", "y_max"])
            point = file["snapshots/point_0000"]
            self.assertEqual([wall.decode() for wall in point["wall"][:]], walls)
            for frame in (0, 1):
                with self.subTest(frame=frame):
                    self.check_frame(group, point, frame)
                    self.check_sliding(group, file["observables/point_0000/sliding"], frame)
            vertical = point["granular_temperature_vertical"]
            self.assertEqual([axis[0].name.split("/")[-1] for axis in vertical.dims],
                             ["tap", "realization", "height"])
            self.assertTrue((vertical[:][np.isfinite(vertical[:])] >= 0).all())
            self.assertEqual(point["height_histogram"].shape, vertical.shape)

    def test_snapshots_keep_the_driven_bed_on_request(self):
        self.write(changed(GRAINS, realizations=2, snapshots={
            "taps": [0, 2, 3], "keep": ["positions", "driven_temperature"], "bin_width": 0.5}))
        self.run_scene("-o", "straight.h5")
        with h5py.File(self.folder / "straight.h5") as file:
            point = file["snapshots/point_0000"]
            for name in ("driven_temperature_lateral", "driven_temperature_vertical",
                         "driven_height_histogram"):
                with self.subTest(name=name):
                    self.assertEqual([axis[0].name.split("/")[-1] for axis in point[name].dims],
                                     ["tap", "realization", "height"])
                    values = point[name][:]
                    # Neither the start nor a lift moves the floor.
                    self.assertTrue(np.isnan(values[[0, 2]]).all())
                    self.assertTrue((values[1][np.isfinite(values[1])] >= 0).all())
            share = point["driven_height_histogram"][1]
            np.testing.assert_allclose(np.nansum(share, axis=1), 1, rtol=1e-12)
            lateral, vertical = (point[f"driven_temperature_{way}"][1, 0, :4]
                                 for way in ("lateral", "vertical"))
            self.assertTrue((lateral[1:] > 0).all() and (vertical[1:] > 0).all())
        arguments = ("run", "scene.json", "-o", "cut.h5", "--quiet", "--checkpoint-every", "0")
        for _ in range(2):
            more = ("--resume",) if (self.folder / "cut.h5").exists() else ()
            process = self.popen(*arguments, *more)
            time.sleep(0.4)
            process.kill()
            process.communicate(timeout=60)
        self.jostle(*arguments, "--resume")
        self.assertEqual(self.digest("cut.h5"), self.digest("straight.h5"))

    def check_sliding(self, group, sliding, frame):
        """The share of the stored contacts of two spheres at mu N; friction is 0.1 by default."""
        contacts = group["contacts"]
        bounds = np.append(contacts["offset"], len(contacts["first"])).astype(int)
        here = slice(bounds[frame], bounds[frame + 1])
        tangential = np.linalg.norm(contacts["tangential_force"][here], axis=1)
        at_limit = tangential >= (1 - 1e-9) * 0.1 * abs(contacts["normal_force"][here])
        share = at_limit[contacts["second"][here] < N].mean()
        self.assertTrue(0 < share < 1)
        self.assertAlmostEqual(sliding[group["position/step"][frame], 1], share, places=12)

    def check_frame(self, group, point, frame):
        contacts = group["contacts"]
        bounds = np.append(contacts["offset"], len(contacts["first"])).astype(int)
        here = slice(bounds[frame], bounds[frame + 1])
        first, second = contacts["first"][here].astype(int), contacts["second"][here].astype(int)
        force = contacts["normal_force"][here][:, None] * contacts["normal"][here]
        force = force + contacts["tangential_force"][here]
        pairs = second < N
        # Normals lead from one centre to the other, and overlaps are the missing distance.
        centres = group["position/value"][frame]
        between = centres[first[pairs]] - centres[second[pairs]]
        distance = np.linalg.norm(between, axis=1)
        np.testing.assert_allclose(1 - distance, contacts["overlap"][here][pairs], atol=1e-13)
        np.testing.assert_allclose(between / distance[:, None], contacts["normal"][here][pairs],
                                   atol=1e-12)
        # Walls carry the weight, but for the ringing of the latched springs.
        acting = np.zeros((N, 3))
        np.add.at(acting, first, force)
        np.add.at(acting, second[pairs], -force[pairs])
        total = acting.sum(axis=0)
        self.assertLess(abs(total[2] - N), N / 10)
        normal, friction = point["wall_normal_force"][frame, 1], point["wall_friction_force"][frame, 1]
        self.assertAlmostEqual(normal[0] + friction[1:, 2].sum(), total[2], places=9)
        self.assertAlmostEqual(normal[1] - normal[2] + friction[[0, 3, 4], 0].sum(), total[0], places=9)
        # The tensor of the bed: twice the arm for pairs, whose other sphere has as much.
        overlap = contacts["overlap"][here]
        arm = np.where(pairs, 1 - overlap, 0.5 - overlap)[:, None] * contacts["normal"][here]
        moment = np.einsum("ka,kb->ab", arm, force)
        np.testing.assert_allclose(point["force_moment"][frame, 1], moment, atol=1e-9)
        self.assertGreater(np.trace(moment), 0)

    def test_snapshots_keep_what_is_asked_for(self):
        without = changed(GRAINS, snapshots={"taps": [0, 3], "keep": ["positions"]})
        self.write(without)
        self.run_scene("-o", "bare.h5")
        self.write(GRAINS)
        self.run_scene("-o", "all.h5")
        with h5py.File(self.folder / "bare.h5") as bare, h5py.File(self.folder / "all.h5") as full:
            particles = "particles/point_0000_realization_00000"
            self.assertEqual(sorted(bare[particles]), ["box", "position"])
            self.assertEqual(sorted(full[particles]), ["box", "contacts", "position", "spin", "velocity"])
            # No row depends on it, bit for bit.
            for name, dataset in bare["observables/point_0000"].items():
                if dataset.dtype.kind == "f":
                    np.testing.assert_array_equal(dataset[:], full["observables/point_0000"][name][:])
        self.write(changed(GRAINS, engine={"discrete_element": {
            "contact": {"walton_braun": {"friction": 0}}}}))
        self.run_scene("-o", "smooth.h5")
        with h5py.File(self.folder / "smooth.h5") as smooth:
            self.assertNotIn("spin", smooth[particles])
            self.assertFalse(smooth[particles]["contacts/tangential_force"][:].any())
        for change, message in (
                ({"engine": {"monte_carlo": {}}, "protocol": []},
                 '/snapshots/keep: "velocities" requires discrete elements: Monte Carlo has no times'),
                ({"snapshots": {"taps": [0], "keep": ["contacts"]}},
                 '/snapshots/keep: "contacts" requires positions: keep positions, too')):
            asked = {"taps": [0], "keep": ["positions", "velocities"]}
            self.write(changed(GRAINS, **{"snapshots": asked, **change}))
            self.assertIn(message, self.jostle("check", "scene.json", expect=BAD_INPUT).stderr)

    def test_both_engines_keep_what_they_have(self):
        self.write(changed(GRAINS, realizations=1, protocol=[{"tap": {"lift": 0.1}, "count": 1}],
                           snapshots={"taps": [0]}, sweep={
                               "/engine": [{"discrete_element": {}}, {"monte_carlo": {}}]}))
        self.run_scene()
        with h5py.File(self.folder / "grains.h5") as file:
            self.assertIn("velocity", file["particles/point_0000_realization_00000"])
            self.assertNotIn("velocity", file["particles/point_0001_realization_00000"])

    def test_exports_carry_velocities(self):
        self.run_scene()
        for form, named, column in (("lammps", "x y z", "vx vy vz omegax omegay omegaz"),
                                    ("extxyz", "pos:R:3", "velo:R:3:omega:R:3")):
            text = self.jostle("export", "grains.h5", "--format", form, "-o", f"out.{form}").stdout
            lines = (self.folder / f"out.{form}").read_text().splitlines()
            header = next(line for line in lines if named in line)
            self.assertIn(column, header, text)
            last = [float(word) for word in lines[-1].split()[-6:]]
            with h5py.File(self.folder / "grains.h5") as file:
                group = file["particles/point_0000_realization_00000"]
                self.assertEqual(last, [*group["velocity/value"][-1, -1], *group["spin/value"][-1, -1]])
        self.jostle("export", "grains.h5", "--format", "vtp", "-o", "out.vtp")
        self.assertIn('Name="velocity" NumberOfComponents="3"', (self.folder / "out.vtp").read_text())

    def test_overlapping_beds_have_one_structure_in_any_file(self):
        """The numbers of a bed of soft grains, read from results and from its export."""
        soft = {"discrete_element": {"contact": {"walton_braun": {"stiffness": 3000}}}}
        self.write(changed(GRAINS, realizations=1, engine=soft, snapshots={"taps": [1]},
                           protocol=[{"tap": {"lift": 0.1}, "count": 1}]))
        self.run_scene()
        self.jostle("export", "grains.h5", "--format", "extxyz", "-o", "bed.xyz")

        def tables(file):
            parts = [word for part in ("profile", "coordination", "order", "voronoi", "pores", "holes")
                     for word in ("--part", part)]
            out = self.jostle("structure", file, *parts, "--no-store", "--json").stdout
            return {table["name"].split("/")[-1]: repr(table["quantities"])
                    for table in json.loads(out)["tables"]}

        results, export = tables("grains.h5"), tables("bed.xyz")
        self.assertEqual(len(results), 6)
        self.assertEqual([part for part in results if export[part] != results[part]], [])
        lines = (self.folder / "bed.xyz").read_text().splitlines()
        first, second = lines[2].split(), lines[3].split()
        with h5py.File(self.folder / "grains.h5") as file:
            centres = file["particles/point_0000_realization_00000/position/value"][-1]
        between = centres[:, None] - centres[None]
        between[..., :2] -= 4 * np.round(between[..., :2] / 4)
        squares = (between**2).sum(axis=2) + 9 * np.eye(len(centres))
        self.assertGreater(1 - squares.min() ** 0.5, 1e-3)
        for name, z, why in (("deep", float(first[3]) + 0.4, "0.400000 apart, and their diameter is 1"),
                             ("below", -0.01, "sphere 1 lies outside the container")):
            moved = [second[0], *first[1:3], str(z), *second[4:]]
            (self.folder / f"{name}.xyz").write_text("\n".join([*lines[:3], " ".join(moved), *lines[4:]]))
            self.assertIn(why, self.jostle("structure", f"{name}.xyz", expect=BROKEN).stderr)

    def test_check_says_what_the_settings_come_to(self):
        self.write(changed(GRAINS, engine={"discrete_element": {}}))
        text = self.jostle("check", "scene.json", environment=UNFOLDED).stdout
        for part in ("contact time 0.000473 s", "Gamma 1.998", "floor speed 0.416 m/s",
                     "sphere steps at", "time steps per tap", "diameter 0.02 m, density 1200 kg/m^3"):
            self.assertIn(part, text)

    def test_check_speaks_of_every_point_and_of_what_will_fail(self):
        law = "/engine/discrete_element/contact/walton_braun/"
        self.write(changed(GRAINS, sweep={law + "stiffness": [1e4, 1e6]}))
        text = self.jostle("check", "scene.json", "--no-pilot", environment=UNFOLDED).stdout
        self.assertIn("contact time 0.0015 s", text)
        self.assertIn("contact time 0.00015 s", text)
        hard = changed(GRAINS, protocol=[{"tap": {"half_sine": {"amplitude": 50}}, "count": 1}])
        hard["engine"] = {"discrete_element": {"contact": {"walton_braun": {"stiffness": 300}},
                                               "rest": {"timed": {"seconds": 9}}}}
        self.write(changed(hard, snapshots={}))
        text = self.jostle("check", "scene.json", "--no-pilot", environment=UNFOLDED).stdout
        self.assertIn("beds fail at 0.2: raise the stiffness", text)
        self.assertIn("is capped after 5 s: every tap will be", text)
        logged = " ".join(self.run_scene(expect=FAILED).stderr.split())
        self.assertIn("beds fail at 0.2: raise the stiffness", logged)
        self.assertIn("the pilot failed: a sphere left the container, or overlaps another by more",
                      self.jostle("check", "scene.json", expect=BAD_INPUT).stderr)

    def test_the_pilot_lasts_until_a_bed_has_come_to_rest(self):
        if not EVERY:
            self.skipTest("ten seconds: in every case")
        law = {"walton_braun": {"stiffness": 1e3, "restitution": 0.5}}
        self.write(changed(GRAINS, container={"sides": "periodic", "width": 16}, spheres=2560,
                           start={"random_settle": {"dilute_fraction": 0.3}},
                           engine={"discrete_element": {"contact": law}}, protocol=[], snapshots={},
                           sweep={"/engine/discrete_element/contact/walton_braun/friction": [0.4, 0.5]}))
        text = self.jostle("check", "scene.json", environment=UNFOLDED).stdout
        self.assertIn("2000 of 2560 spheres", text)
        self.assertNotIn("at least", text)
        self.assertNotIn("a tap", text)  # there is none

    def test_taps_that_dissipate_nothing_are_counted_at_the_cap(self):
        elastic = {"walton_braun": {"restitution": 1, "friction": 0}}
        self.write(changed(GRAINS, snapshots={}, protocol=[{"tap": {"lift": 0.5}, "count": 2}],
                           engine={"discrete_element": {"contact": elastic, "most_seconds": 0.5}}))
        self.assertIn("9 of 9 taps ended at the cap", self.run_scene().stdout)

    def test_what_does_not_go_together_is_refused(self):
        self.write(changed(GRAINS, relax={"polar": {}}))
        self.assertIn("/relax: applies only to Monte Carlo",
                      self.jostle("check", "scene.json", expect=BAD_INPUT).stderr)

    def test_what_their_accuracy_costs(self):
        self.write(changed(GRAINS, snapshots={}, spheres=30))
        said = self.jostle("cost", "scene.json", "--replicates", "2", "--taps", "1",
                           "--observable", "bulk_fraction", "--no-progress", "--wide").stdout
        for text in ("simulated seconds/tap", "80 steps per contact", "ten times softer",
                     "against quiet for 0.5 s"):
            self.assertIn(text, said)
        self.assertNotIn("sweeps", said)
        with h5py.File(self.folder / "grains-cost.h5") as file:
            table = file["analysis/cost/bulk_fraction"]
            seconds = dict(zip(table["setting"].asstr()[:], table["simulated_seconds_per_tap"][:]))
        # Rest is to last 0.48 s longer, from a start that has rested longer, too.
        self.assertGreater(seconds["quiet for 0.5 s"], 0.5)
        self.assertGreater(seconds["as the scene"], 0.02)
        self.assertGreater(seconds["quiet for 0.5 s"] - seconds["as the scene"], 0.3)

    def test_a_bed_of_grains_begins_another_run(self):
        self.run_scene("-o", "poured.h5")
        start = {"file": {"path": "poured.h5", "realization": 1, "overlap": 0.01}}
        again = changed(GRAINS, name="again", realizations=1, start=start)
        self.write(again)
        self.run_scene()
        with h5py.File(self.folder / "again.h5") as file:
            began = file["observables/point_0000/mean_height"][0, 0]
        with h5py.File(self.folder / "poured.h5") as file:
            ended = file["observables/point_0000/mean_height"][-1, 1]
        self.assertAlmostEqual(began, ended, delta=1e-3)
        self.write(changed(again, start={"file": {"path": "poured.h5", "realization": 1}}))
        self.assertIn('set "overlap" to the depth',
                      self.jostle("check", "scene.json", expect=BAD_INPUT).stderr)
        hard = changed(again, engine={"monte_carlo": {}}, relax={"polar": {}},
                       protocol=[{"tap": {"lift": 0.1}, "count": 1}])
        self.write(hard)
        self.assertIn("/start/file/overlap: trials move hard spheres",
                      self.jostle("check", "scene.json", expect=BAD_INPUT).stderr)

    def test_a_sweep_over_the_engine(self):
        scene = changed(GRAINS, realizations=1, protocol=[], snapshots={}, sweep={
            "/engine/discrete_element/contact/walton_braun/friction": [0, 0.5]})
        self.write(scene)
        self.run_scene()
        with h5py.File(self.folder / "grains.h5") as file:
            phi = [file[f"observables/point_{p:04}/bulk_fraction"][0, 0] for p in (0, 1)]
        self.assertGreater(phi[0], phi[1])


if __name__ == "__main__":
    unittest.main()
