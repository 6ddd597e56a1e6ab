"""The page of jostle report in headless Chromium: its sections have the values of the file."""

import base64
import json
import unittest

import h5py
import numpy

from opened import BROWSER, FOLDER, Open
from pages import CATALOGUED
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select
from support import SOURCE

SECTIONS = {"summary", "run", "compaction", "spread", "packing", "fits", "steady", "ageing", "spectra", "sweep",
            "snapshots", "profile", "sides", "layers", "coordination", "pair_correlation", "order",
            "voronoi", "pores", "void_probability", "holes", "relaxation"}


class Sections(Open):
    def test_all_that_the_file_has(self):
        self.assertEqual(set(self.sections()), SECTIONS)
        links = [link.get_attribute("href").split("#")[1] for link in BROWSER.find_all(".contents li a")]
        self.assertEqual(links, [one.get_attribute("id") for one in BROWSER.find_all("section")])

    def test_every_figure_is_drawn_with_caption_units_and_a_table(self):
        BROWSER.draw_everything()
        figures = BROWSER.find_all("figure")
        self.assertGreater(len(figures), 30)
        for figure in figures:
            title = figure.find_element(By.TAG_NAME, "h4").get_attribute("textContent")
            with self.subTest(title):
                facts = BROWSER.run("""
                    const svg = arguments[0].querySelector(".canvas svg"), box = svg.getBoundingClientRect();
                    const inside = [...svg.querySelectorAll("text")].every((text) => {
                      const at = text.getBoundingClientRect();
                      return at.width === 0 || at.left >= box.left - 8 && at.right <= box.right + 8;
                    });
                    arguments[0].querySelector("details").open = true;
                    return {text: svg.textContent, marks: svg.querySelectorAll("path, circle, line").length,
                            label: svg.getAttribute("aria-label"), inside, markup: svg.outerHTML,
                            caption: arguments[0].querySelector("figcaption").textContent};""", figure)
                self.assertGreater(facts["marks"], 2)
                self.assertGreater(len(facts["caption"]), 20)
                self.assertNotIn(".h5", facts["caption"])  # the top of the page names file and bed
                self.assertIn(title, facts["label"])
                self.assertTrue(facts["inside"], "a text leaves its figure")
                for bad in ("NaN", "Infinity", "undefined", "null"):
                    self.assertNotIn(bad, facts["markup"])
                rows = BROWSER.wait(lambda: BROWSER.run(
                    "return arguments[0].querySelectorAll('details tbody tr').length", figure))
                self.assertGreater(rows, 1)

    def test_the_summary_comes_first_and_has_five_lines(self):
        self.assertEqual(self.sections()[:2], ["summary", "run"])
        terms = [one.text for one in BROWSER.find_all("#file-0-summary dt")]
        self.assertEqual(terms, ["run", "end", "law", "steady?", "ageing?"])

    def test_spread_and_relaxation_are_folded_and_drawn_when_opened(self):
        for name in ("spread", "relaxation"):
            with self.subTest(name):
                fold = BROWSER.find(f"#file-0-{name} > details")
                self.assertIsNone(fold.get_attribute("open"))
                BROWSER.run("arguments[0].click()", BROWSER.show(fold.find_element(By.TAG_NAME, "summary")))
                BROWSER.wait(lambda: BROWSER.run(
                    "return arguments[0].querySelector('.canvas svg')?.getBoundingClientRect().width > 200", fold))

    def test_titles_have_the_symbols_of_print(self):
        titles = {one.get_attribute("innerHTML") for one in BROWSER.find_all("#file-0-coordination h4")}
        self.assertIn("Coordination N<sub>c</sub> by tap", titles)

    def test_a_peak_beyond_the_axis_is_clipped(self):
        figure = BROWSER.show(BROWSER.find("#file-0-pair_correlation figure"))
        BROWSER.draw_everything()
        facts = BROWSER.run("""
            const svg = arguments[0].querySelector(".canvas svg"), spec = arguments[0].figure.spec;
            return {domain: svg.scale("x").domain, top: svg.scale("y").domain[1], high: spec.y.high,
                    clipped: svg.querySelectorAll("g[clip-path]").length,
                    peak: Math.max(...spec.series.flatMap((one) => one.rows.map((row) => row.y)))};""", figure)
        self.assertEqual((facts["domain"][0], facts["top"]), (0.9, facts["high"]))
        self.assertGreater(facts["peak"], facts["top"])
        self.assertGreater(facts["clipped"], 0)

    def test_it_fetches_nothing(self):
        BROWSER.draw_everything()
        self.assertEqual(BROWSER.run("return performance.getEntriesByType('resource').map((one) => one.name)"),
                         [])

    def test_words_of_fits_are_those_of_the_file(self):
        with h5py.File(FOLDER / "whole.h5") as file:
            stored = file["fits/point_0000/bottom_fraction/kww/statement"].asstr()[()]
        text = BROWSER.find("#file-0-fits").get_attribute("textContent")
        for statement in stored:
            self.assertIn(statement, text)


