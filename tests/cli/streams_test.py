"""Input is read from a whole file, and output reaches its reader completely, or the exit code reports it: every read
of an input and every write to standard output fails once, is short, or is
interrupted. And nothing that a terminal takes for a command leaves the program."""

import json
import os
import re
import subprocess
import unittest

from support import (BAD_INPUT, BROKEN, JOSTLE, OK, PLAIN, SHIM, TINY, Case, changed, some)

SMALL = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}], snapshots={"taps": [0, 12]},
                description="a scene")
del SMALL["sweep"]
CURVE = "t,X\n" + "".join(f"{t},{0.6 + 0.05 / (1 + t)}\n" for t in range(4000))
# libhdf5 leaks a few bytes where a read fails.
SHIM = {**SHIM, "ASAN_OPTIONS": SHIM["ASAN_OPTIONS"] + ":detect_leaks=0"}
ACTIONS = ("broken", "shortened", "interrupted")


class Streams(Case):
    def setUp(self):
        super().setUp()
        self.write(SMALL)
        self.run_scene()
        self.write(CURVE, "curve.csv")
        self.jostle("export", "tiny.h5", "--format", "extxyz", "--tap", "all")
        self.write(changed(SMALL, start={"file": {"path": "tiny.xyz"}}), "from_xyz.json")
        self.write('{"profile": {}}' + " " * 20000, "settings.json")

    def faulty(self, command, of, **fault):
        """Exit code and both outputs; times of computing are no part of them."""
        count = self.folder / "count"
        environment = {**PLAIN, **SHIM, "JOSTLE_FAULT_OF": of, "JOSTLE_FAULT_COUNT": str(count),
                       **{f"JOSTLE_FAULT_{key.upper()}": str(value) for key, value in fault.items()}}
        done = subprocess.run([JOSTLE, *command], cwd=self.folder, env=environment, text=True,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=120)
        self.assertGreaterEqual(done.returncode, 0, f"{command} {fault} was killed")
        times = re.compile(r'"(started|command_line|seconds)": .*|^(this run|\d+ done).*|trials/s.*', re.M)
        return done.returncode, times.sub("", done.stdout), done.stderr, int(count.read_text())

    # Readers and what they read.
    INPUTS = (("check", "scene.json", "--no-pilot"),
              ("check", "from_xyz.json", "--no-pilot"),
              ("fit", "curve.csv", "--model", "inverse_log"),
              ("structure", "tiny.xyz", "--part", "profile", "--json"),
              ("structure", "tiny.h5", "--part", "profile", "--settings", "settings.json",
               "--no-store", "--json"),
              ("info", "tiny.h5", "--digest"),
              ("analyse", "tiny.h5", "steady", "--observable", "mean_height", "--no-store", "--json"))

    def test_a_failed_read_is_never_the_end_of_an_input(self):
        tried = 0
        for command in self.INPUTS:
            code, out, _, calls = self.faulty(command, "reads", path=self.folder)
            self.assertEqual(code, OK, command)
            self.assertGreater(calls, 0)
            for action in ACTIONS:
                for at in some(range(1, calls + 1, max(1, calls // 8)), 2):
                    with self.subTest(command=command, action=action, at=at):
                        tried += 1
                        found, shown, err, made = self.faulty(command, "reads", path=self.folder,
                                                              action=action, at=at)
                        # The digest's child process counts its reads apart: a refusal shows that one failed.
                        if action == "broken" and (made >= at or found != OK):
                            self.assertIn(found, (BAD_INPUT, BROKEN))
                            self.assertRegex(err, "(?m)^jostle: .*(Input/output error|HDF5)")
                        else:
                            self.assertEqual((found, shown), (OK, out))
        print(f"{tried} faults of reads")

    OUTPUTS = (("--version",), ("--help",), ("run", "--help"), ("schema",),
               ("check", "scene.json", "--no-pilot"), ("info", "tiny.h5"),
               ("info", "tiny.h5", "--json"), ("info", "tiny.h5", "--digest"),
               ("fit", "curve.csv", "--model", "inverse_log"),
               ("fit", "curve.csv", "--model", "inverse_log", "--json"),
               ("analyse", "tiny.h5", "steady", "--observable", "mean_height"),
               ("analyse", "tiny.h5", "steady", "--observable", "mean_height", "--json"),
               ("structure", "tiny.h5", "--part", "profile"),
               ("structure", "tiny.h5", "--part", "profile", "--json"),
               ("export", "tiny.h5", "--format", "vtp", "--force"),
               ("merge", "tiny.h5", "-o", "merged.h5", "--force"),
               ("run", "scene.json", "--no-progress", "--force", "-o", "again.h5"))

    def test_output_that_is_lost_is_said_by_the_exit_code(self):
        tried = 0
        for command in some(self.OUTPUTS, 6):
            code, out, _, calls = self.faulty(command, "output")
            self.assertEqual(code, OK, command)
            self.assertGreater(calls, 0, command)
            for action in ACTIONS:
                for at in {1, calls}:
                    with self.subTest(command=command, action=action, at=at):
                        tried += 1
                        found, shown, err, _ = self.faulty(command, "output", action=action, at=at)
                        if action == "broken":
                            self.assertEqual(found, BROKEN)
                            self.assertIn("jostle: cannot write to standard output: Input/output "
                                          "error", err)
                        else:
                            self.assertEqual((found, shown), (OK, out))
        print(f"{tried} faults of standard output")

    def test_a_full_disk_under_standard_output_is_an_error_of_every_command(self):
        for command in self.OUTPUTS:
            with self.subTest(command=command), open("/dev/full", "w") as full:
                done = subprocess.run([JOSTLE, *command], cwd=self.folder, env=PLAIN, text=True,
                                      stdin=subprocess.DEVNULL, stdout=full,
                                      stderr=subprocess.PIPE, timeout=120)
                self.assertEqual(done.returncode, BROKEN, done.stderr)
                self.assertIn("cannot write to standard output: No space left on device",
                              done.stderr)
        self.assertEqual(self.digest("again.h5"), self.digest("tiny.h5"))  # and it is stored

    def test_a_reader_that_stops_early_is_no_error_of_any_command(self):
        for command in self.OUTPUTS:
            with self.subTest(command=command):
                reader, writer = os.pipe()
                os.close(reader)
                done = subprocess.run([JOSTLE, *command], cwd=self.folder, env=PLAIN, text=True,
                                      stdin=subprocess.DEVNULL, stdout=writer,
                                      stderr=subprocess.PIPE, timeout=120)
                os.close(writer)
                self.assertEqual(done.returncode, OK, done.stderr)
                self.assertNotIn("standard output", done.stderr)
        self.assertEqual(self.digest("again.h5"), self.digest("tiny.h5"))  # and it is stored


class Pipes(Case):
    def setUp(self):
        super().setUp()
        self.write(SMALL)

    def test_a_scene_and_a_curve_may_come_from_a_pipe(self):
        self.write(CURVE, "curve.csv")
        for script in ('"$0" check <(cat scene.json) --no-pilot',
                       '"$0" fit <(cat curve.csv) --model inverse_log'):
            with self.subTest(script=script):
                piped = subprocess.run(["bash", "-c", script, JOSTLE], cwd=self.folder, env=PLAIN,
                                       capture_output=True, text=True, timeout=60)
                self.assertEqual(piped.returncode, OK, piped.stderr)
        whole = self.jostle("fit", "curve.csv", "--model", "inverse_log").stdout
        self.assertEqual(piped.stdout.splitlines()[1:], whole.splitlines()[1:])

    def test_a_pipe_where_a_page_or_a_figure_goes_by_itself_is_refused(self):
        self.run_scene()
        os.mkfifo(self.folder / "tiny.html")
        refused = self.jostle("report", "tiny.h5", "--force", expect=BAD_INPUT).stderr
        self.assertIn("tiny.html is a pipe", refused)
        (self.folder / "figures").mkdir()
        os.mkfifo(self.folder / "figures/mean-height.svg")
        refused = self.jostle("report", "tiny.h5", "--figures", "figures", "--force",
                              expect=BAD_INPUT).stderr
        self.assertIn("mean-height.svg is a pipe", refused)

    def test_text_without_an_end_is_refused_before_it_fills_the_memory(self):
        for name, size, command, code in (("long.json", 300, "check", BAD_INPUT),
                                          ("long.csv", 100, "fit", BROKEN),
                                          ("long.xyz", 100, "structure", BROKEN)):
            with self.subTest(name=name):
                (self.folder / name).touch()
                os.truncate(self.folder / name, size << 20)
                refused = self.jostle(command, name, expect=code).stderr
                self.assertIn("no text that jostle reads", refused)

    def test_a_pipe_in_the_place_of_a_file_is_refused_and_not_waited_for(self):
        os.mkfifo(self.folder / "pipe.xyz")
        os.mkfifo(self.folder / "pipe.h5")
        for name in ("pipe.xyz", "pipe.h5"):
            self.write(changed(SMALL, start={"file": {"path": name}}), "from.json")
            refused = self.jostle("check", "from.json", "--no-pilot", expect=BAD_INPUT)
            self.assertRegex(refused.stderr, rf"{name}: .*not a file")
        self.run_scene()
        for name in ("lock", "parts"):
            (self.folder / f"tiny.h5.{name}").unlink(missing_ok=True)
            os.mkfifo(self.folder / f"tiny.h5.{name}")
            refused = self.run_scene("--force", expect=BROKEN)
            self.assertRegex(refused.stderr, rf"tiny\.h5\.{name}: is no .*jostle")
            (self.folder / f"tiny.h5.{name}").unlink()


class Starts(Case):
    def test_a_start_from_another_container_is_refused(self):
        self.write(SMALL)
        self.run_scene()
        self.jostle("export", "tiny.h5", "--format", "extxyz")
        xyz = (self.folder / "tiny.xyz").read_text()
        self.write(xyz.replace('Lattice="4 ', 'Lattice="4.5 '), "wider.xyz")
        self.write(xyz.replace("container=periodic", "container=walls").replace('pbc="T T F"', 'pbc="F F F"'),
                   "walled.xyz")
        self.write(xyz.replace('Lattice="4 ', 'Lattice="4.0000001 '), "rounded.xyz")
        for name, code in (("tiny.xyz", OK), ("rounded.xyz", OK), ("tiny.h5", OK),
                           ("wider.xyz", BAD_INPUT), ("walled.xyz", BAD_INPUT)):
            with self.subTest(name=name):
                self.write(changed(SMALL, start={"file": {"path": name}}), "from.json")
                done = self.jostle("check", "from.json", "--no-pilot", expect=code)
                if code != OK:
                    self.assertIn(f"{name} holds a packing of another container", done.stderr)

    def test_extended_xyz_is_read_within_bounds(self):
        def frame(lattice='4 0 0 0 4 0 0 0 4', count="1", rest="", row="X 1 2 3"):
            return f'{count}\nLattice="{lattice}" pbc="T T F"{rest}\n{row}\n'
        bad = {"sides": frame("1e160 0 0 0 4 0 0 0 4"), "not 10000000": frame("4 0 0 0 1e7 0 0 0 4"),
               "above 0": frame("4 0 0 0 -4 0 0 0 4"), "farther than": frame(row="X 1 2 1e20"),
               "too few columns": frame(rest=" Properties=species:S:1:pos:R:3:radius:R:1",
                                        row="X 1 2 3"),
               "too many columns": frame(rest=" Properties=species:S:1:pos:R:3", row="X 1 2 3 4"),
               "are more than 10000000": frame(count="99999999999"),
               "more than 1000 columns": frame(rest=" Properties=a:R:99999999999:pos:R:3")}
        for says, text in bad.items():
            with self.subTest(says=says):
                self.write(text, "a.xyz")
                refused = self.jostle("structure", "a.xyz", "--part", "order", expect=BROKEN)
                self.assertRegex(refused.stderr, rf"^jostle: a\.xyz: line \d+: .*{says}")

    def test_faults_are_counted_and_not_all_printed(self):
        self.write(changed(SMALL, sweep={"/protocol/0/tap/dilate": ["x"] * 50_000}))
        refused = self.jostle("check", "scene.json", expect=BAD_INPUT).stderr
        self.assertLess(len(refused), 20_000)
        self.assertRegex(refused, r"scene\.json: \d+ faults?, nothing was run")
        self.write({**SMALL, **{f"k{i}": 1 for i in range(100_000)}})
        refused = self.jostle("check", "scene.json", expect=BAD_INPUT).stderr
        self.assertIn("more than 1000 keys in one object", refused)
        self.write({**SMALL, **{f"k{i}": 1 for i in range(200)}})
        refused = self.jostle("check", "scene.json", expect=BAD_INPUT).stderr
        self.assertIn("200 faults", refused)
        self.assertIn("... and 150 more", refused)
        self.assertEqual(len(refused.splitlines()), 52)


class Terminals(Case):
    ESCAPE = "\x1b]0;owned\x07\x1b[2J\x9b31m\x7f\u202e\u200f\u061c"

    def assert_harmless(self, done):
        for name, text in (("stdout", done.stdout), ("stderr", done.stderr)):
            found = re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]",
                              text)
            self.assertIsNone(found, f"{name}: {text!r}")

    def test_no_text_of_a_scene_reaches_the_terminal_as_a_command(self):
        self.write(changed(SMALL, description=self.ESCAPE))
        self.run_scene()
        for command in (["check", "scene.json", "--no-pilot"], ["info", "tiny.h5"],
                        ["run", "scene.json", "--no-progress", "--force"]):
            self.assert_harmless(self.jostle(*command))
        summary = json.loads(self.jostle("info", "tiny.h5", "--json").stdout)
        self.assertEqual(summary["scene"]["description"], self.ESCAPE)  # JSON stays exact
        for scene in (changed(SMALL, start={"file": {"path": f"a{self.ESCAPE}.h5"}}),
                      changed(SMALL, **{self.ESCAPE: 1}), changed(SMALL, name=self.ESCAPE),
                      changed(SMALL, observe=[self.ESCAPE]), {"a\x00b": 1}):
            self.write(scene)
            self.assert_harmless(self.jostle("check", "scene.json", expect=BAD_INPUT))

    def test_no_name_of_a_file_reaches_the_terminal_as_a_command(self):
        self.write(SMALL)
        name = f"a{self.ESCAPE}.h5"
        self.assert_harmless(self.jostle("run", "scene.json", "-o", name))
        for command in (["info", name], ["export", name, "--format", "extxyz"],
                        ["fit", name, "--observable", "mean_height"],
                        ["merge", name, "-o", f"b{name}"]):
            self.assert_harmless(self.jostle(*command))
        for command in (["info", f"no{name}"], ["run", f"no{name}"], ["fit", f"no{name}"],
                        [self.ESCAPE], ["run", "--" + self.ESCAPE]):
            self.assert_harmless(self.jostle(*command, expect=None))

    def test_a_line_of_an_input_with_a_nul_is_quoted_whole(self):
        self.write("1 2\n3 4\0\x1b[2J after\n", "curve.csv")
        refused = self.jostle("fit", "curve.csv", expect=BAD_INPUT)
        self.assertIn(r'"3 4\x00\x1b[2J after"', refused.stderr)
        self.write('1\nLattice="4 0 0 0 4 0 0 0 4" pbc="T T F"\nX 1 2 3\0\x1b4\n', "a.xyz")
        refused = self.jostle("structure", "a.xyz", expect=BROKEN)
        self.assertIn(r'a.xyz: line 3: "3\x00\x1b4" is not a finite number', refused.stderr)

    def test_names_that_are_no_utf8_are_printed_as_json(self):
        self.write(SMALL)
        name = b"a\xff.h5"
        subprocess.run([JOSTLE, "run", "scene.json", "--quiet", "-o", name], cwd=self.folder,
                       env=PLAIN, check=True)
        for command in (["info", name, "--json"],
                        ["fit", name, "--observable", "mean_height", "--json"],
                        ["analyse", name, "steady", "--observable", "mean_height", "--json"]):
            done = subprocess.run([JOSTLE, *command], cwd=self.folder, env=PLAIN,
                                  capture_output=True)
            self.assertIn(done.returncode, (OK, BAD_INPUT), done.stderr)
            json.loads(done.stdout.decode())


class Tables(Case):
    def setUp(self):
        super().setUp()
        self.write(CURVE, "curve.csv")

    def fit(self, *arguments, **keywords):
        return self.jostle("fit", "curve.csv", "--model", "inverse_log", "--csv", "table.csv",
                           "--force", *arguments, **keywords)

    def test_a_table_replaces_the_old_one_whole_or_not_at_all(self):
        table = self.folder / "table.csv"
        table.write_text("old\n")
        table.chmod(0o600)
        environment = {**SHIM, "JOSTLE_FAULT_PATH": str(table), "JOSTLE_FAULT_AT": "1",
                       "JOSTLE_FAULT_ACTION": "no_space"}
        refused = self.fit(expect=BROKEN, environment=environment)
        self.assertIn("No space left on device; free some space, or write elsewhere", refused.stderr)
        self.assertNotIn("resume", refused.stderr)
        self.assertEqual(table.read_text(), "old\n")
        self.fit()
        self.assertTrue(table.read_text().startswith("t,X"))
        self.assertEqual(table.stat().st_mode & 0o777, 0o600)
        self.assertEqual(self.files(), ["curve.csv", "table.csv"])

    def test_a_write_protected_table_is_kept_and_a_link_followed(self):
        table, real = self.folder / "table.csv", self.folder / "real.csv"
        table.write_text("old\n")
        table.chmod(0o444)
        refused = self.fit(expect=BROKEN)
        self.assertIn("table.csv: is write-protected (mode 444)", refused.stderr)
        self.assertEqual(table.read_text(), "old\n")
        table.unlink()
        real.write_text("old\n")
        table.symlink_to("real.csv")
        self.fit()
        self.assertTrue(table.is_symlink())
        self.assertTrue(real.read_text().startswith("t,X"))


if __name__ == "__main__":
    unittest.main()
