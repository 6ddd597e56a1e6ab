"""Ageing: how far the mean height moves in t taps, after the bed has been tapped t_W times.

    python3 examples/ageing.py
"""

import argparse

import jostle
import matplotlib.pyplot as plt
import numpy as np

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("--taps", type=int, default=200)
parser.add_argument("--realizations", type=int, default=5)
arguments = parser.parse_args()

scene = {
    "name": "ageing",
    "seed": 20010222,
    "realizations": arguments.realizations,
    "container": {"sides": "periodic", "width": 4},
    "spheres": 60,
    "protocol": [{"tap": {"dilate": 0.05}, "count": arguments.taps}],
    "relax": {"polar": {}, "sampler": "skipping",
              "stop": {"mean_height": {"eta": 1e-5, "every_sweeps": 100}}},
    "observe": ["mean_height"],
}
results = jostle.run(scene, force=True)

# A(t, t_W) of Philippe & Bideau 2001, eq. 5, with fits of eq. 6, errors and verdicts.
(table,) = jostle.analyse(results, "ageing", "mean_height", waiting_times=[0, 10, 100],
                          lags=[1, 2, 5, 10, 20, 50, 100])
print("ageing:  ", table.notes["ageing_verdict"])
print("collapse:", table.notes["collapse_verdict"])

# Check by hand: mean over realizations of the squared differences.
heights = results.points[0].series["mean_height"]  # [tap, realization]
by_hand = np.mean((heights[10 + 50] - heights[10]) ** 2)
in_table = table.to_dataset()["a"].sel(waiting_time=10, lag=50)
print(f"A(50, 10) = {by_hand:.4g} by hand, {float(in_table):.4g} in the table")

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
jostle.plot.ageing(table, ax=left)
try:
    jostle.plot.ageing(table, scaled=True, ax=right)
except jostle.NotThere as why:  # few realizations seldom limit the parameters of eq. 6
    right.set_title("no shared law", color="0.5")
    print(why)
figure.savefig("ageing.png", dpi=150)
print("ageing.h5, ageing.png")
