"""The data of a page of jostle report are those of the file."""

import base64
import json
import re
import unittest

import h5py
import numpy

from report_pages import EVERYTHING, Report, number, panel_of
from support import HALF_OF_THREE


class Data(Report):
    def setUp(self):
        super().setUp()
        self.write(EVERYTHING)
        self.run_scene("-o", "everything.h5")
        self.run_data = self.data(self.page("everything.h5")[0])["files"][0]

    def test_the_data_are_those_of_the_file(self):
        for look in (self.curves, self.tables, self.packings, self.snapshots, self.summary, self.comparisons, self.folded,
                     self.units, self.limits, self.pairs_are_drawn_from_contact_on):
            with self.subTest(look.__name__):
                look()

    def test_the_summary_is_of_the_density_whatever_else_is_analysed(self):
        self.jostle("analyse", "everything.h5", "steady", "--observable", "acceptance", "--last", "40")
        run = self.data(self.page("everything.h5")[0])["files"][0]
        self.assertEqual(run["summary"], self.run_data["summary"])

    def test_points_measured_with_other_settings_are_not_drawn_beside_each_other(self):
        for others in (["--settings", '{"coordination": {}}'],
                       ["--settings", '{"coordination": {"cut": 1.3}}', "--sweep-point", 2]):
            self.jostle("structure", "everything.h5", "--part", "coordination", *others)
        with h5py.File(self.folder / "everything.h5") as file:
            settings = file["structure/comparison/coordination"].attrs["note_settings"]
        self.assertNotEqual(json.loads(settings)["cut"], 1.3)
        run = self.data(self.page("everything.h5")[0])["files"][0]
        panel = panel_of(run, "number-of-neighbours-sweep-points-after-60-taps")
        self.assertEqual([series["point"] for series in panel["series"]], [0, 1])
        self.assertTrue(panel["caption"].endswith("Measured with other settings, and left out: ε = 0.1."))
        (section,) = [one for one in run["sections"] if one["id"] == "coordination"]
        self.assertIn("after 60 taps, measured with " + json.dumps(settings)[1:-1],
                      json.dumps(section, ensure_ascii=False))

    def test_a_law_that_was_not_compared_is_not_called_as_good_as_others(self):
        def answer(file):
            blocks = self.data(self.page(file)[0])["files"][0]["summary"]["blocks"]
            return dict(blocks[0]["rows"])["law"].split(" at ")[0]

        line = ("--law", "a + b*log(t)", "--start", "a=4,b=-0.1", "--sweep-point", "0")
        self.write({key: value for key, value in EVERYTHING.items() if key not in ("sweep", "fits", "analyse")},
                   "plain.json")
        self.run_scene("-o", "plain.h5", scene="plain.json")
        self.jostle("fit", "plain.h5", "--observable", "mean_height", *line)
        self.assertIn("own law (no other law fitted)", answer("plain.h5"))
        self.jostle("fit", "plain.h5", "--observable", "mean_height", "--model", "kww")
        self.assertIn("stretched exponential or own law (not compared)", answer("plain.h5"))
        self.jostle("fit", "plain.h5", "--observable", "mean_height")
        self.assertRegex(answer("plain.h5"), r"; own law not compared with them\)")

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

    def limits(self):
        """The heading of a law that was fitted as its limit has the parameters of both."""
        headings = json.dumps([one for one in self.run_data["sections"] if one["id"] == "fits"], ensure_ascii=False)
        found = 0

        def known(law, prefix):
            names = [name.decode() for name in law[prefix + "parameter"][()]]
            ends = (law[prefix + end][()] for end in ("value", "interval_lower", "interval_upper"))
            value, lower, upper = (array if array.ndim == 1 else array[:, 1] for array in ends)
            limited = [name for name, *numbers in zip(names, value, lower, upper) if numpy.isfinite(numbers).all()]
            others = [name for name in names if name not in limited]
            if not others:
                return "All parameters are limited on both sides."
            if not limited:
                return "No parameter is limited on both sides: the curve does not identify this law."
            verbs = ("is" if len(names) == 1 else "are" for names in (limited, others))
            return "{} {} limited on both sides; {} {} not.".format(", ".join(limited), next(verbs), ", ".join(others),
                                                                  next(verbs))

        with h5py.File(self.folder / "everything.h5") as file:
            for name in self.info("everything.h5")["tables"]:
                if not name.startswith("fits/") or "note_limit" not in file[name].attrs:
                    continue
                self.assertIn("Fitted as a limit of the law. Parameters of the limit: " + known(file[name], "limit_") +
                              " Parameters of the full law: " + known(file[name], ""), headings)
                found += 1
        self.assertGreater(found, 0)
        self.assertEqual(headings.count("Fitted as a limit of the law."), found)

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


if __name__ == "__main__":
    unittest.main()
