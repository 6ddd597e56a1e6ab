"""Structure: what a bed looks like inside before and after taps, here and in ASE and OVITO.

    python3 examples/structure.py
"""

import argparse

import jostle
import matplotlib.pyplot as plt

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("--taps", type=int, default=30)
parser.add_argument("--realizations", type=int, default=3)
arguments = parser.parse_args()

scene = {
    "name": "structure",
    "seed": 20010222,
    "realizations": arguments.realizations,
    "container": {"sides": "periodic", "width": 6},
    "spheres": 300,
    "protocol": [{"tap": {"dilate": 0.05}, "count": arguments.taps}],
    "relax": {"polar": {}, "sampler": "skipping",
              "stop": {"mean_height": {"eta": 1e-5, "every_sweeps": 100}}},
    "snapshots": {"taps": [0, arguments.taps]},
}
results = jostle.run(scene, force=True)

profile, coordination = jostle.structure(results, part=["profile", "coordination"])
for tap, neighbours, error in zip(coordination["tap"], coordination["n_c"], coordination.error("n_c")):
    print(f"tap {tap}: {neighbours:.2f} +- {jostle.half_width(error, arguments.realizations - 1):.2f} "
          "neighbours")

# Extended XYZ: OVITO opens it as it is, a frame a tap, with what is known of every sphere.
jostle.export(results, "structure.xyz", format="extxyz", realization=0, tap="all", force=True)
try:
    import ase.io
except ImportError:
    print("ASE is not installed (Debian: python3-ase); OVITO opens structure.xyz all the same")
else:
    for atoms in ase.io.read("structure.xyz", index=":"):
        pairs = atoms.get_all_distances(mic=True)
        touching = ((pairs > 0) & (pairs < 1.001)).sum() / len(atoms)
        crystal = (atoms.arrays["structure_type"] > 0).mean()
        print(f"tap {atoms.info['tap']}, by ASE: {touching:.2f} contacts per sphere, "
              f"{100 * crystal:.0f} % with crystalline order")

figure, axes = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
jostle.plot.profile(profile, "phi_smoothed", ax=axes[0])
jostle.plot.height_histogram(results, ax=axes[1])
jostle.plot.packing_slice(results, ax=axes[2])
figure.savefig("structure.png", dpi=150)
print("structure.h5, structure.xyz, structure.png")
