"""jostle on a real Slurm of one node: an array of shards of which one is killed and requeued, one
stopped before its time is up, and one killed with its job, gives the bytes of a single run."""

import json
import os
import pathlib
import shlex
import signal
import subprocess
import sys
import time
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from daemons import NoSlurm, Slurm  # noqa: E402
from support import BROKEN, TINY, Case, changed  # noqa: E402

SHARDS = 8
KILLED, TIMED, LOST = 3, 5, 7
# A second or more a shard, of four realizations.
SCENE = changed(TINY, name="array", realizations=16, spheres=48,
                relax={"polar": {}, "stop": {"sweeps": 100000}})


def signals_waiting(pid):
    """Those that a stopped process will get, as bits."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(status.split("ShdPnd:")[1].split()[0], 16)


class Cluster(Case):
    def setUp(self):
        super().setUp()
        (self.folder / "slurm").mkdir()
        self.slurm = Slurm(self.folder / "slurm")
        self.addCleanup(self.slurm.stop)
        try:
            self.slurm.start()
        except NoSlurm as error:
            self.skipTest(f"Slurm cannot be started here: {error}")
        self.environment = self.slurm.environment
        self.write(SCENE)

    def popen(self, *arguments, environment=None, folder=None):
        return super().popen(*arguments, environment={**self.environment, **(environment or {})},
                             folder=folder)

    def wait_for(self, what, ready, seconds=100):
        """Polls until ready() is true, and gives what it is."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = ready()
            if found:
                return found
            time.sleep(0.02)
        self.fail(f"waited in vain for {what}\n{self.evidence()}")

    def evidence(self):
        logs = sorted((self.folder / "array.shards").glob("*.log"))
        return "\n".join([self.slurm.answer("squeue", "--states=all"),
                          *(f"--- {path.name}\n{path.read_text()}" for path in
                            [self.folder / "array.slurm.log", *logs] if path.exists())])

    def lock(self, shard):
        return self.folder / f"array.shards/{shard}.h5.lock"

    def hold(self, *shards):
        """Stops the processes that compute them (SIGSTOP), each once it has begun its file, and
        gives the words of the locks."""
        held = {}

        def look():
            for shard in set(shards) - set(held):
                words = self.lock(shard).read_text().split() if self.lock(shard).exists() else []
                if len(words) == 8 and self.lock(shard).with_suffix("").exists():
                    os.kill(int(words[1]), signal.SIGSTOP)
                    held[shard] = words
            return len(held) == len(shards)
        self.wait_for(f"shards {shards} to run", look)
        return held

    def status(self):
        return json.loads(self.jostle("status", "array.shards", "--json").stdout)["studies"][0]

    def state_of(self, task):
        return self.slurm.answer("squeue", "--states=all", "--noheader", "--format=%T",
                                 f"--jobs={self.array}_{task}").strip()

    def submit(self, command):
        done = subprocess.run(shlex.split(command), cwd=self.folder, text=True,
                              capture_output=True, env={**os.environ, **self.environment})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip().rpartition(" ")[2]

    def test_an_array_that_is_disturbed_gives_the_bytes_of_one_run(self):
        whole = self.popen("run", "scene.json", "-o", "whole.h5", "--quiet")
        self.addCleanup(whole.communicate)
        self.addCleanup(whole.kill)
        told = self.jostle("slurm", "scene.json", "--hours", 1 / 60, "--cpus", 1, "--jobs", SHARDS,
                           "-o", "array.sbatch").stderr
        self.assertIn("sbatch array.sbatch", told)
        self.array = self.submit("sbatch array.sbatch")
        held = self.hold(TIMED, KILLED, LOST)
        owner = held[TIMED]
        self.assertEqual(owner[3:5], ["slurm", "jostle-test"])
        self.assertEqual(owner[7], f"{self.array}_{TIMED}")
        self.kill_and_requeue(int(held[KILLED][1]))
        self.kill_with_its_job(int(held[LOST][1]))
        self.check_locks_of_jobs(owner)
        self.stop_before_the_end(int(owner[1]))
        self.wait_for("the array to end", lambda: not self.slurm.answer(
            "squeue", "--noheader", "--array").strip())
        self.redo_what_is_missing()
        self.assertEqual(whole.wait(timeout=100), 0)
        self.jostle("merge", "array.shards", "-o", "array.h5")
        self.assertEqual(self.digest("array.h5"), self.digest("whole.h5"))

    def kill_and_requeue(self, process):
        """A node dies: the process is gone, and its lock names another host."""
        os.kill(process, signal.SIGKILL)
        text = self.lock(KILLED).read_text()
        self.lock(KILLED).write_text("elsewhere " + text.split(maxsplit=1)[1])
        self.submit(f"scontrol requeue {self.array}_{KILLED}")

    def kill_with_its_job(self, process):
        """Out of memory: the script ends, too, and nobody requeues it."""
        script = int(pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])
        os.kill(script, signal.SIGKILL)
        os.kill(process, signal.SIGKILL)

    def check_locks_of_jobs(self, owner):
        """Outside of jobs, of a file that a process on another host was at work on."""
        self.run_scene("--shard", f"1/{SHARDS}", "-o", "other.h5")
        lock = self.folder / "other.h5.lock"
        lock.write_text(" ".join(["elsewhere", *owner[1:]]) + "\n")
        resume = ["--resume", "--shard", f"1/{SHARDS}", "-o", "other.h5"]
        refused = self.run_scene(*resume, expect=BROKEN)
        self.assertIn(f"Slurm job {self.array}_{TIMED}", refused.stderr)
        ended = self.wait_for("another task to end", lambda: [
            line.split() for line in self.slurm.answer(
                "squeue", "--states=COMPLETED", "--noheader", "--format=%A %K").splitlines()])[0]
        lock.write_text(" ".join(["elsewhere", "1", "1", "slurm", "jostle-test", ended[0], "0",
                                  f"{self.array}_{ended[1]}"]) + "\n")
        self.run_scene(*resume)
        self.assertFalse(lock.exists())

    def stop_before_the_end(self, process):
        """Slurm signals the script, which signals the run."""
        usr1 = 1 << (signal.SIGUSR1 - 1)
        self.wait_for("SIGUSR1", lambda: signals_waiting(process) & usr1)
        os.kill(process, signal.SIGCONT)
        self.wait_for("the requeue", lambda: self.state_of(TIMED) == "PENDING")
        self.assertIn("stopped by SIGUSR1",
                      (self.folder / f"array.shards/{TIMED}.log").read_text())

    def redo_what_is_missing(self):
        status = self.status()
        self.assertEqual(status["counts"], {"done": SHARDS - 1, "running": 0, "stopped": 0,
                                            "dead": 1, "missing": 0, "unreadable": 0}, self.evidence())
        self.assertEqual(status["redo"], [f"sbatch --array={LOST} array.shards/job.sbatch"])
        refused = self.jostle("merge", "array.shards", "-o", "array.h5", expect=BROKEN)
        self.assertIn(f"array.shards/{LOST}.h5: is not finished", refused.stderr)
        self.submit(status["redo"][0])
        self.wait_for("the redone shard", lambda: self.status()["counts"]["done"] == SHARDS)
        self.assertEqual(self.status()["redo"], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
