"""The curves of a run in progress, from its checkpoints."""

import json
import os
import signal
import time
import unittest

from support import BAD_INPUT, BROKEN, TINY, Case, changed

# Hours of taps that take a millisecond each.
ENDLESS = changed(TINY, name="endless", realizations=2, spheres=24,
                  container={"sides": "periodic", "width": 3},
                  protocol=[{"tap": {"dilate": 0.05}, "count": 1_000_000}],
                  relax={"polar": {}, "stop": {"sweeps": 200}}, snapshots={"taps": [0, 20]})
del ENDLESS["sweep"]


class Live(Case):
    def setUp(self):
        super().setUp()
        self.write(ENDLESS)

    def begin(self):
        """A run of which both realizations have checkpointed 50 taps, stopped in its tracks."""
        process = self.popen("run", "scene.json", "--threads", "2", "--checkpoint-every", "0",
                             "--quiet")
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        while True:
            self.assertIsNone(process.poll(), "ended early")
            time.sleep(0.05)
            if not (self.folder / "endless.h5").exists():
                continue
            if min(one["taps_recorded"] for one in self.info("endless.h5")["realizations"]) > 50:
                break
        os.kill(process.pid, signal.SIGSTOP)
        return process

    def look(self):
        """Output of every command for the run; none of them changes its file."""
        before = (self.folder / "endless.h5").read_bytes()
        text = self.jostle("info", "endless.h5").stdout
        self.assertRegex(text, r"curves +so far, with the last checkpoints")
        self.assertRegex(text, r"\n +50 .*\n")
        fit = ("fit", "endless.h5", "--observable", "mean_height", "--model", "inverse_log",
               "--range", "1:50", "--json")
        self.assertIn("--live reads its checkpoints", self.jostle(*fit, expect=BAD_INPUT).stderr)
        fitted = json.loads(self.jostle(*fit, "--live").stdout)
        self.assertEqual(fitted["curves"][0]["realizations"], 2)
        analysed = self.jostle("analyse", "endless.h5", "steady", "--observable", "mean_height",
                               "--last", "40", "--live", "--json")
        self.assertIn("the taps of its last checkpoints", analysed.stderr)
        self.assertEqual(len(json.loads(analysed.stdout)["tables"]), 1)
        measured = self.jostle("structure", "endless.h5", "--part", "coordination", "--live")
        self.assertIn("coordination", measured.stdout)
        self.jostle("export", "endless.h5", "--format", "extxyz", "--tap", "20", "--live")
        self.assertEqual(len((self.folder / "endless.xyz").read_text().splitlines()), 24 + 2)
        (self.folder / "endless.xyz").unlink()
        self.assertEqual((self.folder / "endless.h5").read_bytes(), before)
        self.assertEqual(self.info("endless.h5")["tables"], [])

    def test_a_run_is_read_while_it_goes_on_and_after_it_was_killed(self):
        process = self.begin()
        self.look()
        process.kill()
        process.communicate()
        self.look()

    def test_its_checkpoints_are_written_over_by_nothing(self):
        process = self.begin()
        process.kill()
        process.communicate()
        parts = self.folder / "endless.h5.parts"
        before = {path.name: path.read_bytes() for path in parts.iterdir()}
        state = "endless.h5.parts/" + min(name for name in before if name.endswith(".state"))
        fit = ("fit", "endless.h5", "--observable", "mean_height", "--model", "kww", "--live")
        for command in (("report", "endless.h5", "--live", "-o", state), (*fit, "--csv", state),
                        ("export", "endless.h5", "--format", "extxyz", "--live", "--tap", "0",
                         "-o", state)):
            refused = self.jostle(*command, "--force", expect=BAD_INPUT).stderr
            self.assertIn("works with that file", refused)
        self.write(TINY)
        self.run_scene()
        refused = self.jostle("export", "tiny.h5", "--format", "results", "-o", "endless.h5",
                              "--force", expect=BROKEN).stderr
        self.assertIn("holds parts of another run", refused)
        self.assertEqual({path.name: path.read_bytes() for path in parts.iterdir()}, before)

    def test_a_whole_run_has_nothing_more(self):
        self.write(TINY)
        self.run_scene()
        arguments = ("fit", "tiny.h5", "--observable", "mean_height", "--model", "inverse_log",
                     "--sweep-point", "0", "--json")
        live = json.loads(self.jostle(*arguments, "--live").stdout)
        self.assertEqual(json.loads(self.jostle(*arguments).stdout)["curves"], live["curves"])


if __name__ == "__main__":
    unittest.main()
