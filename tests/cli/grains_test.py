"""Discrete elements through the program: the same bytes however they are run, and what they refuse."""

import json
import signal
import time
import unittest

import h5py

from support import BAD_INPUT, STOPPED, UNFOLDED, Case, changed

GRAINS = {
    "name": "grains",
    "seed": 2010,
    "realizations": 3,
    "container": {"sides": "periodic", "width": 4},
    "spheres": 80,
    "start": {"random_settle": {"dilute_fraction": 0.2}},
    "engine": {"discrete_element": {}},
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
        for name, environment in (("avx2", {"JOSTLE_INSTRUCTION_SET": "avx2"}),
                                  ("baseline", {"JOSTLE_INSTRUCTION_SET": "baseline"})):
            with self.subTest(instructions=name):
                self.jostle("run", "scene.json", "-o", f"{name}.h5", "--quiet",
                            environment=environment)
                self.assertEqual(self.digest(f"{name}.h5"), straight)
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

    def test_check_says_what_the_settings_come_to(self):
        text = self.jostle("check", "scene.json", environment=UNFOLDED).stdout
        for part in ("contact time 0.000473 s", "Gamma 1.998", "floor speed 0.416 m/s",
                     "sphere steps at", "time steps a tap"):
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
        self.assertIn("such overlaps fail: raise the stiffness", text)
        self.assertIn("is capped after 5 s: every tap will be", text)
        self.assertIn("the pilot failed: a sphere left the container, or lies deeper",
                      self.jostle("check", "scene.json", expect=BAD_INPUT).stderr)

    def test_what_does_not_go_together_is_refused(self):
        self.write(changed(GRAINS, relax={"polar": {}}))
        self.assertIn("/relax: trials are of Monte Carlo",
                      self.jostle("check", "scene.json", expect=BAD_INPUT).stderr)

    def test_what_their_accuracy_costs(self):
        self.write(changed(GRAINS, snapshots={}, spheres=30))
        said = self.jostle("cost", "scene.json", "--replicates", "2", "--taps", "1",
                           "--observable", "bulk_fraction", "--no-progress", "--wide").stdout
        for text in ("simulated seconds/tap", "80 steps a contact", "ten times softer",
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
        self.assertIn('say how deep ("overlap")',
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
