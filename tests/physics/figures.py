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

from page_text import at, mean_and_error, quoted, table
from structure_figures import contacts, layers, pore_sizes, profiles, void_probability

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

    def table(self, name):
        """An analysis that the scene asks for."""
        return self.file["analysis/" + name]

    def parameters(self, observable, law, point, names):
        """What the data say of the parameters of a law that the scene fits."""
        fit = self.file[f"fits/point_{point:04}/{observable}/{law}"]
        if "statement" not in fit:
            return ["no fit"] * len(names)
        statements = dict(zip((name.decode() for name in fit["parameter"][:]),
                              (text.decode() for text in fit["statement"][:])))
        return [re.sub(r"^\S+ (is|was) ", "", statements[name]) for name in names]


def of(found, name, digits=4):
    """A single value of an analysis with its error."""
    return quoted(found[name][()], found[name + "_error"][()], digits)


def last_taps(curve, n):
    """Mean over the last n taps of each realization, and over these its error."""
    return mean_and_error(curve[-n:].mean(axis=0))


def compaction(run):
    rows = []
    for point, (value, curve) in enumerate(zip(run.values(), run.curves("bottom_fraction"))):
        rows.append([f"{value:g}"] + [at(curve, tap) for tap in (0, 10, 100, 1000)] +
                    run.parameters("bottom_fraction", "inverse_log", point, ("X_inf", "tau")))
    return table(["eps", "Phi_b, tap 0", "10", "100", "1000", "X_inf of the inverse log", "its tau"],
                 rows)


def fluctuations(run):
    rows = []
    for point, value in enumerate(run.values()):
        steady, spectrum = (run.table(f"point_{point:04}/{kind}/mean_height")
                            for kind in ("steady", "spectrum"))
        rows.append([f"{np.sqrt(value):.3f}", of(steady, "sigma"),
                     of(steady, "autocorrelation_time", 1), of(spectrum, "slope", 2),
                     steady.attrs["note_verdict"]])
    line = run.table("sweep/mean_height/steady_sigma")
    return (table(["eps^(1/2)", "sigma_Z", "autocorrelation time, taps", "slope of the spectrum",
                   "steady state"], rows) +
            f"\n\nStraight line through sigma_Z: slope {of(line, 'line_slope')}, at eps = 0 "
            f"{of(line, 'line_intercept')}; reduced chi2 {line['line_reduced_chi2'][()]:.1f}.")


def maximum(curve, symbol, text):
    said = f"\n\nMaximum: {curve.attrs['note_maximum']}"
    if not np.isfinite(curve["maximum_at_error"][()]):
        return said + "."
    return said + (f"; at {symbol} = {of(curve, 'maximum_at', 3)}, "
                   f"{text} = {of(curve, 'maximum')}.")


def bell(run):
    rows = []
    for value, curve in zip(run.values(), run.curves("corrected_fraction")):
        means = [quoted(*mean_and_error(curve[last - 99:last + 1].mean(axis=0)))
                 for last in (400, 700, 1000)]
        rows.append([f"{np.sqrt(value):.3f}", at(curve, 1)] + means)
    return (table(["eps^(1/2)", "Phi_c after tap 1", "mean of taps 301 to 400", "601 to 700",
                   "901 to 1000"], rows) +
            maximum(run.table("sweep/corrected_fraction/value"), "eps^(1/2)", "Phi_c"))


def hysteresis(run):
    found = run.table("point_0000/hysteresis/corrected_fraction")
    names = ("up", "down", "up again")
    values = {(round(strength, 3), names[branch]): quoted(value, error)
              for strength, branch, value, error in
              zip(found["sqrt_epsilon"][:], found["branch"][:], found["corrected_fraction"][:],
                  found["corrected_fraction_error"][:])}
    rows = [[f"{strength:.2f}"] + [values.get((strength, name), "") for name in names]
            for strength in sorted({key[0] for key in values})]
    areas = [f"{names[later]} less {names[earlier]} {1e3 * area:.2f} ± {1e3 * error:.2f}"
             for earlier, later, area, error in
             zip(found["earlier_branch"][:], found["later_branch"][:], found["area"][:],
                 found["area_error"][:])]
    return (table(["eps^(1/2)"] + [f"Phi_c, {name}" for name in names], rows) +
            "\n\nAreas between branches, 10^-3: " + "; ".join(areas) + ".")


def interval(found, name, i, unit):
    """A value with its 95 % interval, where there is one."""
    value, low, high = (unit * found[name + end][i] for end in ("", "_low_95", "_high_95"))
    return f"{value:.3g}" + (f" ({low:.2g} to {high:.2g})" if np.isfinite(low) else "")


def ageing(run):
    found = run.table("point_0000/ageing/mean_height")
    ages, lags = found["waiting_time"][:], found["lag"][:]
    shown = [1, 10, 31, 96, 306]
    rows = []
    for i, age in enumerate(ages):
        row = [str(age)]
        for lag in shown:
            j = int(np.argmin(np.abs(lags - lag)))
            row.append(interval(found, "a", (i, j), 1e4))
        shared = [interval(found, "shared_a_inf", i, 1e4), interval(found, "shared_tau", i, 1)]
        known = np.isfinite(found["shared_tau"][i])
        rows.append(row + (shared if known else ["-", "-"]) + [f"{found['misfit'][i]:.2f}"])
    header = ["t_W"] + [f"10^4 A, lag {lags[int(np.argmin(np.abs(lags - lag)))]}" for lag in shown]
    notes = {name: found.attrs[f"note_{name}_verdict"] for name in ("ageing", "collapse")}
    return (table(header + ["10^4 A_inf, common B", "tau", "misfit of its own fit"], rows) +
            f"\n\nAgeing: {notes['ageing']}. Collapse: {notes['collapse']}. Relative difference "
            f"between ages: {found['unscaled_collapse_relative'][()]:.2f} as measured, "
            f"{found['collapse_relative'][()]:.2f} for A/A_inf against t/tau. Of the fit with a "
            f"common B: {found['shared_verdict'][0].decode()}.")


