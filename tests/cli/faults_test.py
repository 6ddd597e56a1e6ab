"""Failures of the environment during a run: checkpoints stay, the message has the remedy, and a resume ends with the
digest of an uninterrupted run."""

import os
import pathlib
import resource
import shutil
import signal
import subprocess
import unittest

from paused_runs import INSTRUMENTED, OPTIONS, Faults, needs_mounts
from support import BROKEN, JOSTLE, OK, PLAIN, STOPPED, TINY, changed


def limit_memory(megabytes):
    """Limit of addresses of this process."""
    resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))


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


if __name__ == "__main__":
    unittest.main()
