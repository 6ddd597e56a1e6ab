"""The number of reads of a results file grows in proportion to its sweep points, not to their square."""

import unittest

from support import SHIM, TINY, Case, changed

POINTS, TIMES = 8, 4
MOST_GROWTH = 1.1 * TIMES  # a square grows by TIMES**2
COMMANDS = {
    "info": ("--wide",),
    "fit": ("--observable", "mean_height", "--model", "kww", "--no-store"),
    "analyse": ("sweep", "--observable", "mean_height", "--last", "2", "--no-store"),
    "report": ("-o", "page.html", "--force"),
}


class SweepReads(Case):
    def reads(self, command, points):
        count = self.folder / "count"
        path = self.folder / f"runs/{points}.h5"
        environment = {**SHIM, "JOSTLE_FAULT_OF": "reads", "JOSTLE_FAULT_PATH": str(path.parent),
                       "JOSTLE_FAULT_COUNT": str(count)}
        self.jostle(command, path, *COMMANDS[command], environment=environment)
        return int(count.read_text())

    def test_reads_grow_in_proportion_to_the_sweep_points(self):
        (self.folder / "runs").mkdir()
        for points in (POINTS, TIMES * POINTS):
            self.write(changed(TINY, relax={"polar": {}, "stop": {"sweeps": 1}}, snapshots={}, sweep={
                "/protocol/0/tap/dilate": [0.005 * (i + 1) for i in range(points)]}))
            self.run_scene("--quiet", "-o", f"runs/{points}.h5")
        for command in COMMANDS:
            with self.subTest(command=command):
                few, many = self.reads(command, POINTS), self.reads(command, TIMES * POINTS)
                self.assertGreater(few, POINTS)
                self.assertLess(many, MOST_GROWTH * few)


if __name__ == "__main__":
    unittest.main()