class SameFigures(Open):
    """The page draws the catalogue, as jostle report --catalogue describes it: every figure, and no other."""

    def test_every_figure_of_the_page_is_one_of_the_catalogue_and_the_reverse(self):
        for name in CATALOGUED:
            BROWSER.open(FOLDER / f"{name}.html")
            catalogue = panels_of(FOLDER / f"{name}-figures.json")
            shown = BROWSER.run("""
                return [...document.querySelectorAll("figure")].map(({figure}) => ({
                  title: figure.spec.title, caption: figure.spec.caption, source: figure.spec.source,
                  labels: [figure.spec.x.label, figure.spec.y.label], names: figure.spec.series.map((one) => one.name),
                  rows: figure.spec.series.flatMap((one) => one.rows.map((row) => [row.x, row.y, row.error ?? null])),
                }));""")
            self.assertGreater(len(shown), 3)
            for one in shown:
                with self.subTest(page=name, figure=one["title"]):
                    own = catalogue.pop(one["title"])
                    for key in ("caption", "source"):
                        self.assertEqual(one[key], own[key])
                    self.assertEqual(one["labels"], [own["x"]["label"], own["y"]["label"]])
                    self.assertEqual(one["names"], [series["name"] for series in own["series"]])
                    rows = numpy.array(one["rows"], dtype=float)  # null: not a number
                    stored = numpy.array([row for series in own["series"] for row in zip(
                        series["x"], series["y"], series.get("error", [None] * len(series["x"])))], dtype=float)
                    # The page has 7 digits, and residuals are small differences.
                    small = 1e-4 if one["title"].startswith("Residuals") else 1e-12
                    numpy.testing.assert_allclose(rows, stored, rtol=1e-5, atol=small)
            self.assertEqual(set(catalogue), set(), "not on the page")


def panels_of(path):
    """{title: panel} of a catalogue, of the first sweep point where a figure shows one."""
    return {panel["title"]: panel for figure in json.loads(path.read_text())["figures"]
            if figure.get("point", 0) == 0 for panel in figure["panels"]}


class Values(Open):
    name = "plain"

    def test_numbers_are_shown_as_the_shared_vectors_say(self):
        vectors = json.loads((SOURCE / "tests/data/value_texts.json").read_text())
        for kind, function in (("numbers", "number"), ("with_error", "withError"), ("counts", "count"), ("durations", "duration")):
            shown = BROWSER.run(f"""
                const ends = {{nan: NaN, inf: Infinity, "-inf": -Infinity}};
                return arguments[0].map((one) => jostle.format.{function}(...one.slice(0, -1).map((value) => ends[value] ?? value)));""",
                                vectors[kind])
            self.assertEqual(shown, [one[-1] for one in vectors[kind]])


class Spread(Open):
    name = "spread"

    def test_an_error_as_large_as_its_value_leaves_a_logarithmic_axis_as_it_is(self):
        BROWSER.draw_everything()
        figure = next(one for one in BROWSER.find_all("figure")
                      if one.find_element(By.TAG_NAME, "h4").get_attribute("textContent") == "Pores by volume")
        axis = BROWSER.run("""
            const svg = arguments[0].querySelector(".canvas svg"), scale = svg.scale("y");
            return {type: scale.type, domain: scale.domain};""", figure)
        with h5py.File(FOLDER / "spread.h5") as file:
            values = []
            file["structure"].visititems(lambda name, item: values.extend(item[()].ravel())
                                         if name.endswith("/rho_v") else None)
        least = min(value for value in values if value > 0)
        self.assertEqual(axis["type"], "log")
        self.assertGreater(axis["domain"][0], least / 10)


class Plain(Open):
    name = "plain"

    def test_what_the_file_lacks_has_no_section(self):
        self.assertEqual(self.sections(), ["summary", "run", "compaction", "relaxation"])
        self.assertEqual(BROWSER.find_all(".chips, canvas"), [])


