#!/usr/bin/env python3
"""Runs the reduced scenes of the papers' figures and puts what came out into docs/physics-results.md.

figures.py JOSTLE FOLDER PAGE [FIGURE ...]: results are kept in FOLDER, and a finished one is not run
again. Sections of other figures stay as they are."""
import json
import pathlib
import re
import subprocess
import sys

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
PB, DR = "philippe-bideau-2001", "rosato-dybenko-2010"


class Run:
    """A finished run: its curves, [tap, realization] a sweep point."""

    def __init__(self, jostle, scene, folder):
        self.jostle = jostle
        self.path = folder / (scene.replace("/", "-") + ".h5")
        paper, figure = scene.split("/")
        self.scene = ROOT / "config" / "scenes" / paper / "reduced" / (figure + ".json")
        subprocess.run([jostle, "run", self.scene, "-o", self.path, "--resume", "--no-progress"],
                       check=True, stdout=subprocess.DEVNULL)
        self.file = h5py.File(self.path)
        self.labels = [label.decode() for label in self.file["sweep/label"][:]]
        self.seconds = sum(float(point["seconds"][:].sum())
                           for point in self.file["timing"].values())

    def curves(self, observable):
        return [self.file["observables"][point][observable][:]
                for point in sorted(self.file["observables"])]

    def values(self):
        """The swept number of each point."""
        return [float(re.search(r"([0-9.e-]+)}?$", label).group(1)) for label in self.labels]

    def fit(self, observable, model, point):
        """A fit of `jostle fit`, or nothing."""
        done = subprocess.run([self.jostle, "fit", self.path, "--observable", observable, "--model",
                               model, "--sweep-point", str(point), "--json"],
                              capture_output=True, text=True)
        fits = json.loads(done.stdout)["curves"][0]["fits"] if done.stdout else []
        return fits[0] if fits and "parameters" in fits[0] else None


def mean_and_error(values):
    values = np.asarray(values)
    return values.mean(), values.std(ddof=1) / np.sqrt(values.size)


def quoted(value, error, digits=4):
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def at(curve, tap):
    return quoted(*mean_and_error(curve[tap]))


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def last_taps(curve, n):
    """Mean over the last n taps of each realization, and over these its error."""
    return mean_and_error(curve[-n:].mean(axis=0))


def compaction(run):
    rows = []
    for point, (value, curve) in enumerate(zip(run.values(), run.curves("bottom_fraction"))):
        fit = run.fit("bottom_fraction", "inverse_log", point)
        found = fit["parameters"] if fit else {}
        rows.append([f"{value:g}"] + [at(curve, tap) for tap in (0, 10, 100, 500)] +
                    [found[name]["statement"] if fit else "no fit" for name in ("X_inf", "tau")])
    return table(["eps", "Phi_b, tap 0", "10", "100", "500", "X_inf of the inverse log", "its tau"],
                 rows)


