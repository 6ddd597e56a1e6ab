"""Beds poured by discrete elements and by LAMMPS from the same columns, with the same law and step:
python3 pours_against_lammps.py JOSTLE FOLDER [--friction MU] [--pours N] [--spheres N] [--ratio R].
Both fall for the same time; what comes out is measured by the same lines below. Equal spheres by
LAMMPS' gran/hooke/history. With a ratio every other sphere is so many times as large, by its pair
style granular, whose dashpots are given for each pair of sizes so that all part with one
restitution.

LAMMPS takes some two minutes a pour of 3456 spheres. A pour that is in FOLDER is not made again."""
import argparse
import json
import math
import pathlib
import shutil
import subprocess
import sys

import h5py
import numpy as np
from scipy.spatial import cKDTree

WIDTH, COLUMN = 12.0, 0.2  # diameters; packing fraction of the columns
SECONDS = 1.6  # duration of fall and rest
DIAMETER, DENSITY, GRAVITY = 0.02, 1200.0, 9.81
STIFFNESS, RESTITUTION, STEPS_PER_CONTACT = 1e5, 0.9, 40
STANDARD_ERRORS = 3.0


class Law:
    """The linear law in reduced units (lengths in diameters, masses in sphere masses, gravity 1)."""

    def __init__(self):
        mass = DENSITY * math.pi / 6 * DIAMETER**3
        self.stiffness = STIFFNESS / (mass * GRAVITY / DIAMETER)
        self.loss = -math.log(RESTITUTION)
        self.unit_seconds = math.sqrt(DIAMETER / GRAVITY)
        # Half a period of the damped oscillation of two spheres, and of their tangential spring.
        damped = 0.5 * self.damping(0.5)
        normal = math.pi / math.sqrt(self.stiffness / 0.5 - damped**2)
        self.step = min(normal, math.pi * math.sqrt(0.5 / self.stiffness)) / STEPS_PER_CONTACT

    def damping(self, mass):
        """Rate for two bodies with this reduced mass: LAMMPS' gamma_n."""
        return 2 * self.loss * math.sqrt(self.stiffness / mass / (math.pi**2 + self.loss**2))

    def granular(self, mass, friction):
        """Damping of LAMMPS' granular styles: its eta is force over velocity."""
        return (f"hooke {self.stiffness!r} {mass * self.damping(mass)!r} damping velocity "
                f"tangential linear_history {2 / 7 * self.stiffness!r} 0.5 {friction!r}")

    def for_lammps(self, mass, friction):
        rate = self.damping(mass)
        return (f"{self.stiffness!r} {2 / 7 * self.stiffness!r} {rate!r} {0.5 * rate!r} "
                f"{friction!r} 1")


def diameters_of(n, ratio):
    """[n]: every other sphere is larger by the ratio."""
    return np.where(np.arange(n) % 2 == 1, ratio, 1.0)


