#!/usr/bin/env python3
"""Prints the tables of docs/explanation/mixtures.md from the reduced data of tests/physics/reduced/mixtures-*.

mixtures.py. Errors are halves of 68 % intervals by Student's t over realizations."""
import collections
import functools
import re

import numpy as np
from scipy import optimize, stats

from reduce import REDUCED, read_table

RISEN = 0.5  # d


def series_of(run):
    """{point: {column: [realization, tap]}}, taps and labels of a run."""
    header, *rows = read_table(REDUCED / run / "series.csv")
    labels = {int(key.removeprefix("point ")): text for key, text in
              read_table(REDUCED / run / "origin.csv")[1:] if key.startswith("point ")}
    taps = sorted({int(row[2]) for row in rows})
    beds = collections.defaultdict(dict)
    for row in rows:
        bed = beds[int(row[0])].setdefault(int(row[1]), {name: {} for name in header[3:]})
        for name, value in zip(header[3:], row[3:]):
            bed[name][int(row[2])] = float(value)
    found = {point: {name: np.array([[bed[name][tap] for tap in taps] for bed in of_point.values()])
                     for name in header[3:]} for point, of_point in sorted(beds.items())}
    return found, taps, labels


def mean_of(values):
    """(mean, half of its 68 % interval, p of a mean of 0) over realizations."""
    values = np.asarray(values)
    if len(values) < 2 or values.std() == 0:
        return values.mean(), 0.0, float("nan")
    error = values.std(ddof=1) / np.sqrt(len(values))
    dof = len(values) - 1
    return values.mean(), stats.t.ppf(0.5 + 0.6827 / 2, dof) * error, 2 * stats.t.sf(abs(values.mean() / error), dof)


def text_of(values, digits=2):
    mean, half, _ = mean_of(values)
    return f"{mean:.{digits}f} ± {half:.{digits}f}" if len(values) > 1 else f"{mean:.{digits}f}"


def holm(ps):
    """p-values corrected for their number."""
    order = np.argsort(ps)
    corrected, least = np.empty(len(ps)), 0.0
    for rank, k in enumerate(order):
        least = max(least, min(1.0, (len(ps) - rank) * ps[k]))
        corrected[k] = least
    return corrected


def number(label, key):
    return float(re.search(rf"{key} = ([-0-9.e]+)", label)[1])


def rise():
    found, taps, labels = series_of("mixtures-rise")
    last = len(taps) - 1
    rows = []
    for point, columns in found.items():
        heights = columns["height_intruder"]
        gained = heights - heights[:, :1]
        rows.append((number(labels[point], "diameter"), number(labels[point], "eta"), gained))
    rows.sort(key=lambda row: (-row[1], row[0]))
    ps = holm([mean_of(gained[:, last])[2] for *_, gained in rows])
    print("| size ratio | eta | tap 10 | tap 50 | tap 100 | p | beds risen by 0.5 d |\n|---|---|---|---|---|---|---|")
    for (ratio, eta, gained), p in zip(rows, ps):
        at = [text_of(gained[:, taps.index(tap)]) for tap in (10, 50, 100)]
        print(f"| {ratio:g} | {eta:g} | " + " | ".join(at) +
              f" | {p:.2g} | {(gained[:, last] > RISEN).sum()} of {len(gained)} |")
    by_eta = collections.defaultdict(dict)
    for ratio, eta, gained in rows:
        by_eta[eta][ratio] = gained[:, last]
    print("\nrise at the smaller eta less that at the larger, in pairs, tap 100:")
    high, low = sorted(by_eta, reverse=True)
    for ratio in sorted(by_eta[high]):
        difference = by_eta[low][ratio] - by_eta[high][ratio]
        print(f"  {ratio:g}: {text_of(difference)}, p = {mean_of(difference)[2]:.2g}")


def composition():
    found, taps, labels = series_of("mixtures-composition")
    print("| small | large | share of the volume of small ones | fraction, poured | fraction, tap 20 | S, poured | "
          "S, tap 20 less poured |\n|---|---|---|---|---|---|---|")
    fractions = {}
    for point, columns in found.items():
        small, large = (int(number(labels[point], f"/spheres/{k}/count")) for k in (0, 1))
        share = small / (small + 8 * large)
        fractions[share], segregation = columns["bulk_fraction"], columns["segregation_large_small"]
        print(f"| {small} | {large} | {share:.2f} | {text_of(columns['bulk_fraction'][:, 0], 4)} | "
              f"{text_of(columns['bulk_fraction'][:, -1], 4)} | {text_of(segregation[:, 0])} | "
              f"{text_of(segregation[:, -1] - segregation[:, 0])} |")
    shares = sorted(fractions)
    for name, tap in (("poured", 0), (f"tap {taps[-1]}", -1)):
        best = max(shares, key=lambda share: fractions[share][:, tap].mean())
        for end in (shares[0], shares[-1]):
            difference = fractions[best][:, tap] - fractions[end][:, tap]
            print(f"{name}: densest at {best:.2f}, above {end:.2f} by {text_of(difference, 4)}, "
                  f"p = {mean_of(difference)[2]:.2g}")


