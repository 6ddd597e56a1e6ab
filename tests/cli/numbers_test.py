"""No text has a number that is not finite or one with the digits of rounding noise: neither the sources let one through, nor do reports, tables,
verdicts, pages and figures of series that do not vary, of single spheres, realizations and taps, and of
runs that failed have one."""

import csv
import html
import json
import os
import re
import sys
import unittest
import xml.etree.ElementTree

import h5py
from support import SOURCE, UNFOLDED, Case

sys.path.insert(0, str(SOURCE / "python"))
from jostle.plot import draw, save  # noqa: E402

# "nan", "-inf" and Python's "Infinity" as words; not X_inf, a beta of "infinity" or "--info".
NOT_FINITE = re.compile(r"(?<![\w.])[-+]?(?:(?i:nan|inf)|Infinity)(?!\w)")
FOR_PROGRAMS_TO_READ = ("nan", "inf", "-inf")
# A number with a decimal point; one for people has fewer than 15 significant digits.
WITH_POINT = re.compile(r"(?<![\w.])\d+\.\d+(?![\w.])|(?<![\w.])\d+\.\d+(?=e[-+]?\d)")
# The phrase for a sentence that was about to print one.
NOT_STATED = "a number of it is not finite"

# Who writes numbers for programs, or is the formatter.
FOR_PROGRAMS = {"study/drawing/figures/catalogue.cpp", "study/drawing/page/page_json.cpp",
                "config/grids.cpp", "ensemble/statistics/finite_text.hpp"}
LIBRARIES = ("ensemble", "config", "results", "study", "cli")
# A format of a floating number within a literal: {:.2g}, {:+.1f}, {:>8.3e}.
FLOATING = re.compile(r"\{\w*:[^{}]*(?:\.\d+|[efgEG])[^{}]*\}")
CALL = re.compile(r'fmt::(?:format|print|format_to)\(\s*((?:"(?:[^"\\]|\\.)*"\s*)+)')


# Scenes' numbers are printed so that they read back: the default theta0, and a footprint to be typed.
EXACT = re.compile(r"theta0\W+0\.7853981633974483|that they fill are [^:]*")


def long_number(line):
    """The place of the first number with 15 significant digits or more; None without one."""
    for number in WITH_POINT.finditer(EXACT.sub("", line)):
        if len(number.group().replace(".", "").lstrip("0")) >= 15:
            return number.start()
    return None


class LongNumbers(unittest.TestCase):
    def test_long_numbers_are_found(self):
        for line in ("slope -0.0500000000000001", "0.123456789012345e-05(12)", "x=1234567890.12345, y"):
            self.assertIsNotNone(long_number(line), line)
        for line in ("0.59389024(28)", "seed 12345678901234567890", "0.000000000000000012", "6aca6d83.0123456789012345"):
            self.assertIsNone(long_number(line), line)


class Sources(unittest.TestCase):
    def test_floating_numbers_are_formatted_by_finite_text_alone(self):
        n_calls = 0
        for folder in LIBRARIES:
            for path in sorted((SOURCE / folder).rglob("*.[ch]pp")):
                name = str(path.relative_to(SOURCE))
                if name in FOR_PROGRAMS:
                    continue
                for call in CALL.finditer(path.read_text()):
                    n_calls += 1
                    with self.subTest(file=name, text=call.group(1)[:60]):
                        self.assertNotRegex(call.group(1), FLOATING, "use finite_text()")
        self.assertGreater(n_calls, 300)

    def test_the_page_formats_numbers_in_one_file(self):
        found = []
        for path in sorted((SOURCE / "report/src").rglob("*.js")):
            if path.name == "format.js":
                continue
            for method in re.findall(r"\.(toFixed|toPrecision|toExponential|toLocaleString)\(", path.read_text()):
                found.append((path.name, method))
        # Shares of spheres that are there.
        self.assertEqual(found, [("packing.js", "toFixed")])

    def test_the_python_package_formats_numbers_in_one_file(self):
        for path in sorted((SOURCE / "python/jostle").rglob("*.py")):
            if path.name in ("text.py", "values.py"):
                continue
            with self.subTest(file=path.name):
                self.assertNotRegex(path.read_text(), r"\{[^{}'\"]+:[^{}'\"]*\.\d+[efg]\}")


SERIES = ["mean_height", "corrected_fraction", "bulk_fraction", "crystalline_fraction"]