def column(diameters, seed):
    """[n, 3]: random points, one by one, none nearer than two radii to another; large spheres first."""
    random = np.random.default_rng(seed)
    height = (diameters**3).sum() * math.pi / 6 / (COLUMN * WIDTH**2)
    across = int(WIDTH / diameters.max())
    side = WIDTH / across
    cells, centres = {}, np.empty((len(diameters), 3))
    for sphere in np.argsort(-diameters, kind="stable"):
        radius = diameters[sphere] / 2
        while True:
            point = random.uniform([0, 0, radius], [WIDTH, WIDTH, radius + height])
            place = np.floor(point / side).astype(int)
            around = [((place[0] + i) % across, (place[1] + j) % across, place[2] + k)
                      for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
            near = np.array([other for cell in around for other in cells.get(cell, [])], dtype=int)
            between = centres[near] - point
            between[:, :2] -= WIDTH * np.round(between[:, :2] / WIDTH)
            if ((between**2).sum(axis=1) >= (radius + diameters[near] / 2)**2).all():
                break
        centres[sphere] = point
        cells.setdefault(tuple(place), []).append(sphere)
    return centres


def by_jostle(jostle, folder, columns, diameters, friction):
    """[pour]: centres, velocities and spins at the end, in reduced units."""
    ratio = diameters.max()
    name = f"jostle-{len(columns)}x{len(columns[0])}-{friction:g}-{ratio:g}"
    sizes = ":diameter:R:1" if ratio != 1 else ""
    with open(folder / f"{name}.xyz", "w") as file:
        for centres in columns:
            file.write(f'{len(centres)}\nLattice="{WIDTH} 0 0 0 {WIDTH} 0 0 0 200" '
                       f'Properties=species:S:1:pos:R:3{sizes} pbc="T T F"\n')
            file.writelines(f"{'AB'[d > 1]} {x!r} {y!r} {z!r}{f' {d!r}' if sizes else ''}\n"
                            for (x, y, z), d in zip(centres.tolist(), diameters.tolist()))
    contact = {"stiffness": STIFFNESS, "restitution": RESTITUTION, "friction": friction}
    scene = {
        "seed": 1, "container": {"sides": "periodic", "width": WIDTH}, "spheres": len(columns[0]),
        "start": {"file": {"path": f"{name}.xyz", "frame": 0}}, "protocol": [],
        "engine": {"discrete_element": {
            "diameter": DIAMETER, "density": DENSITY, "gravity": GRAVITY,
            "contact": {"linear_spring_dashpot": contact}, "steps_per_contact": STEPS_PER_CONTACT,
            "rest": {"timed": {"seconds": SECONDS}}, "most_seconds": 2 * SECONDS}},
        "observe": ["mean_height"],
        "snapshots": {"taps": [0], "keep": ["positions", "velocities"]},
        "sweep": {"/start/file/frame": list(range(len(columns)))}}
    path, result = folder / f"{name}.json", folder / f"{name}.h5"
    path.write_text(json.dumps(scene))
    subprocess.run(["nice", "-n", "19", jostle, "run", path, "-o", result, "--resume", "--quiet"],
                   check=True)
    unit = Law().unit_seconds
    with h5py.File(result) as file:
        groups = [file[f"particles/point_{pour:04}_realization_00000"] for pour in range(len(columns))]
        return [(group["position/value"][-1], group["velocity/value"][-1] * unit,
                 group["spin/value"][-1] * unit) for group in groups]


def force_lines(ratio, friction):
    """LAMMPS' commands for the contacts of spheres and with the floor."""
    law = Law()
    if ratio == 1:
        return (f"pair_style gran/hooke/history {law.for_lammps(0.5, friction)}\npair_coeff * *\n",
                f"fix 3 all wall/gran hooke/history {law.for_lammps(1.0, friction)} zplane 0.0 NULL\n")
    masses = {1: 1.0, 2: ratio**3}
    pairs = [f"pair_coeff {i} {j} {law.granular(m * n / (m + n), friction)}\n"
             for i, m in masses.items() for j, n in masses.items() if i <= j]
    floor = [f"group kind{i} type {i}\nfix floor{i} kind{i} wall/gran granular {law.granular(m, friction)} "
             "zplane 0.0 NULL\n" for i, m in masses.items()]
    return "pair_style granular\n" + "".join(pairs), "".join(floor)


def by_lammps(lammps, folder, centres, diameters, friction, pour):
    """Measures one pour by LAMMPS."""
    law, n, ratio = Law(), len(centres), float(diameters.max())
    pairs, floor = force_lines(ratio, friction)
    name = f"lammps-{n}-{friction:g}-{ratio:g}-{pour}"
    result = folder / f"{name}.npy"
    if not result.exists():
        top = math.ceil(centres[:, 2].max()) + 5
        rows = [f"{i + 1} {1 + (d > 1)} {d!r} {6 / math.pi!r} {x!r} {y!r} {z!r}"
                for i, ((x, y, z), d) in enumerate(zip(centres.tolist(), diameters.tolist()))]
        (folder / f"{name}.data").write_text(
            f"a column\n\n{n} atoms\n{len(set(diameters))} atom types\n0 {WIDTH} xlo xhi\n0 {WIDTH} ylo yhi\n"
            f"0 {top} zlo zhi\n\nAtoms # sphere\n\n" + "\n".join(rows) + "\n")
        steps = round(SECONDS / law.unit_seconds / law.step)
        (folder / f"{name}.in").write_text(
            "units lj\natom_style sphere\nboundary p p f\nnewton off\ncomm_modify vel yes\n"
            f"read_data {name}.data\n"
            f"{pairs}neighbor 0.1 bin\nneigh_modify delay 0 every 1 check yes\nfix 1 all nve/sphere\n"
            f"fix 2 all gravity 1.0 vector 0 0 -1\n{floor}"
            f"timestep {law.step!r}\nthermo {steps}\nrun {steps}\n"
            f"write_dump all custom {name}.dump id x y z vx vy vz omegax omegay omegaz "
            "modify sort id format float %.17g\n")
        subprocess.run(["nice", "-n", "19", lammps, "-in", f"{name}.in", "-log", "none"], cwd=folder,
                       check=True, stdout=subprocess.DEVNULL)
        np.save(result, np.loadtxt(folder / f"{name}.dump", skiprows=9)[:, 1:])
    rows = np.load(result)
    return rows[:, :3], rows[:, 3:6], rows[:, 6:9]


def slab_share(centres, diameters, low, high):
    """Volume of the spheres between two heights / that of the slab."""
    def below(z):  # volume of each sphere below height z
        h = np.clip(z - centres[:, 2] + diameters / 2, 0, diameters)
        return math.pi * h**2 * (1.5 * diameters - h) / 3
    return float((below(high) - below(low)).sum() / (WIDTH**2 * (high - low)))


def measured(bed, diameters):
    """Compared quantities, by name. Energies are per mass of a sphere of diameter 1."""
    centres, velocities, spins = bed
    mass, radii = diameters**3, diameters / 2
    height = float((mass * centres[:, 2]).sum() / mass.sum())
    n, low, high = len(centres), 1.5, 2 * height - 3
    inside = centres.copy()
    inside[:, :2] %= WIDTH
    tree = cKDTree(inside, boxsize=[WIDTH, WIDTH, 1e3])
    pairs = tree.query_pairs(float(diameters.max()), output_type="ndarray")
    between = inside[pairs[:, 0]] - inside[pairs[:, 1]]
    between[:, :2] -= WIDTH * np.round(between[:, :2] / WIDTH)
    overlaps = radii[pairs].sum(axis=1) - np.linalg.norm(between, axis=1)
    pairs, overlaps = pairs[overlaps > 0], overlaps[overlaps > 0]
    on_floor = np.maximum(0, radii - centres[:, 2])
    moving = (mass * (velocities**2).sum(axis=1)).sum()
    turning = 0.4 * (mass * radii**2 * (spins**2).sum(axis=1)).sum()
    elastic = 0.5 * Law().stiffness * ((overlaps**2).sum() + (on_floor**2).sum()) / mass.sum()
    out = {"packing fraction from 1.5 d to 1.5 d below the top": slab_share(centres, diameters, low, high),
           "mean height (potential energy), d": height,
           "elastic energy of the normal springs, 1e-3 m g d a mass m": 1e3 * elastic,
           "contacts per sphere": (2 * len(pairs) + int((on_floor > 0).sum())) / n,
           "log10 of the kinetic energy a mass m, m g d":
               math.log10(0.5 * (moving + turning) / mass.sum())}
    if diameters.max() > 1:
        large = diameters > 1
        out["height of the large spheres less that of the small, d"] = float(
            centres[large, 2].mean() - centres[~large, 2].mean())
        alike = large[pairs].sum(axis=1)
        for both, name in ((0, "small"), (1, "unlike"), (2, "large")):
            out[f"contacts of two spheres, {name}, per sphere"] = float((alike == both).sum() / n)
    return out


def compared(ours, theirs):
    """The table, and whether all lie within STANDARD_ERRORS of each other."""
    print(f"{'':58}{'jostle':>20}{'LAMMPS':>20}   apart")
    agree = True
    for name in ours[0]:
        samples = [np.array([one[name] for one in beds]) for beds in (ours, theirs)]
        means = [sample.mean() for sample in samples]
        errors = [sample.std(ddof=1) / math.sqrt(sample.size) for sample in samples]
        apart = abs(means[0] - means[1]) / math.hypot(*errors)
        agree = agree and apart <= STANDARD_ERRORS
        print(f"{name:58}" + "".join(f"{f'{mean:.5f} +- {error:.5f}':>20}"
                                     for mean, error in zip(means, errors)) +
              f"   {apart:.1f} standard errors")
    return agree


def main():
    parser = argparse.ArgumentParser(prog="./dev bench pours", allow_abbrev=False)
    for path in ("jostle", "folder"):
        parser.add_argument(path, type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--friction", type=float, default=0.1, metavar="MU")
    parser.add_argument("--pours", type=int, default=5, metavar="N", help="at least 2")
    parser.add_argument("--spheres", type=int, default=3456, metavar="N", help="at least 1000")
    parser.add_argument("--ratio", type=float, default=1, metavar="R", help="1, or of two sizes: to 4")
    asked = parser.parse_args()
    if not 1 <= asked.ratio <= 4:
        parser.error("a ratio of 1 to 4")
    if asked.pours < 2 or asked.spheres < 1000:
        parser.error("at least 2 pours of at least 1000 spheres")
    lammps = shutil.which("lmp")
    if not lammps:
        print("skipped: LAMMPS is not here: apt-get install lammps")
        return
    asked.folder.mkdir(parents=True, exist_ok=True)
    diameters = diameters_of(asked.spheres, asked.ratio)
    columns = [column(diameters, pour) for pour in range(asked.pours)]
    ours = by_jostle(asked.jostle.resolve(), asked.folder, columns, diameters, asked.friction)
    theirs = [by_lammps(lammps, asked.folder, centres, diameters, asked.friction, pour)
              for pour, centres in enumerate(columns)]
    print(f"{asked.pours} pours of {asked.spheres} spheres, ratio {asked.ratio:g}, "
          f"linear_spring_dashpot, friction {asked.friction:g}, after {SECONDS:g} s; mean +- standard error")
    if not compared([measured(bed, diameters) for bed in ours],
                    [measured(bed, diameters) for bed in theirs]):
        sys.exit("they differ by more than three standard errors")


if __name__ == "__main__":
    main()