def polydisperse():
    found, taps, labels = series_of("mixtures-polydisperse")
    print("| strength | equal | 10 % lognormal | equal less drawn | p |\n|---|---|---|---|---|")
    gains = collections.defaultdict(dict)
    for point, columns in found.items():
        gains["lognormal" in labels[point]][number(labels[point], "dilate")] = columns["bulk_fraction"]
    for strength in sorted(gains[False]):
        n = min(len(gains[is_drawn][strength]) for is_drawn in (False, True))
        equal, drawn = (gains[is_drawn][strength][:n, -1] for is_drawn in (False, True))
        print(f"| {strength:g} | {text_of(equal, 4)} | {text_of(drawn, 4)} | {text_of(equal - drawn, 4)} | "
              f"{mean_of(equal - drawn)[2]:.2g} |")
    for name, is_drawn in (("equal", False), ("drawn", True)):
        n = min(len(values) for values in gains[is_drawn].values())
        ends = {strength: values[:n, -1] for strength, values in gains[is_drawn].items()}
        best = max(ends, key=lambda strength: ends[strength].mean())
        for end in (min(ends), max(ends)):
            print(f"{name}: densest at {best:g}, above {end:g} by {text_of(ends[best] - ends[end], 4)}, "
                  f"p = {mean_of(ends[best] - ends[end])[2]:.2g}")
        print(f"{name}: poured at {text_of(gains[is_drawn][best][:, 0], 4)}")


def rise_of(run, swept):
    """A table of an intruder's rise at some taps, by the swept values."""
    found, taps, labels = series_of(run)
    shown = [tap for tap in (5, 10, 20, 100, 200, 400) if tap in taps]
    rows = [([number(labels[point], key) for key in swept], columns["height_intruder"] - columns["height_intruder"][:, :1])
            for point, columns in found.items()]
    ps = holm([mean_of(gained[:, -1])[2] for _, gained in rows])
    print("| " + " | ".join(swept + [f"tap {tap}" for tap in shown]) + " | p | beds risen by 0.5 d |\n" +
          "|---" * (len(swept) + len(shown) + 2) + "|")
    for (values, gained), p in zip(rows, ps):
        at = [text_of(gained[:, taps.index(tap)]) for tap in shown]
        tested = f"{p:.2g}" if len(gained) > 1 else "-"
        print("| " + " | ".join([f"{value:g}" for value in values] + at) +
              f" | {tested} | {(gained[:, -1] > RISEN).sum()} of {len(gained)} |")


def detectable(values, power=0.8):
    """The smallest mean that a t-test at 5 % finds with this power at the scatter of the values."""
    dof = len(values) - 1
    critical = stats.t.ppf(0.975, dof)

    def excess(shift):
        return stats.nct.sf(critical, dof, shift) + stats.nct.cdf(-critical, dof, shift) - power

    return optimize.brentq(excess, 0.5, 20) * np.std(values, ddof=1) / np.sqrt(len(values))


def rise_by_density(run):
    """A table of rises and, in pairs, their differences from that of an intruder of density 1."""
    rise_of(run, ["density"])
    found, taps, labels = series_of(run)
    gained = {number(labels[point], "density"): columns["height_intruder"] - columns["height_intruder"][:, :1]
              for point, columns in found.items()}
    for density, rises in sorted(gained.items()):
        mean, _, _ = mean_of(rises[:, -1])
        margin = stats.t.ppf(0.95, len(rises) - 1) * rises[:, -1].std(ddof=1) / np.sqrt(len(rises))
        print(f"density {density:g}: at most {rises[:, -1].max():.2f}, upper 95 % limit of the mean {mean + margin:.2f}")
    rows = [(tap, density, (rises - gained[1])[:, taps.index(tap)])
            for tap in (10, taps[-1]) for density, rises in sorted(gained.items()) if density != 1]
    ps = holm([mean_of(differences)[2] for *_, differences in rows])
    for (tap, density, differences), p in zip(rows, ps):
        print(f"tap {tap}: density {density:g} less 1, in pairs: {text_of(differences, 3)}, p = "
              f"{mean_of(differences)[2]:.2g}, by Holm's rule {p:.2g}, found with a power of 80 %: "
              f"{detectable(differences):.2g}")


RISES = {"mixtures-rise-long": ["diameter"], "mixtures-rise-grains": ["friction", "diameter"]}
DENSITIES = ["mixtures-rise-density", "mixtures-rise-grains-density"]


if __name__ == "__main__":
    tables = {"mixtures-rise": rise, **{run: functools.partial(rise_of, run, swept) for run, swept in RISES.items()},
              **{run: functools.partial(rise_by_density, run) for run in DENSITIES},
              "mixtures-composition": composition, "mixtures-polydisperse": polydisperse}
    for name, table in tables.items():
        print(f"\n## {name}\n")
        try:
            table()
        except FileNotFoundError as missing:
            print(f"no reduced data: {missing.filename}")
