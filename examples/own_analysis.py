"""An analysis of one's own: does a bed settle more from the top or from the bottom?

Everything that was measured is a numpy array, every packing too. Here spheres are followed from one kept
packing to the next, and the mean fall of a sphere is drawn against its height, with its standard error
over realizations: spheres of one packing are not independent, realizations are.

    python3 examples/own_analysis.py
"""

import argparse

import jostle
import matplotlib.pyplot as plt
import numpy as np

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("--taps", type=int, default=30)
parser.add_argument("--realizations", type=int, default=5)
arguments = parser.parse_args()

scene = {
    "name": "own_analysis",
    "seed": 20010222,
    "realizations": arguments.realizations,
    "container": {"sides": "periodic", "width": 5},
    "spheres": 200,
    "protocol": [{"tap": {"dilate": 0.05}, "count": arguments.taps}],
    "relax": {"polar": {}, "sampler": "skipping",
              "stop": {"mean_height": {"eta": 1e-5, "every_sweeps": 100}}},
    "observe": ["mean_height"],
    "snapshots": {"taps": [0, arguments.taps], "keep": ["positions"]},
}
results = jostle.run(scene, force=True)
point = results.points[0]

bins = np.arange(0.0, 8.0)
falls = np.full((point.n_realizations, len(bins) - 1), np.nan)  # [realization, bin]
for realization in range(point.n_realizations):
    before = point.positions(realization, tap=0)  # [sphere, 3]; a sphere keeps its place in the array
    after = point.positions(realization, tap=arguments.taps)
    fallen = before[:, 2] - after[:, 2]
    place = np.digitize(before[:, 2], bins) - 1
    for i in range(len(bins) - 1):
        if (place == i).any():
            falls[realization, i] = fallen[place == i].mean()

count = np.isfinite(falls).sum(axis=0)
kept = count >= 2
mean = np.nanmean(falls[:, kept], axis=0)
error = np.nanstd(falls[:, kept], axis=0, ddof=1) / np.sqrt(count[kept])
half = jostle.half_width(error, count[kept] - 1)
middle = (bins[:-1] + bins[1:])[kept] / 2
for z, fall, width in zip(middle, mean, half):
    print(f"spheres at z = {z:.1f}: fell by {fall:.3f} +- {width:.3f} diameters in {arguments.taps} taps")

# It must come to the fall of the mean height that the run has measured.
measured = point.series["mean_height"]
np.testing.assert_allclose([(point.positions(r, 0) - point.positions(r))[:, 2].mean()
                            for r in range(point.n_realizations)], measured[0] - measured[-1], atol=1e-9)

plt.errorbar(middle, mean, half, fmt="o-", markersize=4)
plt.xlabel("height at the start (diameter)")
plt.ylabel(f"fall in {arguments.taps} taps (diameter)")
plt.savefig("own_analysis.png", dpi=150)
print("own_analysis.h5, own_analysis.png")
