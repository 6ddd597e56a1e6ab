"""The page of jostle report in headless Chromium: figures, packings, looks, and what hostile texts do."""

import base64
import csv
import re
import unittest
import xml.etree.ElementTree

import h5py
import numpy

from opened import BROWSER, FOLDER, Open
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select
from support import HALF_OF_THREE


class Figures(Open):
    def first_figure(self):
        figure = BROWSER.show(BROWSER.find("#file-0-compaction figure"))
        BROWSER.wait(lambda: figure.find_elements(By.CSS_SELECTOR, ".canvas svg"))
        return figure

    def test_hover_tells_values(self):
        svg = self.first_figure().find_element(By.CSS_SELECTOR, ".canvas svg")
        tip = "return arguments[0].querySelector('[aria-label=tip]').textContent"
        self.assertEqual(BROWSER.run(tip, svg), "")
        for dx in (10, 60, 110, -60):
            ActionChains(BROWSER.driver).move_to_element_with_offset(svg, dx, 5).perform()
            BROWSER.frames()
            if BROWSER.run(tip, svg):
                break
        text = BROWSER.run(tip, svg)
        self.assertRegex(text, r"ε = 0\.\d+")
        self.assertRegex(text, r"tap.*\d")
        self.assertRegex(text, r"mean height.*\d\.\d+\(\d+\)")

    def saved(self, word):
        figure = self.first_figure()
        before = set(BROWSER.downloads.iterdir())
        button = next(one for one in figure.find_elements(By.TAG_NAME, "button") if one.text == word)
        BROWSER.show(button).click()
        return BROWSER.downloaded(before)

    def test_a_saved_svg_is_a_figure_by_itself(self):
        path = self.saved("Save SVG")
        self.assertEqual(path.name, "whole.h5-mean-height.svg")
        text = path.read_text()
        root = xml.etree.ElementTree.fromstring(text)
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        words = " ".join(root.itertext())
        for part in ("taps t", "mean height", "ε = 0.02", "ε = 0.1", "whole.h5: 48 spheres"):
            self.assertIn(part, words)
        self.assertNotIn("var(--", re.sub(r"var\(--plot-background\)", "", text))

    def test_a_saved_csv_has_the_values_of_the_file(self):
        path = self.saved("Save CSV")
        with path.open() as lines:
            rows = list(csv.reader(lines))
        self.assertEqual(rows[0][3], "half width 68 %")
        with h5py.File(FOLDER / "whole.h5") as file:
            for point, label in enumerate(("ε = 0.02", "ε = 0.05", "ε = 0.1")):
                stored = file[f"ensemble/point_{point:04}"]
                own = numpy.array([[float(cell) for cell in row[1:4]] for row in rows if row[0] == label])
                taps = own[:, 0].astype(int)
                self.assertGreater(len(taps), 30)
                numpy.testing.assert_allclose(own[:, 1], stored["mean_height_mean"][()][taps], rtol=1e-6)
                numpy.testing.assert_allclose(own[:, 2], HALF_OF_THREE * stored["mean_height_error"][()][taps], rtol=1e-6)

    def test_sweep_points_are_switched_off_and_on(self):
        figure = self.first_figure()
        legend = lambda: figure.find_element(By.CSS_SELECTOR, ".canvas").get_attribute("textContent")
        self.assertIn("ε = 0.05", legend())
        box = BROWSER.find_all(".chip input")[1]
        BROWSER.run("arguments[0].click()", box)
        self.assertNotIn("ε = 0.05", legend())
        self.assertIn("ε = 0.1", legend())
        BROWSER.run("arguments[0].click()", box)
        self.assertIn("ε = 0.05", legend())

    def test_a_menu_chooses_the_sweep_point(self):
        menu = BROWSER.find("#file-0-pair_correlation select")
        section = BROWSER.find("#file-0-pair_correlation")
        values = lambda: BROWSER.run("""
            const details = arguments[0].querySelector(".by-point details.values");
            details.open = true;
            details.parentNode.figure.fillTable();
            return details.textContent;""", section)
        before = values()
        Select(BROWSER.show(menu)).select_by_visible_text("ε = 0.1")
        self.assertNotEqual(values(), before)


