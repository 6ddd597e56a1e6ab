"""The page of jostle report, without a browser: its parts, that its data are those of the file, what
hostile texts do in it, and what it may be written to."""

import base64
import hashlib
import json
import os
import re
import unittest

import h5py
import numpy

from report_pages import HOSTILE, Elements, Report, panel_of
from support import BAD_INPUT, BROKEN, STOPPED, TINY, changed


class Page(Report):
    def setUp(self):
        super().setUp()
        self.write(TINY)
        self.run_scene()

    def test_it_is_one_file_that_fetches_nothing_and_runs_its_own_script_alone(self):
        page, done = self.page("tiny.h5")
        self.assertRegex(done.stdout, r"^page.html: \d+\.\d KiB; open it in a browser\n$")
        found = Elements(page)
        for tag, attributes in found.elements:
            with self.subTest(tag=tag):
                self.assertNotIn("src", attributes)
                self.assertRegex(attributes.get("href", "data:"), r"^data:")
                self.assertNotEqual(attributes.get("type"), "module")
                self.assertFalse([key for key in attributes if key.startswith("on")])
        policy = next(attributes["content"] for tag, attributes in found.elements
                      if attributes.get("http-equiv") == "Content-Security-Policy")
        script = base64.b64encode(hashlib.sha256(found.scripts[1].encode()).digest()).decode()
        self.assertIn("default-src 'none'", policy)
        self.assertIn(f"script-src 'sha256-{script}';", policy)

    def test_it_says_what_was_run(self):
        page, _ = self.page("tiny.h5")
        data = self.data(page)
        run = data["files"][0]
        self.assertIn("<title>tiny.h5</title>", page)
        self.assertEqual(data["made"]["command_line"].split()[1:],
                         ["report", "tiny.h5", "-o", "page.html", "--force"])
        self.assertEqual(run["digest"], self.digest("tiny.h5"))
        self.assertEqual((run["state"], run["file"], run["realizations_a_point"]),
                         ("complete", "tiny.h5", 3))
        self.assertEqual(run["realizations"]["done"], 6)
        self.assertEqual([point["label"] for point in run["points"]],
                         ["ε = 0.02", "ε = 0.1"])
        self.assertEqual(run["points"][0]["seed"], "4711")
        self.assertEqual(run["scene"]["spheres"], 48)
        self.assertEqual(run["left_out"], [])
        self.assertEqual([one["id"] for one in run["sections"]],
                         ["compaction", "spread", "packing", "snapshots", "relaxation"])

    def test_labels_of_the_scene_name_the_points(self):
        self.write(changed(TINY, name="named", point_labels=["weak", "strong (10 %)"]), "named.json")
        self.run_scene("-o", "named.h5", scene="named.json")
        run = self.data(self.page("named.h5")[0])["files"][0]
        self.assertEqual([one["label"] for one in run["points"]], ["weak", "strong (10 %)"])
        self.assertEqual([one["label"] for one in run["curve_points"]], ["weak", "strong (10 %)"])
        figures = self.folder / "strong.json"
        self.jostle("report", "named.h5", "--catalogue", figures, "--sweep-point", "strong (10 %)")
        names = {series["name"] for figure in json.loads(figures.read_text())["figures"]
                 for panel in figure["panels"] for series in panel["series"]}
        self.assertIn("strong (10 %)", names)
        self.assertNotIn("weak", names)

    def test_several_files_stand_on_one_page(self):
        self.write(changed(TINY, name="other", seed=1))
        self.run_scene()
        data = self.data(self.page("tiny.h5", "other.h5")[0])
        self.assertEqual([run["file"] for run in data["files"]], ["tiny.h5", "other.h5"])
        done = self.jostle("report", "tiny.h5", "./tiny.h5", "-o", "twice.html", expect=BAD_INPUT)
        self.assertIn("given twice", done.stderr)

    def test_an_existing_page_is_kept_and_no_input_is_replaced(self):
        self.jostle("report", "tiny.h5")
        before = (self.folder / "tiny.html").read_bytes()
        done = self.jostle("report", "tiny.h5", expect=BAD_INPUT)
        self.assertIn("tiny.html exists and is kept", done.stderr)
        self.assertEqual((self.folder / "tiny.html").read_bytes(), before)
        self.jostle("report", "tiny.h5", "--force")
        self.assertNotEqual((self.folder / "tiny.html").read_bytes(), before)  # the command line
        results = (self.folder / "tiny.h5").read_bytes()
        done = self.jostle("report", "tiny.h5", "-o", "tiny.h5", "--force", expect=BAD_INPUT)
        self.assertIn("works with that file", done.stderr)
        self.assertEqual((self.folder / "tiny.h5").read_bytes(), results)
        self.jostle("report", "tiny.h5", "-o", "missing/page.html", expect=BROKEN)
        (self.folder / "tiny.html").unlink()
        (self.folder / "tiny.html").symlink_to("elsewhere.html")
        self.jostle("report", "tiny.h5", expect=BROKEN)
        self.assertFalse((self.folder / "elsewhere.html").exists())

    def test_what_is_no_results_file_is_refused(self):
        done = self.jostle("report", "scene.json", expect=None)
        self.assertIn(done.returncode, (BAD_INPUT, BROKEN))
        self.assertIn("scene.json", done.stderr)
        self.assertFalse((self.folder / "scene.html").exists())

    def test_the_page_can_go_to_a_stream(self):
        done = self.jostle("report", "tiny.h5", "-o", "/dev/stdout")
        self.assertTrue(done.stdout.startswith("<!doctype html>"))
        self.assertTrue(done.stdout.endswith("</html>\n"))


