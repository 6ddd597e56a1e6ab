"""jostle analyse: volumes, memory and hysteresis against their definitions."""

import math
import unittest

import numpy as np

from analysed import TAPPED, Analysed
from support import BAD_INPUT, TINY, changed


class States(Analysed):
    def test_volumes_over_the_points_of_a_sweep(self):
        self.write(changed(TAPPED, sweep={"/protocol/0/tap/dilate": [0.05, 0.2, 0.5]}))
        self.run_scene()
        table = self.analyse("tiny.h5", "volumes", "--observable", "mean_height", "--last",
                             "100")["tables"][0]
        self.assertEqual(table["name"], "volumes/mean_height")
        values = {name: one["values"] for name, one in table["quantities"].items()}
        area, spheres = TAPPED["container"]["width"] ** 2, TAPPED["spheres"]
        v = [2 * area / (math.pi / 6) * self.series("mean_height", point)[61:] for point in range(3)]
        for i, one in enumerate(v):
            self.assertAlmostEqual(values["volume"][i] * spheres / one.mean(), 1, places=12)
        # The jackknife of the variance about the mean of all realizations, of its logarithm.
        left_out = [np.log(np.delete(v[0], r, 1).var()) for r in range(3)]
        logarithm = 3 * np.log(v[0].var()) - 2 * np.mean(left_out)
        self.assertAlmostEqual(values["volume_variance"][0] * spheres / np.exp(logarithm), 1, places=10)
        for text in values["steady"]:
            self.assertRegex(text, r"(drifts of|it drifts[^:]*:) [-+\d.e]+ diameter")
        used = [i for i, text in enumerate(values["steady"]) if not text.startswith("not reached")]
        steps = list(zip(used, used[1:]))
        self.assertEqual(values["from_state"], [i for i, _ in steps])
        for k, (i, j) in enumerate(steps):
            def step(a, b):
                return -(b.mean() - a.mean()) / (a.std() * b.std())
            each = [step(np.delete(v[i], r, 1), np.delete(v[j], r, 1)) for r in range(3)]
            self.assertAlmostEqual(values["step_fluctuations"][k],
                                   3 * step(v[i], v[j]) - 2 * np.mean(each), places=9)
            error = (2 / 3 * sum((x - np.mean(each)) ** 2 for x in each)) ** 0.5
            self.assertAlmostEqual(values["step_fluctuations_error"][k], error, places=9)
        self.assertRegex(table["notes"]["verdict"], "^(agree|disagree|cannot decide)")

    def test_volumes_over_the_last_branch_of_a_ramp(self):
        ramp = {"sqrt_from": 0.2, "sqrt_to": 0.4, "sqrt_step": 0.1}
        down = {**ramp, "sqrt_from": 0.3, "sqrt_to": 0.2}
        scene = changed(TINY, protocol=[{"ramp": {"dilate": ramp}, "count": 40},
                                        {"ramp": {"dilate": down}, "count": 40}])
        del scene["sweep"]
        self.write(scene)
        self.run_scene()
        table = self.analyse("tiny.h5", "volumes", "--observable", "bottom_fraction", "--last",
                             "32")["tables"][0]
        self.assertEqual(table["name"], "point_0000/volumes/bottom_fraction")
        values = {name: one["values"] for name, one in table["quantities"].items()}
        for found, wanted in zip(values["sqrt_epsilon"], (0.4, 0.3, 0.2), strict=True):
            self.assertAlmostEqual(found, wanted, places=12)
        self.assertEqual(values["first_tap"], [89, 129, 169])
        phi = self.series("bottom_fraction")
        for k, first in enumerate((89, 129, 169)):
            self.assertAlmostEqual(values["volume"][k] / (1 / phi[first:first + 32]).mean(), 1, places=12)
        # Spheres up to 2 d at the mean of the first state.
        self.assertAlmostEqual(float(table["notes"]["spheres"]) /
                               (16 * 2 * phi[89:121].mean() / (math.pi / 6)), 1, places=5)

    def test_volumes_of_what_is_none_are_refused(self):
        self.write(TAPPED)
        self.run_scene()
        out = self.jostle("analyse", "tiny.h5", "volumes", "--observable", "sweeps", expect=None)
        self.assertNotEqual(out.returncode, 0)
        self.assertIn("no volume can be made of it", out.stdout + out.stderr)

    def test_memory_of_two_ways_to_one_value(self):
        scene = changed(TINY, realizations=4, streams="matched", protocol=[
            {"tap": {"dilate": 0.05}, "count": 6}, {"tap": {"dilate": 0.02}, "count": 9}])
        scene["sweep"] = {"zip": {"/protocol/0/tap/dilate": [0.05, 0.3], "/protocol/0/count": [6, 4]}}
        self.write(scene)
        self.run_scene()
        table = self.analyse("tiny.h5", "memory", "--observable", "mean_height")["tables"][0]
        values = {name: one["values"] for name, one in table["quantities"].items()}
        self.assertEqual(values["switch_tap"], [6, 4])
        self.assertEqual(values["first_lag"], [1, 2, 4])
        first, second = (self.series("mean_height", point) for point in (0, 1))
        at = second[4] - first[6]
        response = (second[6:8].mean(0) - second[4]) - (first[8:10].mean(0) - first[6])
        slope = ((at - at.mean()) * (response - response.mean())).sum() / ((at - at.mean()) ** 2).sum()
        self.assertAlmostEqual(values["difference"][0][1], response.mean() - slope * at.mean(), places=10)
        left = response - response.mean() - slope * (at - at.mean())
        error = ((left ** 2).sum() / 2 * (1 / 4 + at.mean() ** 2 / ((at - at.mean()) ** 2).sum())) ** 0.5
        self.assertAlmostEqual(values["difference_error"][0][1], error, places=10)
        self.assertEqual(values["difference_dof"][0][1], 2)
        self.assertRegex(table["notes"]["verdict"],
                         "^(mean_height alone is not the state|no memory found|cannot decide)")

    def test_points_that_are_not_chosen_are_named_as_the_cause(self):
        scene = changed(TINY, realizations=3, protocol=[
            {"tap": {"dilate": 0.05}, "count": 40}, {"tap": {"dilate": 0.02}, "count": 5}])
        scene["sweep"] = {"/protocol/0/tap/dilate": [0.05, 0.2, 0.3]}
        self.write(scene)
        self.run_scene("-o", "memory.h5")
        self.write(changed(TAPPED, sweep={"/protocol/0/tap/dilate": [0.05, 0.2, 0.5]}))
        self.run_scene("-o", "volumes.h5")
        for kind in ("volumes", "memory"):
            out = self.jostle("analyse", f"{kind}.h5", "--sweep-point", "1", kind, "--observable",
                              "mean_height", expect=BAD_INPUT).stderr
            self.assertIn("a choice of sweep points leaves 1 of the file's 3: take all",
                          " ".join(out.split()))
            self.jostle("analyse", f"{kind}.h5", kind, "--observable", "mean_height")

    def test_memory_needs_a_common_last_stage(self):
        self.write(TAPPED)
        self.run_scene()
        self.assertIn("at least two stages", self.jostle(
            "analyse", "tiny.h5", "memory", "--observable", "mean_height", expect=BAD_INPUT).stderr)

    def test_taps_of_several_strengths_are_named(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.2}, "count": 60},
                                           {"tap": {"dilate": 0.05}, "count": 40},
                                           {"tap": {"dilate": 0.05}, "count": 20}]))
        self.run_scene()
        for analysis in ("steady", "spectrum", "sweep"):
            command = ("tiny.h5", analysis, "--observable", "mean_height", "--no-store", "--last")
            for last, expected in (("60", None), ("70", "taps 51 to 60 have other strengths than taps 61 to 120: "
                                                        "for one strength set last to 60 or less")):
                for table in self.analyse(*command, last)["tables"]:
                    self.assertEqual(table["notes"].get("strengths"), expected, table["name"])

    def test_a_field_of_taps_is_drawn_against_itself(self):
        """Not against their strength, which is the same at every point."""
        self.write(changed(TINY, realizations=2, protocol=[{"tap": {"shake": {"lambda": 0.05}}, "count": 40}],
                           sweep={"/protocol/0/tap/shake/lateral_radius": [0, 0.05, 0.1]}))
        self.run_scene()
        (table,) = self.analyse("tiny.h5", "sweep", "--observable", "mean_height")["tables"]
        self.assertEqual(table["axes"]["lateral_radius"]["values"], [0, 0.05, 0.1])

    def test_points_whose_analysis_is_refused_leave_the_others(self):
        self.write(changed(TINY, sweep={"/protocol/0/count": [4, 40, 50]}))
        self.run_scene()
        self.analyse("tiny.h5", "steady", "--observable", "mean_height")
        (table,) = self.analyse("tiny.h5", "sweep", "--observable", "mean_height", "--quantity",
                                "steady/value")["tables"]
        self.assertEqual(table["axes"]["count"]["values"], [40, 50])
        self.assertRegex(table["notes"]["left_out"], "^at 4: .*32 taps")

    def test_a_combination_that_is_refused_leaves_the_others(self):
        self.write(changed(TINY, sweep={"/protocol/0/count": [4, 40], "/protocol/0/tap/dilate": [0.02, 0.1]}))
        self.run_scene()
        short, full = self.analyse("tiny.h5", "sweep", "--observable", "mean_height", "--against",
                                   "/protocol/0/tap/dilate", "--last", "30")["tables"]
        self.assertEqual((short["notes"]["at"], full["notes"]["at"]), ("/protocol/0/count = 4", "/protocol/0/count = 40"))
        self.assertIn("30", short["notes"]["refused"])
        self.assertEqual(len(full["quantities"]["mean_height"]["values"]), 2)

    def test_volumes_of_different_beds_or_taps_are_refused(self):
        for sweep, reason in (({"/spheres": [48, 64]}, "has other spheres or sides than"),
                              ({"/protocol/0/tap": [{"dilate": 0.1}, {"lift": 0.3}]}, "are not one sweep")):
            self.write(changed(TAPPED, sweep=sweep))
            self.run_scene("--force")
            refused = self.jostle("analyse", "tiny.h5", "volumes", "--observable", "mean_height", expect=BAD_INPUT)
            self.assertIn(reason, " ".join(refused.stderr.split()))

    def test_hysteresis_of_a_ramp_up_and_down(self):
        ramp = {"sqrt_from": 0.1, "sqrt_to": 0.3, "sqrt_step": 0.1}
        down = {**ramp, "sqrt_from": 0.2, "sqrt_to": 0.1}
        scene = changed(TINY, protocol=[{"ramp": {"dilate": ramp}, "count": 8},
                                        {"ramp": {"dilate": down}, "count": 8}])
        del scene["sweep"]
        self.write(scene)
        self.run_scene()
        table = self.analyse("tiny.h5", "hysteresis", "--observable", "bottom_fraction",
                             "--last", "3")["tables"][0]
        values = table["quantities"]
        for found, wanted in zip(values["sqrt_epsilon"]["values"], (0.1, 0.2, 0.3, 0.2, 0.1)):
            self.assertAlmostEqual(found, wanted, places=12)
        phi = self.series("bottom_fraction")
        steps = [phi[8 * k + 6:8 * k + 9].mean(axis=0) for k in range(5)]
        for found, step in zip(values["bottom_fraction"]["values"], steps):
            self.assertAlmostEqual(found / step.mean(), 1, places=12)
        # Later less earlier branch, by trapezia over 0.1 to 0.3.
        area = 0.1 * ((steps[4] - steps[0]) / 2 + (steps[3] - steps[1]))
        self.assertAlmostEqual(values["area"]["values"][0], area.mean(), places=12)
        self.assertEqual(values["area_dof"]["values"], [2])
        self.assertRegex(values["area_verdict"]["values"][0],
                         "^(the branches differ|cannot decide with 3 realizations)")
        self.assertAlmostEqual(values["area_error"]["values"][0] / (area.std(ddof=1) / 3 ** 0.5), 1,
                               places=9)


if __name__ == "__main__":
    unittest.main()
