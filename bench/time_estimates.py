#!/usr/bin/env python3
"""How well `jostle cost` foretells the time of a run.

time_estimates.py JOSTLE FOLDER [SCENE ...]: for each scene (without a sweep) a pilot of two replicates, then the
whole run, both on two threads; prints the estimated and the real core time and their ratio, and
exits with 1 where one is more than 25 % off."""
import pathlib
import subprocess
import sys

import h5py

SCENES = pathlib.Path(__file__).resolve().parents[1] / "config" / "scenes"
DEFAULT = [SCENES / "quickstart.json", SCENES / "philippe-bideau-2001" / "reduced" / "fig9.json",
           SCENES / "rosato-dybenko-2010" / "reduced" / "fig6.json"]
TOLERANCE = 0.25


def run(*arguments):
    subprocess.run([*map(str, arguments), "--threads", "2", "--no-progress"], check=True,
                   stdout=subprocess.DEVNULL)


def estimated_seconds(path):
    """Time of the scene's own setting, all realizations."""
    with h5py.File(path) as file:
        tables = file["analysis/cost"]
        return 3600 * float(tables[sorted(tables)[0]]["core_hours"][0])


def real_seconds(path):
    with h5py.File(path) as file:
        return sum(float(point["seconds"][:].sum()) for point in file["timing"].values())


def main(jostle, folder, scenes):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    worst = 0.0
    print(f"{'scene':<40}{'estimated':>12}{'real':>12}{'ratio':>8}")
    for scene in map(pathlib.Path, scenes or DEFAULT):
        name = f"{scene.parent.parent.name}-{scene.stem}"
        pilot, whole = folder / f"{name}-cost.h5", folder / f"{name}.h5"
        run(jostle, "cost", scene, "--replicates", 2, "-o", pilot, "--force")
        run(jostle, "run", scene, "-o", whole, "--force")
        estimated, real = estimated_seconds(pilot), real_seconds(whole)
        worst = max(worst, abs(estimated / real - 1))
        print(f"{name:<40}{estimated:>10.0f} s{real:>10.0f} s{estimated / real:>8.2f}", flush=True)
    sys.exit(worst > TOLERANCE)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