def against_taps(taps, law=None):
    """Phi at some taps; with a law its parameters, and the maximum over the sweep."""
    def write(run):
        rows = [[label.replace("|", "")] + [at(curve, tap) for tap in taps]
                for label, curve in zip(run.labels, run.curves("bulk_fraction"))]
        header = ["point", f"Phi, tap {taps[0]}"] + [str(tap) for tap in taps[1:]]
        if law:
            names = ("rho_inf", "tau", "beta")
            header += [f"{law}: {name}" for name in names]
            for point, row in enumerate(rows):
                row += run.parameters("bulk_fraction", law, point, names)
        text = table(header, rows)
        if "analysis/sweep/bulk_fraction/value" in run.file:
            text += maximum(run.table("sweep/bulk_fraction/value"), "lift", "Phi")
        return text
    return write


# What a figure's section says besides its numbers: what the paper shows, and what came of it.
FIGURES = {
    "pb2": (f"{PB}/fig2", compaction,
            "Phi_b grows as the inverse log, slower for smaller eps; at small eps tau rises "
            "spectacularly and X_inf may exceed 0.64."),
    "pb3": (f"{PB}/fig3", fluctuations,
            "The spectrum of <Z> falls as f^-s with s between 1 and 1.5; sigma_Z of the steady "
            "state is linear in eps^(1/2)."),
    "pb4-bell": (f"{PB}/fig4-bell", bell,
                 "A bell with its maximum at eps^(1/2) between 0.1 and 0.2."),
    "pb4-hysteresis": (f"{PB}/fig4-hysteresis", hysteresis,
                       "Above eps^(1/2) of about 0.15 the way down is a reversible branch of higher "
                       "Phi, on which Phi_c falls with eps^(1/2); below it is frozen."),
    "pb5": (f"{PB}/fig5", ageing, "A(t, t_W) falls with the age t_W at equal lag t, and collapses."),
    "pb6-8": (f"{PB}/fig6-8", profiles,
              "Peaks at the floor, a density that falls upward as eq. 7, three layers at the walls; "
              "alpha is bell-shaped in eps^(1/2); Phi grows less in the centre than near the walls, "
              "which jump at the first tap."),
    "pb6-8-periodic": (f"{PB}/fig6-8-periodic", profiles,
                       "With periodic sides Phi is larger, grows less, and has no peaks at the "
                       "sides."),
    "pb9": (f"{PB}/fig9", void_probability,
            "From Phi = 58.4 % to 60.6 % P0 hardly changes, and is near Gotoh's."),
    "pb10": (f"{PB}/fig10", pore_sizes,
             "The tail of large pores shrinks and is exponential, small pores hardly change; nu "
             "moves as Phi_c does, v0 follows nu. Table I is Bernal's, from models built by hand."),
    "dr2": (f"{DR}/fig2", against_taps((0, 1, 10, 30, 100, 200, 350)),
            "The lift of 0.25 densifies much faster than the held dilation by 1.025, which gives "
            "little or nothing."),
    "dr3": (f"{DR}/fig6", contacts, "N_c rises with Phi."),
    "dr4": (f"{DR}/fig4", against_taps((0, 1, 10, 50, 100, 250, 400), "kww"),
            "Phi grows as KWW, and most at an intermediate lift, near 0.25 to 0.3."),
    "dr5": (f"{DR}/fig5", against_taps((0, 10, 60, 200, 500)),
            "From a crystal Phi falls within 60 taps and flattens; its final value is largest at "
            "about the same lift as from a poured bed."),
    "dr6": (f"{DR}/fig6", layers,
            "<rho> = 0.567, 0.578, 0.597 and 0.654 after 0, 50, 250 and 90 000 taps; layers grow "
            "upwards from the floor."),
}

HEAD = """# What the papers' figures become here

Made by `./dev physics [FIGURE ...]` from scenes of reduced size ([config/scenes/](../config/scenes/)*/reduced); each scene's description says what was reduced and what that biases, and the scene of full size stands beside it: `jostle check` tells its core-hours. Errors are standard errors over realizations.
"""


OUTDATED = "(Of earlier numbers.) "


def remark_of(page, figure, numbers):
    """What a person wrote below the numbers, kept when they are made again, and marked if they
    are not the same any more."""
    found = re.search(rf"## {re.escape(figure)}\n(.*?)\n\*\*Outcome\*\*: (.*?)(?=\n## |\Z)", page, re.S)
    if not found:
        return "not judged yet."
    remark = found.group(2).strip()
    same = numbers in found.group(1) or remark.startswith(OUTDATED)
    return remark if same else OUTDATED + remark


def section(figure, run, page):
    _, write, claim = FIGURES[figure]
    description = json.loads(run.scene.read_text())["description"]
    numbers = write(run)
    return "\n\n".join([
        f"## {figure}", f"`./dev physics {figure}`, {run.seconds / 60:.0f} core-minutes. " +
        " ".join(description), f"**The paper**: {claim}", numbers,
        f"**Outcome**: {remark_of(page, figure, numbers)}"]) + "\n"


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
