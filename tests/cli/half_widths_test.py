"""One convention of errors: terminal, page, catalogue of figures and Python give half the 68 % interval by
Student's t, and the file the standard error from which it comes."""

import html
import json
import re
import sys
import unittest

import h5py
from support import SOURCE, TINY, UNFOLDED, Case, changed

sys.path.insert(0, str(SOURCE / "python"))
import jostle  # noqa: E402

STANDARD = re.compile(r"\bstandard errors?\b")


def half_of(text):
    """The half width that a person reads in "0.5591(14)" or "12.3(4.5)"."""
    value, digits = re.fullmatch(r"(-?[\d.]+)\(([\d.]+)\)", text).groups()
    if "." in digits or "." not in value:
        return float(digits)
    return int(digits) * 10.0 ** -len(value.split(".")[1])


class HalfWidths(Case):
    def setUp(self):
        super().setUp()
        scene = {key: value for key, value in TINY.items() if key != "sweep"}
        self.write(changed(scene, protocol=[{"tap": {"dilate": 0.05}, "count": 40}],
                           snapshots={"taps": [0, 10, 40]}))
        self.report = self.run_scene(environment=UNFOLDED).stdout
        with h5py.File(self.folder / "tiny.h5") as file:
            stored = file["ensemble/point_0000"]
            self.error = stored["mean_height_error"][()]
            self.count = stored["mean_height_count"][()]
        self.half = jostle.half_width(self.error, self.count - 1.0)

    def page(self):
        self.jostle("report", "tiny.h5", "--force")
        text = (self.folder / "tiny.html").read_text()
        blocks = re.findall(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', text, re.DOTALL)
        return "\n".join(html.unescape(block) for block in blocks)

    def catalogue(self):
        self.jostle("report", "tiny.h5", "--catalogue", "catalogue.json", "--force")
        return json.loads((self.folder / "catalogue.json").read_text())["figures"]

    def test_a_mean_has_one_half_width_everywhere(self):
        self.assertAlmostEqual(self.half[-1] / self.error[-1], 1.3213, delta=1e-4)  # two degrees of freedom
        rows = [line.split() for line in self.report.splitlines()]
        head = next(row for row in rows if "mean_height" in row)
        last = next(row for row in rows if row and row[0] == "40")
        self.assertAlmostEqual(half_of(last[head.index("mean_height")]) / self.half[-1], 1, delta=0.05)
        self.assertIn("is half the 68 % interval", self.report)
        info = self.jostle("info", "tiny.h5", environment=UNFOLDED).stdout
        self.assertIn(last[head.index("mean_height")], info)
        drawn = next(one for one in self.catalogue() if one["name"] == "mean-height")["panels"][0]
        self.assertIn("68 % interval", drawn["caption"])
        self.assertAlmostEqual(drawn["series"][0]["error"][-1], self.half[-1], delta=1e-12)
        self.assertIn(drawn["caption"], json.loads('"' + re.search(
            r'"caption":\s*"(Mean height[^"]*|[^"]*against the number of taps; the band[^"]*)"',
            self.page()).group(1) + '"'))

    def test_structure_has_the_half_widths_of_its_table(self):
        text = self.jostle("structure", "tiny.h5", "--part", "coordination", environment=UNFOLDED).stdout
        head = next(line for line in text.splitlines() if re.match(r"tap +realizations +n_c\b", line)).split()
        row = next(line for line in text.splitlines() if re.match(r" *40 +3 ", line)).split()
        with h5py.File(self.folder / "tiny.h5") as file:
            table = file["structure/point_0000/coordination"]
            error, dof = table["n_c_error"][()][-1], table["n_c_dof"][()][-1]
        self.assertEqual(dof, 2)
        half = float(jostle.half_width(error, dof))
        self.assertAlmostEqual(half_of(row[head.index("n_c")]) / half, 1, delta=0.05)
        figure = next(one for one in self.catalogue() if one["name"].startswith("coordination-n-c-by-tap"))
        self.assertAlmostEqual(figure["panels"][0]["series"][0]["error"][-1], half, delta=1e-12)

    def test_a_difference_between_laws_has_its_half_width(self):
        found = json.loads(self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--model", "all",
                                       "--json").stdout)
        text = self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--model", "all", "--force",
                           environment=UNFOLDED).stdout
        laws = found["curves"][0]["comparison"]["laws"]
        compared = [law for law in laws.values() if law["difference_error"]]
        self.assertTrue(compared)
        for law in compared:
            self.assertAlmostEqual(
                law["difference_half_width_68"],
                float(jostle.half_width(law["difference_error"], law["difference_dof"])), delta=1e-9)
        self.assertNotIn("is the standard error", text)

    def test_one_law_has_no_word_of_differences(self):
        text = self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--model", "kww",
                           environment=UNFOLDED).stdout
        self.assertIn("half the 68 % interval", text)
        self.assertNotIn("difference", text)

    def test_captions_name_standard_errors_only_where_they_are_drawn(self):
        for kind in ("steady", "spectrum", "ageing", "motion"):
            self.jostle("analyse", "tiny.h5", kind, *([] if kind == "motion" else ["--observable", "mean_height"]),
                        expect=None)
        self.jostle("structure", "tiny.h5")
        self.jostle("fit", "tiny.h5", "--observable", "mean_height", "--model", "kww")
        with_error = 0
        for figure in self.catalogue():
            for panel in figure["panels"]:
                has_bars = any(any(value is not None for value in series.get(name, []))
                               for series in panel["series"] for name in ("error", "low"))
                with_error += has_bars
                with self.subTest(figure=figure["name"]):
                    if has_bars:
                        self.assertRegex(panel["caption"], r"(68|95) %\s+intervals?")
                    if not panel["title"].startswith(("Blocking", "Residuals", "Spread")):
                        self.assertNotRegex(panel["caption"], STANDARD)
        self.assertGreater(with_error, 10)


if __name__ == "__main__":
    unittest.main()
