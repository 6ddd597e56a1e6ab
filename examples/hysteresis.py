"""Hysteresis: taps that get stronger and then weaker again leave the bed denser than they found it.

    python3 examples/hysteresis.py
"""

import argparse

import jostle
import matplotlib.pyplot as plt

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("--taps", type=int, default=20, help="at each strength")
parser.add_argument("--realizations", type=int, default=5)
arguments = parser.parse_args()

up = {"sqrt_from": 0.05, "sqrt_to": 0.35, "sqrt_step": 0.05}
down = {"sqrt_from": 0.35, "sqrt_to": 0.05, "sqrt_step": 0.05}
scene = {
    "name": "hysteresis",
    "seed": 20010222,
    "realizations": arguments.realizations,
    "container": {"sides": "periodic", "width": 4},
    "spheres": 60,
    "protocol": [{"ramp": {"dilate": up}, "count": arguments.taps},
                 {"ramp": {"dilate": down}, "count": arguments.taps}],
    "relax": {"polar": {}, "sampler": "skipping",
              "stop": {"mean_height": {"eta": 1e-5, "every_sweeps": 100}}},
    "observe": ["mean_height", "bottom_fraction"],
}
results = jostle.run(scene, force=True)

(table,) = jostle.analyse(results, "hysteresis", "mean_height")
print(table.to_pandas("step").to_string(float_format="{:.4g}".format))
area, error = table["area"][0], table.error("area")[0]
half = jostle.half_width(error, table["area_dof"][0])
print(f"area of the loop: {area:.4f} +- {half:.4f}; {table['area_verdict'][0]}")

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
jostle.plot.hysteresis(table, ax=left)
jostle.plot.compaction(results, "mean_height", ax=right)
figure.savefig("hysteresis.png", dpi=150)
print("hysteresis.h5, hysteresis.png")
