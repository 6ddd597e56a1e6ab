"""Every example of every help text and every command of the documentation runs, on results as the
quickstart scene makes them."""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from support import JOSTLE, PLAIN, SCRATCH, SOURCE, Case, EVERY, changed, some

COMMANDS = ("new", "run", "check", "cost", "schema", "info", "merge", "bench", "selftest", "fit",
            "analyse", "structure", "export", "report", "slurm", "status")

# A hundred taps of a small bed, with everything that quickstart observes and keeps.
QUICK = {
    "name": "quickstart", "seed": 20010222, "realizations": 4,
    "container": {"sides": "periodic", "width": 5}, "spheres": 120,
    "protocol": [{"tap": {"dilate": 0.02}, "count": 100}],
    "relax": {"polar": {}, "stop": {"mean_height": {"eta": 1e-3, "every_sweeps": 10}}},
    "observe": ["mean_height", "bottom_fraction", "corrected_fraction", "bulk_fraction"],
    "snapshots": {"taps": [0, 100]},
}
# The taps of the papers' scenes, with as few spheres as possible.
LONG = changed(QUICK, container={"sides": "periodic", "width": 3}, spheres=30,
               snapshots={"taps": [0, 99]},
               protocol=[{"tap": {"dilate": 0.02}, "count": 2000}],
               relax={"polar": {}, "stop": {"mean_height": {"eta": 1e-2, "every_sweeps": 10}}})
LOW = {"/protocol/0/tap/dilate": [0.01, 0.02]}
HIGH = {"/protocol/0/tap/dilate": [0.05, 0.1, 0.2]}
UP_AND_DOWN = [{"ramp": {"dilate": {"sqrt_from": 0.1, "sqrt_to": 0.5, "sqrt_step": 0.1}}, "count": 60},
               {"ramp": {"dilate": {"sqrt_from": 0.5, "sqrt_to": 0.1, "sqrt_step": 0.1}}, "count": 60}]
THEN_COMMON = [{"tap": {"dilate": 0.05}, "count": 9}, {"tap": {"dilate": 0.02}, "count": 100}]
TWO_WAYS = {"zip": {"/protocol/0/tap/dilate": [0.05, 0.1], "/protocol/0/count": [9, 5]}}

# Parts that are too long for a test, and their replacements.
INSTEAD = {"jostle bench": "jostle bench fluid_0.45", "jostle bench tapped_bed --json":
           "jostle bench fluid_0.45 --json", "--budget 30m": "--replicates 2",
           "--folder /scratch/me": "--folder .",
           "jostle run quickstart.json": "jostle run small.json --force",
           "jostle merge low.h5 high.h5 -o all.h5": "jostle merge low.h5 high.h5 -o all.h5 --force"}


# Replacements in the documentation. Long commands run on a bed that takes seconds.
INSTEAD_IN_DOCS = {
    **INSTEAD,
    "jostle run config/scenes/quickstart.json": "jostle run config/scenes/quickstart.json --force",
    "jostle run my-scene.json --resume": "jostle run small.json -o my-scene.h5 --resume",
    "jostle run mine.json --resume": "jostle run small.json -o mine.h5 --resume",
    "jostle run my-scene.json": "jostle run small.json -o my-scene.h5",
    "jostle run mine.json": "jostle run small.json -o mine.h5",
    "jostle run bell.json": "jostle info bell.h5",
    "jostle run loop.json": "jostle info loop.h5",
    "jostle run scene.json --retry-failed": "jostle run scene.json -o retried.h5 --retry-failed",
    "jostle check my-scene.json": "jostle check my-scene.json --no-pilot",
    "jostle cost scene.json": "jostle cost scene.json --replicates 2",
    "jostle cost scene.json --target 0.001 --observable bottom_fraction --budget 2m":
        "jostle cost scene.json --target 0.001 --observable bottom_fraction --replicates 2 --force",
    "jostle cost scene.json --target 0.001 --observable bottom_fraction":
        "jostle cost scene.json --target 0.001 --observable bottom_fraction --replicates 2 --force",
    "jostle merge a.h5 b.h5 -o all.h5": "jostle merge low.h5 high.h5 -o all.h5 --force",
    "jostle slurm scene.json": "jostle slurm scene.json --hours 1 --cpus 1 --jobs 1",
    "jostle fit data.csv": "jostle fit measured.csv",
    "jostle fit quickstart.h5 --observable bottom_fraction --csv measured.csv":
        "jostle fit quickstart.h5 --observable bottom_fraction --csv measured.csv --force",
    "jostle fit data.csv --realizations": "jostle fit experiments.csv --realizations",
    "jostle fit file.csv --model pore_tail": "jostle fit volumes.csv --model pore_tail",
    "jostle analyse file.h5 hysteresis --observable bulk_fraction --last 1000":
        "jostle analyse fig4.h5 hysteresis --observable bulk_fraction",
}
RESULTS_OF_DOCS = {"volumes": "bell", "file": "fig5", "results": "quickstart", "run": "quickstart", "long": "fig5",
                   "loop": "fig4"}


