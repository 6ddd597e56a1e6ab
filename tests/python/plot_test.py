"""Figures show the numbers that they are made of."""

import copy
import json
import os
import pathlib
import unittest
import unittest.mock
import xml.etree.ElementTree

import jostle
import numpy as np
from jostle.plot.drawing import typeset
from jostle.plot.values import number, with_error
from jostle.student import factor, half_width
from matplotlib import pyplot
from matplotlib.backends.backend_agg import FigureCanvasAgg

from support import TINY, Case, changed, made

SOURCE = pathlib.Path(os.environ["SOURCE"])
BED = changed(TINY, name="bed", realizations=4, sweep=None,
              protocol=[{"tap": {"dilate": 0.05}, "count": 64}], snapshots={"taps": [0, 64]},
              fits=[{"observable": "mean_height", "model": "inverse_log"}],
              analyse={"ageing": [{"observable": "mean_height"}],
                       "spectrum": [{"observable": "mean_height", "last": 64}]},
              structure={"profile": {}})
LOOP = changed(TINY, sweep=None, snapshots=None, protocol=[
    {"ramp": {"dilate": {"from": 0.02, "to": 0.1, "step": 0.04}}, "count": 8},
    {"ramp": {"dilate": {"from": 0.1, "to": 0.02, "step": 0.04}}, "count": 8}],
    analyse={"hysteresis": [{"observable": "mean_height"}]})
BELL = changed(TINY, snapshots=None, sweep={"/protocol/0/tap/dilate": [0.02, 0.05, 0.1]},
               analyse={"sweep": [{"observable": "mean_height"}]})


