"""Sweeps with a failed or late point, or only such points: the rest is analysed, and the output reports it."""
import signal
import time
import unittest

import h5py
from support import BAD_INPUT, UNFOLDED, Case, changed

# A crystal needs periodic sides that fit its rows: not 4 d along y.
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
        self.assertRegex(found, r"left_out +at 4: no realization has taps")
        self.assertRegex(found, r"against +width_1\n")
        self.assertNotRegex(found, r"(?m)^ +4 ")
        ordering = ("ordering", "--observable", "mean_height", "--threshold", "5", "--hold", "3")
        self.assertRegex(self.analyse(*ordering).stdout,
                         r"left_out +width/1 = 4: no realization has taps")
        memory = self.analyse("memory", "--observable", "mean_height")
        self.assertRegex(memory.stdout, r"left_out +width/1 = 4: no realization has taps")

    def test_points_of_other_taps_are_not_compared(self):
        widths = [WIDTHS[0], WIDTHS[2], WIDTHS[3]]
        scene = changed(SCENE, realizations=1, sweep={"/container/width/1": widths})
        scene.pop("motion")
        self.run_with_failures(scene)
        longer = changed(scene, protocol=[*scene["protocol"][:1],
                                          {**scene["protocol"][1], "count": 1_000_000}])
        self.write(longer)
        process = self.popen("run", "scene.json", "-o", "widths.h5", "--resume", "--quiet",
                             "--threads", "1")
        time.sleep(3)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        with h5py.File(self.folder / "widths.h5") as file:
            rows = [int(file[f"observables/point_{point:04}/rows"][0]) for point in range(3)]
        self.assertGreater(rows[0], 2 * 24 + 1)
        self.assertEqual(rows[1:], [25, 25])
        why = ("its realizations have all reached tap 24, fewer than half of the "
               f"{rows[0] - 1} taps that those of another point reached")
        self.assertIn(f"at 5.196: {why}; at 6.928: {why}", self.analyse(*SWEEP).stdout)
        ordering = ("ordering", "--observable", "mean_height", "--threshold", "5", "--hold", "3")
        self.assertRegex(self.analyse(*ordering).stdout,
                         rf"needs two sweep points at least; left out: width/1 = [0-9.]+: {why}")
        # Histories are compared over the lags that all have.
        self.assertNotIn("refused", self.analyse("memory", "--observable", "mean_height").stdout)

    def test_a_point_is_named_as_it_is_listed(self):
        self.run_with_failures(SCENE)
        for place in ("5.196", "5.19615", "5.196152422706632"):
            with self.subTest(place=place):
                self.assertRegex(self.analyse(*SWEEP, "--reference", place).stdout,
                                 r"(?m)^ *0 +5\.196 ")
        self.assertRegex(self.analyse(*SWEEP, "--against", "width_1").stdout, "against +width_1")
        self.assertRegex(self.analyse(*SWEEP, "--reference", "5.2", expect=BAD_INPUT).stderr,
                         r"no such point; there are, of width_1, 3.4641, 5.19615, 6.9282")

    def test_where_all_failed_every_analysis_says_so(self):
        self.run_with_failures(changed(SCENE, sweep={"/container/width/1": [4, 4.1]}))
        of_bed = ("--observable", "mean_height")
        for analysis, why in ((SWEEP, "no realization has taps, at any sweep point"),
                              (("motion",), "no realization has taps"),
                              (("steady", *of_bed), "no realization has taps at width/1 = 4.1"),
                              (("hysteresis", *of_bed), "no realization has taps at width/1 = 4"),
                              (("memory", *of_bed), "left out: width/1 = 4: no realization has taps")):
            with self.subTest(analysis=analysis[0]):
                self.assertIn(why, self.analyse(*analysis, expect=BAD_INPUT).stderr)

    def test_strengths_without_taps_are_left_out_of_volumes(self):
        strengths = [0.02, 0.05, 0.1, 0.2]
        scene = changed(SCENE, protocol=[{"tap": {"dilate": 0.05}, "count": 40}], sweep={
            "zip": {"/protocol/0/tap/dilate": strengths,
                    "/container/width/1": [WIDTHS[0]] * 3 + [4]}})
        self.run_with_failures(scene)
        found = self.analyse("volumes", "--observable", "mean_height").stdout
        self.assertRegex(found, r"points_left_out +dilate = 0.2, width/1 = 4: no realization has taps")
        self.assertNotIn("refused", found)


if __name__ == "__main__":
    unittest.main()
