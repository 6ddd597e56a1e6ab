#!/usr/bin/env python3
"""Counts instructions with callgrind: what an effect that is not used costs (nothing), and what one
that is used does. instruction_costs.py FOLDER [--all], FOLDER holding the programs cost_*.

Exits with 1 if a trial of a periodic scene, a tap of a realization that observes nothing, or a step
of grains without friction, walls or motion takes over 0.5 % more or less than in a program that
does nothing else, with 77 where there is no valgrind."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

TOLERANCE = 0.005
TRIALS = 200_000
CALLS = 10
SCENES = ["periodic", "walls", "cylinder", "periodic_metropolis", "periodic_metropolis_beta_1e6"]
TAPS = 5
STEPS = 300
GRAINS = 1024
EFFECTS = ["grains", "grains_friction", "grains_walls", "grains_moving_floor",
           "grains_driven_temperature"]
MEASUREMENTS = ["mean_height", "bottom_fraction", "corrected_fraction", "bulk_fraction",
                "coordination", "height_histogram", "voronoi_cells", "cells_and_pores"]


def instructions(command):
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", *command],
            capture_output=True, text=True, env={**os.environ, "JOSTLE_INSTRUCTION_SET": "avx2"})
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
    program = {name: os.path.join(folder, name) for name in
               ("cost_of_effect", "cost_of_grains", "cost_single_loop", "cost_plain_taps",
                "cost_plain_grains")}
    within = True
    for whole, alone, what, unit, count in (
            ("cost_of_effect", "cost_single_loop", "periodic", "trial", TRIALS),
            ("cost_of_effect", "cost_plain_taps", "taps", "tap", TAPS),
            ("cost_of_grains", "cost_plain_grains", "grains", "time step", STEPS)):
        full, single = (each([program[name], what], count) for name in (whole, alone))
        within = within and abs(full / single - 1) <= TOLERANCE
        print(f"instructions a {unit}: {full:.2f}; in a program that does nothing else: "
              f"{single:.2f}; difference {100 * (full / single - 1):+.3f} %")
    if "--all" in sys.argv:
        for scene in SCENES:
            cost = each([program["cost_of_effect"], scene], TRIALS)
            print(f"{scene:<30} {cost:8.1f} instructions a trial")
        for measurement in MEASUREMENTS:
            cost = each([program["cost_of_effect"], measurement], CALLS) / 512
            print(f"{measurement:<30} {cost:8.1f} instructions a sphere and measurement")
        for effect in EFFECTS:
            cost = each([program["cost_of_grains"], effect], STEPS) / GRAINS
            print(f"{effect:<30} {cost:8.1f} instructions a sphere step")
    sys.exit(0 if within else 1)


if __name__ == "__main__":
    main()
