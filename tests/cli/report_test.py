"""The page of jostle report, without a browser: its parts, that its data are those of the file, what
hostile texts do in it, and what it may be written to."""

import base64
import hashlib
import html.parser
import json
import os
import re
import unittest

import h5py
import numpy

from support import BAD_INPUT, BROKEN, HALF_OF_THREE, STOPPED, TINY, Case, changed

EVERYTHING = changed(
    TINY, name="everything", description="A bed of 48 spheres.", realizations=3, streams="matched",
    protocol=[{"tap": {"dilate": 0.05}, "count": 60}], snapshots={"taps": [0, 7, 60]},
    sweep={"/protocol/0/tap/dilate": [0.02, 0.05, 0.1]},
    fits=[{"observable": "bottom_fraction", "model": "all"}],
    analyse={"steady": [{"observable": "mean_height", "last": 40}],
             "spectrum": [{"observable": "mean_height", "last": 40}],
             "ageing": [{"observable": "mean_height"}],
             "sweep": [{"observable": "mean_height"}]},
    structure={"region": {"heights": [0.5, 2]}, "profile": {}, "pair_correlation": {}, "order": {},
               "voronoi": {"cut_cells": True}, "layers": {}})

HOSTILE = ('</script><script>document.title="x"</script><img src=x onerror=alert(1)>'
           '<!--\u2028\u2029\u202e&amp;{{7*7}}"\'`')


class Elements(html.parser.HTMLParser):
    """The elements of a page with their attributes, and the text of its scripts."""

    def __init__(self, page):
        super().__init__()
        self.elements, self.scripts, self.inside = [], [], False
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        self.inside = tag == "script"
        if self.inside:
            self.scripts.append("")

    def handle_endtag(self, tag):
        self.inside = False

    def handle_data(self, data):
        if self.inside:
            self.scripts[-1] += data


def number(value):
    return {None: numpy.nan, "inf": numpy.inf, "-inf": -numpy.inf}.get(value, value)


def panel_of(run, name):
    """The first panel of a figure of the page."""
    (figure,) = [one for one in run["figures"] if one["name"] == name]
    return figure["panels"][0]


class Report(Case):
    def page(self, *inputs, output="page.html", **keywords):
        done = self.jostle("report", *inputs, "-o", output, "--force", **keywords)
        return (self.folder / output).read_text(), done

    def data(self, page):
        scripts = Elements(page).scripts
        self.assertEqual(len(scripts), 2)
        return json.loads(scripts[0])


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
        self.assertIn("curves are drawn at 40 taps a decade, and where they are highest and lowest",
                      run["left_out"])
        taps = panel_of(run, "mean-height")["series"][0]["x"]
        self.assertEqual(taps, sorted(set(taps)))
        self.assertEqual((taps[:17], taps[-1]), (list(range(17)), 600))
        self.assertTrue(70 < len(taps) < 105)
        t = panel_of(run, "fits-of-mean-height-point-0000")["series"][0]["x"]
        self.assertEqual((t[0], t[-1]), (1, 600))
        self.assertTrue(50 < len(t) < 120)
        self.assertLess(len(page), 1_000_000)


