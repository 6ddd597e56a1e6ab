"""Failures of the environment during a run: checkpoints stay, the message has the remedy, and a resume ends with the
digest of an uninterrupted run."""

import hashlib
import os
import pathlib
import resource
import shlex
import shutil
import signal
import subprocess
import time
import unittest

import h5py

from support import (BAD_INPUT, BROKEN, JOSTLE, OK, PLAIN, SHIM, STOPPED, TINY, Case,
                     changed)

# A fifth of a second, with checkpoints all the way, and snapshots that fill disk and memory.
RUN = changed(TINY, realizations=4, spheres=96, relax={"polar": {}, "stop": {"sweeps": 300}},
              protocol=[{"tap": {"dilate": 0.05}, "count": 30}],
              snapshots={"taps": list(range(31))})
del RUN["sweep"]
# A start of many minutes.
GROWTH = {"name": "growth", "seed": 1999, "realizations": 1, "spheres": 20000,
          "container": {"sides": "fully_periodic", "width": 25.4, "height": 25.4},
          "start": {"grow": {}}, "protocol": [{"tap": {"lift": 0}, "count": 1}],
          "relax": {"metropolis": {}, "stop": {"sweeps": 10}}, "observe": [],
          "snapshots": {"taps": [0, 1]}}
SEAL = len("\njostle-sha256 \n") + 64  # the last line of a results file
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


def limit_memory(megabytes):
    """Limit of addresses of this process."""
    resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))


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


class Folders(Faults):
    @needs_mounts
    def test_a_folder_that_cannot_be_written_is_named_before_anything_is_run(self):
        (self.folder / "locked").mkdir()
        ended = self.in_namespace("""
            mount --bind locked locked && mount -o remount,ro,bind locked
            "$JOSTLE" run scene.json -o locked/tiny.h5""")
        self.assertEqual(ended.returncode, BROKEN, ended.stderr)
        self.assertRegex(ended.stderr, r"^jostle: locked/tiny\.h5\.lock: cannot create: Read-only "
                                       r"file system; write to another disk")

    @unittest.skipIf(os.getuid() == 0, "permissions do not bind root")
    def test_a_folder_without_permission_is_named(self):
        locked = self.folder / "locked"
        locked.mkdir(mode=0o555)
        refused = self.run_scene("-o", "locked/tiny.h5", expect=BROKEN)
        self.assertIn("locked/tiny.h5.lock: cannot create: Permission denied; make the folder "
                      "writable", refused.stderr)

    def test_a_folder_that_is_not_there_is_named(self):
        refused = self.run_scene("-o", "nowhere/tiny.h5", expect=BROKEN)
        self.assertIn("nowhere/tiny.h5: there is no folder nowhere", refused.stderr)

    @needs_mounts
    def test_a_folder_that_becomes_read_only_costs_nothing_that_was_checkpointed(self):
        straight = self.straight()
        (self.folder / "disk").mkdir()
        ended = self.in_namespace("""
            pause -o disk/tiny.h5 "$@"
            mount -t tmpfs -o ro none disk/tiny.h5.parts  # hides the files of the folder
            kill -CONT $run
            wait $run""", *OPTIONS)
        self.assertEqual(ended.returncode, BROKEN, ended.stderr)
        # Or a file between its writing and its renaming is hidden by the mount.
        self.assertRegex(ended.stderr, "(?m)^jostle: disk/tiny.h5.*(Read-only file system|"
                                       "No such file or directory)")
        self.resume_by(ended.stderr)
        self.assertEqual(self.digest("disk/tiny.h5"), straight)

    @needs_mounts
    def test_a_disk_that_fills_under_a_run_costs_nothing_that_was_checkpointed(self):
        straight = self.straight()
        (self.folder / "disk").mkdir()
        ended = self.in_namespace("""
            mount -t tmpfs -o size=16m none disk
            pause -o disk/tiny.h5 "$@"
            cat /dev/zero >disk/ballast 2>/dev/null || true
            kill -CONT $run
            code=0; wait $run || code=$?
            test $code -eq 4
            "$JOSTLE" info disk/tiny.h5 >/dev/null
            rm disk/ballast
            "$JOSTLE" run scene.json -o disk/tiny.h5 "$@" --resume --quiet
            "$JOSTLE" info disk/tiny.h5 --digest
            ls disk""", *OPTIONS)
        self.assertEqual(ended.returncode, OK, ended.stderr)
        self.assertIn("No space left on device; free some space, or write elsewhere", ended.stderr)
        self.assertEqual(ended.stdout.split(), [straight, "tiny.h5"])


    def test_a_plan_that_no_disk_holds_is_run_to_its_time_limit_or_refused(self):
        self.write(changed(TINY, name="long", protocol=[{"tap": {"dilate": 0.05}, "count": 1000000000}],
                           snapshots={"taps": [0]}))
        refused = self.run_scene(expect=BROKEN)
        self.assertIn("of disk may be needed", refused.stderr)
        self.assertIn("or give the run a time limit", refused.stderr)
        self.run_scene("--time-limit", "1s", expect=STOPPED)
        refused = self.run_scene("--resume", expect=BROKEN)
        self.assertIn("of disk may be needed", refused.stderr)
        self.run_scene("--resume", "--time-limit", "1s", expect=STOPPED)
        self.assertEqual(self.info("long.h5")["state"], "interrupted")

    @needs_mounts
    def test_a_merge_that_does_not_fit_is_refused_before_it_is_written(self):
        for share in ("1/2", "2/2"):
            self.run_scene("--shard", share, "-o", f"{share[0]}.h5")
        (self.folder / "disk").mkdir()
        ended = self.in_namespace("""
            mount -t tmpfs -o size=64k none disk
            code=0; "$JOSTLE" merge 1.h5 2.h5 -o disk/all.h5 || code=$?
            ls disk
            exit $code""")
        self.assertEqual((ended.returncode, ended.stdout), (BROKEN, ""), ended.stderr)
        self.assertRegex(ended.stderr,
                         r"^jostle: disk/all\.h5: \S+ MB of disk may be needed, but only "
                         r"\S+ MB are free; free some space or write elsewhere")
        self.jostle("merge", "1.h5", "2.h5", "-o", "all.h5")
        self.assertEqual(self.digest("all.h5"), self.straight())


