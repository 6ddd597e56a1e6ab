"""jostle cost: what accuracy costs, in pairs from the same packings."""

import csv
import unittest

import h5py

from support import BAD_INPUT, BROKEN, FAILED, OK, TINY, UNFOLDED, Case, changed

SCENE = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}],
                relax={"polar": {}, "stop": {"mean_height": {"eta": 1e-4, "every_sweeps": 20}}})
del SCENE["sweep"]


class Cost(Case):
    def setUp(self):
        super().setUp()
        self.write(SCENE)

    def cost(self, *arguments, expect=OK):
        return self.jostle("cost", "scene.json", "--no-progress", *arguments, expect=expect,
                           environment=UNFOLDED)

    def rows(self, name):
        """The settings of bottom_fraction from a CSV, without times."""
        lines = (self.folder / name).read_text().splitlines()
        start = lines.index("# cost/bottom_fraction")
        header = next(i for i in range(start, len(lines)) if lines[i].startswith("setting,part"))
        end = next((i for i in range(header, len(lines)) if not lines[i]), len(lines))
        rows = list(csv.DictReader(lines[header:end]))
        timed = ("tap_seconds", "start_seconds", "core_hours", "pareto")
        return [{key: row[key] for key in row if key not in timed} for row in rows]

    def test_biases_are_means_of_paired_differences(self):
        done = self.cost("--replicates", "3", "--taps", "5", "--target", "0.5", "--csv", "c.csv")
        self.assertIn("against eta = 1e-06", done.stdout)
        self.assertRegex(done.stdout, "For an error of 0.5 in bottom_fraction: .+, 2 real")
        self.assertRegex(done.stdout, r"Upper limits at 80 % confidence \(3 pilot replicates\): bias \S+, spread of real")
        with h5py.File(self.folder / "tiny-cost.h5") as stored:
            table = stored["analysis/cost/bottom_fraction"]
            names = [name.decode() for name in table["setting"][:]]
            last = [stored[f"observables/point_{p:04}/bottom_fraction"][5]
                    for p in range(len(names))]
            reference = last[names.index("eta = 1e-06")]
            for p, values in enumerate(last):
                difference = values - reference
                self.assertAlmostEqual(table["bias"][p], difference.mean(), places=14)
                self.assertAlmostEqual(table["bias_error"][p],
                                       difference.std(ddof=1) / 3 ** 0.5, places=14)
                self.assertAlmostEqual(table["bias_by_tap"][p, 4], difference.mean(), places=14)
            # Pairs begin from the same bed, but for half the spheres.
            starts = [stored[f"observables/point_{p:04}/mean_height"][0] for p in range(len(names))]
            for name, start in zip(names, starts):
                if name != "half the footprint":
                    self.assertTrue((start == starts[0]).all(), name)
            timing = stored["timing/point_0000"]
            self.assertAlmostEqual(table["start_seconds"][0], timing["start_seconds"][:].mean())
            sweeps = table["sweeps_per_tap"][:]
            self.assertGreater(sweeps[names.index("eta = 1e-06")], sweeps[0])
        self.assertEqual([row["setting"] for row in self.rows("c.csv")], names)

    def test_starts_windows_and_growth_with_taps(self):
        self.write(changed(SCENE, container={"sides": "walls", "width": 4},
                           start={"pour": "fitted"}, observe=["mean_height", "bulk_fraction"]))
        done = self.cost("--replicates", "4", "--taps", "6", "--observable", "bulk_fraction")
        self.assertRegex(done.stdout, r"\n *poured between the walls  ")
        self.assertRegex(done.stdout, r"\n *theta_0 = 0.393  ")
        self.assertRegex(done.stdout, r"Since tap 3 the scene's changed by [+-][\d.]+\(\d+\)\S*: ")
        self.assertRegex(done.stdout, r"the same beds differ by \S+\) \(quantiles 0.35 to 0.65\); "
                                      r"\S+\) \(quantiles 0.1 to 0.9\); "
                                      r"\S+\) \(quantiles 0.2 to 0.8, tapered over 0.8165\)\.")
        with h5py.File(self.folder / "tiny-cost.h5") as stored:
            table = stored["analysis/cost/bulk_fraction"]
            names = [name.decode() for name in table["setting"][:]]
            reference = names.index("eta = 1e-06")
            values = {(p, tap): stored[f"observables/point_{p:04}/bulk_fraction"][tap]
                      for p in range(len(names)) for tap in (3, 6)}
            for p in range(len(names)):
                grown = (values[p, 6] - values[reference, 6]) - (values[p, 3] - values[reference, 3])
                self.assertAlmostEqual(table["growth"][p], grown.mean(), places=14)
                self.assertAlmostEqual(table["growth_error"][p],
                                       grown.std(ddof=1) / 4 ** 0.5, places=14)
            for name, difference in zip(("narrow", "wide"), table["window_difference"][:]):
                other = stored[f"observables/point_0000/bulk_fraction_{name}"][6]
                self.assertAlmostEqual(difference, (other - values[0, 6]).mean(), places=14)
            # The other pour begins from beds of its own.
            starts = [stored[f"observables/point_{p:04}/mean_height"][0] for p in range(len(names))]
            poured = names.index("poured between the walls")
            self.assertTrue((starts[poured] != starts[0]).all())
            self.assertEqual(table["pareto"][poured], 0)
            self.assertIn(f"fitting/point_{reference:04}", stored)
            self.assertNotIn(f"fitting/point_{poured:04}", stored)

    def test_the_same_replicates_give_the_same_numbers(self):
        self.cost("--replicates", "4", "--taps", "3", "--csv", "a.csv", "--threads", "1")
        self.cost("--replicates", "2", "--taps", "3", "--csv", "b.csv", "--threads", "2", "-o", "b.h5")
        kept = self.cost("--replicates", "4", "--taps", "3", "-o", "b.h5", expect=BAD_INPUT)
        self.assertIn("b.h5 exists and is kept", kept.stderr)
        again = ("--replicates", "4", "--taps", "3", "--csv", "b.csv", "--threads", "2", "-o", "b.h5",
                 "--resume")
        self.assertIn("b.csv exists and is kept", self.cost(*again, expect=BAD_INPUT).stderr)
        # The lock of another host, which --force takes over: the pilots stay.
        (self.folder / "b.h5.lock").write_text("elsewhere 1 1\n")
        self.assertIn("resume its run, which takes the file over (--force)",
                      self.cost(*again[:4], *again[-5:], expect=BROKEN).stderr)
        self.cost(*again, "--force")
        self.assertEqual(self.rows("a.csv"), self.rows("b.csv"))
        self.assertEqual(self.digest("tiny-cost.h5"), self.digest("b.h5"))
        other = self.cost("--replicates", "4", "--taps", "4", "-o", "b.h5", "--resume", "--observable",
                          "mean_height")
        self.assertIn("mean_height: pilots after 4 taps, 4 replicates", other.stdout)

    def test_a_budget_decides_whole_replicates(self):
        done = self.cost("--budget", "0s", "--taps", "2")
        self.assertIn("pilots after 2 taps, 2 replicates", done.stdout)
        done = self.cost("--budget", "1s", "--taps", "2", "--resume")
        self.assertNotIn(" 2 replicates", done.stdout)

    def test_failures_are_told_and_no_replicate_follows_where_all_fail(self):
        self.write(changed(SCENE, container={"sides": "periodic", "width": 4},
                           start={"crystal": "hcp"}))
        done = self.cost("--budget", "60s", "--taps", "2", expect=FAILED)
        self.assertNotIn("nan", done.stdout)
        self.assertRegex(done.stdout, r"2 of 2 replicates failed, and are not in the numbers: .+\n  \(as the scene, ")

    def test_a_reference_that_relaxes_less_is_called_doubtful(self):
        relax = {"metropolis": {"max_step": 0.1, "adapt": {"reset_each_tap": False}},
                 "stop": {"mean_height": {"eta": 1e-5, "every_sweeps": 100}}}
        self.write(changed(SCENE, start={"random_settle": {}}, relax=relax, snapshots={},
                           protocol=[{"tap": {"lift": 0.25}, "count": 3}]))
        self.assertIn("DOUBTFUL: the reference takes", self.cost("--replicates", "3").stdout)
        # The pilot's scene is the scene: its step is what the start's relaxation left.
        self.run_scene("-o", "whole.h5")
        with h5py.File(self.folder / "whole.h5") as whole, \
                h5py.File(self.folder / "tiny-cost.h5") as pilot:
            self.assertTrue((whole["observables/point_0000/mean_height"][0]
                             == pilot["observables/point_0000/mean_height"][0]).all())
            sweeps = [file["observables/point_0000/sweeps"][1:].mean() for file in (whole, pilot)]
            self.assertLess(abs(sweeps[0] / sweeps[1] - 1), 0.5)

    def test_what_cannot_be_costed_is_refused(self):
        refused = self.cost("--observable", "bulk_fraction", expect=BAD_INPUT)
        self.assertIn("the scene observes mean_height, bottom_fraction", refused.stderr)
        self.write(changed(SCENE, protocol=[], snapshots={}))
        self.assertIn("there is no tap", self.cost(expect=BAD_INPUT).stderr)
        self.write(changed(SCENE, sweep={"/protocol/0/tap/dilate": [0.05, 0.1], "/spheres": [40, 48]}))
        refused = self.cost("--sweep-point", "48", "--replicates", 1, expect=BAD_INPUT)
        self.assertIn("--sweep-point 48: points 1, 3 have this value, and the command uses only one", refused.stderr)
        self.assertEqual(self.files(), ["scene.json"])


if __name__ == "__main__":
    unittest.main()
