"""Compaction: how a poured bed gets denser under taps of three strengths, and a law for the curves.

    python3 examples/compaction.py                 sixty taps of small beds, in seconds
    python3 examples/compaction.py --taps 4000     any length; --resume continues a stopped run
"""

import argparse

import jostle
import matplotlib.pyplot as plt

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("--taps", type=int, default=60)
parser.add_argument("--realizations", type=int, default=4)
parser.add_argument("--resume", action="store_true")
arguments = parser.parse_args()

scene = {
    "name": "compaction",
    "seed": 20010222,
    "realizations": arguments.realizations,
    "container": {"sides": "periodic", "width": 4},
    "spheres": 80,
    "protocol": [{"tap": {"dilate": 0.02}, "count": arguments.taps}],
    "relax": {"polar": {}, "sampler": "skipping",
              "stop": {"mean_height": {"eta": 1e-5, "every_sweeps": 100}}},
    "observe": ["mean_height", "bottom_fraction"],
    "sweep": {"/protocol/0/tap/dilate": [0.005, 0.05, 0.15]},
}
results = jostle.run(scene, force=not arguments.resume, resume=arguments.resume)

# The whole sweep is one dataset: strengths along one dimension, taps along the other.
height = results.ensemble["mean_height_mean"]
drop = height.isel(tap=0) - height.isel(tap=-1)
for strength in height["dilate"].values:
    print(f"dilated by {strength:5}: <Z> falls by {float(drop.sel(dilate=strength)):.3f} diameters")

# A law fitted to every curve: parameters with intervals, and a sentence on what the data constrain.
for curve in jostle.fit(results, "mean_height", model="kww"):
    print(curve.title)
    fit = curve["kww"]
    if fit.refused:
        print("  no fit:", fit.refused)
    for parameter in fit.parameters.values():
        print(" ", parameter.statement)

# Fits are kept in the file: opened anew, it has their tables.
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
jostle.plot.compaction(results, "mean_height", ax=left)
with jostle.open(results.path) as fitted:
    jostle.plot.fit(fitted.tables.one("mean_height", "kww", point=1), ax=right)
figure.savefig("compaction.png", dpi=150)
print("compaction.h5, compaction.png")
