"""Output for people: widths, colours, curves and the next commands."""

import fcntl
import os
import pty
import re
import shlex
import struct
import subprocess
import termios
import unittest

from support import EVERY, JOSTLE, PLAIN, TINY, Case, changed, some

# Everything that quickstart observes and keeps, of a small bed.
BED = {**TINY, "sweep": {}, "spheres": 60, "realizations": 4,
       "protocol": [{"tap": {"dilate": 0.05}, "count": 40}],
       "relax": {"polar": {}, "stop": {"mean_height": {"eta": 1e-3, "every_sweeps": 20}}},
       "description": "A bed that is tapped, described at length: " + 20 * "word after word, ",
       "observe": ["mean_height", "bottom_fraction", "corrected_fraction", "bulk_fraction"],
       "snapshots": {"taps": [0, 20, 40]}}
del BED["sweep"]
SWEEP = changed(BED, name="swept", sweep={"/protocol/0/tap/dilate": [0.02, 0.05, 0.1, 0.2]})
UP_AND_DOWN = changed(BED, name="loop", protocol=[
    {"ramp": {"dilate": {"sqrt_from": 0.1, "sqrt_to": 0.3, "sqrt_step": 0.1}}, "count": 10},
    {"ramp": {"dilate": {"sqrt_from": 0.3, "sqrt_to": 0.1, "sqrt_step": 0.1}}, "count": 10}])
LISTING = [["info", "FILE"], ["fit", "FILE", "--observable", "bulk_fraction", "--no-store"],
           ["analyse", "FILE", "steady", "--observable", "mean_height", "--no-store"],
           ["analyse", "FILE", "spectrum", "--observable", "mean_height", "--no-store"],
           ["analyse", "FILE", "ageing", "--observable", "mean_height", "--no-store"],
           ["structure", "FILE", "--no-store"]]
BRAILLE = re.compile("[\u2801-\u28ff]")