class Data(Report):
    def setUp(self):
        super().setUp()
        self.write(EVERYTHING)
        self.run_scene("-o", "everything.h5")
        self.run_data = self.data(self.page("everything.h5")[0])["files"][0]

    def test_the_data_are_those_of_the_file(self):
        for look in (self.curves, self.tables, self.packings, self.snapshots, self.summary, self.comparisons, self.folded,
                     self.units, self.pairs_are_drawn_from_contact_on):
            with self.subTest(look.__name__):
                look()

    def curves(self):
        points = self.run_data["curve_points"]
        self.assertEqual([(one["number"], one["shown"]) for one in points], [(0, True), (1, True), (2, True)])
        with h5py.File(self.folder / "everything.h5") as file:
            for name in ("mean_height", "bottom_fraction", "sweeps", "acceptance"):
                mean = panel_of(self.run_data, name.replace("_", "-"))["series"]
                thin = [series for series in mean if series.get("thin")]
                mean = [series for series in mean if not series.get("thin")]
                self.assertEqual([series["point"] for series in mean], [0, 1, 2])
                self.assertEqual(len(thin), 9 if name in ("mean_height", "bottom_fraction") else 0)
                for k, series in enumerate(thin):
                    stored = file[f"observables/point_{series['point']:04}/{name}"][()]
                    self.assertEqual(series["name"], f"ε = {(0.02, 0.05, 0.1)[k // 3]}, realization {k % 3}")
                    self.same(series["y"], stored[:, k % 3][series["x"]])
                for series in mean:
                    stored, taps = file[f"ensemble/point_{series['point']:04}"], series["x"]
                    self.assertEqual(taps[:4] + taps[-1:], [0, 1, 2, 3, 60])
                    self.same(series["y"], stored[f"{name}_mean"][()][taps])
                    self.same(series["error"], HALF_OF_THREE * stored[f"{name}_error"][()][taps])
            for series in panel_of(self.run_data, "spread-of-mean-height")["series"]:
                self.same(series["y"], file[f"ensemble/point_{series['point']:04}/mean_height_sigma"][()][series["x"]])

    def same(self, drawn, stored):
        numpy.testing.assert_allclose([number(value) for value in drawn], stored, rtol=1e-6)

    def tables(self):
        """Every derived table has its figures and its statements in the section of its kind."""
        sections = {one["id"]: json.dumps(one, ensure_ascii=False) for one in self.run_data["sections"]}
        kinds = {"fits": "fits", "spectrum": "spectra"}
        compared = 0
        with h5py.File(self.folder / "everything.h5") as file:
            for name in self.info("everything.h5")["tables"]:
                group, *path = name.split("/")
                kind = "fits" if group == "fits" else next(part for part in path if not part.startswith("point_"))
                # The section of a part shows differences between sweep points.
                shown = sections[path[-1] if kind == "comparison" else kinds.get(kind, kind)]
                for key, value in file[name].attrs.items():
                    if key in ("note_verdict", "note_refused", "note_choice", "note_ageing_verdict", "note_maximum",
                               "note_minimum"):
                        with self.subTest(table=name, note=key):
                            lead = re.match(r"(not reached|reached|cannot decide|found|agrees|maximum)?(.*)", value)
                            # Ageing has a table: the answer, and the test that follows it in brackets.
                            parts = re.fullmatch(r"(.*?)(?: \((.*)\))?", value).groups() if kind == "ageing" else [lead[2]]
                            for part in filter(None, parts):
                                part = re.sub(r"\ba (?=with|from|changes)", "A ", part) if kind == "ageing" else part
                                self.assertIn(json.dumps(part, ensure_ascii=False)[1:-1], shown)
                            compared += 1
        self.assertGreater(compared, 15)

    def units(self):
        """Numbers of tables have their units, and captions name the numbers without units."""
        sections = {one["id"]: one["blocks"] for one in self.run_data["sections"]}
        (steady,) = [block for block in sections["steady"] if block["kind"] == "table"]
        self.assertIn("Numbers without a unit are dimensionless.", steady["caption"])
        seen = 0
        for observable, _, _, mean, sigma, memory, drift, _ in steady["rows"]:
            if observable != "mean height":
                continue
            for cell in (mean, sigma, drift):
                self.assertRegex(cell, r"\d\)? diameter$")
            self.assertRegex(memory, r"\d\)? taps$|^–?$")
            seen += 1
        self.assertEqual(seen, 3)
        shown = json.dumps(sections["profile"], ensure_ascii=False)
        self.assertIn("gradient α (1/R)", shown)
        laws = json.dumps(sections["fits"], ensure_ascii=False)
        self.assertIn('"parameter", "estimate", "unit", "95 % interval"', laws)

    def summary(self):
        """Five lines, before everything else."""
        lines = dict(self.run_data["summary"]["blocks"][0]["rows"])
        self.assertEqual(list(lines), ["run", "end", "law", "steady?", "ageing?"])
        self.assertIn("48 spheres", lines["run"])
        self.assertNotIn("FILE", " ".join(lines.values()))
        self.assertIn("ε = 0.02 to ε = 0.1", lines["run"])
        end = lines["end"].replace("\u00a0", " ")
        self.assertRegex(end, r"^(bulk|bottom) fraction Φ_?\S* after 60 taps: 0\.\d+\(\d+\) at ε = 0\.02, ")
        with h5py.File(self.folder / "everything.h5") as file:
            name = end.split(" Φ")[0].replace(" ", "_")
            mean = file[f"ensemble/point_0000/{name}_mean"][60]
            self.assertAlmostEqual(float(re.search(r"taps: ([\d.]+)\(", end)[1]), mean, delta=0.006)
            verdicts = [file[f"analysis/point_{p:04}/steady/mean_height"].attrs["note_verdict"] for p in range(3)]
        words = {"reached": "no drift found", "not reached": "still drifts", "cannot decide": "cannot decide"}
        for verdict in verdicts:
            self.assertIn(words[re.match(r"not reached|reached|cannot decide", verdict)[0]], lines["steady?"])

    def comparisons(self):
        """The section of a part shows differences between sweep points, with Holm's p."""
        sections = {one["id"]: one for one in self.run_data["sections"]}
        with h5py.File(self.folder / "everything.h5") as file:
            stored = file["structure/comparison/order"]
            quantities = stored["quantity"].asstr()[()]
            p, corrected = stored["p"][()], stored["p_corrected"][()]
            self.assertIn("paired by realization", stored.attrs["note_test"])  # streams are matched
            one = list(quantities).index("q6")
            means = [file[f"structure/point_{k:04}/order/q6"][()][-1] for k in range(3)]
            numpy.testing.assert_allclose(stored["difference"][()][one:one + 3],
                                          [means[1] - means[0], means[2] - means[0], means[2] - means[1]])
        q6 = p[one:one + 3]
        smallest = numpy.argmin(q6)
        self.assertAlmostEqual(corrected[one:one + 3][smallest], min(1, 3 * q6[smallest]))
        (part,) = [block for block in sections["order"]["blocks"] if block["kind"] == "subsection"]
        self.assertEqual(part["title"], "Sweep points beside each other")
        shown = json.dumps(part, ensure_ascii=False)
        self.assertIn("bond order q_6", shown)
        self.assertIn("ε = 0.1 against ε = 0.02", shown)
        for place in part["blocks"][0]["figures"]:
            names = [series["name"] for series in self.run_data["figures"][place]["panels"][0]["series"]]
            self.assertEqual(names, ["ε = 0.02", "ε = 0.05", "ε = 0.1"])

    def folded(self):
        sections = {one["id"]: one["blocks"] for one in self.run_data["sections"]}
        for name in ("spread", "relaxation"):
            self.assertEqual([(one["kind"], one["open"]) for one in sections[name]], [("details", False)])

    def pairs_are_drawn_from_contact_on(self):
        panel = panel_of(self.run_data, "pair-correlation-g-r-point-0000")
        self.assertEqual(panel["x"]["low"], 0.9)
        for series in panel["series"]:
            self.assertGreaterEqual(min(series["x"]), 0.9)
        peak = max(value for series in panel["series"] for value in series["y"])
        self.assertLess(panel["y"]["high"], peak)
        self.assertIn("The peak at contact is clipped: it reaches", panel["caption"])

    def packings(self):
        packings = self.run_data["packings"]
        self.assertEqual([(one["point"], one["realization"], one["tap"]) for one in packings],
                         [(p, r, tap) for p in range(3) for r in range(3) for tap in (0, 7, 60)])
        with h5py.File(self.folder / "everything.h5") as file:
            for one in packings:
                group = file[f"particles/point_{one['point']:04}_realization_{one['realization']:05}"]
                step = list(group["position/step"][()]).index(one["tap"])
                stored = group["position/value"][()][step]
                words = numpy.frombuffer(base64.b64decode(one["position"]), "<u2").reshape(-1, 3)
                size = numpy.array(one["upper"])
                numpy.testing.assert_allclose(words / 65535 * size, stored, atol=size.max() / 65535)
                columns = {key: numpy.frombuffer(base64.b64decode(one[key]), numpy.uint8)
                           for key in ("coordination", "structure", "q6", "local_fraction")}
                taps = list(file[f"snapshots/point_{one['point']:04}/tap"][()])
                coordination = file[f"snapshots/point_{one['point']:04}/coordination"][()]
                self.assertAlmostEqual(columns["coordination"].mean(),
                                       coordination[taps.index(one["tap"]), one["realization"]])
                self.assertLessEqual(columns["structure"].max(), 2)
                self.assertTrue(0.2 < columns["q6"].mean() / 255 < 0.7)
                self.assertTrue(0.3 < columns["local_fraction"].mean() / 255 < 0.75)

    def snapshots(self):
        kept = panel_of(self.run_data, "coordination-of-the-kept-packings")["series"]
        self.assertEqual([one["point"] for one in kept], [0, 1, 2])
        with h5py.File(self.folder / "everything.h5") as file:
            for one in kept:
                self.assertEqual(one["x"], [0, 7, 60])
                self.same(one["y"], file[f"snapshots/point_{one['point']:04}/coordination"][()].mean(axis=1))


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
