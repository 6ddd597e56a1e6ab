"""Figures 7 to 15 of Rosato et al.: discrete elements."""
import dataclasses
import re

import numpy as np

from lift_figures import as_printed
from page_text import at, table, window
from verdicts import (Estimate, are_positive, is_positive, is_within, of_interval, undecided)

POURED, RANGE = 0.6088, 0.0035  # at a friction of 0.1, "in the range"
BEST_GAIN, DENSEST = 0.055, 0.665  # limits of "about 5 %" and "about 0.66"
LAYERS = 6  # the lowest, that are shown
WINDOWS = ("bulk_fraction", "mid_heights", "low_heights")


def neighbours(run, point):
    """(least, greatest) of mean and width of the normal law, 95 %; the two numbers."""
    found = run.ensemble_structure("coordination", point)
    return [(found[f"normal_{name}_low_95"][0], found[f"normal_{name}_high_95"][0],
             found[f"normal_{name}"][0]) for name in ("mean", "width")]


def poured(run):
    frictions = run.values()
    phi, contacts = run.curves("bulk_fraction"), run.curves("contacts")
    rows = []
    for point, friction in enumerate(frictions):
        mean, width = neighbours(run, point)
        free = run.ensemble_structure("voronoi", point)
        rows.append([f"{friction:g}", at(phi[point], 0), at(run.curves("mid_heights")[point], 0),
                     at(contacts[point], 0, 3), f"{mean[2]:.3f}", f"{width[2]:.3f}",
                     f"{free['mean_free_volume'][0]:.4f}", f"{free['sigma_free_volume'][0]:.4f}"])
    tenth = frictions.index(0.1)
    mean, width = neighbours(run, tenth)
    statements = [
        are_positive("Phi falls with friction", [Estimate.of(phi[i][0] - phi[i + 1][0])
                                                 for i in range(len(phi) - 1)],
                     f"its falls from each of {', '.join(f'{mu:g}' for mu in frictions)} to the "
                     "next: ", name="paired t-tests"),
        as_printed("without friction 0.6366 +- 0.0005, as random packings have",
                   Estimate.of(phi[0][0]), 0.6366, 0.0005, 0.00005),
        is_within(f"{POURED} +- {RANGE} at a friction of 0.1", Estimate.of(
            phi[tenth][0] - POURED), RANGE, f"{at(phi[tenth], 0)}; from it "),
        of_interval("nearest neighbours at 0.1, cut at 1.05 d: mean 7.2713 +- 0.0558", *mean[:2],
                    between=(7.2713 - 0.0558, 7.2713 + 0.0558), found="mean within 1.05 d"),
        of_interval("nearest neighbours at 0.1, cut at 1.05 d: width 1.2550 +- 0.0262", *width[:2],
                    between=(1.2550 - 0.0262, 1.2550 + 0.0262), found="width within 1.05 d")]
    first = table(["friction", "Phi, the middle 60 % of the spheres", "Phi, 5 to 15 d",
                   "contacts per sphere", "neighbours within 1.05 d: mean", "width",
                   "free volume, sphere volumes: mean", "sigma"], rows)
    return "\n\n".join([first] + [
        distributions(run, part, axis, quantity, title, places)
        for part, axis, quantity, title, places in (
            ("coordination", "neighbours", "neighbour_share",
             "share of the spheres with neighbours within 1.05 d", range(3, 13)),
            ("voronoi", "free_volume", "free_volume_density",
             "density of the free volume, sphere volumes",
             [0.35 + 0.06 * k for k in range(11)]))]), statements


def distributions(run, part, axis, quantity, title, places):
    """Figs. 8 and 9, one line a friction."""
    rows = []
    for point, friction in enumerate(run.values()):
        found = run.ensemble_structure(part, point)
        cells = []
        for place in places:
            i = int(np.argmin(np.abs(found[axis] - place)))
            # The axis ends at the last place that holds anything.
            cells.append("0" if place > found[axis][i] + 0.5 else Estimate(
                float(found[quantity][0][i]), float(found[quantity + "_error"][0][i]),
                run.realizations - 1).text(4 if part == "coordination" else 2))
        rows.append([f"friction {friction:g}"] + cells)
    return table([title] + [f"{place:g}" for place in places], rows)


def columns(run):
    zipped = run.scene["sweep"]["zip"]
    stiffness, column = (next(values for pointer, values in zipped.items() if name in pointer)
                         for name in ("stiffness", "dilute_fraction"))
    curves = [run.curves(name) for name in WINDOWS]
    rows, statements = [], []
    for i, (k1, fraction) in enumerate(zip(stiffness, column)):
        rows.append([f"{k1:g}", f"{fraction:g}"] + [at(curve[i], 0) for curve in curves])
        statements.append(is_within(
            f"{POURED} +- {RANGE} at a friction of 0.1; K1 = {k1:g} N/m, column {fraction:g}",
            Estimate.of(curves[0][i][0] - POURED), RANGE, f"{at(curves[0][i], 0)}; from it "))
    return table(["K1, N/m", "column", "Phi, the middle 60 % of the spheres", "Phi, 5 to 15 d",
                  "Phi, 0 to 15 d"], rows), statements


