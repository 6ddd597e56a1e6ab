"""Several processes that store into one results file at once: each waits for the others, and what was not
stored is an exit code."""

import fcntl
import inspect
import json
import os
import subprocess
import sys
import time
import unittest

import h5py

from support import BROKEN, JOSTLE, OK, PLAIN, PORTABLE, SOURCE, TINY, Case, changed

sys.path.insert(0, str(SOURCE / "python"))
import jostle  # noqa: E402

HOST = os.uname().nodename
FIT = ("fit", "tiny.h5", "--observable", "mean_height")
STORING = (("fit", "tiny.h5", "--observable", "mean_height", "--model", "kww"),
           ("analyse", "tiny.h5", "steady", "--observable", "mean_height"),
           ("structure", "tiny.h5", "--part", "profile"))
OTHERS = (("run", "scene.json", "--no-progress", "--resume"),
          ("merge", "copy.h5", "-o", "tiny.h5", "--force"),
          ("export", "copy.h5", "--format", "results", "-o", "tiny.h5", "--force"))


def start_time(pid):
    """Field 22 of /proc/PID/stat, which a portable build does not read."""
    if PORTABLE:
        return 1
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:
        return file.read().rsplit(")", 1)[1].split()[19]


class Waiting(Case):
    def setUp(self):
        super().setUp()
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}], snapshots={"taps": [0, 40]}))
        self.run_scene()
        (self.folder / "copy.h5").write_bytes((self.folder / "tiny.h5").read_bytes())

    def hold(self, purpose="", name="tiny.h5.lock"):
        """The lock as another process of this host has it."""
        lock = open(self.folder / name, "w", encoding="ascii")
        fcntl.flock(lock, fcntl.LOCK_EX)
        lock.write(f"{os.uname().nodename} {os.getpid()} {start_time(os.getpid())}{purpose}\n")
        lock.flush()
        self.addCleanup(lock.close)
        return lock

    def release(self, lock):
        (self.folder / "tiny.h5.lock").unlink()
        lock.close()

    def tables(self, name="tiny.h5"):
        return self.info(name)["tables"]

    def test_all_of_many_fits_at_once_are_stored(self):
        held = self.hold(" storing")
        fits = [self.popen(*FIT, "--law", "a + b*log(t)", "--start", "a=1,b=1", "--law-name", f"law{i}",
                           "--sweep-point", i % 2, "--threads", 1) for i in range(8)]
        others = [self.popen("analyse", "tiny.h5", "steady", "--observable", "mean_height"),
                  self.popen("structure", "tiny.h5", "--part", "profile", "--sweep-point", 0)]
        time.sleep(0.5)  # most of them wait by now
        self.release(held)
        for process in fits + others:
            out, err = process.communicate(timeout=600)
            self.assertEqual(process.returncode, OK, err)
        tables = self.tables()
        for i in range(8):
            self.assertIn(f"fits/point_{i % 2:04}/mean_height/law{i}", tables)
        self.assertEqual({name.split("/")[0] for name in tables}, {"fits", "analysis", "structure"})
        self.assertEqual([name for name in self.files() if "lock" in name or "tmp" in name], [])
        with h5py.File(self.folder / "tiny.h5") as file:
            self.assertEqual(len(file["fits/point_0000/mean_height"]), 4)

    def test_what_is_not_stored_is_an_exit_code(self):
        before = (self.folder / "tiny.h5").read_bytes()
        self.hold(" storing")
        for command in STORING:
            with self.subTest(command):
                done = self.jostle(*command, "--wait", "0.2s", expect=BROKEN)
                self.assertIn("the tables are not stored", done.stderr)
                self.assertIn(f"process {os.getpid()} on host {HOST} is storing tables in this file, still after "
                              "0.2 s", done.stderr)
                self.assertIn("--wait", done.stderr)
                self.assertGreater(len(done.stdout), 100)
                self.jostle(*command, "--no-store")
        self.assertIn("still after 0.2 s", self.jostle("info", "--reseal", "tiny.h5", "--wait", "0.2s",
                                                       expect=BROKEN).stderr)
        for command in OTHERS:
            self.assertIn("still after 0.2 s", self.jostle(*command, "--wait", "0.2s", expect=BROKEN).stderr)
        self.assertEqual((self.folder / "tiny.h5").read_bytes(), before)

    def test_a_run_is_named_at_once_and_waited_for_where_that_is_asked_for(self):
        self.hold()
        for command in (*STORING, *OTHERS, ("info", "--reseal", "tiny.h5")):
            with self.subTest(command):
                done = self.jostle(*command, expect=BROKEN)
                self.assertIn(f"process {os.getpid()} on host {HOST} is working on this file; wait for it, or stop it",
                              done.stderr)
                for asked in ({"JOSTLE_WAIT": "100ms"}, {}):
                    words = () if asked else ("--wait", "100ms")
                    done = self.jostle(*command, *words, environment=asked, expect=BROKEN)
                    self.assertIn("waiting up to 0.1 s", done.stderr)
                    self.assertIn("still after 0.1 s", done.stderr)

    def test_a_run_that_ends_meanwhile(self):
        for command in STORING:
            held = self.hold()
            process = self.popen(*command, "--wait", "10m")
            line = process.stderr.readline()
            self.assertIn("waiting up to 600 s", line)
            self.release(held)
            _, err = process.communicate(timeout=600)
            self.assertEqual(process.returncode, OK, err)
        self.assertGreater(len(self.tables()), 3)

    def test_tables_of_other_data_are_not_stored(self):
        """Those of the data before a run that the command has waited for."""
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 50}], snapshots={"taps": [0, 40]}))
        (self.folder / "longer.h5").write_bytes((self.folder / "copy.h5").read_bytes())
        self.jostle("run", "scene.json", "--resume", "--no-progress", "-o", "longer.h5")
        for command in STORING:
            (self.folder / "tiny.h5").write_bytes((self.folder / "copy.h5").read_bytes())
            held = self.hold()
            process = self.popen(*command, "--wait", "10m")
            self.assertIn("waiting up to 600 s", process.stderr.readline())
            (self.folder / "tiny.h5").write_bytes((self.folder / "longer.h5").read_bytes())
            self.release(held)
            _, err = process.communicate(timeout=600)
            self.assertEqual(process.returncode, BROKEN, err)
            self.assertIn("its data have changed since they were read; run the command again", err)
            self.assertEqual(self.tables(), [])

    def test_a_file_that_cannot_be_changed(self):
        (self.folder / "tiny.h5").chmod(0o444)
        for command in STORING:
            self.assertIn("write-protected", self.jostle(*command, expect=BROKEN).stderr)
            self.jostle(*command, "--no-store")

    def test_durations_that_are_none(self):
        for wrong in ("soon", "-1", ""):
            self.assertIn("--wait", self.jostle(*FIT, "--wait", wrong, expect=2).stderr)

    def test_python_gives_the_tables_and_warns(self):
        self.hold()
        with self.assertWarnsRegex(UserWarning, "not stored"):
            tables = jostle.analyse(self.folder / "tiny.h5", "steady", "mean_height", program=JOSTLE)
        self.assertEqual(len(tables), 2)

    def test_python_waits_as_long_as_it_is_told_to(self):
        self.hold(" storing")
        path, given = self.folder / "tiny.h5", {"wait": "0.2s", "program": JOSTLE}
        for store in (lambda: jostle.fit(path, "mean_height", model="kww", **given),
                      lambda: jostle.analyse(path, "steady", "mean_height", **given),
                      lambda: jostle.structure(path, part=["profile"], **given)):
            with self.assertWarnsRegex(UserWarning, r"still after 0\.2 s"):
                store()
        scene = json.loads((self.folder / "scene.json").read_text())
        single = {key: value for key, value in scene.items() if key != "sweep"}
        for write in (lambda: jostle.run(scene, path, resume=True, **given),
                      lambda: jostle.cost(single, path, replicates=2, taps=1, force=True, **given),
                      lambda: jostle.export(self.folder / "copy.h5", path, format="results", force=True, **given)):
            with self.assertRaisesRegex(jostle.ProgramError, r"still after 0\.2 s"):
                write()

    def test_every_function_waits_whose_command_does(self):
        for name in ("run", "cost", "fit", "analyse", "structure", "export"):
            with self.subTest(name):
                self.assertIn("--wait", self.jostle(name, "--help").stdout)
                self.assertIn("wait", inspect.signature(getattr(jostle, name)).parameters)
        for name in ("report", "check"):
            self.assertNotIn("--wait", self.jostle(name, "--help").stdout)

    def test_names_of_locks_are_of_whole_files(self):
        """The lock of one file keeps nobody from another."""
        self.hold()
        done = subprocess.run([JOSTLE, "fit", "copy.h5", "--observable", "mean_height", "--json"], cwd=self.folder,
                              env=PLAIN, capture_output=True, text=True, check=True)
        self.assertEqual(len(json.loads(done.stdout)["curves"]), 2)


if __name__ == "__main__":
    unittest.main()