class Terminal(Case):
    def at_a_terminal(self, *arguments, columns=80, **environment):
        """Output of the program on a terminal of this width."""
        inner, outer = pty.openpty()
        fcntl.ioctl(outer, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        surroundings = {**PLAIN, "TERM": "xterm", "LC_ALL": "C.UTF-8", **environment}
        surroundings.pop("COLUMNS", None)
        surroundings.pop("NO_COLOR", None)
        surroundings.update({key: environment[key] for key in ("COLUMNS", "NO_COLOR")
                             if key in environment})
        process = subprocess.Popen([JOSTLE, *map(str, arguments)], cwd=self.folder, stdout=outer,
                                   stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   env=surroundings)
        os.close(outer)
        written = b""
        while True:
            try:
                piece = os.read(inner, 65536)
            except OSError:  # the other end is closed
                break
            if not piece:
                break
            written += piece
        os.close(inner)
        self.assertEqual(process.wait(timeout=60), 0)
        return written.decode().replace("\r\n", "\n")

    def run_bed(self, scene=BED):
        self.write(scene)
        return self.run_scene(environment={"COLUMNS": ""}).stdout

    def assert_narrow(self, text, width):
        for line in text.splitlines():
            self.assertLessEqual(len(line), width, f"{line!r}\n{text}")

    def test_reports_are_as_wide_as_asked_for(self):
        files = ((BED, "tiny.h5"), (SWEEP, "swept.h5"))
        for scene, file in files if EVERY else files[1:]:
            # A command is in one line, for any length of its words.
            self.assert_narrow(self.run_bed(scene).split("\nnext:\n")[0], 80)
            for width in (66, 80) if EVERY else (66,):
                for words in LISTING:
                    with self.subTest(words=words, width=width, file=file):
                        words = [file if word == "FILE" else word for word in words]
                        text = self.jostle(*words, environment={"COLUMNS": str(width)}).stdout
                        self.assertGreater(text.count("\n"), 5)
                        self.assert_narrow(text, width)
        for words in (["check", "scene.json"], ["analyse", "swept.h5", "sweep", "--observable",
                                                "mean_height"],
                      ["cost", "scene.json", "--replicates", "2", "--taps", "3",
                       "--no-progress"]):
            self.assert_narrow(self.jostle(*words, environment={"COLUMNS": ""}).stdout, 80)
        self.write(UP_AND_DOWN)
        self.run_scene()
        self.assert_narrow(self.jostle("analyse", "loop.h5", "hysteresis", "--observable",
                                       "bulk_fraction").stdout, 80)

    def test_wide_prints_every_column_and_programs_read_what_they_always_did(self):
        self.run_bed()
        few, wide = (self.jostle("info", "tiny.h5", *more).stdout for more in ([], ["--wide"]))
        self.assertNotRegex(few, r"\n *tap .* sigma")
        self.assertRegex(wide, r"\n *tap .* sigma .* sigma .* sigma .* sigma  sweeps  acceptance\n")
        for words in some(LISTING[1:], 3):
            words = ["tiny.h5" if word == "FILE" else word for word in words]
            with self.subTest(words=words):
                narrow, broad = (re.sub(r'"(command_line|started)": ".*"', "", self.jostle(
                    *words, "--json", environment={"COLUMNS": columns}).stdout)
                    for columns in ("40", "400"))
                self.assertEqual(narrow, broad)
                self.assertGreaterEqual(len(self.jostle(*words, "--wide").stdout.split()),
                                        len(self.jostle(*words).stdout.split()))

    def test_a_terminal_has_its_width_colours_and_a_curve(self):
        self.run_bed()
        text = self.at_a_terminal("info", "tiny.h5", columns=70)
        self.assertTrue(text.startswith("\x1b[1mtiny.h5: tiny, complete\x1b[0m\n"), text)
        plain = re.sub(r"\x1b\[\d*m", "", text)
        self.assert_narrow(plain, 70)
        self.assertTrue(any(len(line) > 60 for line in plain.splitlines()))
        curve = plain.split("bottom_fraction over taps\n")[1].splitlines()
        self.assertEqual(len(curve), 9)
        self.assertTrue(all(BRAILLE.search(line) for line in curve[:8]), curve)
        self.assertRegex(curve[8], r"^ +0  1 +10 +40$")
        self.assertNotIn("\x1b", self.at_a_terminal("info", "tiny.h5", NO_COLOR="1"))
        self.assertIn("\x1b", self.at_a_terminal("info", "tiny.h5", NO_COLOR=""))

    def test_what_a_terminal_cannot_show_is_left_out(self):
        self.run_bed()
        dumb = self.at_a_terminal("info", "tiny.h5", TERM="dumb")
        self.assertNotIn("\x1b", dumb)
        self.assertNotIn("over taps", dumb)
        ascii_curve = self.at_a_terminal("info", "tiny.h5", LC_ALL="C").split("over taps\n")[1]
        self.assertTrue(ascii_curve.isascii())
        self.assertGreater(ascii_curve.count("*"), 10)
        piped = self.jostle("info", "tiny.h5", environment={"TERM": "xterm", "LC_ALL": "C.UTF-8"})
        self.assertNotIn("over taps", piped.stdout)
        self.assertTrue(piped.stdout.isascii())

    def test_a_sweep_has_a_line_a_point(self):
        self.run_bed(SWEEP)
        text = self.at_a_terminal("info", "swept.h5")
        lines = re.findall(r"^  dilate = (\S+) +([\u2581-\u2588]{24})  \S+$", text, re.M)
        self.assertEqual([value for value, _ in lines], ["0.02", "0.05", "0.1", "0.2"])
        self.assertGreater(len({curve for _, curve in lines}), 1)

    def test_a_failed_realization_is_red(self):
        self.write(changed(TINY, start={"crystal": "hcp"},
                           sweep={"/start/crystal/stretch": [False, True]}))
        self.run_scene(expect=3)
        text = self.at_a_terminal("info", "tiny.h5", columns=200)
        self.assertRegex(text, r"\x1b\[31m3 of 6 realizations done.*3 FAILED.*\x1b\[0m")
        self.assertRegex(text, r"\x1b\[31mrealization 0 failed \(seed 4711\).*\x1b\[0m")

    def test_a_run_names_the_next_commands_and_they_run(self):
        for scene, kinds in ((BED, ["fit", "structure"]), (SWEEP, ["analyse", "fit"]),
                             (UP_AND_DOWN, ["analyse", "structure"]),
                             (changed(BED, name="short", protocol=[], snapshots={"taps": [0]}),
                              ["structure", "export"]),
                             (changed(BED, name="asked", fits=[{"observable": "bulk_fraction", "model": "kww"}],
                                      structure={"coordination": {}}), ["report", "export"])):
            with self.subTest(scene=scene["name"]):
                said = self.run_bed(scene).split("\nnext:\n")[1].splitlines()
                commands = [shlex.split(line) for line in said]
                self.assertEqual([words[0] for words in commands], [JOSTLE, JOSTLE])
                self.assertEqual([words[1] for words in commands], kinds)
                for words in commands:
                    self.jostle(*words[1:])
        self.assertNotIn("next:", self.run_scene("--shard", "1/2", "-o", "part.h5").stdout)

    def test_a_run_ends_with_results_and_not_with_every_table(self):
        self.write(changed(SWEEP, fits=[{"observable": "mean_height", "model": "inverse_log"},
                                        {"observable": "bulk_fraction", "model": "inverse_log"}],
                           analyse={"steady": [{"observable": "mean_height", "last": 32}],
                                    "sweep": [{"observable": "bulk_fraction"}]},
                           structure={"coordination": {}, "order": {}}))
        short = self.run_scene(environment={"COLUMNS": ""}).stdout
        self.assert_narrow(short, 80)
        self.assertEqual(short.count("fits of "), 2)
        results = short.split("steady/mean_height\n")[1]
        self.assertEqual(re.findall(r"(?m)^  dilate = (\S+)  (?:not )?\w+", results), ["0.02", "0.05", "0.1", "0.2"])
        self.assertRegex(results, r"stored\s+tables:\s+coordination,\s+order,\s+comparison/coordination,\s+comparison/order\n")
        self.assertLess(len(short.splitlines()), 120)
        full = self.run_scene("--force", "--verbose", environment={"COLUMNS": ""}).stdout
        self.assertGreater(len(full.splitlines()), 3 * len(short.splitlines()))
        for name in ("point_0003/steady/mean_height", "point_0003/coordination", "blocked_error"):
            self.assertIn(name, full)
            self.assertNotIn(name, short)

    def test_proposals_are_of_the_observable_that_the_scene_studies(self):
        for scene, name in ((BED, "bottom_fraction"),
                            (changed(BED, analyse={"steady": [{"observable": "mean_height", "last": 32}]}),
                             "mean_height")):
            with self.subTest(name=name):
                self.write(scene)
                told = self.run_scene("--force", environment={"COLUMNS": ""}).stdout
                self.assertRegex(told.split("\nnext:\n")[1], rf"fit \S+ --observable {name}\n")


if __name__ == "__main__":
    unittest.main()