def tapped(run):
    strong, weak = run.curves("bulk_fraction")
    last = len(strong) - 1
    shown = [tap for tap in (0, 1, 10, 25, 50, 100, 150, 200) if tap <= last]
    rows = [[f"Gamma = {gamma}"] + [at(curve, tap) for tap in shown]
            for gamma, curve in (("2", strong), ("0.5", weak))]
    rows += [[f"Gamma = 2, realization {m}"] + [f"{strong[tap, m]:.4f}" for tap in shown]
             for m in range(strong.shape[1])]
    end = max(last - 19, 0), last
    gains = [window(curve, *end) - curve[0] for curve in (strong, weak)]
    grown = [run.ensemble_structure("layers", point) for point in (0, 1)]
    taps = [int(tap) for tap in grown[0]["tap"]]

    def layers_at(point, k):
        return Estimate(float(grown[point]["grown_layers"][k]),
                        float(grown[point]["grown_layers_error"][k]), run.realizations - 1)
    found = [run.structure(["layers", "profile"], point) for point in (0, 1)]
    packings = [[parts["layers"] for parts in of_point] for of_point in found]

    def added(point, name):
        """Since tap 0; shares are summed over the layers of the table."""
        def at_frame(layers, k):
            values = layers[name][k]
            return values if name == "grown_layers" else values[:LAYERS].sum()
        return Estimate.of([at_frame(layers, -1) - at_frame(layers, 0)
                            for layers in packings[point]])

    def by_height(part, name, width, total, places):
        """Figs. 12 to 14: bins of `width`, each the mean or the sum of the table's, at taps."""
        rows = []
        for point, gamma, tap in ((0, 2, 0), (0, 2, 50), (0, 2, 100), (0, 2, taps[-1]),
                                  (1, 0.5, taps[-1])):
            if tap not in taps:
                continue
            cells = []
            for z in places:
                values = []
                for parts in found[point]:
                    inside = np.abs(np.array(parts[part]["height"]) - z) < 0.5 * width
                    bins = parts[part][name][taps.index(tap)][inside]
                    values.append(bins.sum() if total else bins.mean())
                cells.append(Estimate.of(values).text(3))
            rows.append([f"Gamma = {gamma}, tap {tap}"] + cells)
        return rows
    columns = [k + 0.5 for k in range(18)], [0.5 + 0.2 * k for k in range(19)]
    profiles = [
        table(["Phi(z), z ="] + [f"{z:g}" for z in columns[0]],
              by_height("profile", "phi", 1, False, columns[0])),
        table(["n(z), share of the centres in 0.2 d, z ="] + [f"{z:.1f}" for z in columns[1]],
              by_height("layers", "n", 0.2, True, columns[1]))]
    layer_rows = [[f"Gamma = {gamma}, tap {taps[k]}", layers_at(point, k).text(2)] +
                  [f"{grown[point]['share'][k, layer]:.2f}" for layer in range(LAYERS)]
                  for point, gamma in ((0, "2"), (1, "0.5")) for k in range(len(taps))]
    statements = [
        is_within("Phi = 0.609 at the start (0.0035)", Estimate.of(strong[0] - 0.609), RANGE,
                  f"{at(strong, 0)}; from it "),
        is_positive("Phi grows at Gamma = 2", Estimate.of(gains[0]),
                    f"taps {end[0]} to {end[1]} less tap 0: "),
        is_positive("almost nothing at Gamma = 0.5: less than a tenth of that",
                    Estimate.of(0.1 * gains[0] - gains[1]),
                    f"{Estimate.of(gains[1]).text()}; a tenth of the gain at 2 less it: ",
                    name="paired t-test"),
        at_the_end(strong, 898),
        is_positive("layers grow from the floor at Gamma = 2", added(0, "grown_layers"),
                    f"grown layers at tap {taps[-1]} less tap 0: ", digits=2,
                    name="paired t-test"),
        is_within("no order at Gamma = 0.5 (less than half a layer)", added(1, "share"), 0.5,
                  f"shares of layers 1 to {LAYERS}, summed, at tap {taps[-1]} less tap 0: ", 2)]
    return "\n\n".join([table(["Phi, tap"] + [str(tap) for tap in shown], rows),
                        table(["", "grown layers"] + [f"share, layer {layer + 1}"
                                                      for layer in range(LAYERS)], layer_rows)] +
                       profiles), \
        statements


def at_the_end(strong, taps):
    name, last = f"Phi = 0.6997 +- 0.0058 at Gamma = 2 after {taps} taps", len(strong) - 1
    if last < taps:
        return undecided(name, f"{at(strong, last)} after {last}", "too few taps")
    return is_within(name, Estimate.of(strong[taps] - 0.6997), 0.0058,
                     f"{at(strong, taps)}; from it ")