class Removed(Faults):
    def test_a_results_file_that_is_removed_under_a_run_is_written_whole_in_the_end(self):
        straight = self.straight()
        process = self.paused()
        (self.folder / "tiny.h5").unlink()
        process.send_signal(signal.SIGCONT)
        _, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, OK, err)
        self.assertEqual(self.digest("tiny.h5"), straight)

    def test_checkpoints_that_are_removed_under_a_run_end_it_and_it_is_done_again(self):
        straight = self.straight()
        process = self.paused()
        # Into a name of their own at one stroke: removed file by file, new ones would appear.
        (self.folder / "tiny.h5.parts").rename(self.folder / "gone")
        err = self.broken(process, r"tiny\.h5\.parts.*No such file or directory")
        self.resume_by(err)
        self.assertEqual(self.digest("tiny.h5"), straight)

    def test_what_is_restored_is_gone_on_from(self):
        straight = self.straight()
        process = self.paused()
        parts, gone = self.folder / "tiny.h5.parts", self.folder / "gone"
        parts.rename(gone)
        err = self.broken(process, "No such file or directory")
        shutil.rmtree(parts, ignore_errors=True)
        gone.rename(parts)
        self.resume_by(err)
        self.assertEqual(self.digest("tiny.h5"), straight)


class Limits(Faults):
    def test_a_limit_on_file_sizes_is_said_and_costs_nothing_that_was_checkpointed(self):
        straight = self.straight()
        process = self.paused()
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (8192, 8192))
        err = self.broken(process, "File too large; raise the limit on file sizes")
        self.resume_by(err)
        self.assertEqual(self.digest("tiny.h5"), straight)

    def test_force_takes_nothing_away_before_its_file_is_written(self):
        self.run_scene("-o", "straight.h5")
        straight = self.digest("straight.h5")
        process = self.paused()
        process.kill()
        process.wait()
        parts = sorted(path.name for path in (self.folder / "tiny.h5.parts").iterdir())
        self.assertTrue(parts)
        limit = "ulimit -f 4; "  # 4 kB: less than the file of a run that begins
        for command in (f"{limit} exec {JOSTLE} run scene.json --force --quiet",
                        f"{limit} exec {JOSTLE} merge straight.h5 -o tiny.h5 --force"):
            with self.subTest(command=command):
                ended = subprocess.run(["bash", "-c", command], cwd=self.folder, env=PLAIN, text=True,
                                       capture_output=True)
                self.assertEqual(ended.returncode, BROKEN, ended.stderr)
                self.assertIn("File too large", ended.stderr)
                self.assertEqual(parts, sorted(
                    path.name for path in (self.folder / "tiny.h5.parts").iterdir()))
        self.jostle("run", "scene.json", "--resume", "--quiet")
        self.assertEqual(self.digest("tiny.h5"), straight)

    def run_within(self, room):
        """A run that may take `room` bytes of addresses more than it has when it is paused."""
        process = self.paused("--force", "--quiet")
        pages = int(pathlib.Path(f"/proc/{process.pid}/statm").read_text().split()[0])
        limit = pages * resource.getpagesize() + room
        resource.prlimit(process.pid, resource.RLIMIT_AS, (limit, limit))
        return process

    @unittest.skipIf(INSTRUMENTED, "a sanitizer takes all addresses for itself")
    def test_memory_that_runs_out_under_a_run_is_said_and_fails_no_realization(self):
        straight = self.straight()
        for room in (0, 400_000, 2_000_000, 8_000_000):
            with self.subTest(room=room):
                err = self.broken(self.run_within(room), "out of memory; raise the limit")
                self.resume_by(err)
                self.assertEqual(self.digest("tiny.h5"), straight)

    def least_memory(self):
        """Memory of a process that only prints its version, to a megabyte."""
        least, most = 0, 1 << 10
        while most - least > 1:
            middle = (least + most) // 2
            ended = subprocess.run([JOSTLE, "--version"], env=PLAIN, capture_output=True,
                                   preexec_fn=lambda: limit_memory(middle))
            least, most = (least, middle) if ended.returncode == OK else (middle, most)
        return most

    @unittest.skipIf(INSTRUMENTED, "a sanitizer takes all addresses for itself")
    def test_a_run_that_finds_too_little_memory_to_begin_says_so(self):
        least = self.least_memory()
        for room in (3, 6, 9):
            with self.subTest(room=room):
                ended = subprocess.run(
                    [JOSTLE, "run", "scene.json", "--no-progress", "--threads", "4"],
                    env=PLAIN, cwd=self.folder, capture_output=True, text=True,
                    preexec_fn=lambda: limit_memory(least + room))
                self.assertEqual(ended.returncode, BROKEN, ended.stderr)
                self.assertRegex(ended.stderr, "(?m)^jostle: .*(out of memory|cannot start a "
                                               "thread|pthread_create).*; raise the limit")
                self.assertNotIn("tiny.h5.lock", self.files())
                self.run_scene("--resume")
                self.assertEqual(self.digest("tiny.h5"), self.straight())
                (self.folder / "tiny.h5").unlink()


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
                seal = hashlib.sha256(data).hexdigest()
                path.write_bytes(data + f"\njostle-sha256 {seal}\n".encode())
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