class Unfinished(Report):
    def test_a_stopped_run_is_shown_as_far_as_it_is(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 100000}],
                           snapshots={"taps": [0]}))
        self.run_scene("--time-limit", "1s", expect=STOPPED)
        page, done = self.page("tiny.h5")
        self.assertIn("its run is unfinished", done.stderr)
        run = self.data(page)["files"][0]
        self.assertEqual(run["state"], "interrupted")
        self.assertGreater(run["realizations"]["unfinished"], 0)


class Long(Report):
    def test_long_curves_are_thinned_and_the_page_says_so(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 600}],
                           relax={"polar": {}, "stop": {"sweeps": 1}}, realizations=2,
                           snapshots={"taps": []},
                           fits=[{"observable": "mean_height", "model": "kww"}]))
        self.run_scene()
        page, _ = self.page("tiny.h5")
        run = self.data(page)["files"][0]
        self.assertIn("curves are drawn at 40 taps per decade, and where they are highest and lowest",
                      run["left_out"])
        taps = panel_of(run, "mean-height")["series"][0]["x"]
        self.assertEqual(taps, sorted(set(taps)))
        self.assertEqual((taps[:17], taps[-1]), (list(range(17)), 600))
        self.assertTrue(70 < len(taps) < 105)
        t = panel_of(run, "fits-of-mean-height-point-0000")["series"][0]["x"]
        self.assertEqual((t[0], t[-1]), (1, 600))
        self.assertTrue(50 < len(t) < 120)
        self.assertLess(len(page), 1_000_000)


class Wide(Report):
    def test_histograms_of_tens_of_thousands_of_bins_are_joined(self):
        """Reports a bed that was thrown a thousand diameters high."""
        scene = changed(TINY, protocol=[{"tap": {"dilate": 10}, "count": 3}], snapshots={"taps": [0, 3]},
                        relax={"polar": {}, "stop": {"sweeps": 1}}, realizations=2)
        del scene["sweep"]
        self.write(scene)
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as file:
            stored = file["snapshots/point_0000/height_histogram"][()]
        self.assertGreater(stored.shape[-1], 10000)
        drawn = panel_of(self.data(self.page("tiny.h5")[0])["files"][0], "centres-by-height-n-z")["series"]
        self.assertEqual(len(drawn), 2)
        for k, series in enumerate(drawn):
            width = 2 * series["x"][0]  # the first bin's middle is half of it
            joined = round(width / 0.1)
            self.assertAlmostEqual(width, 0.1 * joined)
            self.assertLessEqual(len(series["y"]), 2000)
            mean = stored[k].mean(axis=0)
            sums = numpy.add.reduceat(mean, numpy.arange(0, len(mean), joined))[:len(series["y"])]
            numpy.testing.assert_allclose(series["y"], sums, rtol=1e-5, atol=1e-12)
            self.assertAlmostEqual(sum(series["y"]), 1, places=4)


class Hostile(Report):
    def test_hostile_texts_are_data(self):
        """Hostile text in a scene, in a file's name and in a forged file is shown as text."""
        self.write(changed(TINY, description=HOSTILE + "\x01\x1b[31m"))
        self.run_scene()
        clean = Elements(self.page("tiny.h5")[0]).elements
        name = "a<script>alert(1)</script>&.h5".replace("/", "\u2215")
        os.rename(self.folder / "tiny.h5", self.folder / name)
        page, _ = self.page(name)
        self.assertEqual(Elements(page).elements, clean)
        run = self.data(page)["files"][0]
        self.assertEqual(run["file"], name)
        description = run["scene"]["description"]
        self.assertIn("</script><script>", description)
        self.assertIn("\\x01\\x1b[31m", description)
        self.assertIn("\\xe2\\x80\\xae", description)  # it would turn the text
        start = page.index("report-data")
        json_text = page[start:page.index("</script>", start)]
        self.assertFalse(re.search("[\u2028\u2029<&\x00-\x08\x0b-\x1f]", json_text.split(">", 1)[1]))


if __name__ == "__main__":
    unittest.main()