class Packing(Open):
    def setUp(self):
        super().setUp()
        self.canvas = BROWSER.show(BROWSER.find("canvas.packing"))
        self.status = BROWSER.find(".packing-status")
        BROWSER.wait(lambda: self.status.text, "the packing")

    def changes(self, act):
        before = BROWSER.picture(self.canvas)
        act()
        after = BROWSER.picture(self.canvas)
        self.assertNotEqual(before, after)
        return before, after

    def test_it_is_drawn(self):
        colours, share = BROWSER.colours(BROWSER.picture(self.canvas))
        self.assertGreater(colours, 500)  # shaded spheres
        self.assertGreater(share, 0.1)
        self.assertIn("48 spheres", self.status.text)
        self.assertIn("tap 60", self.status.text)

    def test_it_turns_with_the_mouse_and_the_keys(self):
        drag = ActionChains(BROWSER.driver).click_and_hold(self.canvas).move_by_offset(80, 30).release()
        self.changes(drag.perform)
        for key in (Keys.ARROW_LEFT, Keys.ARROW_UP, "+"):
            with self.subTest(key=key):
                self.changes(lambda: self.canvas.send_keys(key))

    def test_it_turns_with_a_finger(self):
        box = BROWSER.run("const r = arguments[0].getBoundingClientRect(); return [r.x + r.width / 2, "
                          "r.y + r.height / 2]", self.canvas)
        touch = lambda kind, points: BROWSER.command("Input.dispatchTouchEvent", type=kind, touchPoints=points)

        def swipe():
            touch("touchStart", [{"x": box[0], "y": box[1]}])
            for step in (20, 40, 60):
                touch("touchMove", [{"x": box[0] + step, "y": box[1] + step / 2}])
            touch("touchEnd", [])
        self.changes(swipe)

    def test_the_slider_goes_through_the_stored_taps(self):
        slider = BROWSER.find("input.tap-slider")
        self.assertEqual(slider.get_attribute("max"), "2")
        self.changes(lambda: slider.send_keys(Keys.ARROW_LEFT))
        self.assertIn("tap 7;", self.status.text)
        self.changes(lambda: slider.send_keys(Keys.HOME))
        self.assertIn("tap 0;", self.status.text)

    def menu(self, label):
        for one in BROWSER.find_all(".controls label"):
            if one.text.startswith(label):
                return Select(one.find_element(By.TAG_NAME, "select"))
        raise AssertionError(f"no menu {label}")

    def test_realizations_points_and_colours_can_be_chosen(self):
        self.changes(lambda: self.menu("Realization").select_by_visible_text("2"))
        self.assertIn("realization 2", self.status.text)
        self.changes(lambda: self.menu("Sweep point").select_by_visible_text("ε = 0.1"))
        self.assertIn("ε = 0.1, realization 2", self.status.text)
        options = [one.text for one in self.menu("Colour by").options]
        self.assertEqual(options, ["coordination", "crystalline order", "bond order q\u2086",
                                   "local packing fraction", "height"])
        for one in options[1:]:
            with self.subTest(colour=one):
                self.changes(lambda: self.menu("Colour by").select_by_visible_text(one))

    def test_slices_hide_spheres_and_reset_brings_them_back(self):
        for axis in "zxy":
            with self.subTest(axis=axis):
                slider = BROWSER.find(f"input[data-slice='{axis}1']")
                self.changes(lambda: BROWSER.run(
                    "arguments[0].value = 0.5; arguments[0].dispatchEvent(new Event('input'))", slider))
                shown = int(re.match(r"(\d+) of 48", self.status.text)[1])
                self.assertTrue(0 < shown < 48)
                next(one for one in BROWSER.find_all(".controls button") if one.text == "Reset view").click()
                self.assertTrue(self.status.text.startswith("48 spheres"))

    def test_its_values_are_a_table_and_its_picture_a_file(self):
        BROWSER.run("document.querySelector('.packing-panel details').open = true")
        rows = BROWSER.wait(lambda: BROWSER.find_all(".packing-panel details tbody tr"))
        self.assertEqual(sum(int(row.find_elements(By.TAG_NAME, "td")[0].text) for row in rows), 48)
        before = set(BROWSER.downloads.iterdir())
        next(one for one in BROWSER.find_all(".controls button") if one.text == "Save PNG").click()
        path = BROWSER.downloaded(before)
        self.assertEqual(path.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")


class Looks(Open):
    PAPER = "return getComputedStyle(document.body).backgroundColor"
    INK = "return document.querySelector('#file-0-compaction .canvas svg > text').getAttribute('fill')"

    def test_dark_as_the_system_has_it_and_by_the_button(self):
        BROWSER.draw_everything()
        light, ink = BROWSER.run(self.PAPER), BROWSER.run(self.INK)
        self.assertEqual(light, "rgb(255, 255, 255)")
        BROWSER.prefer("dark")
        BROWSER.wait(lambda: BROWSER.run(self.PAPER) != light)
        self.assertNotEqual(BROWSER.run(self.INK), ink)
        BROWSER.find("button.theme").click()
        self.assertEqual((BROWSER.run(self.PAPER), BROWSER.run(self.INK)), (light, ink))

    def test_it_prints(self):
        pdf = base64.b64decode(BROWSER.command("Page.printToPDF", printBackground=True)["data"])
        self.assertEqual(pdf[:5], b"%PDF-")
        self.assertGreater(pdf.count(b"/Type /Page\n") + pdf.count(b"/Type /Page/") +
                           len(re.findall(rb"/Type /Page\b(?!s)", pdf)), 3)
        self.assertEqual(BROWSER.run("return document.querySelectorAll('figure .canvas:empty').length"), 0)

    def test_a_phone_shows_sentences_without_sideways_scrolling(self):
        BROWSER.resize(390)
        BROWSER.open(FOLDER / "whole.html")
        BROWSER.draw_everything()
        BROWSER.run("for (const one of document.querySelectorAll('details')) one.open = true")
        BROWSER.frames()
        tables = BROWSER.run("""
            return [...document.querySelectorAll(".stacks")].map((one) => [one.scrollWidth, one.clientWidth, one.textContent]);""")
        self.assertTrue([text for _, _, text in tables if "Does A change with age?" in text])
        for needed, there, text in tables:
            self.assertLessEqual(needed, there, text[:80])

    def test_a_phone_needs_no_sideways_scrolling(self):
        for name in ("whole", "loop", "grains", "cost", "hostile"):
            with self.subTest(page=name):
                BROWSER.resize(360)
                BROWSER.open(FOLDER / f"{name}.html")
                BROWSER.draw_everything()
                BROWSER.run("for (const one of document.querySelectorAll('details')) one.open = true")
                BROWSER.frames()
                self.assertLessEqual(BROWSER.run("return document.documentElement.scrollWidth"), 360)


class Hostile(Open):
    name = "hostile"

    def test_nothing_that_stands_in_the_file_becomes_markup(self):
        BROWSER.draw_everything()
        BROWSER.run("for (const one of document.querySelectorAll('details')) one.open = true")
        BROWSER.frames()
        self.assertEqual(BROWSER.run("return document.title"), "hostile.h5")
        self.assertEqual(BROWSER.find_all("img, iframe, object, embed, script[src]"), [])
        self.assertEqual(len(BROWSER.find_all("script")), 2)
        heading = BROWSER.find("article h2").get_attribute("textContent")
        self.assertIn("</script><script>", heading)
        self.assertIn("\\xe2\\x80\\xae", heading)
        text = BROWSER.find("main").get_attribute("textContent")
        self.assertGreater(text.count("onerror=alert(1)"), 20)
        self.assertIn("{{7*7}}", text)

    def test_a_saved_csv_begins_no_formula(self):
        figure = BROWSER.find("#file-0-compaction figure")
        rows = BROWSER.run("return arguments[0].figure.rows().map((row) => row[0])", figure)
        self.assertTrue(rows and all(row.startswith("</script>") for row in rows))


if __name__ == "__main__":
    unittest.main()