def scene(**changes):
    """Periodic, twenty spheres, 40 taps that move little."""
    return {"name": "one", "seed": 4, "realizations": 2,
            "container": {"sides": "periodic", "width": 3}, "spheres": 20,
            "protocol": [{"tap": {"dilate": 0.05}, "count": 40}],
            "relax": {"polar": {}, "stop": {"sweeps": 3}}, "observe": SERIES,
            "snapshots": {"taps": [0, 1, 2, 5, 10, 20, 40]}, "motion": {}, **changes}


def protocol(*strengths, count=40):
    return [{"tap": {"dilate": strength}, "count": count} for strength in strengths]


def few_snapshots(last):
    return {"taps": sorted({0, min(1, last), last})}


LOOP = [0.02, 0.04, 0.06, 0.04, 0.02]
SCENES = {
    # crystalline_fraction is 0 at every tap: its verdicts contained "-nan times the scatter".
    "constant": scene(protocol=protocol(0.05, count=130), snapshots=few_snapshots(130)),
    "motionless": scene(protocol=protocol(0, count=40)),
    "single realization": scene(realizations=1, protocol=protocol(0.05, count=64),
                                snapshots=few_snapshots(64)),
    "one tap": scene(protocol=protocol(0.05, count=1), snapshots=few_snapshots(1), motion={}),
    "no tap": {key: value for key, value in scene(protocol=protocol(0.05, count=0),
                                                  snapshots=few_snapshots(0)).items()
               if key != "motion"},
    "one sphere": scene(spheres=1, motion={"layers": 1}),
    "two spheres": scene(spheres=2, motion={"layers": 1}),
    "a single file": scene(container={"sides": "cylinder", "diameter": 1.4}, spheres=6),
    "walls": scene(container={"sides": "walls", "width": 3.5}, start={"pour": "fitted"}),
    "no sides": scene(container={"sides": "fully_periodic", "width": [3, 3], "height": 4}, spheres=20,
                      start={"grow": {}}, protocol=protocol(0, count=3),
                      relax={"metropolis": {}, "stop": {"sweeps": 3}},
                      snapshots=few_snapshots(3), observe=[]),
    "all failed": scene(container={"sides": "periodic", "width": [4, 4]}, spheres=48,
                        start={"crystal": "hcp"}),
    "constant loop": scene(protocol=protocol(*LOOP), snapshots=few_snapshots(200)),
    "motionless loop": scene(protocol=protocol(*([0] * 5)), snapshots=few_snapshots(200)),
    "constant sweep": scene(sweep={"/protocol/0/tap/dilate": [0.02, 0.05, 0.1, 0.2]}),
    "motionless sweep": scene(relax={"polar": {"max_step": 1e-9}, "stop": {"sweeps": 1}},
                              sweep={"/protocol/0/tap/dilate": [0, 0.001, 0.002]}),
    "sweep of one realization": scene(realizations=1, spheres=2, motion={"layers": 1},
                                      sweep={"/protocol/0/tap/dilate": [0.02, 0.05, 0.1]}),
    "two histories": scene(realizations=4, protocol=protocol(0.01, 0.2, count=40) + protocol(0.05),
                           sweep={"/protocol/0/tap/dilate": [0.02, 0.05]},
                           snapshots=few_snapshots(120)),
    "grains": {"name": "one", "seed": 4, "realizations": 2,
               "container": {"sides": "periodic", "width": 3}, "spheres": 2,
               "engine": {"discrete_element": {"contact": {"walton_braun": {}}, "most_seconds": 0.05}},
               "protocol": [{"tap": {"half_sine": {"amplitude": 0.1, "frequency": 7.5}}, "count": 2}],
               "observe": ["mean_height", "bulk_fraction"], "snapshots": {}},
}
ANALYSES = ["steady", "spectrum", "ageing", "hysteresis", "ordering", "sweep", "volumes", "memory"]


