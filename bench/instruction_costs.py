#!/usr/bin/env python3
"""Counts instructions with callgrind: what an effect that is not used costs (nothing), and what one
that is used does. instruction_costs.py FOLDER [--all], FOLDER holding the two programs.

Exits with 1 if a trial of a periodic scene takes over 0.5 % more or less than in a program that
holds that one loop, with 77 where there is no valgrind."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

TOLERANCE = 0.005
TRIALS = 200_000
CALLS = 50
SCENES = ["periodic", "walls", "cylinder", "periodic_metropolis", "periodic_metropolis_beta_1e6"]
OBSERVABLES = ["mean_height", "bottom_fraction", "corrected_fraction", "bulk_fraction"]


def instructions(command):
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", *command],
            capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{result.stderr}")
    return int(re.search(r"Collected : (\d+)", result.stderr).group(1))


def each(command, count):
    """Instructions of one more, beyond the first `count`: start and lists drop out."""
    few, many = (instructions([*command, str(k * count)]) for k in (1, 2))
    return (many - few) / count


def has_avx2():
    with open("/proc/cpuinfo", encoding="ascii") as file:
        return " avx2" in file.read()


def main():
    folder = sys.argv[1]
    if not shutil.which("valgrind") or not has_avx2():
        print("skipped: this needs valgrind and a machine with AVX2")
        sys.exit(77)
    effect = os.path.join(folder, "cost_of_effect")
    alone = each([os.path.join(folder, "cost_single_loop")], TRIALS)
    periodic = each([effect, "periodic"], TRIALS)
    print(f"instructions a trial, periodic sides: {periodic:.2f}; in a program with that loop "
          f"alone: {alone:.2f}; difference {100 * (periodic / alone - 1):+.3f} %")
    if "--all" in sys.argv:
        for scene in SCENES:
            print(f"{scene:<30} {each([effect, scene], TRIALS):8.1f} instructions a trial")
        for observable in OBSERVABLES:
            cost = each([effect, observable], CALLS) / 512
            print(f"{observable:<30} {cost:8.1f} instructions a sphere, once a tap")
    sys.exit(0 if abs(periodic / alone - 1) <= TOLERANCE else 1)


if __name__ == "__main__":
    main()