ENGINES = ("Monte Carlo", "grains, friction 0", "grains, friction 0.1")
TAPPED = ("lift 0.25", "held dilation 1.025")


def both_engines(run):
    """Every tap by every engine, from the same pours."""
    shape = len(TAPPED), len(ENGINES)
    phi = np.array(run.curves("bulk_fraction")).reshape(*shape, -1, run.realizations)
    taps = run.scene["snapshots"]["taps"]
    kept = [run.structure(["layers", "pores"], point) for point in range(np.prod(shape))]

    def of(part, name):
        """[tap, engine, kept tap, realization]"""
        return np.array([[packing[part][name] for packing in point] for point in kept]).reshape(
            *shape, run.realizations, len(taps)).swapaxes(2, 3)
    layers, nu, v0 = of("layers", "grown_layers"), of("pores", "nu"), of("pores", "tail_v0")
    blocks = [("Phi, heights 1.5 to 7.5 d", phi[:, :, taps], 4), ("grown layers", layers, 2),
              ("nu, sphere volumes", nu, 4), ("v0, sphere volumes", v0, 4)]
    tables = [table([f"{name}, tap"] + [str(tap) for tap in taps],
                    [[f"{tap}, {engine}"] + [Estimate.of(values[i, k, j]).text(digits)
                                             for j in range(len(taps))]
                     for i, tap in enumerate(TAPPED) for k, engine in enumerate(ENGINES)])
              for name, values, digits in blocks]
    first, last = taps.index(1), len(taps) - 1
    statements = []
    for i, tap in enumerate(TAPPED):
        for k, engine in enumerate(ENGINES):
            statements += [
                is_positive(f"{tap}, {engine}: Phi grows from tap 1 to {taps[-1]} (ours)",
                            Estimate.of(phi[i, k, taps[-1]] - phi[i, k, 1]), "gain: "),
                is_positive(f"{tap}, {engine}: pores shrink (ours)",
                            Estimate.of(nu[i, k, first] - nu[i, k, last]), "fall of nu: ")]
        statements += [
            is_positive(f"{tap}: grains without friction end denser than Monte Carlo (ours)",
                        Estimate.of(phi[i, 1, taps[-1]] - phi[i, 0, taps[-1]]),
                        "difference: ", name="paired t-test"),
            is_within(f"{tap}: as many layers by Monte Carlo as by grains with friction, within "
                      "half of one (ours)", Estimate.of(layers[i, 0, last] - layers[i, 2, last]),
                      0.5, "difference: ", 2)]
    return "\n\n".join(tables), statements


def none_above(paper, estimates, most, found):
    """No number lies above `most`: shown where the test of each shows it."""
    room = [Estimate(most - one.value, one.error, one.dof) for one in estimates]
    return dataclasses.replace(are_positive(paper, room, ""), found=found)


def shaken(run):
    settings = [tuple(float(re.search(rf"{name} = ([0-9.e-]+)", label)[1])
                      for name in ("amplitude", "frequency")) for label in run.labels]
    phi = [(curve[0], curve[1]) for curve in run.curves("bulk_fraction")]
    gains = [Estimate.of(after / before - 1) for before, after in phi]
    ends = [Estimate.of(after) for _, after in phi]
    grown = [run.ensemble_structure("layers", point)["grown_layers"][-1]
             for point in range(len(settings))]
    amplitudes, frequencies = (sorted(set(values)) for values in zip(*settings))

    def map_of(title, texts):
        texts = dict(zip(settings, texts))
        return table([title] + [f"{f:g} Hz" for f in frequencies],
                     [[f"a/d = {a:g}"] + [texts[a, f] for f in frequencies] for a in amplitudes])
    gamma = [a * run.scene["engine"]["discrete_element"].get("diameter", 0.02) *
             (2 * np.pi * f)**2 / 9.81 for a, f in settings]
    best = max(range(len(settings)), key=lambda point: gains[point].value)
    densest = max(range(len(settings)), key=lambda point: ends[point].value)

    def where(point):
        return "at a/d = {:g}, f = {:g} Hz".format(*settings[point])
    statements = [
        none_above("the improvement is at most about 5 % (5.5 %)", gains, BEST_GAIN,
                   f"the greatest of {len(settings)} settings, {where(best)}: "
                   f"{gains[best].text(1, 100)} %"),
        none_above("no packing fraction above about 0.66 (0.665)", ends, DENSEST,
                   f"the densest of {len(settings)} settings, {where(densest)}: "
                   f"{ends[densest].text()}; the densest single bed "
                   f"{max(after.max() for _, after in phi):.4f}")]
    return "\n\n".join([
        f"The beds are poured to {Estimate.of(phi[0][0]).text()}.",
        map_of("improvement, %", [gain.text(1, 100) for gain in gains]),
        map_of("Phi after shaking", [end.text() for end in ends]),
        map_of("grown layers", [f"{layers:.1f}" for layers in grown]),
        map_of("Gamma", [f"{one:.3g}" for one in gamma])]), statements