class Loop(Open):
    name = "loop"

    def test_hysteresis(self):
        self.assertIn("hysteresis", self.sections())
        BROWSER.draw_everything()
        legend = BROWSER.find("#file-0-hysteresis .legend").get_attribute("textContent")
        self.assertEqual(legend, "branch 1, upwardsbranch 2, downwards")


class States(Open):
    name = "states"

    def test_ordering_motion_and_volumes_say_what_the_file_says(self):
        self.assertLess({"ordering", "motion", "volumes", "gaps", "structure_factor", "clusters"},
                        set(self.sections()))
        self.assertNotIn("others", self.sections())
        with h5py.File(FOLDER / "states.h5") as file:
            analysis = file["analysis"]
            notes = {
                "ordering": analysis["ordering/bottom_fraction"].attrs["note_verdict"],
                "motion": analysis["point_0000/motion/displacement"].attrs["note_age"],
                "volumes": analysis["volumes/mean_height"].attrs["note_verdict"]}
        for section, note in notes.items():
            with self.subTest(section):
                self.assertIn(note, BROWSER.find(f"#file-0-{section}").get_attribute("textContent"))


class Memory(Open):
    name = "memory"

    def test_memory_says_what_the_file_says(self):
        with h5py.File(FOLDER / "memory.h5") as file:
            note = file["analysis/memory/mean_height"].attrs["note_verdict"]
        text = BROWSER.find("#file-0-memory").get_attribute("textContent")
        self.assertIn(note, text)
        self.assertIn("lags 2 to 3", text)


class Grains(Open):
    name = "grains"

    def test_energies_and_contacts(self):
        self.assertIn("grains", self.sections())
        titles = BROWSER.find("#file-0-grains").get_attribute("textContent")
        for word in ("Kinetic energy", "Contacts"):
            self.assertIn(word, titles)

    def test_forces_are_those_of_the_contacts(self):
        packings = self.data()["files"][0]["packings"]
        self.assertEqual([(one["realization"], one["tap"]) for one in packings],
                         [(0, 0), (0, 2), (1, 0), (1, 2)])
        with h5py.File(FOLDER / "grains.h5") as file:
            for one in packings:
                group = file[f"particles/point_0000_realization_{one['realization']:05}"]
                step = list(group["position/step"][()]).index(one["tap"])
                ends = [*group["contacts/offset"][()], len(group["contacts/first"])]
                own = slice(ends[step], ends[step + 1])
                force = numpy.zeros(60)
                for key in ("first", "second"):
                    sphere = group[f"contacts/{key}"][own]
                    is_sphere = sphere < 60
                    numpy.add.at(force, sphere[is_sphere], group["contacts/normal_force"][own][is_sphere])
                drawn = numpy.frombuffer(base64.b64decode(one["force"]), numpy.uint8)
                self.assertAlmostEqual(one["greatest_force"], force.max(), delta=1e-5 * force.max())
                self.assertGreater(force.max(), 1)
                numpy.testing.assert_allclose(drawn / 255 * force.max(), force, atol=force.max() / 500)

    def test_spheres_are_coloured_by_force(self):
        BROWSER.show(BROWSER.find("canvas.packing"))
        menu = next(Select(one.find_element(By.TAG_NAME, "select")) for one in BROWSER.find_all("label.chooser")
                    if one.text.startswith("Colour by"))
        before = BROWSER.picture(BROWSER.find("canvas.packing"))
        menu.select_by_visible_text("force")
        self.assertNotEqual(BROWSER.picture(BROWSER.find("canvas.packing")), before)
        key = BROWSER.find(".packing-panel .key").text
        self.assertIn("sum of the normal forces on a sphere, m g", key)
        self.assertRegex(key, r"\d and more")
        BROWSER.run("document.querySelector('.packing-panel details').open = true")
        rows = BROWSER.wait(lambda: BROWSER.find_all(".packing-panel details tbody tr"))
        self.assertEqual(sum(int(row.find_elements(By.TAG_NAME, "td")[0].text) for row in rows), 60)
        self.assertIn("and more", rows[-1].text)