def fluctuations(run):
    n, rows, points = 500, [], []
    for value, curve in zip(run.values(), run.curves("mean_height")):
        sigma = mean_and_error(curve[-n:].std(axis=0))
        drift = mean_and_error(curve[-n // 2:].mean(axis=0) - curve[-n:-n // 2].mean(axis=0))
        points.append((np.sqrt(value), sigma[0]))
        rows.append([f"{np.sqrt(value):.3f}", quoted(*sigma), quoted(*drift)])
    slope, offset = np.polyfit(*zip(*points), 1)
    return (table(["eps^(1/2)", f"sigma_Z over the last {n} taps",
                   "drift of <Z> between its halves"], rows) +
            f"\n\nStraight line through sigma_Z: {slope:.3f} eps^(1/2) {offset:+.4f}.")


def bell(run):
    n, rows = 100, []
    for value, curve in zip(run.values(), run.curves("corrected_fraction")):
        earlier = mean_and_error(curve[-2 * n:-n].mean(axis=0))
        rows.append([f"{np.sqrt(value):.3f}", at(curve, 1), quoted(*earlier),
                     quoted(*last_taps(curve, n))])
    return table(["eps^(1/2)", "Phi_c after tap 1", "mean of taps 201 to 300", "301 to 400"], rows)


def hysteresis(run):
    count, n = 130, 40
    up = [0.05 * k for k in range(1, 9)]
    strengths = up + up[-2::-1] + up[1:]
    curve = run.curves("corrected_fraction")[0]
    found = {}
    for k, strength in enumerate(strengths):
        branch = "up" if k < 8 else "down" if k < 15 else "up again"
        last = curve[1 + k * count:1 + (k + 1) * count][-n:]
        found[branch, round(strength, 3)] = mean_and_error(last.mean(axis=0))
    rows = []
    for strength in up:
        key = round(strength, 3)
        rows.append([f"{strength:.2f}"] + [quoted(*found[branch, key]) if (branch, key) in found
                                           else "" for branch in ("up", "down", "up again")])
    return table(["eps^(1/2)", "Phi_c, up", "down", "up again"], rows)


def ageing(run):
    height = run.curves("mean_height")[0]
    lags, rows = (1, 10, 30, 100, 200), []
    for age in (3, 10, 30, 100):
        row = [str(age)]
        for lag in lags:
            value, error = mean_and_error((height[age + lag] - height[age]) ** 2)
            row.append(f"{1e4 * value:.2f} ± {1e4 * error:.2f}")
        rows.append(row)
    return table(["t_W"] + [f"10^4 A, lag {lag}" for lag in lags], rows)


def against_taps(taps):
    def write(run):
        rows = [[label.replace("|", "")] + [at(curve, tap) for tap in taps]
                for label, curve in zip(run.labels, run.curves("bulk_fraction"))]
        return table(["point"] + [f"Phi, tap {taps[0]}"] + [str(tap) for tap in taps[1:]], rows)
    return write


# What a figure's section says besides its numbers: what the paper shows, and what came of it.
FIGURES = {
    "pb2": (f"{PB}/fig2", compaction,
            "Phi_b grows as the inverse log, slower for smaller eps; at small eps tau rises "
            "spectacularly and X_inf may exceed 0.64."),
    "pb3": (f"{PB}/fig3", fluctuations, "sigma_Z of the steady state is linear in eps^(1/2)."),
    "pb4-bell": (f"{PB}/fig4-bell", bell,
                 "A bell with its maximum at eps^(1/2) between 0.1 and 0.2."),
    "pb4-hysteresis": (f"{PB}/fig4-hysteresis", hysteresis,
                       "Above eps^(1/2) of about 0.15 the way down is a reversible branch of higher "
                       "Phi, on which Phi_c falls with eps^(1/2); below it is frozen."),
    "pb5": (f"{PB}/fig5", ageing, "A(t, t_W) falls with the age t_W at equal lag t, and collapses."),
    "dr2": (f"{DR}/fig2", against_taps((0, 1, 10, 30, 100, 200, 350)),
            "The lift of 0.25 densifies much faster than the held dilation by 1.025, which gives "
            "little or nothing."),
    "dr4": (f"{DR}/fig4", against_taps((0, 1, 10, 50, 100, 250, 400)),
            "Phi grows as KWW, and most at an intermediate lift, near 0.25 to 0.3."),
    "dr5": (f"{DR}/fig5", against_taps((0, 10, 60, 200, 500)),
            "From a crystal Phi falls within 60 taps and flattens; its final value is largest at "
            "about the same lift as from a poured bed."),
}

HEAD = """# What the papers' figures become here

Made by `./dev physics [FIGURE ...]` from scenes of reduced size ([config/scenes/](../config/scenes/)*/reduced); each scene's description says what was reduced and what that biases, and the scene of full size stands beside it: `jostle check` tells its core-hours. Errors are standard errors over realizations.
"""


def remark_of(page, figure):
    """What a person wrote below the numbers, kept when the numbers are made again."""
    found = re.search(rf"## {re.escape(figure)}\n.*?\n\*\*Outcome\*\*: (.*?)(?=\n## |\Z)", page, re.S)
    return found.group(1).strip() if found else "not judged yet."


def section(figure, run, page):
    _, write, claim = FIGURES[figure]
    description = json.loads(run.scene.read_text())["description"]
    return "\n\n".join([
        f"## {figure}", f"`./dev physics {figure}`, {run.seconds / 60:.0f} core-minutes. " +
        " ".join(description), f"**The paper**: {claim}", write(run),
        f"**Outcome**: {remark_of(page, figure)}"]) + "\n"


def main(jostle, folder, page, figures):
    unknown = [figure for figure in figures if figure not in FIGURES]
    if unknown:
        sys.exit(f"{unknown[0]}: no such figure; there are {', '.join(FIGURES)}")
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    page = pathlib.Path(page)
    text = page.read_text() if page.exists() else ""
    sections = {part.split("\n", 1)[0]: "## " + part for part in re.split(r"^## ", text, flags=re.M)[1:]}
    for figure in figures or FIGURES:
        print(f"{figure} ...", flush=True)
        sections[figure] = section(figure, Run(jostle, FIGURES[figure][0], folder), text)
        print(sections[figure], flush=True)
        ordered = [sections[name].strip() for name in FIGURES if name in sections]
        page.write_text("\n\n".join([HEAD.strip()] + ordered) + "\n")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:])