class Texts(Case):
    """A scene through every command, and every text they print or write searched."""

    def setUp(self):
        super().setUp()
        self.n_commands = self.n_texts = self.n_figures = 0
        self.found = []

    def look_at(self, text, where, for_people=True):
        self.n_texts += 1
        for line in text.splitlines():
            if for_people and (at := long_number(line)) is not None:
                self.found.append(f"{where}: {line[max(0, at - 60):at + 60]}")
            if NOT_FINITE.search(line) or NOT_STATED in line:
                at = (NOT_FINITE.search(line) or re.search(NOT_STATED, line)).start()
                self.found.append(f"{where}: {line[max(0, at - 100):at + 60]}")

    def ask(self, *arguments):
        self.n_commands += 1
        done = self.jostle(*arguments, expect=None, environment=UNFOLDED)
        self.assertIn(done.returncode, (0, 2, 3, 4), done.stderr)
        self.look_at(done.stdout, (self.scene_name, *arguments), for_people="--json" not in arguments)
        self.look_at(done.stderr, (self.scene_name, *arguments))
        return done

    def look_at_file(self, name):
        """CSV: a missing number is an empty field, and every block has one number of fields."""
        path = self.folder / name
        if path.exists():
            with path.open(newline="") as file:
                rows = [row for row in csv.reader(file) if not row or not row[0].startswith("#")]
            self.look_at("\n".join(cell for row in rows for cell in row), (self.scene_name, name),
                         for_people=False)
            for before, row in zip(rows, rows[1:], strict=False):
                if before and row:
                    self.assertEqual(len(before), len(row), (self.scene_name, name, row))
            path.unlink()

    def look_at_notes(self):
        with h5py.File(self.folder / "one.h5") as file:
            def visit(name, item):
                for key, value in item.attrs.items():
                    if isinstance(value, str):
                        self.look_at(value, (self.scene_name, name, key))
            file.visititems(visit)

    def look_at_page(self):
        self.ask("report", "one.h5", "--force")
        if not (self.folder / "one.html").exists():
            return
        page = (self.folder / "one.html").read_text()
        for block in re.findall(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', page, re.DOTALL):
            texts = self.strings(json.loads(html.unescape(block)))
            self.look_at("\n".join(text for text in texts if text not in FOR_PROGRAMS_TO_READ),
                         (self.scene_name, "page"))

    def look_at_figures(self):
        """All texts of the figures as they are saved. PDF files take the most time, and are made for QUICK scenes alone."""
        if self.scene_name in QUICK:
            self.ask("report", "one.h5", "--figures", "figures", "--force")
        self.ask("report", "one.h5", "--catalogue", "figures.json", "--force")
        catalogue = self.folder / "figures.json"
        for figure in json.loads(catalogue.read_text())["figures"] if catalogue.exists() else []:
            save(draw(figure), self.folder / "figure", kinds=["svg"])
            root = xml.etree.ElementTree.parse(self.folder / "figure.svg").getroot()
            texts = ["".join(text.itertext()) for text in root.iter("{http://www.w3.org/2000/svg}text")]
            self.n_figures += 1
            self.look_at(" ".join(texts), (self.scene_name, figure["name"]))

    def strings(self, value):
        if isinstance(value, str):
            yield value
        elif isinstance(value, dict):
            for member in value.values():
                yield from self.strings(member)
        elif isinstance(value, list):
            for member in value:
                yield from self.strings(member)

    def go_through(self, name):
        self.scene_name = name
        given = SCENES[name]
        for old in self.folder.glob("*"):
            if old.is_file():
                old.unlink()
        self.write(given)
        self.ask("check", "scene.json")
        self.assertIn(self.ask("run", "scene.json", "--no-progress", "--wide").returncode, (0, 3))
        for options in ([], ["--wide"], ["--json"]):
            self.ask("info", "one.h5", *options)
        self.ask("status", "one.h5")
        for observable in given["observe"][-2:]:
            self.ask("fit", "one.h5", "--observable", observable, "--verbose", "--csv", "fit.csv", "--force")
            self.look_at_file("fit.csv")
            for kind in ANALYSES:
                extra = ["--threshold", "0.5"] if kind == "ordering" else []
                self.ask("analyse", "one.h5", "--wide", "--csv", "tables.csv", "--force", kind,
                         "--observable", observable, *extra)
                self.look_at_file("tables.csv")
        self.ask("analyse", "one.h5", "--wide", "motion")
        self.ask("structure", "one.h5", "--wide", "--csv", "structure.csv", "--force")
        self.look_at_file("structure.csv")
        self.ask("export", "one.h5", "--format", "extxyz", "--force")
        self.ask("export", "one.h5", "--format", "lammps", "--force")
        self.look_at_notes()
        self.look_at_page()
        self.look_at_figures()


def test_of(name):
    def test(self):
        self.go_through(name)
        print(f"{name}: {self.n_commands} commands, {self.n_figures} figures, {self.n_texts} texts, "
              f"{len(self.found)} found")
        self.assertEqual(self.found, [])
        self.assertEqual(self.n_figures > 0, name != "all failed")
        self.assertGreaterEqual(self.n_commands, 12)
    return test


def add_tests(case, names):
    for name in names:
        setattr(case, f"test_{name.replace(' ', '_')}", test_of(name))


# numbers_sweep_test.py has the remaining cases.
QUICK = ["one sphere", "all failed"]


class QuickTexts(Texts):
    pass


add_tests(QuickTexts, QUICK)


if __name__ == "__main__":
    unittest.main()
