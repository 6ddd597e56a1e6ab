"""Runs that are paused in their midst, so that their environment can fail them."""

import os
import pathlib
import shlex
import signal
import subprocess
import unittest

from support import BROKEN, JOSTLE, PLAIN, SHIM, TINY, Case, changed

# A fifth of a second, with checkpoints all the way, and snapshots that fill disk and memory.
RUN = changed(TINY, realizations=4, spheres=96, relax={"polar": {}, "stop": {"sweeps": 300}},
              protocol=[{"tap": {"dilate": 0.05}, "count": 30}],
              snapshots={"taps": list(range(31))})
del RUN["sweep"]
OPTIONS = ("--no-progress", "--threads", "2", "--checkpoint-every", "0")
# Pauses a run in its midst, until SIGCONT: it has written about twenty checkpoints of a hundred.
PAUSE = {**SHIM, "JOSTLE_FAULT_ACTION": "pause", "JOSTLE_FAULT_AT": "100"}
BUILD = pathlib.Path(os.environ["BUILD"])
INSTRUMENTED = "-fsanitize" in (BUILD / "CMakeCache.txt").read_text()


def private_mounts():
    """The command under which a process may mount what nobody else sees; none where it may not."""
    for command in (["unshare", "-m"], ["unshare", "-Urm"]):
        try:
            mount = subprocess.run([*command, "mount", "-t", "tmpfs", "none", "/mnt"],
                                   capture_output=True)
        except FileNotFoundError:
            return None
        if mount.returncode == 0:
            return command
    return None


MOUNTS = private_mounts()
needs_mounts = unittest.skipUnless(MOUNTS, "no process may mount here: unshare -m and -Urm fail")


class Faults(Case):
    def setUp(self):
        super().setUp()
        self.write(RUN)

    straight_digest = None

    def straight(self):
        if not Faults.straight_digest:
            self.run_scene("-o", "straight.h5")
            Faults.straight_digest = self.digest("straight.h5")
            (self.folder / "straight.h5").unlink()
        return Faults.straight_digest

    def paused(self, *arguments, at=PAUSE["JOSTLE_FAULT_AT"]):
        """A run that has written checkpoints and waits."""
        process = self.popen("run", "scene.json", *OPTIONS, *arguments,
                             environment={**PAUSE, "JOSTLE_FAULT_PATH": str(self.folder),
                                          "JOSTLE_FAULT_AT": at})
        change = os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
        self.assertEqual(change.si_code, os.CLD_STOPPED, "ended before it was paused")
        return process

    def broken(self, process, says):
        process.send_signal(signal.SIGCONT)
        _, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, BROKEN, err)
        self.assertRegex(err, f"(?m)^jostle: .*{says}")
        return err

    def resume_by(self, err):
        command = err.strip().splitlines()[-1].split()
        self.assertIn("--resume", command, err)
        return self.jostle(*command[1:])

    def in_namespace(self, script, *arguments):
        """A shell script with mounts of its own; `pause` begins a run and pauses it."""
        shim = " ".join(f"{key}={shlex.quote(value)}" for key, value in
                        {**PAUSE, "JOSTLE_FAULT_PATH": str(self.folder / "disk")}.items())
        pause = f"""
            pause() {{
                env {shim} "$JOSTLE" run scene.json "$@" & run=$!
                until grep -q "^State:.T" /proc/$run/status; do sleep 0.005; done
            }}"""
        return subprocess.run([*MOUNTS, "bash", "-euc", pause + script, "bash", *arguments],
                              cwd=self.folder, env={**PLAIN, "JOSTLE": JOSTLE}, text=True,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=120)