def documented(page):
    """The commands of a page: lines of their own, and those in a text that name a file. Words in
    capitals, brackets and dots stand for others."""
    found = [re.split(r"\s{2,}", line)[0]
             for line in re.findall(r"^ {4}((?:jostle|\./dev) .*)$", page, re.M)]
    found += [" ".join(line.split()) for line in re.findall(r"`((?:jostle|\./dev) [^`]*)`", page)]
    commands = [re.sub(r"^\./dev", "jostle", command) for command in found]
    return [command for command in dict.fromkeys(commands)
            if command.split()[1] in COMMANDS and not re.search(r"\b[A-Z]{2,}\b|\[|\.\.\.|\*", command)
            and (re.search(r"\.(h5|json|csv|xyz)\b", command) or " new " in command)]


def examples(text):
    """The commands of a help text; text after two blanks describes them."""
    return [re.split(r"\s{2,}", line.strip())[0] for line in text.splitlines()
            if line.startswith("  jostle ")]


def instead(command):
    if command in INSTEAD:
        return INSTEAD[command]
    for what, other in INSTEAD.items():
        command = command.replace(what, other) if what.startswith("--") else command
    return command


class Examples(Case):
    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory(prefix="jostle-cli-", dir=SCRATCH)
        cls.addClassCleanup(cls.made.cleanup)

    def setUp(self):
        super().setUp()
        made = pathlib.Path(self.made.name)
        if not any(made.iterdir()):
            self.make_files()
            shutil.copytree(self.folder, made, dirs_exist_ok=True, symlinks=True)
        else:
            shutil.copytree(made, self.folder, dirs_exist_ok=True, symlinks=True)
        self.program = self.folder / "bin"

    def make_files(self):
        """Everything that the examples name."""
        self.write(QUICK, "small.json")
        self.write(changed(QUICK, name="scene"))
        self.jostle("run", "small.json", "--quiet")
        runs = {"fig5": LONG, "fig9": QUICK, "fig10": LONG, "bell": changed(LONG, sweep=HIGH),
                "low": changed(QUICK, sweep=LOW), "high": changed(QUICK, sweep=HIGH),
                "fig4": changed(LONG, protocol=UP_AND_DOWN), "motion": changed(QUICK, motion={}),
                "lifts": changed(QUICK, observe=["mean_height", "crystalline_fraction", "grown_layers"],
                                 sweep=LOW),
                "memory": changed(LONG, protocol=THEN_COMMON, sweep=TWO_WAYS)}
        for name, scene in runs.items():
            self.write(scene, "of.json")
            self.jostle("run", "of.json", "--quiet", "-o", f"{name}.h5")
        for number, name in enumerate(("packing", "a", "b", "c")):
            self.jostle("export", "quickstart.h5", "--format", "extxyz", "--realization",
                        number % 4, "-o", f"{name}.xyz")
        (self.folder / "measured.csv").write_text("t,X\n" + "".join(
            f"{t},{0.62 - 0.053 * 2.718 ** -((t / 40) ** 0.5)}\n" for t in range(1, 200)))
        (self.folder / "experiments.csv").write_text("t,first,second,third\n" + "".join(
            "{},{},{},{}\n".format(t, *(0.6 - 0.06 / (1 + 0.5 * math.log(1 + t / 10)) +
                                        1e-3 * math.cos(t * t * r) for r in (1, 2, 3)))
            for t in range(1, 200)))
        (self.folder / "of.json").unlink()
        (self.folder / "scene.shards").mkdir()
        for shard in (1, 2):
            self.jostle("run", "scene.json", "--quiet", "--shard", f"{shard}/2", "-o",
                        f"scene.shards/{shard}.h5")
        (self.folder / "bin").mkdir()
        (self.folder / "bin/jostle").symlink_to(JOSTLE)

    def copy_files(self, folder):
        for path in self.folder.iterdir():
            if path.is_file():
                shutil.copy(path, folder)
        shutil.copytree(self.folder / "scene.shards", folder / "scene.shards")

    def run_all(self, commands, folder, instead=instead):
        environment = {**PLAIN, "PATH": f"{self.program}:{os.environ['PATH']}"}
        for command in commands:
            done = subprocess.run(["bash", "-c", instead(command)], cwd=folder, env=environment,
                                  text=True, capture_output=True, timeout=600)
            with self.subTest(command=command):
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_every_example_of_every_help_runs(self):
        n = 0
        commands = some((None, *COMMANDS), 5)
        for command in commands:
            text = self.jostle(*filter(None, (command, "--help"))).stdout
            found = examples(text)
            self.assertGreaterEqual(len(found), 1, command)
            n += len(found)
            folder = self.folder / f"of_{command}"
            folder.mkdir()
            self.copy_files(folder)
            self.run_all(found, folder)
        self.assertGreater(n, 2 * len(commands))

    def test_every_command_of_the_documentation_runs(self):
        for name, of in RESULTS_OF_DOCS.items():
            shutil.copy(self.folder / f"{of}.h5", self.folder / f"{name}.h5")
        (self.folder / "volumes.csv").write_text("t,X\n" + "".join(
            f"{0.01 * t},{30 * math.exp(-0.1 * t) + 0.01 * math.cos(t * t)}\n" for t in range(20)))
        n = 0
        pages = [page for page in (SOURCE / "README.md", *sorted((SOURCE / "docs").rglob("*.md")))
                 if documented(page.read_text())]
        for page in some(pages, 2):
            found = documented(page.read_text())
            n += len(found)
            folder = self.folder / f"of_{page.parent.name}_{page.stem}"
            (folder / "config/scenes").mkdir(parents=True)
            self.copy_files(folder)
            shipped = json.loads((SOURCE / "config/scenes/tutorial.json").read_text())
            small = {**shipped, "spheres": 30, "realizations": 4,
                     "container": {"sides": "periodic", "width": 3}, "relax": LONG["relax"]}
            (folder / "config/scenes/tutorial.json").write_text(json.dumps(small))
            (folder / "config/scenes/quickstart.json").write_text(json.dumps(QUICK))
            with self.subTest(page=page.name):
                self.run_all(found, folder, lambda command: INSTEAD_IN_DOCS.get(command, command))
        self.assertGreater(n, 40 if EVERY else 4)

    def test_no_command_is_forgotten(self):
        listed = re.search(r"Subcommands:\n((?:  .*\n)+)", self.jostle("--help").stdout).group(1)
        named = [line.split()[0] for line in listed.splitlines() if re.match(r"  \S", line)]
        self.assertEqual(sorted(named), sorted(COMMANDS))


if __name__ == "__main__":
    unittest.main()