class Figures(Case):
    def setUp(self):
        super().setUp()
        self.ax = pyplot.figure().gca()
        self.addCleanup(pyplot.close, self.ax.figure)

    def drawn(self):
        self.ax.figure.savefig("figure.png")  # figures that cannot be drawn fail here
        self.assertGreater((self.folder / "figure.png").stat().st_size, 5000)
        return [np.array(line.get_xydata()) for line in self.ax.get_lines()]

    def test_compaction_shows_tap_0_and_a_band(self):
        results = self.open(made(TINY))
        jostle.plot.compaction(results, "mean_height", points=[0, 3], ax=self.ax)
        lines = self.drawn()
        self.assertEqual(len(lines), 2)
        np.testing.assert_array_equal(lines[1][:, 0], np.arange(41))
        np.testing.assert_array_equal(lines[1][:, 1], results.points[3].mean["mean_height"])
        self.assertLess(self.ax.get_xlim()[0], 0)
        self.assertEqual(self.ax.get_xscale(), "symlog")
        self.assertEqual(self.ax.get_ylabel(), "mean height (diameter)")
        top = max(self.ax.collections[1].get_paths()[0].vertices[:, 1])
        point = results.points[3]
        self.assertAlmostEqual(top, max(point.mean["mean_height"] +
                                        half_width(point.error["mean_height"], 2)), places=12)
        with self.assertRaisesRegex(ValueError, "one of error, sigma, none"):
            jostle.plot.compaction(results, "mean_height", band="two", ax=self.ax)

    def test_a_fit_is_drawn_over_its_curve(self):
        table = self.open(made(BED)).tables.one("inverse_log")
        jostle.plot.fit(table, ax=self.ax)
        points, law = [line for line in self.drawn() if len(line) == 64]
        np.testing.assert_array_equal(points[:, 1], table["x"])
        np.testing.assert_array_equal(law[:, 1], table["fitted"])

    def test_a_fit_to_one_realization_is_drawn_without_a_band(self):
        table = self.open(made(changed(BED, realizations=1, analyse=None, structure=None))) \
            .tables.one("inverse_log")
        self.assertNotIn("x_error", table)
        jostle.plot.fit(table, ax=self.ax)
        self.assertEqual(len([line for line in self.drawn() if len(line) == 64]), 2)

    def test_points_without_taps_are_not_drawn(self):
        # A share: realization 0 of point 0, not of point 1.
        share = self.open(made(changed(TINY, realizations=1, sweep={
            "/protocol/0/tap/dilate": [0.02, 0.05]}), "--shard", "1/2"))
        there = [point.has_taps for point in share.points]
        self.assertEqual(sorted(there), [False, True])
        jostle.plot.compaction(share, "mean_height", ax=self.ax)
        self.assertEqual(len(self.drawn()), 1)
        with self.assertRaisesRegex(jostle.NotThere, "none of its realizations has taps"):
            jostle.plot.compaction(share, "mean_height", points=there.index(False), ax=self.ax)

    def test_ageing_is_drawn_measured_and_scaled(self):
        table = self.open(made(BED)).tables.one("ageing")
        jostle.plot.ageing(table, ax=self.ax)
        first = self.drawn()[0]
        known = np.isfinite(table["a"][0])
        np.testing.assert_array_equal(first[:, 1], table["a"][0][known])
        ax = pyplot.figure().gca()
        self.addCleanup(pyplot.close, ax.figure)
        if np.isfinite(table["scaled_a"]).any():
            jostle.plot.ageing(table, scaled=True, ax=ax)
            known = np.isfinite(table["scaled_a"][0])
            np.testing.assert_array_equal(ax.get_lines()[0].get_ydata(), table["scaled_a"][0][known])
        else:
            with self.assertRaisesRegex(jostle.NotThere, "no scaled curves"):
                jostle.plot.ageing(table, scaled=True, ax=ax)

    def test_scaled_ageing_of_a_law(self):
        """A table as the program makes one of curves that collapse."""
        lag = np.array([1.0, 10, 100])
        curves = np.array([[0.1, 0.2, 0.3], [0.05, np.nan, 0.25]])
        along = ("waiting_time", "lag")
        table = jostle.Table(
            "ageing", {"waiting_time": jostle.Quantity(np.array([0, 10]), ("waiting_time",)),
                       "lag": jostle.Quantity(lag, ("lag",))},
            {"scaled_lag": jostle.Quantity(np.array([lag, lag / 3]), along),
             "scaled_a": jostle.Quantity(curves, along),
             "scaled_a_error": jostle.Quantity(curves / 10, along),
             "realizations_fitted": jostle.Quantity(np.array(4), ())}, {})
        jostle.plot.ageing(table, scaled=True, ax=self.ax)
        first, second = (line for line in self.drawn() if len(line) > 1)
        np.testing.assert_array_equal(first, np.transpose([lag, curves[0]]))
        np.testing.assert_array_equal(second[:, 0], [1 / 3, 100 / 3])

    def test_spectrum_hysteresis_and_sweep(self):
        table = self.open(made(BED)).tables.one("spectrum")
        jostle.plot.spectrum(table, ax=self.ax)
        lines = self.drawn()
        np.testing.assert_array_equal(lines[0][:, 1], table["density"])
        if np.isfinite(table["slope"]):
            steps = np.diff(np.log(lines[-1]), axis=0)
            np.testing.assert_allclose(steps[:, 1] / steps[:, 0], table["slope"])
        self.ax.clear()
        table = self.open(made(LOOP)).tables.one("hysteresis")
        jostle.plot.hysteresis(table, ax=self.ax)
        up, down = (line for line in self.drawn() if len(line) > 2)
        np.testing.assert_array_equal(up[:, 1], table["mean_height"][table["branch"] == 0])
        self.assertEqual(down[0].tolist(), up[-1].tolist())  # the turn belongs to both
        self.ax.clear()
        table = self.open(made(BELL)).tables.one("sweep")
        jostle.plot.sweep(table, ax=self.ax)
        np.testing.assert_array_equal(self.drawn()[0][:, 1], table["mean_height"])

    def test_heights_and_profiles(self):
        results = self.open(made(BED))
        jostle.plot.height_histogram(results, taps=[64], layers=False, ax=self.ax)
        (line,) = self.drawn()
        histogram = results.points[0].snapshots["height_histogram"]
        np.testing.assert_allclose(line[:, 1], histogram[1].mean(axis=0))
        self.ax.clear()
        table = results.tables.one("profile")
        jostle.plot.profile(table, ax=self.ax)
        np.testing.assert_array_equal(self.drawn()[0][:, 1], table["phi"][0])
        with self.assertRaisesRegex(jostle.NotThere, "no histogram of tap 3; kept: 0, 64"):
            jostle.plot.height_histogram(results, taps=[3], ax=self.ax)

    def test_a_slice_has_the_discs_of_the_plane(self):
        results = self.open(made(BED))
        jostle.plot.packing_slice(results, normal="z", at=1.0, ax=self.ax)
        self.drawn()
        discs = self.ax.collections[0].get_paths()
        area = sum(np.prod(disc.get_extents().size) * np.pi / 4 for disc in discs)
        below = np.abs(results.positions()[:, 2] - 1) < 0.5
        self.assertGreaterEqual(len(discs), below.sum())  # and images beyond periodic sides
        fully = np.pi * (0.25 - (results.positions()[below, 2] - 1) ** 2).sum()
        self.assertGreaterEqual(area, fully * (1 - 1e-9))
        with self.assertRaisesRegex(ValueError, "one of x, y, z"):
            jostle.plot.packing_slice(results, normal="w", ax=self.ax)

    def test_a_slice_of_a_mixture_has_discs_of_every_size_and_colours_of_kinds(self):
        scene = changed(TINY, name="slice", sweep=None, realizations=1, container={"sides": "periodic", "width": 6},
                        spheres=[{"name": "small", "count": 40}, {"name": "large", "count": 10, "diameter": 2}],
                        observe=["mean_height"], protocol=[{"tap": {"dilate": 0.05}, "count": 1}],
                        snapshots={"taps": [1]})
        results = self.open(made(scene))
        jostle.plot.packing_slice(results, normal="z", at=1.5, ax=self.ax)
        self.drawn()
        self.assertEqual([text.get_text() for text in self.ax.get_legend().get_texts()], ["small", "large"])
        point = results.points[0]
        above = results.positions()[:, 2] - 1.5
        for kind, drawn in enumerate(self.ax.collections):
            radii = np.array([path.get_extents().width for path in drawn.get_paths()]) / 2
            own = point.kind == kind
            expected = np.sqrt(np.maximum(point.diameters()[own] ** 2 / 4 - above[own] ** 2, 0))
            self.assertGreater((expected > 0).sum(), 1)
            for radius in expected[expected > 0]:
                self.assertLess(np.abs(radii - radius).min(), 1e-9)
            self.assertAlmostEqual(radii.max(), expected.max(), places=9)
        self.assertGreater(radii.max(), 0.6)  # a sphere of 1 d has no such disc

    def test_what_cannot_be_drawn_says_why(self):
        with self.assertRaisesRegex(jostle.NotThere, "this draws tables of jostle fit"):
            jostle.plot.fit(self.open(made(BED)).tables.one("spectrum"), ax=self.ax)


