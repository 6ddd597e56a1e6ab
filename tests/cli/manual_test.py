"""Manual pages and completions agree with the program's own help texts."""

import os
import pathlib
import re
import shutil
import subprocess
import unittest

from support import Case

MANUAL = pathlib.Path(os.environ["BUILD"]) / "manual"
KINDS = ("steady", "spectrum", "ageing", "hysteresis", "ordering", "sweep", "volumes", "memory")


def plain(page):
    """A page's text without what roff makes of it."""
    return re.sub(r"\\f[BIR]|\\&", "", page).replace("\\-", "-").replace("\\e", "\\")


class Manual(Case):
    def commands(self):
        listed = re.search(r"Subcommands:\n((?:  .*\n)+)", self.jostle("--help").stdout).group(1)
        return [line.split()[0] for line in listed.splitlines() if re.match(r"  \S", line)]

    def options(self, *command):
        """Names of a command's options, as its help lists them."""
        text = self.jostle(*command, "--help").stdout
        named = re.findall(r"^  ((?:-\w,)?--[\w-]+(?:,--[\w-]+)*)", text, re.MULTILINE)
        return [name for names in named for name in names.split(",")]

    def test_every_command_has_a_page_with_all_its_options(self):
        pages = {path.name: plain(path.read_text()) for path in (MANUAL / "man1").iterdir()}
        commands = self.commands()
        self.assertGreater(len(commands), 10)
        self.assertEqual(set(pages), {"jostle.1"} | {f"jostle-{one}.1" for one in commands})
        for command in commands:
            page = pages[f"jostle-{command}.1"]
            options = self.options(command)
            self.assertGreaterEqual(len(options), 2, command)
            for kind in KINDS if command == "analyse" else ():
                self.assertIn(f'.SS "analyse {kind}"', page)
                options += self.options(command, __file__, kind)
            for option in options:
                with self.subTest(command=command, option=option):
                    self.assertRegex(page, rf"(?m)^(-\w, )?.*{option}\b")
            self.assertIn(f"jostle-{command}(1)", pages["jostle.1"])
            self.assertRegex(page, rf'.SH "EXAMPLES"\n.nf\n(  jostle .*\n)*  jostle {command}\b')

    def test_pages_are_good_roff(self):
        if not shutil.which("groff"):
            self.skipTest("groff is not installed")
        for path in sorted((MANUAL / "man1").iterdir()):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", path], capture_output=True,
                                  text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""), path.name)
            self.assertIn("SYNOPSIS", re.sub("\x1b\\[[0-9;]*m|.\b", "", done.stdout))


class Bash(Case):
    def complete(self, *words):
        """Offers of bash for the last of the words."""
        script = (f'source "{MANUAL}/bash/jostle"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _jostle; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        done = subprocess.run(["bash", "-euc", script, "bash", "jostle", *words], cwd=self.folder,
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""), words)
        return sorted(done.stdout.split("\n")[:-1]) if done.stdout != "\n" else []

    def test_commands_options_and_values_are_offered(self):
        commands = Manual.commands(self)
        self.assertEqual(self.complete(""), sorted(commands))
        self.assertEqual(self.complete("str"), ["structure"])
        for command in commands:
            self.assertEqual(self.complete(command, "--"),
                             sorted(one for one in set(Manual.options(self, command))
                                    if one.startswith("--")), command)
        self.assertEqual(self.complete("--ver"), ["--version"])
        self.assertEqual(self.complete("fit", "a.h5", "--resample", ""), ["bootstrap", "jackknife", "none"])
        self.assertEqual(self.complete("fit", "--model", "inv"), ["inverse_log", "inverse_log_height"])
        self.assertEqual(self.complete("new", "mine", "--from", "quick"), ["quickstart"])
        self.assertEqual(self.complete("run", "--threads", ""), [])
        self.assertEqual(self.complete("nonsense", "--wide", "x"), [])

    def test_kinds_of_analyses_bring_their_options(self):
        self.assertEqual(self.complete("analyse", "a.h5", "st"), ["steady"])
        self.assertNotIn("--lags", self.complete("analyse", "a.h5", "--"))
        self.assertIn("--lags", self.complete("analyse", "a.h5", "ageing", "--"))
        self.assertIn("--csv", self.complete("analyse", "a.h5", "ageing", "--"))
        self.assertEqual(self.complete("analyse", "a.h5", "spectrum", "--window", ""), ["boxcar", "hann"])

    def test_files_are_offered_by_their_suffix(self):
        for name in ("scene.json", "two words.json", "run.h5", "curve.csv", "page.html", "notes.md"):
            self.write("", name)
        (self.folder / "folder").mkdir()
        self.assertEqual(self.complete("run", ""), ["folder", "scene.json", "two words.json"])
        self.assertEqual(self.complete("run", "two"), ["two words.json"])
        self.assertEqual(self.complete("info", ""), ["folder", "run.h5"])
        self.assertEqual(self.complete("fit", ""), ["curve.csv", "folder", "run.h5"])
        self.assertEqual(self.complete("report", "run.h5", "-o", ""), ["folder", "page.html"])
        self.assertEqual(self.complete("fit", "--csv", "n"), ["notes.md"])

    def test_no_name_is_a_pattern_of_names(self):
        for name in ("*.h5", "a.h5", "[ab].h5", "$(touch made).h5", "?.h5"):
            self.write("", name)
        names = sorted(["*.h5", "a.h5", "[ab].h5", "$(touch made).h5", "?.h5"])
        self.assertEqual(self.complete("info", ""), names)
        self.assertEqual(self.complete("info", "*"), ["*.h5"])
        self.assertEqual(self.complete("run", "--no-such"), [])
        self.assertEqual(self.files(), names)

    def test_the_word_after_a_command_that_is_a_value_is_no_command(self):
        self.assertEqual(self.complete("new", "run", "--fr"), ["--from"])


class Zsh(Case):
    def setUp(self):
        super().setUp()
        if not shutil.which("zsh"):
            self.skipTest("zsh is not installed")

    def specs(self, command):
        """Specifications that the completion passes to zsh's _arguments for a command."""
        script = ('_arguments() { print -rl -- "$@"; state=argument }; _files() { }; _describe() { }; '
                  f'words=({command} x); source {MANUAL}/zsh/_jostle')
        done = subprocess.run(["zsh", "-f", "-c", script], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def test_the_file_is_good_zsh(self):
        done = subprocess.run(["zsh", "-n", MANUAL / "zsh/_jostle"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_every_option_of_every_command_is_handed_over(self):
        for command in Manual.commands(self):
            specs = self.specs(command)
            for option in Manual.options(self, command):
                self.assertRegex(specs, rf"(?m)^(\(.*\)|\*)?{option}\[", command)
        self.assertIn('scene:_files -g "*.(json)"', self.specs("run"))
        self.assertIn(":value:(jackknife bootstrap none)", self.specs("fit"))
        self.assertIn("compadd steady spectrum ageing hysteresis motion ordering sweep volumes memory",
                      self.specs("analyse"))


if __name__ == "__main__":
    unittest.main()
