"""The figures of jostle report --figures: which there are, that their data are those of the file to
the digit, what hostile texts do in them, and what they may be written to."""

import csv
import json
import os
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree

import h5py
import numpy

from crafted_files import SEAL, sealed
from report_pages import EVERYTHING, HOSTILE
from support import BAD_INPUT, BROKEN, EVERY, HALF_OF_THREE, SHIM, SOURCE, TINY, Case, changed

PYTHON = sys.executable  # has what the tests need
KINDS = ("csv", "json", "py", "svg", "pdf")
ALL_POINTS = {
    "mean-height", "bottom-fraction", "spread-of-mean-height", "spread-of-bottom-fraction",
    "sweeps", "acceptance", "spectrum-of-mean-height", "mean-height-against-strength-of-the-taps",
    "coordination-of-the-kept-packings"}
ONE_POINT = {
    "fits-of-bottom-fraction", "blocking-of-mean-height", "ageing-of-mean-height-as-measured",
    "covariance-ratio-of-mean-height", "packing-fraction-by-height",
    "packing-fraction-by-height-smoothed", "centres-by-height-n-z", "how-sharp-the-layers-are",
    "how-full-the-layers-are", "pair-correlation-g-r", "bond-order-by-height",
    "spheres-with-fcc-order-by-height", "free-volumes", "local-packing-fractions", "faces-of-the-cells"}


