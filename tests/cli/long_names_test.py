"""Results whose names are as long as the file system allows, names that are longer, and why a file cannot be
written: the advice depends on the cause."""

import os
import shutil
import subprocess
import sys
import unittest

from support import (BAD_INPUT, BROKEN, EVERY, JOSTLE, OK, PLAIN, SHIM, SLOW, SOURCE, STOPPED, TINY, Case, changed,
                     some)

sys.path.insert(0, str(SOURCE / "python"))
import jostle  # noqa: E402

LONGEST = 255


def name_of(size, letter="n", ending=".h5"):
    """A name of so many bytes."""
    letters = (size - len(ending)) // len(letter.encode())
    name = letter * letters
    return name + "x" * (size - len(ending) - len(name.encode())) + ending


class Names(Case):
    def setUp(self):
        super().setUp()
        self.write(TINY)

    def test_names_of_every_length_that_a_folder_takes(self):
        self.run_scene("-o", "short.h5")
        digest = self.digest("short.h5")
        sizes = some((236, 237, 242, 243, 246, 249, 250, 251, LONGEST), 4)
        for name in (*map(name_of, sizes), name_of(LONGEST, "\N{GREEK SMALL LETTER PHI}"), name_of(LONGEST - 1, "\N{SNOWMAN}")):
            with self.subTest(size=len(name.encode())):
                self.run_scene("-o", name)
                self.assertEqual(self.digest(name), digest)
                self.jostle("fit", name, "--observable", "mean_height", "--model", "inverse_log")
                self.assertEqual(len(self.info(name)["tables"]), 2)
                self.jostle("merge", "short.h5", "-o", name, "--force")
                self.jostle("export", name, "--format", "results", "-o", name_of(LONGEST, "c"), "--force")
                self.assertEqual(self.digest(name_of(LONGEST, "c")), digest)
                left = [file for file in self.files() if file.endswith((".tmp", ".lock", ".parts"))]
                self.assertEqual(left, [])

    def test_a_run_with_the_longest_name_is_killed_and_goes_on(self):
        self.write(SLOW)
        self.run_scene("-o", "straight.h5")
        for size in (243, LONGEST) if EVERY else (LONGEST,):
            name = name_of(size)
            process = self.popen("run", "scene.json", "--no-progress", "-o", name, "--checkpoint-every", "50ms")
            while not list(self.folder.glob("*/p0000_r00000.state")):
                self.assertIsNone(process.poll())
            refused = self.run_scene("--resume", "-o", name, expect=BROKEN)
            self.assertIn(f"process {process.pid}", refused.stderr)
            process.kill()
            process.communicate()
            self.assertGreater(self.info(name)["bytes"]["parts"], 0)
            with self.assertWarnsRegex(UserWarning, "live=True"):
                jostle.open(self.folder / name, program=JOSTLE).close()
            other = name_of(size, "m")  # a different beginning, and one that differs at its end
            self.assertFalse((self.folder / other).exists())
            self.run_scene("--resume", "-o", name)
            self.assertEqual(self.digest(name), self.digest("straight.h5"))
            self.assertEqual([file for file in self.files() if "~" in file], [])

    def test_names_that_differ_at_their_ends_only(self):
        one, other = name_of(LONGEST), name_of(LONGEST)[:-4] + "m.h5"
        self.run_scene("-o", one)
        self.write(changed(TINY, seed=1))
        self.run_scene("-o", other)
        self.assertNotEqual(self.digest(one), self.digest(other))

    def test_a_name_that_is_too_long_is_refused_before_anything_is_computed(self):
        self.run_scene("-o", "tiny.h5")
        name = name_of(LONGEST + 1)
        before = self.files()
        for command in (["run", "scene.json", "-o", name],
                        ["run", "scene.json", "-o", name, "--resume"],
                        ["merge", "tiny.h5", "-o", name],
                        ["cost", "scene.json", "-o", name],
                        ["fit", "tiny.h5", "--observable", "mean_height", "--csv", name],
                        ["analyse", "tiny.h5", "--csv", name, "steady", "--observable", "mean_height"],
                        ["structure", "tiny.h5", "--csv", name],
                        ["report", "tiny.h5", "-o", name],
                        ["export", "tiny.h5", "--format", "results", "-o", name],
                        ["export", "tiny.h5", "--format", "extxyz", "-o", name],
                        ["export", "tiny.h5", "--format", "h5md", "-o", name]):
            with self.subTest(command):
                refused = self.jostle(*command, expect=None)
                self.assertIn(refused.returncode, (BAD_INPUT, BROKEN))
                self.assertIn("256 bytes", refused.stderr)
                self.assertIn("255", refused.stderr)
                self.assertEqual(refused.stdout, "")
                self.assertEqual(self.files(), before)

    def test_frames_are_all_written_or_none(self):
        self.run_scene("-o", "tiny.h5")
        before = self.files()
        for size in (236, 240, 246, 247, 248, 249, 250, 251, LONGEST, LONGEST + 1):
            name = name_of(size, ending=".vtp")
            with self.subTest(size=size):
                done = self.jostle("export", "tiny.h5", "--format", "vtp", "--tap", "all", "-o", name, expect=None)
                stem = name[:-4]
                frames = [f"{stem}.pvd", f"{stem}_tap0.vtp", f"{stem}_tap4.vtp"]
                if max(map(len, frames)) <= LONGEST:
                    self.assertEqual(done.returncode, OK, done.stderr)
                    self.assertEqual(self.files(), sorted(before + frames))
                    for frame in frames:
                        (self.folder / frame).unlink()
                else:
                    self.assertEqual(done.returncode, BROKEN)
                    self.assertIn("255", done.stderr)
                    self.assertEqual(self.files(), before)

    def test_frames_on_a_disk_that_fails_are_all_written_or_none(self):
        self.run_scene("-o", "tiny.h5")
        out = self.folder / "out"
        failures = 0
        for at in range(1, 30):
            shutil.rmtree(out, ignore_errors=True)
            out.mkdir()
            done = self.jostle("export", "tiny.h5", "--format", "vtp", "--tap", "all", "-o", "out/f.vtp", expect=None,
                               environment={**SHIM, "JOSTLE_FAULT_PATH": str(out), "JOSTLE_FAULT_AT": str(at),
                                            "JOSTLE_FAULT_ACTION": "broken"})
            there = sorted(os.listdir(out))
            if done.returncode == OK:
                self.assertEqual(there, ["f.pvd", "f_tap0.vtp", "f_tap4.vtp"])
            else:
                failures += 1
                self.assertEqual(done.returncode, BROKEN, done.stderr)
                self.assertIn(there, ([], ["f.pvd", "f_tap0.vtp", "f_tap4.vtp"]))
        self.assertGreater(failures, 5)


