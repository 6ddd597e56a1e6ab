"""Numbers of analyses recomputed from the raw data of small runs with numpy, by the rules of the documents."""

import unittest

import h5py
import numpy as np

from support import TINY, Case, changed

EXACT = {"rtol": 1e-9, "atol": 1e-12}


def jackknife(left_out):
    n = len(left_out)
    return np.sqrt((n - 1) / n * ((left_out - left_out.mean()) ** 2).sum())


class Recomputed(Case):
    def test_squared_changes_their_variances_and_the_errors_of_both(self):
        scene = changed(TINY, realizations=5, protocol=[{"tap": {"dilate": 0.05}, "count": 30}],
                        snapshots={"taps": [0]}, analyse={"ageing": [{"observable": "mean_height"}]})
        del scene["sweep"]
        self.write(scene)
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as file:
            heights = file["observables/point_0000/mean_height"][:]
            table = file["analysis/point_0000/ageing/mean_height"]
            for name in ("a", "v", "a_inf", "b", "tau", "ageing_factor"):
                self.assertEqual(table[name + "_error"].attrs["long_name"],
                                 "standard error over realizations of ln of the value, times the value")
            for k, waiting in enumerate(table["waiting_time"][:]):
                for j, lag in enumerate(table["lag"][:]):
                    if waiting + lag > 30:
                        continue
                    change = heights[waiting + lag] - heights[waiting]
                    n = len(change)
                    without = [np.delete(change, r) for r in range(n)]
                    squares = np.array([(rest**2).mean() for rest in without])
                    variances = np.array([rest.var(ddof=1) for rest in without])
                    for name, value, left_out in (("a", (change**2).mean(), squares),
                                                  ("v", change.var(ddof=1), variances)):
                        np.testing.assert_allclose(table[name][k, j], value, **EXACT)
                        np.testing.assert_allclose(table[name + "_error"][k, j],
                                                   value * jackknife(np.log(left_out)), **EXACT)


if __name__ == "__main__":
    unittest.main()
