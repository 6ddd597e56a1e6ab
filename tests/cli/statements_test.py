"""Statements of analyses: the level of the test, the condition, and no sums of different quantities."""

import json
import re
import unittest

from support import STOPPED, UNFOLDED, Case, TINY, changed

SWEPT = "/protocol/0/tap/dilate"
TAPPED = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 160}], snapshots={"taps": [0, 160]},
                 observe=["mean_height", "bottom_fraction"], sweep={SWEPT: [0.01, 0.02, 0.05, 0.1, 0.2]})


class Statements(Case):
    def notes(self, *arguments):
        tables = json.loads(self.jostle(*arguments, "--json", "--no-store").stdout)["tables"]
        return {f"{table['name']}: {key}": text for table in tables for key, text in table["notes"].items()}

    def test_every_test_that_decides_names_one_level(self):
        self.write(TAPPED)
        self.run_scene()
        seen = 0
        for analysis in (["steady"], ["spectrum"], ["ageing"], ["volumes"], ["sweep"]):
            for name, text in self.notes("analyse", "tiny.h5", analysis[0], "--observable", "bottom_fraction",
                                         *analysis[1:]).items():
                if not re.search(r"\bp [=<] ", text):
                    continue
                seen += 1
                self.assertRegex(text, r"p [=<] \S+ at the 5 % level", name)
                self.assertNotRegex(text, r"at the (?!5 %)\S+ % level", name)
        self.assertGreater(seen, 15)

    def test_a_maximum_over_beds_that_still_move_is_kinetic(self):
        # Dilute beds, tapped weakly and relaxed shortly, compact to the end of so short a protocol.
        self.write(changed(TAPPED, start={"random_settle": {}}, relax={"polar": {}, "stop": {"sweeps": 20}},
                           protocol=[{"tap": {"dilate": 0.01}, "count": 400}], realizations=6,
                           sweep={SWEPT: [0.001, 0.002, 0.004]}))
        self.run_scene()
        steady = self.notes("analyse", "tiny.h5", "steady", "--observable", "mean_height", "--last", "100")
        sweep = self.notes("analyse", "tiny.h5", "sweep", "--observable", "mean_height", "--last", "100")
        verdicts = [steady[f"point_000{p}/steady/mean_height: verdict"].split(":")[0] for p in range(3)]
        self.assertIn("not reached", verdicts)
        name = "sweep/mean_height/value"
        for place, verdict in zip(("0.03162", "0.04472", "0.06325"), verdicts):
            condition = sweep[f"{name}: steady"]
            kinetic, _, shown = condition.partition("not shown")
            self.assertEqual(place in kinetic, verdict == "not reached", condition)
            self.assertEqual(place in shown, verdict.startswith("cannot decide"), condition)
        self.assertTrue(sweep[f"{name}: steady"].startswith("kinetic: the averaged taps still drift at sqrt_epsilon "))
        for extremum in ("maximum", "minimum"):
            self.assertTrue(sweep[f"{name}: {extremum}"].endswith(sweep[f"{name}: steady"]))
        few = self.notes("analyse", "tiny.h5", "sweep", "--observable", "mean_height", "--last", "5")
        self.assertIn("the averaged taps are not shown to be steady at sqrt_epsilon = 0.03162 (dilate = 0.001), "
                      "0.04472 (dilate = 0.002), 0.06325 (dilate = 0.004)", few[f"{name}: steady"])

    def test_packings_whose_spheres_do_not_touch_have_no_rattlers(self):
        self.write(changed(TAPPED, sweep={SWEPT: [0.05]}))
        self.run_scene()
        table = json.loads(self.jostle("structure", "tiny.h5", "--part", "gaps", "--settings",
                                       '{"gaps": {}, "region": {"heights": [0.6, 1.5], "from_sides": 0}}', "--no-store",
                                       "--json").stdout)["tables"][0]
        self.assertEqual(table["quantities"]["rattlers_packings"]["values"][1], 0)
        self.assertIsNone(table["quantities"]["rattlers"]["values"][1])
        self.assertEqual(table["quantities"]["rattlers_packings"]["values"][0], 3)
        self.assertIn("surfaces up to 0.001 d apart touch", table["notes"]["tolerance"])

    def test_a_run_that_was_stopped_runs_no_more(self):
        self.write(TAPPED)
        self.run_scene("--time-limit", "0s", expect=STOPPED)
        text = self.jostle("info", "tiny.h5").stdout
        self.assertNotIn("running", text)
        self.assertNotIn('"running"', self.jostle("info", "tiny.h5", "--json").stdout)

    def test_what_a_sweep_replaces_is_swept(self):
        self.write(TAPPED)
        for text in (self.jostle("check", "scene.json", "--no-pilot", environment=UNFOLDED).stdout,
                     self.run_scene() and self.jostle("info", "tiny.h5", environment=UNFOLDED).stdout):
            self.assertIn("tap (dilate swept), count 160", text)
            self.assertNotIn("tap (dilate 0.05)", text)

    def test_work_of_two_engines_has_no_common_unit(self):
        self.write(changed(TINY, protocol=[], snapshots={"taps": [0]}, realizations=1, spheres=4,
                           sweep={"/engine": ["monte_carlo", {"discrete_element": {}}]}))
        self.run_scene()
        self.jostle("report", "tiny.h5", "-o", "page.html")
        page = (self.folder / "page.html").read_text()
        data = json.loads(re.search(r"<script[^>]*json[^>]*>(.*?)</script>", page, re.S).group(1))
        run = data["files"][0]
        self.assertEqual(run["unit"], "")
        self.assertEqual([point["unit"] for point in run["points"]], ["trials", "sphere steps"])


if __name__ == "__main__":
    unittest.main()
