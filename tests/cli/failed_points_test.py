"""Sweeps of which a point, or every point, has failed: what is left is analysed, and says so."""
import unittest

from support import BAD_INPUT, UNFOLDED, Case, changed

# A crystal stands between periodic sides that its rows fit: not in 4 d along y.
WIDTHS = [3.4641016151377544, 4, 5.196152422706632, 6.928203230275509]
SCENE = {
    "name": "widths",
    "seed": 1,
    "realizations": 3,
    "container": {"sides": "periodic", "width": [4, WIDTHS[0]]},
    "spheres": 48,
    "start": {"crystal": "hcp"},
    "protocol": [{"tap": {"dilate": 0.05}, "count": 12}, {"tap": {"dilate": 0.1}, "count": 12}],
    "relax": {"polar": {"max_step": 0.1, "theta0": 0.7854},
              "stop": {"mean_height": {"eta": 1e-3, "every_sweeps": 50}}},
    "observe": ["mean_height"],
    "snapshots": {},
    "motion": {},
    "sweep": {"/container/width/1": WIDTHS},
}
SWEEP = ("sweep", "--observable", "mean_height", "--last", "5")


class FailedPoints(Case):
    def run_with_failures(self, scene):
        self.write(scene)
        self.popen("run", "scene.json", "-o", "widths.h5", "--quiet").communicate(timeout=300)

    def analyse(self, *arguments, expect=0):
        return self.jostle("analyse", "widths.h5", *arguments, "--no-store", expect=expect,
                           environment=UNFOLDED)

    def test_a_failed_point_is_left_out_by_name(self):
        self.run_with_failures(SCENE)
        found = self.analyse(*SWEEP).stdout
        self.assertRegex(found, r"left_out +at 4 no realization has taps")
        self.assertRegex(found, r"against +width_1\n")
        self.assertNotRegex(found, r"(?m)^ +4 ")
        ordering = ("ordering", "--observable", "mean_height", "--threshold", "5", "--hold", "3")
        self.assertRegex(self.analyse(*ordering).stdout,
                         r"left_out +width/1 = 4: no realization has taps")
        memory = self.analyse("memory", "--observable", "mean_height", expect=BAD_INPUT)
        self.assertRegex(memory.stdout, r"refused +no realization has taps at width/1 = 4")

    def test_a_point_is_named_as_it_is_listed(self):
        self.run_with_failures(SCENE)
        for place in ("5.19615", "5.196152422706632"):
            with self.subTest(place=place):
                self.assertRegex(self.analyse(*SWEEP, "--reference", place).stdout,
                                 r"(?m)^ *0 +5\.196 ")
        self.assertRegex(self.analyse(*SWEEP, "--reference", "5.2", expect=BAD_INPUT).stdout,
                         r"no such point; there are, of width_1, 3.4641, 5.19615, 6.9282")

    def test_where_all_failed_every_analysis_says_so(self):
        scene = changed(SCENE, container={"sides": "periodic", "width": [4, 4]})
        scene.pop("sweep")
        self.run_with_failures(scene)
        for analysis in (SWEEP, ("motion",), ("memory", "--observable", "mean_height"),
                         ("volumes", "--observable", "mean_height"),
                         ("steady", "--observable", "mean_height")):
            with self.subTest(analysis=analysis[0]):
                self.assertRegex(self.analyse(*analysis, expect=BAD_INPUT).stdout,
                                 r"refused +.*(no realization has taps|two sweep points)")


if __name__ == "__main__":
    unittest.main()
