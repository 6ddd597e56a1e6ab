"""Killed at any instant or out of disk, a run leaves a file that opens and a resume that finishes
it to the same digest."""

import concurrent.futures
import os
import random
import signal
import time
import unittest

from support import BROKEN, OK, SHIM, TINY, Case, changed, some

# The fewest writes of a run, including checkpoints after its taps.
SHORT = changed(TINY, realizations=1, spheres=24, container={"sides": "periodic", "width": 3},
                protocol=[{"tap": {"dilate": 0.05}, "count": 1}], observe=["mean_height"],
                snapshots={"taps": [1]})
del SHORT["sweep"]
# About half a second, in which random moments fall.
LONGER = changed(TINY, realizations=4, relax={"polar": {}, "stop": {"sweeps": 10000}})

WORKERS = len(os.sched_getaffinity(0))


class Kill(Case):
    def straight_digest(self, scene):
        self.write(scene)
        began = time.monotonic()
        self.run_scene("-o", "straight.h5", "--checkpoint-every", "0")
        return self.digest("straight.h5"), time.monotonic() - began

    def place(self, name, scene):
        folder = self.folder / name
        folder.mkdir()
        self.write(scene, f"{name}/scene.json")
        return folder

    def finish(self, folder, straight):
        """The file of a killed run opens, and finishes to the digest of an uninterrupted run."""
        if (folder / "tiny.h5").exists():
            self.jostle("info", "tiny.h5", folder=folder)
        self.run_scene("--resume", folder=folder)
        self.assertEqual(self.digest("tiny.h5", folder=folder), straight)
        left = sorted(path.name for path in folder.iterdir())
        self.assertEqual(left, ["scene.json", "tiny.h5"])

    def in_parallel(self, task, items):
        with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
            for item, outcome in [(item, pool.submit(task, item)) for item in items]:
                with self.subTest(item=item):
                    outcome.result()

    def test_sigkill_at_random_moments(self):
        straight, duration = self.straight_digest(LONGER)
        moments = random.Random(20010222)

        def kill_and_resume(numbered_share):
            number, share = numbered_share
            folder = self.place(f"moment{number}", LONGER)
            process = self.popen("run", "scene.json", "--quiet", "--checkpoint-every", "0",
                                 folder=folder)
            time.sleep(share * duration)
            process.kill()
            process.communicate()
            self.finish(folder, straight)

        self.in_parallel(kill_and_resume,
                         some([(n, moments.uniform(0, 1)) for n in range(100)], 6))

    def faulty_run(self, folder, environment):
        """A run of SHORT, single-threaded so that its calls come in one order; its exit code."""
        process = self.popen(
            "run", "scene.json", "--quiet", "--threads", "1", "--checkpoint-every", "0",
            folder=folder, environment={**SHIM, "JOSTLE_FAULT_PATH": str(folder), **environment})
        _, err = process.communicate(timeout=120)
        return process.returncode, err

    def number_of_calls(self):
        count = self.folder / "count"
        code, err = self.faulty_run(self.place("counted", SHORT),
                                    {"JOSTLE_FAULT_COUNT": str(count)})
        self.assertEqual(code, OK, err)
        calls = int(count.read_text())
        self.assertGreater(calls, 20, "the shim saw too few writes, fsyncs and renames")
        return calls

    def test_sigkill_before_and_after_every_write_fsync_and_rename(self):
        straight, _ = self.straight_digest(SHORT)
        calls = self.number_of_calls()

        def kill_and_resume(at):
            call, action = at
            folder = self.place(f"{action}{call}", SHORT)
            code, err = self.faulty_run(folder, {"JOSTLE_FAULT_AT": str(call),
                                                 "JOSTLE_FAULT_ACTION": action})
            self.assertEqual(code, -signal.SIGKILL, err)
            self.finish(folder, straight)

        everywhere = [(call, action) for call in range(1, calls + 1)
                      for action in ("kill_before", "kill_after")]
        halfway = [(call, "kill_within") for call in range(1, calls + 1, 5)]
        self.in_parallel(kill_and_resume, some(everywhere, 10) + some(halfway, 3))

    def test_a_disk_that_fills_or_fails_ends_the_run_with_a_message(self):
        straight, _ = self.straight_digest(SHORT)
        calls = self.number_of_calls()
        broken = []

        def fail_and_resume(at):
            call, action = at
            folder = self.place(f"{action}{call}", SHORT)
            code, err = self.faulty_run(folder, {"JOSTLE_FAULT_AT": str(call),
                                                 "JOSTLE_FAULT_ACTION": action})
            # After the last write or fsync the fault has nothing to act on.
            self.assertIn(code, (BROKEN, OK), err)
            if code == BROKEN:
                broken.append(at)
                self.assertRegex(err, "(?m)^jostle: .*(No space left|Input/output error)")
            self.finish(folder, straight)

        tried = some([(call, action) for call in range(1, calls + 1, 5)
                      for action in ("no_space", "fsync_fails")], 12)
        self.in_parallel(fail_and_resume, tried)
        self.assertGreater(len(broken), len(tried) // 2)


if __name__ == "__main__":
    unittest.main()
