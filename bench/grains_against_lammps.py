"""Sphere steps per second of discrete elements and of LAMMPS (gran/hooke/history, one core) on one
settled bed of 3456 spheres, at rest and thrown upwards, in turns; then two beds on two threads, and
beds of other numbers and of several sizes: python3 grains_against_lammps.py BENCH_GRAINS [ROUNDS]."""

import os
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

# LAMMPS' inputs and the steps of their runs.
RUNS = {"at rest": ("in.rest", 4000), "in flight": ("in.flight", 6000),
        "thrown": ("in.thrown", 16000)}
N_SPHERES = 3456


def processor_seconds(command, folder):
    """Time of the command alone: other programs on the machine do not count."""
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
            for how, (script, steps) in RUNS.items():
                seconds = processor_seconds([lammps, "-in", script, "-log", "none"], folder)
                rate = N_SPHERES * steps / seconds / 1e6
                print(f"{'LAMMPS, the same bed':<26} {how} {rate:6.2f}")
                for law, ours in re.findall(rf"^(\S.*?)  .*?{how} +([\d.]+)", text, re.MULTILINE):
                    ratios.setdefault((law, how), []).append(float(ours) / rate)
    if not lammps:
        print("LAMMPS is not here: apt-get install lammps")
    for (law, how), found in ratios.items():
        print(f"{law}, {how}: {statistics.median(found):.2f} times LAMMPS "
              f"({min(found):.2f} to {max(found):.2f}, {len(found)} turns)")
    for what in ("threads", "sizes", "mixtures"):
        print(subprocess.run([bench, what], check=True, text=True, capture_output=True).stdout,
              end="")


if __name__ == "__main__":
    main()