class Mixture(Open):
    name = "mixture"

    def test_sizes_and_kinds_are_those_of_the_file(self):
        packings = self.data()["files"][0]["packings"]
        self.assertEqual(len(packings), 6)
        with h5py.File(FOLDER / "mixture.h5") as file:
            kinds = file["spheres/point_0000/kind"][()]
            diameters = file["spheres/point_0000/diameter"][()]
            for one in packings:
                radii = numpy.frombuffer(base64.b64decode(one["radius"]), "<u2") / 65535 * one["greatest_radius"]
                numpy.testing.assert_allclose(2 * radii, diameters[one["realization"]], atol=1e-4)
                numpy.testing.assert_array_equal(numpy.frombuffer(base64.b64decode(one["kind"]), numpy.uint8), kinds)
                self.assertEqual(one["kinds"], ["small", "large"])
                self.assertNotIn("q6", one)

    def test_spheres_are_drawn_by_size_and_coloured_by_kind(self):
        canvas = BROWSER.show(BROWSER.find("canvas.packing"))
        menu = next(Select(one.find_element(By.TAG_NAME, "select")) for one in BROWSER.find_all("label.chooser")
                    if one.text.startswith("Colour by"))
        self.assertEqual([one.text for one in menu.options],
                         ["kind", "diameter", "coordination", "local packing fraction", "height"])
        key = BROWSER.find(".packing-panel .key")
        self.assertRegex(key.text, "(?s)kind of sphere.*small.*large")
        BROWSER.run("document.querySelector('.packing-panel details').open = true")
        rows = BROWSER.wait(lambda: BROWSER.find_all(".packing-panel details tbody tr"))
        self.assertEqual({row.text.split()[0]: row.text.split()[1] for row in rows}, {"small": "60", "large": "8"})
        before = BROWSER.picture(canvas)
        menu.select_by_visible_text("diameter")
        self.assertNotEqual(BROWSER.picture(canvas), before)
        self.assertIn("diameter of the sphere", key.text)
        menu.select_by_visible_text("coordination")
        self.assertIn("centres within 1.05 times the sum of the two radii", key.text)

    def test_a_sphere_covers_the_area_of_its_size(self):
        drawn = BROWSER.run("""
            const canvas = document.createElement("canvas");
            canvas.style.width = canvas.style.height = "400px";
            document.body.append(canvas);
            const view = new jostle.View(canvas);
            view.background = [1, 1, 1];
            view.ink = [1, 1, 1];
            const pixels = (radius) => {
              view.show({centres: new Float32Array([1.5, 1.5, 1.5]), radii: new Float32Array([radius]),
                         colours: new Uint8Array([200, 0, 0, 255]), lines: new Float32Array(6), size: [3, 3, 3]});
              const {width, height} = canvas, flat = document.createElement("canvas");
              Object.assign(flat, {width, height});
              const plane = flat.getContext("2d", {willReadFrequently: true});
              plane.drawImage(canvas, 0, 0);
              const all = plane.getImageData(0, 0, width, height).data;
              let n = 0;
              for (let i = 0; i < all.length; i += 4) if (all[i + 1] < 128) ++n;
              return n;
            };
            const found = [pixels(0.25), pixels(0.5)];
            canvas.remove();
            return found;""")
        self.assertGreater(drawn[0], 100)
        self.assertAlmostEqual(drawn[1] / drawn[0], 4, delta=0.3)

    def test_heights_of_kinds_stand_in_one_figure(self):
        BROWSER.draw_everything()
        names = BROWSER.run("""
            const one = [...document.querySelectorAll("figure")].find(({figure}) => figure.spec.title === "Heights of the kinds");
            return one.figure.spec.series.map((series) => series.name);""")
        self.assertEqual(names, ["small", "large"])

    def test_distances_are_relative_to_the_sum_of_two_radii(self):
        labels = BROWSER.run("""
            return [...document.querySelectorAll("figure")].map(({figure}) => [figure.spec.title, figure.spec.x.label]);""")
        labels = dict(labels)
        self.assertEqual(labels["Coordination by cut"], "cut (sum of the two radii)")
        self.assertIn("sum of the two radii", labels["Partial pair correlation"])


class Cost(Open):
    name = "cost"

    def test_accuracy_against_time(self):
        self.assertIn("cost", self.sections())
        BROWSER.draw_everything()
        self.assertIn("no other is better and faster",
                      BROWSER.find("#file-0-cost figure svg").get_attribute("textContent"))


class Two(Open):
    name = "two"

    def test_two_files_are_two_chapters(self):
        self.assertEqual([one.text for one in BROWSER.find_all("article h2")], ["plain", "loop"])
        ids = [one.get_attribute("id") for one in BROWSER.find_all("[id]")]
        self.assertEqual(len(ids), len(set(ids)))


if __name__ == "__main__":
    unittest.main()