class Student(unittest.TestCase):
    def test_factors_are_those_of_the_tables(self):
        """docs/reference/analyses.md; scipy.stats.t.ppf((1 + 0.6827) / 2, dof)."""
        for dof, expected in ((1, 1.8373), (2, 1.3213), (9, 1.0592), (1000, 1.0005)):
            self.assertAlmostEqual(factor(dof), expected, places=3)
        self.assertEqual(factor(float("inf")), 1)
        self.assertTrue(np.isnan(factor(0)))
        np.testing.assert_allclose(half_width([[1.0, 2.0]], [1, 2]), [[factor(1), 2 * factor(2)]])


HOSTILE = "</script><b onclick=alert(1)> $x^2$ \\frac{1}{2} {a}_b ^2 %d \"'` \\"


class Catalogue(Case):
    def test_every_figure_is_drawn_with_its_numbers(self):
        figures = jostle.plot.figures(self.open(made(BED)))
        self.assertLessEqual({"mean-height", "fits-of-mean-height", "spectrum-of-mean-height",
                              "packing-fraction-by-height"}, set(figures))
        for name, figure in figures.items():
            for columns, width in ((1, 86), (2, 178)):
                with self.subTest(figure=name, columns=columns):
                    drawn = jostle.plot.draw(figure, columns=columns)
                    self.assertEqual(len(drawn.axes), len(figure["panels"]))
                    self.assertAlmostEqual(drawn.get_size_inches()[0] * 25.4, width, places=6)
                    self.assert_inside(drawn)
        stored = self.open(made(BED)).points[0]
        series = figures["mean-height"]["panels"][0]["series"][0]
        taps = np.array(series["x"], int)
        self.assertEqual((taps[0], taps[-1]), (0, 64))
        np.testing.assert_array_equal(series["y"], stored.mean["mean_height"][taps])
        ax = jostle.plot.draw(figures["mean-height"]).axes[0]
        line = max(ax.get_lines(), key=lambda one: len(one.get_xdata()))
        np.testing.assert_array_equal(line.get_ydata(), stored.mean["mean_height"][taps[1:]])

    def assert_inside(self, drawn):
        """No text leaves the figure, and the legend is above the axes."""
        renderer = FigureCanvasAgg(drawn).get_renderer()
        drawn.draw(renderer)
        frame = drawn.bbox
        for ax in drawn.axes:
            box = ax.get_tightbbox(renderer)
            self.assertGreaterEqual(min(box.x0 - frame.x0, box.y0 - frame.y0, frame.y1 - box.y1), -1)
            self.assertLessEqual(box.x1, frame.x1 + 8)
            if ax.get_legend():
                self.assertGreaterEqual(ax.get_legend().get_window_extent(renderer).y0, ax.bbox.y1 - 1)

    def test_texts_are_texts(self):
        figure = copy.deepcopy(jostle.plot.figures(self.open(made(BED)))["fits-of-mean-height"])
        for panel in figure["panels"]:
            panel["x"]["label"] = panel["y"]["label"] = HOSTILE
            for series in panel["series"]:
                series["name"] = HOSTILE
        for columns in (1, 2):
            drawn = jostle.plot.draw(figure, columns=columns)
            renderer = FigureCanvasAgg(drawn).get_renderer()
            self.assertLessEqual(drawn.axes[0].get_legend().get_window_extent(renderer).x1, drawn.bbox.x1)
        jostle.plot.save(drawn, self.folder / "hostile")
        root = xml.etree.ElementTree.parse(self.folder / "hostile.svg").getroot()
        self.assertGreater("".join(root.itertext()).count(HOSTILE[:40]), 4)
        self.assertFalse({"script", "b", "image"} & {element.tag.split("}")[1] for element in root.iter()})

    def test_symbols_have_subscripts_and_names_have_none(self):
        self.assertEqual(typeset("A(t, t_W) of Φ_b"), r"A(t, t$_{W}$) of Φ$_{b}$")
        for text in ("max_step = 0.1", "a_bc", "x__y", "_a"):
            self.assertEqual(typeset(text), text)

    def letters_of(self, label):
        """All letters of a figure as it is saved with this label of y."""
        figure = copy.deepcopy(jostle.plot.figures(self.open(made(BED)))["mean-height"])
        figure["panels"][0]["y"]["label"] = label
        jostle.plot.save(jostle.plot.draw(figure), self.folder / "letters", kinds=["svg"])
        root = xml.etree.ElementTree.parse(self.folder / "letters.svg").getroot()
        return "".join("".join(text.itertext()) for text in root.iter("{http://www.w3.org/2000/svg}text"))

    def test_letters_missing_from_the_first_font_are_drawn_beside_a_subscript(self):
        with unittest.mock.patch("jostle.plot.drawing.FONTS", ("cmss10", "DejaVu Sans")):
            letters = self.letters_of("mean \u27e8h_c\u27e9")
        self.assertLess({"\u27e8", "\u27e9"}, set(letters))
        self.assertNotIn("\u00a4", letters)  # the sign for a missing letter

    def test_every_letter_may_stand_beside_a_subscript(self):
        for text in ("h_c \U00020000", "x_\U00020000", "h_c \u4e2d", "h_c \\", "\\h_c", "\\\u27e8h_c\u27e9", "\\\\\u27e8h_c", "h_c $",
                     "\\$h_c", "{h_c %^"):
            with self.subTest(text=text):
                self.assertEqual(self.letters_of(text).count("$"), text.count("$"))

    def test_files_are_the_same_on_every_day(self):
        figure = jostle.plot.figures(self.open(made(BED)))["mean-height"]
        for name in ("one", "two.pdf"):
            jostle.plot.save(jostle.plot.draw(figure), self.folder / name)
        for kind in ("svg", "pdf"):
            self.assertEqual((self.folder / f"one.{kind}").read_bytes(), (self.folder / f"two.{kind}").read_bytes())


class Values(unittest.TestCase):
    def test_numbers_are_shown_as_the_shared_vectors_say(self):
        vectors = json.loads((SOURCE / "tests/data/value_texts.json").read_text())
        for value, digits, text in vectors["numbers"]:
            self.assertEqual(number(float(value), digits), text)
        for value, error, text in vectors["with_error"]:
            self.assertEqual(with_error(float(value), float(error)), text)


if __name__ == "__main__":
    unittest.main()