def series_of(path):
    """The series of a .csv: [(name, names of columns, rows of texts)]; of several panels one after another."""
    with open(path, encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    found = {}
    for panel, name, *cells in rows:
        found.setdefault((panel, name), []).append(cells)
    return [(name, head[2:], cells) for (_, name), cells in found.items()]


def column(rows, k):
    return numpy.array([float(row[k] or "nan") for row in rows])


def shown_text(path):
    """The text that an SVG shows, its pieces joined."""
    return "".join(xml.etree.ElementTree.parse(path).getroot().itertext())


class Figures(Case):
    def figures(self, *inputs, folder="figures", **keywords):
        done = self.jostle("report", *inputs, "--figures", folder, **keywords)
        return done

    def names(self, folder="figures"):
        return {path.stem for path in (self.folder / folder).iterdir()}

    def data(self, name, folder="figures"):
        return series_of(self.folder / folder / f"{name}.csv")

    def assert_drawn(self, folder="figures", width=86):
        for name in self.names(folder):
            with self.subTest(figure=name):
                self.assertRegex(name, r"^[a-z0-9][a-z0-9-]*$")
                files = {kind: self.folder / folder / f"{name}.{kind}" for kind in KINDS}
                root = xml.etree.ElementTree.parse(files["svg"]).getroot()
                self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
                self.assertAlmostEqual(float(root.get("width").removesuffix("pt")) / 72 * 25.4, width, delta=0.2)
                tags = {element.tag.split("}")[1] for element in root.iter()}
                self.assertFalse(tags & {"script", "img", "image", "a", "foreignObject", "b", "iframe"})
                self.assertTrue(files["pdf"].read_bytes().startswith(b"%PDF"))
        self.assertEqual({path.suffix[1:] for path in (self.folder / folder).iterdir()}, set(KINDS))


class Everything(Figures):
    def test_a_file_that_has_everything(self):
        if not EVERY:
            self.skipTest("draws 120 figures: in every case")
        self.write(EVERYTHING)
        self.run_scene("-o", "everything.h5")
        done = self.figures("everything.h5")
        self.all_is_drawn(done.stdout)
        with h5py.File(self.folder / "everything.h5") as file:
            for look in (self.curves, self.fits, self.structure, self.spectrum):
                with self.subTest(look.__name__):
                    look(file)
        self.one_sweep_point_and_two_columns()
        self.a_script_draws_by_itself()
        self.the_catalogue_is_the_same()

    def all_is_drawn(self, text):
        names = self.names()
        self.assertRegex(text, rf"^figures: {len(names)} figures, each as SVG and PDF")
        self.assertLessEqual(ALL_POINTS, names)
        for name in ONE_POINT:
            for point in range(3):
                self.assertIn(f"{name}-point-{point:04}", names)
        self.assert_drawn()

    def curves(self, file):
        figure = json.loads((self.folder / "figures/mean-height.json").read_text())
        self.assertRegex(figure["origin"], r"^Data: everything\.h5: 48 spheres in .* diameters; 3 realizations "
                                           r"per sweep point\. Drawn by jostle ")
        series = self.data("mean-height")
        points = ["ε = 0.02", "ε = 0.05", "ε = 0.1"]
        self.assertEqual([name for name, _, _ in series],
                         points + [f"{one}, realization {r}" for one in points for r in range(3)])
        for point, (_, columns, rows) in enumerate(series[:3]):
            self.assertEqual(columns, ["taps t", "mean height ⟨Z⟩ (diameter)", "half width 68 %",
                                       "low", "high", "label"])
            stored = file[f"ensemble/point_{point:04}"]
            taps = column(rows, 0).astype(int)
            self.assertEqual((taps[0], taps[-1]), (0, 60))
            numpy.testing.assert_array_equal(column(rows, 1), stored["mean_height_mean"][()][taps])
            numpy.testing.assert_allclose(column(rows, 2), HALF_OF_THREE * stored["mean_height_error"][()][taps],
                                          rtol=1e-9)

    def fits(self, file):
        series = self.data("fits-of-bottom-fraction-point-0001")
        names = ["data", "inverse logarithm", "stretched exponential", "two exponentials"]
        self.assertEqual([name for name, _, _ in series], names + names[1:])  # and the residuals
        stored = file["fits/point_0001/bottom_fraction/kww"]
        t = list(stored["t"][()])
        taps = [t.index(tap) for tap in column(series[0][2], 0)]
        self.assertGreater(len(taps), 20)
        x, error, fitted = (stored[key][()][taps] for key in ("x", "x_error", "fitted"))
        numpy.testing.assert_array_equal(column(series[0][2], 1), x)
        numpy.testing.assert_allclose(column(series[0][2], 2), HALF_OF_THREE * error, rtol=1e-9)
        numpy.testing.assert_array_equal(column(series[2][2], 1), fitted)
        numpy.testing.assert_array_equal(column(series[5][2], 1), (x - fitted) / error)

    def structure(self, file):
        stored = file["structure/point_0002/profile"]
        series = self.data("packing-fraction-by-height-point-0002")
        self.assertEqual([name for name, _, _ in series], ["tap 0", "tap 7", "tap 60"])
        for k, (_, columns, rows) in enumerate(series):
            self.assertEqual(columns[0], "height z (diameters)")
            phi, error = stored["phi"][()][k], stored["phi_error"][()][k]
            there = numpy.isfinite(phi)
            numpy.testing.assert_array_equal(column(rows, 0), stored["height"][()][there])
            numpy.testing.assert_array_equal(column(rows, 1), phi[there])
            numpy.testing.assert_allclose(column(rows, 2), HALF_OF_THREE * error[there], rtol=1e-9)

    def spectrum(self, file):
        stored = file["analysis/point_0000/spectrum/mean_height"]
        name, columns, rows = self.data("spectrum-of-mean-height")[0]
        self.assertEqual(columns[:2], ["frequency (1/taps)", "power density (diameter² taps)"])
        numpy.testing.assert_array_equal(column(rows, 0), stored["frequency"][()])
        numpy.testing.assert_array_equal(column(rows, 1), stored["density"][()])

    def one_sweep_point_and_two_columns(self):
        self.figures("everything.h5", "--columns", 2, "--sweep-point", "/protocol/0/tap/dilate=0.1",
                     folder="wide")
        self.assertEqual([name for name, _, _ in self.data("mean-height", "wide")],
                         ["ε = 0.1", *(f"ε = 0.1, realization {r}" for r in range(3))])
        self.assertEqual({name[-4:] for name in self.names("wide") if "point" in name}, {"0002"})
        self.assert_drawn("wide", width=178)

    def a_script_draws_by_itself(self):
        alone = self.folder / "alone"
        alone.mkdir()
        for kind in ("json", "py"):
            shutil.copy(self.folder / "figures" / f"fits-of-bottom-fraction-point-0000.{kind}", alone)
        subprocess.run([PYTHON, "fits-of-bottom-fraction-point-0000.py"], cwd=alone, check=True,
                       env={**os.environ, "PYTHONPATH": str(SOURCE / "python")})
        for kind in ("svg", "pdf"):
            name = f"fits-of-bottom-fraction-point-0000.{kind}"
            self.assertEqual((alone / name).read_bytes(), (self.folder / "figures" / name).read_bytes())

    def the_catalogue_is_the_same(self):
        self.jostle("report", "everything.h5", "--catalogue", "figures.json")
        catalogue = json.loads((self.folder / "figures.json").read_text())
        self.assertEqual(catalogue["format"], 1)
        described = {figure["name"]: figure for figure in catalogue["figures"]}
        self.assertEqual(set(described), self.names())
        for name, figure in described.items():
            self.assertEqual(figure, json.loads((self.folder / f"figures/{name}.json").read_text()))
        done = self.jostle("report", "everything.h5", "--catalogue", "figures.json", expect=BAD_INPUT)
        self.assertIn("exists", done.stderr)


class Output(Figures):
    def setUp(self):
        super().setUp()
        self.write(changed(TINY, snapshots={"taps": []}))
        self.run_scene()

    def test_what_the_file_lacks_has_no_figure(self):
        self.figures("tiny.h5")
        self.assertEqual(self.names(), {"mean-height", "bottom-fraction", "spread-of-mean-height",
                                        "spread-of-bottom-fraction", "sweeps", "acceptance"})
        self.assert_drawn()
        self.assertFalse((self.folder / "tiny.html").exists())

    def test_several_files_stand_in_one_folder(self):
        self.write(changed(TINY, name="other", seed=1, snapshots={"taps": []}))
        self.run_scene()
        self.figures("tiny.h5", "other.h5")
        self.assertLessEqual({"tiny-mean-height", "other-mean-height"}, self.names())
        self.assertEqual(len(self.names()), 12)

    def test_nothing_is_overwritten_without_force(self):
        self.figures("tiny.h5")
        script = self.folder / "figures/mean-height.py"
        script.write_text("my own\n")
        done = self.figures("tiny.h5", expect=BAD_INPUT)
        self.assertIn("exists and is kept", done.stderr)
        self.assertEqual(script.read_text(), "my own\n")
        self.figures("tiny.h5", "--force")
        self.assertIn("mean-height.json", script.read_text())
        (self.folder / "figures/sweeps.pdf").unlink()
        (self.folder / "figures/sweeps.pdf").symlink_to(self.folder / "tiny.h5")
        results = (self.folder / "tiny.h5").read_bytes()
        self.figures("tiny.h5", "--force", expect=BROKEN)
        self.assertEqual((self.folder / "tiny.h5").read_bytes(), results)

    def test_what_is_no_folder_is_refused(self):
        self.figures("tiny.h5", folder="tiny.h5", expect=BAD_INPUT)
        self.figures("tiny.h5", folder="missing/figures", expect=BROKEN)
        for arguments in (("--columns", "2"), ("--sweep-point", "0"),
                          ("--figures", "figures", "-o", "page.html"),
                          ("--figures", "figures", "--columns", "3")):
            with self.subTest(arguments):
                self.jostle("report", "tiny.h5", *arguments, expect=BAD_INPUT)
        self.assertFalse((self.folder / "figures").exists())

    def test_a_disk_that_is_full_leaves_no_folder(self):
        full = {**SHIM, "JOSTLE_FAULT_PATH": str(self.folder / "full"), "JOSTLE_FAULT_AT": "3",
                "JOSTLE_FAULT_ACTION": "no_space"}
        before = self.files()
        done = self.jostle("report", "tiny.h5", "--figures", "full", environment=full, expect=BROKEN)
        self.assertIn("No space left", done.stderr)
        self.assertEqual(self.files(), before)
        (self.folder / "full").mkdir()
        (self.folder / "full/own.txt").write_text("own")
        self.jostle("report", "tiny.h5", "--figures", "full", environment=full, expect=BROKEN)
        self.assertEqual(self.files(), sorted([*before, "full", "full/own.txt"]))

    def test_without_matplotlib_data_and_scripts_are_written(self):
        (self.folder / "without/matplotlib").mkdir(parents=True)
        (self.folder / "without/matplotlib/__init__.py").write_text(
            "raise ModuleNotFoundError(\"No module named 'matplotlib'\")\n")
        done = self.figures("tiny.h5", environment={"PYTHONPATH": str(self.folder / "without")}, expect=BROKEN)
        self.assertIn("matplotlib", done.stderr)
        self.assertIn("apt-get install python3-matplotlib", done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual({path.suffix for path in (self.folder / "figures").iterdir()}, {".csv", ".json", ".py"})
        self.assertEqual(len(self.names()), 6)

    def test_a_python_that_fails_is_reported(self):
        fake = self.folder / "python3"
        fake.write_text("#!/bin/sh\necho 'no room for pictures' >&2\nexit 1\n")
        fake.chmod(0o755)
        done = self.figures("tiny.h5", environment={"PATH": f"{self.folder}:{os.environ['PATH']}"},
                            expect=BROKEN)
        self.assertIn("no room for pictures", done.stderr)

    def test_the_python_of_the_own_environment_comes_first(self):
        bin_folder = self.folder / "venv/bin"
        bin_folder.mkdir(parents=True)
        (self.folder / "venv/pyvenv.cfg").write_text("home = /usr/bin\n")
        program = shutil.copy2(os.environ["JOSTLE"], bin_folder / "jostle")
        fake = bin_folder / "python3"
        fake.write_text("#!/bin/sh\necho 'that of the environment' >&2\nexit 1\n")
        fake.chmod(0o755)
        done = subprocess.run([program, "report", "tiny.h5", "--figures", "figures"], cwd=self.folder, text=True,
                              capture_output=True, timeout=60, check=False)
        self.assertEqual(done.returncode, BROKEN)
        self.assertIn("that of the environment", done.stderr)

    def test_settings_of_the_user_change_nothing(self):
        self.figures("tiny.h5")
        (self.folder / "matplotlibrc").write_text("axes.facecolor: red\nfont.size: 40\nbackend: tkagg\n")
        self.figures("tiny.h5", folder="again", environment={"MPLCONFIGDIR": str(self.folder),
                                                             "MATPLOTLIBRC": str(self.folder)})
        for name in self.names():
            self.assertEqual((self.folder / f"figures/{name}.svg").read_bytes(),
                             (self.folder / f"again/{name}.svg").read_bytes())


class Hostile(Figures):
    LABEL = HOSTILE + "'\\n$x^2$ \\frac{1}{2} `touch /tmp/jostle-hostile` @HOME {/=99 A}_2^3 %d\"\"\"\\"

    def test_texts_of_a_forged_file_are_texts(self):
        self.write(changed(EVERYTHING, sweep={"/protocol/0/tap/dilate": [0.02, 0.05]},
                           structure={"profile": {}, "layers": {}}))
        self.run_scene("-o", "forged.h5")
        path = self.folder / "forged.h5"
        path.write_bytes(path.read_bytes()[:-SEAL])
        with h5py.File(path, "r+") as file:
            for point in range(2):
                file[f"sweep/point_{point:04}"].attrs["label"] = self.LABEL

            def forge(name, item):
                for key, value in item.attrs.items():
                    if (key.startswith("note_") or key in ("long_name", "source", "units")) and \
                            key not in ("note_refused", "note_observable", "note_against"):
                        item.attrs[key] = self.LABEL if isinstance(value, str) else value
            for group in ("fits", "analysis", "structure", "observables"):
                file[group].visititems(forge)
        path.write_bytes(sealed(path.read_bytes()))
        os.rename(path, self.folder / "a`b'$(x)<b>.h5")
        self.figures("a`b'$(x)<b>.h5")
        self.assert_drawn()
        self.assertFalse(os.path.exists("/tmp/jostle-hostile"))
        figure = json.loads((self.folder / "figures/mean-height.json").read_text())
        self.assertEqual(len([one for one in figure["panels"][0]["series"] if not one.get("thin")]), 2)
        self.assertIn('</script><script>document', shown_text(self.folder / "figures/mean-height.svg"))
        for script in (self.folder / "figures").glob("*.py"):
            self.assertNotRegex(script.read_text(), r"<script|touch|`|HOME|frac\{")
        for table in (self.folder / "figures").glob("*.csv"):
            with open(table, encoding="utf-8", newline="") as file:
                self.assertEqual({len(row) for row in csv.reader(file)}, {8})


if __name__ == "__main__":
    unittest.main()