class ReadOnlyDisk(Case):
    """A file system that is mounted read-only, in a namespace of its own."""

    def mounted(self, *command):
        disk = self.folder / "disk"
        script = ('mount -t tmpfs none "$0" && cp tiny.h5 "$0/tiny.h5" && mount -o remount,ro "$0" && '
                  'exec "$@"')
        return subprocess.run(["unshare", "-rm", "sh", "-c", script, str(disk), JOSTLE, *command], cwd=self.folder,
                              env=PLAIN, capture_output=True, text=True)

    def test_advice_on_a_read_only_disk(self):
        self.write(TINY)
        self.run_scene()
        (self.folder / "disk").mkdir()
        if subprocess.run(["unshare", "-rm", "true"], capture_output=True).returncode != 0:
            self.skipTest("no namespaces of mounts here")
        for command in (["fit", "disk/tiny.h5", "--observable", "mean_height", "--model", "inverse_log"],
                        ["run", "scene.json", "--force", "-o", "disk/tiny.h5"],
                        ["run", "scene.json", "-o", "disk/new.h5"],
                        ["merge", "tiny.h5", "-o", "disk/tiny.h5", "--force"],
                        ["report", "tiny.h5", "-o", "disk/page.html"],
                        ["export", "tiny.h5", "--format", "extxyz", "-o", "disk/a.xyz"]):
            with self.subTest(command):
                refused = self.mounted(*command)
                self.assertEqual(refused.returncode, BROKEN, refused.stderr)
                self.assertRegex(refused.stderr.lower(), "read-only file\\s+system")
                self.assertRegex(refused.stderr, "another\\s+disk")
                self.assertNotIn("chmod", refused.stderr)
                self.assertNotIn("make the folder writable", refused.stderr)

    def test_advice_on_a_file_that_is_protected(self):
        self.write(TINY)
        self.run_scene()
        (self.folder / "tiny.h5").chmod(0o444)
        self.assertIn("chmod u+w", self.run_scene("--force", expect=BROKEN).stderr)


if __name__ == "__main__":
    unittest.main()
