"""Sphere steps a second of discrete elements and of LAMMPS (gran/hooke/history, one core) on one
settled bed of 3456 spheres, in turns: python3 grains_against_lammps.py BENCH_GRAINS [ROUNDS]."""

import os
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

SPHERE_STEPS = 3456 * 4000  # of LAMMPS' run


def processor_seconds(command, folder):
    """Of the command alone: other programs on the machine do not count."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "OMP_NUM_THREADS": "1"})
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main():
    bench, rounds = pathlib.Path(sys.argv[1]).resolve(), int((sys.argv[2:] or ["3"])[0])
    lammps = shutil.which("lmp")
    ratios = {}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds):
            text = subprocess.run([bench, folder], check=True, text=True, capture_output=True).stdout
            print(text, end="")
            if not lammps:
                continue
            rate = SPHERE_STEPS / processor_seconds([lammps, "-in", "in.lammps", "-log", "none"],
                                                    folder) / 1e6
            print(f"{'LAMMPS, the same bed':<26} at rest {rate:6.2f}")
            for law, ours in re.findall(r"^(\S.*?) +at rest +([\d.]+)", text, re.MULTILINE):
                ratios.setdefault(law, []).append(float(ours) / rate)
    if not lammps:
        print("LAMMPS is not here: apt-get install lammps")
    for law, found in ratios.items():
        print(f"{law}: {statistics.median(found):.2f} times LAMMPS "
              f"({min(found):.2f} to {max(found):.2f})")


if __name__ == "__main__":
    main()
