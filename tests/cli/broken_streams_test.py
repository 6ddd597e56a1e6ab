"""Streams that go away, files without results, and early signals: no run is lost, and messages name the cause."""

import os
import signal
import subprocess
import time
import unittest

import h5py

from crafted_files import SEAL, sealed
from paused_runs import OPTIONS, Faults
from support import BAD_INPUT, BROKEN, JOSTLE, OK, PLAIN, STOPPED

# A start of many minutes.
GROWTH = {"name": "growth", "seed": 1999, "realizations": 1, "spheres": 20000,
          "container": {"sides": "fully_periodic", "width": 25.4, "height": 25.4},
          "start": {"grow": {}}, "protocol": [{"tap": {"lift": 0}, "count": 1}],
          "relax": {"metropolis": {}, "stop": {"sweeps": 10}}, "observe": [],
          "snapshots": {"taps": [0, 1]}}


class Streams(Faults):
    def test_a_reader_that_goes_away_does_not_end_the_run(self):
        straight = self.straight()
        process = self.popen("run", "scene.json", *OPTIONS)
        process.stdout.close()
        err = process.stderr.read()
        process.stderr.close()
        self.assertEqual(process.wait(timeout=60), OK, err)
        self.assertNotIn("standard output", err)
        self.assertEqual(self.digest("tiny.h5"), straight)
        self.assertEqual(self.info("tiny.h5")["state"], "complete")

    def test_a_reader_of_messages_that_goes_away_does_not_end_the_run(self):
        straight = self.straight()
        process = self.popen("run", "scene.json", "--threads", "2")
        process.stderr.close()
        process.stdout.read()
        process.stdout.close()
        self.assertEqual(process.wait(timeout=60), OK)
        self.assertEqual(self.digest("tiny.h5"), straight)

    def test_a_closed_stream_is_not_taken_for_a_results_file(self):
        straight = self.straight()
        for closed in ("0<&-", "1>&-", "2>&-", "0<&- 1>&- 2>&-"):
            with self.subTest(closed=closed):
                subprocess.run(["bash", "-c", f'"$0" run scene.json --force {closed}', JOSTLE],
                               cwd=self.folder, env=PLAIN, capture_output=True, timeout=60)
                self.assertEqual(self.digest("tiny.h5"), straight)
                self.assertEqual(self.files(), ["scene.json", "tiny.h5"])

    def test_output_goes_to_a_file_alone(self):
        os.mkfifo(self.folder / "pipe")
        os.symlink("pipe", self.folder / "link")
        (self.folder / "folder").mkdir()
        for output in ("pipe", "link", "folder", "/dev/stdout", "/dev/fd/1", "/dev/null"):
            for force in ((), ("--force",)):
                with self.subTest(output=output, force=force):
                    refused = self.run_scene("-o", output, *force, expect=BAD_INPUT)
                    self.assertRegex(refused.stderr, rf"^jostle: {output} is a .*\btiny\.h5")
        self.run_scene()
        for command in (["merge", "tiny.h5"], ["export", "tiny.h5", "--format", "extxyz"]):
            refused = self.jostle(*command, "-o", "pipe", "--force", expect=BAD_INPUT)
            self.assertIn("jostle: pipe is a pipe", refused.stderr)
        self.assertTrue((self.folder / "pipe").is_fifo())

    def test_input_comes_from_a_file_alone(self):
        os.mkfifo(self.folder / "pipe")
        refused = self.jostle("info", "pipe", expect=BROKEN)
        self.assertIn("jostle: pipe: not a file", refused.stderr)


class Reading(Faults):
    def test_a_killed_run_without_taps_in_its_file_is_said_to_be_unfinished(self):
        process = self.paused()
        process.kill()
        process.communicate()
        for command in (["analyse", "tiny.h5", "steady", "--observable", "mean_height"],
                        ["analyse", "tiny.h5", "sweep", "--observable", "mean_height"],
                        ["fit", "tiny.h5", "--observable", "mean_height"],
                        ["structure", "tiny.h5"], ["export", "tiny.h5", "--format", "vtp"]):
            with self.subTest(command=command):
                self.assertIn("its file has no taps yet; --live reads its checkpoints. Finish it",
                              self.jostle(*command, expect=BAD_INPUT).stderr)

    def test_info_of_a_live_run_says_how_far_its_parts_are(self):
        process = self.paused(at="350")  # the first two of four realizations end at about 270
        text, summary = self.jostle("info", "tiny.h5").stdout, self.info("tiny.h5")
        process.send_signal(signal.SIGCONT)
        process.communicate(timeout=60)
        done = [one["status"] for one in summary["realizations"]].count("done")
        self.assertIn(done, (1, 2, 3))
        self.assertRegex(text, rf"4 per sweep point: .*\b{done} done")
        # Lines above and below the table count alike.
        states = [one["status"] for one in summary["realizations"]]
        begun, missing = 4 - done - states.count("missing"), states.count("missing")
        counted = f"{done} done" + (f", {begun} unfinished" if begun else "") + (
            f", {missing} missing" if missing else "")
        self.assertRegex(text, rf"(?m)^{counted}, 0 failed; [1-9][0-9.]* \w+ trials in ")
        self.assertIn(f"{done} of 4 realizations done", text)

    def test_a_stored_scene_that_is_none_is_refused_by_name(self):
        self.run_scene()
        path = self.folder / "tiny.h5"
        for text in ("{\"name\": ", "17"):
            with self.subTest(scene=text):
                path.write_bytes(path.read_bytes()[:-SEAL])
                with h5py.File(path, "r+") as file:
                    del file["scene/resolved"]
                    file["scene"].create_dataset("resolved", data=text, dtype=h5py.string_dtype())
                data = path.read_bytes()
                path.write_bytes(sealed(data))
                for command in (["info", "tiny.h5"], ["info", "tiny.h5", "--json"],
                                ["run", "scene.json", "--resume"]):
                    refused = self.jostle(*command, expect=BROKEN)
                    self.assertIn("jostle: tiny.h5: its scene (/scene/resolved) is not a JSON "
                                  "object", refused.stderr)


class Signals(Faults):
    def test_a_start_under_way_is_given_up(self):
        self.write(GROWTH, "growth.json")
        process = self.popen("run", "growth.json", "--no-progress", "-o", "growth.h5")
        while not (self.folder / "growth.h5").exists():
            self.assertIsNone(process.poll(), "ended before it wrote a file")
            time.sleep(0.005)
        process.send_signal(signal.SIGTERM)
        _, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, STOPPED, err)
        taps = [one["taps_recorded"] for one in self.info("growth.h5")["realizations"]]
        self.assertEqual(taps, [0])
        self.assertIn("stopped by SIGTERM", err)

    def test_a_signal_that_comes_first_of_all_stops_resumably(self):
        straight = self.straight()
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1):
            with self.subTest(signal=number.name):
                os.mkfifo(self.folder / "slow.json")
                process = self.popen("run", "slow.json", "--no-progress")
                with open(self.folder / "slow.json", "w") as scene:  # opened once run reads it
                    process.send_signal(number)
                    scene.write((self.folder / "scene.json").read_text())
                _, err = process.communicate(timeout=60)
                self.assertEqual(process.returncode, STOPPED, err)
                self.assertIn(f"stopped by {number.name}", err)
                (self.folder / "slow.json").unlink()
                self.run_scene("--resume")
                self.assertEqual(self.digest("tiny.h5"), straight)
                (self.folder / "tiny.h5").unlink()


if __name__ == "__main__":
    unittest.main()
