"""Scenes that run until a target precision is reached."""

import unittest

import h5py

from support import BAD_INPUT, STOPPED, TINY, UNFOLDED, Case, changed

TARGETS = [{"observable": "mean_height", "taps": [2, 4], "standard_error": 0.012},
           {"observable": "bottom_fraction", "standard_error": 0.004}]
UNTIL = changed(TINY, realizations=2, until={"targets": TARGETS, "at_most": 400})


class TargetPrecision(Case):
    def spreads(self, file="tiny.h5"):
        """Standard errors of the targets, largest over points and taps, and the realizations."""
        with h5py.File(self.folder / file) as stored:
            points = [stored[f"observables/point_{point:04}"] for point in (0, 1)]
            number = points[0]["mean_height"].shape[1]
            error = lambda values: values.std(axis=-1, ddof=1) / number ** 0.5
            height = max(error(point["mean_height"][[2, 4]]).max() for point in points)
            bottom = max(error(point["bottom_fraction"][4]) for point in points)
            return height, bottom, number

    def test_realizations_are_added_until_every_target_is_met(self):
        self.write(UNTIL)
        done = self.run_scene("--threads", "1")
        height, bottom, number = self.spreads()
        self.assertLessEqual(height, 0.012)
        self.assertLessEqual(bottom, 0.004)
        self.assertGreater(number, 4)
        self.assertIn("2 realizations: target precision not reached yet: ", done.stdout)
        self.assertIn(f"\n{number} realizations: target precision reached: ", done.stdout)
        self.assertEqual(done.stdout.count("this run: "), 1)
        self.assertEqual(self.info("tiny.h5")["tables"], ["analysis/target_precision"])
        with h5py.File(self.folder / "tiny.h5") as stored:
            self.assertEqual(stored["analysis/target_precision"].attrs["note_verdict"], "met")
            self.assertEqual(len(stored["provenance/version"]), 1)
            values = stored["analysis/target_precision/value"][:]
        self.assertAlmostEqual(max(values[0], values[2]) / height, 1, places=12)
        self.assertAlmostEqual(max(values[1], values[3]) / bottom, 1, places=12)

        # Equal number and bytes on two threads, and in pieces.
        digest = self.digest("tiny.h5")
        self.run_scene("--threads", "2", "-o", "two.h5")
        self.assertEqual(self.digest("two.h5"), digest)
        for _ in range(1000):
            piece = self.run_scene("--resume", "--time-limit", "0.02s", "-o", "pieces.h5",
                                   expect=None)
            if piece.returncode != STOPPED:
                break
        self.assertEqual(piece.returncode, 0, piece.stderr)
        self.assertEqual(self.digest("pieces.h5"), digest)
        # Each realization is that of a run of so many.
        fixed = changed(TINY, realizations=number, name="fixed")
        self.write(fixed, "fixed.json")
        self.run_scene(scene="fixed.json")
        with h5py.File(self.folder / "tiny.h5") as a, h5py.File(self.folder / "fixed.h5") as b:
            for point in ("point_0000", "point_0001"):
                column = f"observables/{point}/mean_height"
                self.assertTrue((a[column][:] == b[column][:]).all())

    def test_the_limit_is_kept_and_can_be_raised(self):
        sigma = [{"observable": "mean_height", "sigma": 1e-6}]
        self.write(changed(UNTIL, until={"targets": sigma, "at_most": 5}))
        done = self.run_scene(environment=UNFOLDED)
        self.assertIn("5 realizations: target precision NOT reached, and no more are allowed: sigma of mean_height",
                      done.stdout)
        self.assertEqual(self.spreads()[2], 5)
        self.write(changed(UNTIL, until={"targets": sigma, "at_most": 7}))
        self.run_scene("--resume")
        self.assertEqual(self.spreads()[2], 7)

    def test_a_share_cannot_tell_the_precision(self):
        self.write(UNTIL)
        refused = self.run_scene("--shard", "1/2", expect=BAD_INPUT)
        self.assertIn("cannot decide. Run it whole", refused.stderr)
        self.assertEqual(self.files(), ["scene.json"])


if __name__ == "__main__":
    unittest.main()
