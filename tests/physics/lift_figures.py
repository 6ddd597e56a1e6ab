"""Figures 2 to 6 of Rosato et al.: the bulk fraction against taps, order and contacts."""
import dataclasses

import numpy as np

from compaction_figures import maximum_of
from page_text import are_steady, at, interval, parameters, table, window
from verdicts import (Estimate, are_positive, are_within, is_positive, is_within, is_zero,
                      of_interval)

# A mean of the paper is known to half a unit of its last digit; its own error is about 0.001, if it
# is as of the equilibrium values ("realizations were added until sigma <= 0.001").
ROUNDED, PRINTED_ERROR = 0.0005, 0.001
EQUILIBRIUM = 10000  # taps: "under 1e4 taps" for the stronger lifts
TAPERED = "Phi, edges over a layer"


def against_taps(run, taps, observable="bulk_fraction", name="Phi"):
    rows = [[label.replace("|", "")] + [at(curve, tap) for tap in taps]
            for label, curve in zip(run.labels, run.curves(observable))]
    return ["point", f"{name}, tap {taps[0]}"] + [str(tap) for tap in taps[1:]], rows


# Windows of taps about a tap, and the taps of the table.
SPANS = {10: (6, 15), 100: (81, 120), 200: (181, 220), 350: (331, 350), 700: (651, 750),
         1500: (1401, 1500)}
SHOWN = (0, 1, 10, 30, 100, 200, 350, 700, 1500)


def lift_or_dilation(run):
    lift, held = run.curves("bulk_fraction")
    width, last = run.scene["container"]["width"], len(lift) - 1
    spans = {tap: span for tap, span in SPANS.items() if tap <= last}
    statements = [
        is_positive(f"the lift densifies faster: about tap {tap}, {width} d wide",
                    Estimate.of(window(lift, *span) - window(held, *span)),
                    f"lift less held dilation, taps {span[0]} to {span[1]}: ",
                    name="paired t-test")
        for tap, span in spans.items()]
    first, end = list(spans.values())[-1]
    statements.append(is_within("the held dilation gives little or nothing (0.005)",
                                Estimate.of(window(held, first, end) - held[0]), 0.005,
                                f"gain by taps {first} to {end}: "))
    header, rows = against_taps(run, tuple(tap for tap in SHOWN if tap <= last))
    return table(header, rows), statements


PUBLISHED_BETA = {0.1: 0.2000, 0.2: 0.2588, 0.25: 0.2715}


def best_lift(run):
    header, rows = against_taps(run, (0, 1, 10, 50, 100, 250, 400))
    fits = run.fits("bulk_fraction", "kww", "--range", "0:")
    names = ("rho_inf", "tau", "beta")
    for row, fit in zip(rows, fits):
        row += parameters(fit, names)
    sweep = next(iter(run.analyse("sweep", "--observable", "bulk_fraction", "--last", 50).values()))
    steady = run.analyse("steady", "--observable", "bulk_fraction", "--last", 200)
    lifts, curves = run.values(), run.curves("bulk_fraction")
    end = {lift: window(curve, 351, 400) for lift, curve in zip(lifts, curves)}
    last = len(curves[0]) - 1
    statements = [
        are_positive("Phi is largest at an intermediate lift (here: after 400 taps)",
                     [Estimate.of(end[0.25] - end[0.1]), Estimate.of(end[0.25] - end[0.5])],
                     "0.25 less 0.1 and less 0.5, taps 351 to 400: ", name="paired t-tests"),
        of_interval("that lift is near 0.25 to 0.3", sweep["maximum_at_low"],
                    sweep["maximum_at_high"], between=(0.2, 0.35), found="maximum at"),
        are_steady("the maximum is one of equilibrium values", steady, "bulk_fraction",
                   [f"{lift:g}" for lift in lifts], (last - 199, last), EQUILIBRIUM)]
    for lift, fit in zip(lifts, fits):
        if lift in PUBLISHED_BETA:
            beta = PUBLISHED_BETA[lift]
            statements.append(of_interval(f"KWW with beta = {beta} at {lift:g}",
                                          *interval(fit, "beta"), found="beta",
                                          between=(0.9 * beta, 1.1 * beta)))
    return table(header + [f"kww: {name}" for name in names], rows), statements


def from_crystal(run):
    header, rows = against_taps(run, (0, 10, 60, 200, 500))
    sweep = next(iter(run.analyse("sweep", "--observable", "bulk_fraction", "--last", 50).values()))
    steady = run.analyse("steady", "--observable", "bulk_fraction", "--last", 250)
    statements, last = [], len(run.curves("bulk_fraction")[0]) - 1
    for lift, curve in zip(run.values(), run.curves("bulk_fraction")):
        statements.append(is_positive(f"Phi falls within 60 taps at {lift:g}",
                                      Estimate.of(curve[0] - curve[60]), "fall: "))
    statements += [
        maximum_of(sweep, "the final Phi is largest at an intermediate lift (here: after 500 taps)",
                   "lift"),
        of_interval("at about the lift of fig. 4", sweep["maximum_at_low"],
                    sweep["maximum_at_high"], between=(0.2, 0.35), found="maximum at"),
        are_steady("Phi flattens after many thousand taps", steady, "bulk_fraction",
                   [f"{lift:g}" for lift in run.values()], (last - 249, last), EQUILIBRIUM)]
    tapered = against_taps(run, (0, 10, 60, 200, 500), "tapered_fraction", TAPERED)
    return f"{table(header, rows)}\n\n{table(*tapered)}", statements


def contacts(run):
    bulk, kept = run.curves("bulk_fraction")[0], run.structure(["coordination", "profile"])
    taps = run.scene["snapshots"]["taps"]
    phi, n_c, n_all = (np.array([packings[part][name] for packings in kept])  # [realization, tap]
                       for part, name in (("profile", "phi_region"), ("coordination", "n_c"),
                                          ("coordination", "n_c_all")))
    rows = [[str(tap), at(bulk, tap), Estimate.of(phi[:, k]).text(), Estimate.of(n_c[:, k]).text(3),
             Estimate.of(n_all[:, k]).text(3)] for k, tap in enumerate(taps)]

    def slope(y, chosen, x=phi):
        return np.array([np.polyfit(x[r, chosen], y[r, chosen], 1)[0] for r in range(len(y))])
    every = np.ones(len(taps), bool)
    early, late = np.array(taps) <= 100, np.array(taps) >= 100
    statements = [
        is_positive("N_c rises with Phi", Estimate.of(slope(n_c, every)),
                    "slope of N_c against Phi of the same region: ", digits=1),
        is_zero("on one straight line", Estimate.of(slope(n_c, late) - slope(n_c, early)),
                f"slope after tap 100, {Estimate.of(slope(n_c, late)).text(1)}, less that before, "
                f"{Estimate.of(slope(n_c, early)).text(1)}: ", digits=1)]
    return table(["tap", "bulk Phi", "Phi of the region", "N_c of the region", "N_c of all"],
                 rows), statements


def as_printed(paper, estimate, printed, error=PRINTED_ERROR, rounded=ROUNDED):
    """A number that is printed with an error of its own: it can be refuted, hardly shown."""
    statement = is_within(paper, estimate.from_printed(printed, error), rounded,
                          f"{estimate.text()}; from it, the paper's own error counted: ")
    return dataclasses.replace(statement, test=f"{statement.test}, which can only refute")


def densities(curve, printed, of=""):
    return [as_printed(f"rho = {value} after {tap} taps{of}", Estimate.of(curve[tap]), value)
            for tap, value in printed.items()]


def gain_of_two_hundred(curve, of=""):
    return as_printed(f"from tap 50 to 250 it gains 0.019{of}",
                      Estimate.of(curve[250] - curve[50]), 0.019, np.sqrt(2) * PRINTED_ERROR,
                      2 * ROUNDED)


def published_rules(run):
    shown = (0, 1, 2, 5, 10, 20, 50, 100, 150, 200, 250)
    curves, steps = run.curves("bulk_fraction"), run.values()
    statements = densities(curves[0], {0: 0.567})  # every first step has equal beds
    rows = []
    for curve, step in zip(curves, steps):
        of = f", first step {step}"
        statements += densities(curve, {50: 0.578, 250: 0.597}, of)
        statements.append(gain_of_two_hundred(curve, of))
        rows.append([str(step)] + [at(curve, tap) for tap in shown])
    return table(["first step, d"] + [f"Phi, tap {tap}" for tap in shown], rows), statements


def reading(max_step, reset_each_tap, measure_start, of):
    """The reading of the published rules, in words."""
    return "; ".join([
        f"first step {max_step:g}",
        "reset at each tap" if reset_each_tap else "handed on",
        "first compared: " + ("right after the tap" if measure_start else "after 1e6 trials"),
        "half of " + ("all trials" if of == "all_trials" else "those that do not rise")])


def readings(run):
    """Each reading against the two densities that the paper prints."""
    taps, printed = (0, 1, 10, 50, 100, 250), {50: 0.578, 250: 0.597}
    rows, statements = [], []
    settings = {pointer.rsplit("/", 1)[1]: values
                for pointer, values in run.scene["sweep"]["zip"].items()}
    for place, (curve, sweeps) in enumerate(zip(run.curves("bulk_fraction"),
                                                run.curves("sweeps"))):
        words = reading(**{name: values[place] for name, values in settings.items()})
        rows.append([f"{place + 1}: {words}"] + [at(curve, tap) for tap in taps] +
                    [f"{np.mean(sweeps[1:]):.0f}"])
        statement = are_within(
            f"rho = 0.578 and 0.597 after 50 and 250 taps, reading {place + 1}",
            [Estimate.of(curve[tap]).from_printed(value, PRINTED_ERROR)
             for tap, value in printed.items()], ROUNDED,
            " and ".join(at(curve, tap) for tap in printed))
        statements.append(dataclasses.replace(
            statement, test=f"{statement.test}, which can only refute"))
    return table(["reading"] + [f"Phi, tap {tap}" for tap in taps] + ["sweeps per tap"],
                 rows), statements


def layers(run):
    grown, order = (run.ensemble_structure(part) for part in ("layers", "order"))
    kept = run.structure(["layers", "order"])
    bulk, taps = run.curves("bulk_fraction")[0], [int(tap) for tap in grown["tap"]]
    each = np.array([packings["layers"]["grown_layers"] for packings in kept])

    def ordered(k, height):
        places = kept[0]["order"]["height"]
        place = int(np.argmin(np.abs(places - height)))
        return np.array([1 - packings["order"]["disordered_at_height"][k, place]
                         for packings in kept])
    tapered = run.curves("tapered_fraction")[0]
    rows = [[str(tap), at(bulk, tap), at(tapered, tap), Estimate.of(each[:, k]).text(2)] +
            [f"{grown['share'][k, layer]:.2f}" for layer in range(8)]
            for k, tap in enumerate(taps)]
    heights = (1.5, 3.5, 5.5, 7.5, 9.5, 11.5)
    order_rows = [[str(tap)] + [Estimate.of(ordered(k, height)).text(3) for height in heights]
                  for k, tap in enumerate(taps)]
    text = [table(["tap", "Phi", TAPERED, "grown layers"] +
                  [f"share, layer {layer + 1}" for layer in range(8)], rows),
            f"Layers of tap {taps[-1]} lie at " +
            ", ".join(f"{height:.2f}" for height in grown["found_height"][-1, :6]) + " (hcp: " +
            ", ".join(f"{height:.2f}" for height in grown["layer_height"][:6]) + "). fcc and hcp "
            f"make {order['fcc'][-1]:.3f} and {order['hcp'][-1]:.3f} of the spheres of the region.",
            table(["fcc and hcp at height"] + [f"{height:g}" for height in heights], order_rows)]
    statements = densities(bulk, {0: 0.567, 50: 0.578, 250: 0.597}) + [
        gain_of_two_hundred(bulk),
        is_positive("layers grow with taps", Estimate.of(each[:, -1] - each[:, 0]),
                    f"grown layers, tap {taps[-1]} less tap 0: ", digits=2, name="paired t-test"),
        is_positive("they grow upwards from the floor", Estimate.of(
            ordered(-1, 1.5) - ordered(-1, 5.5)),
            f"share of fcc and hcp at tap {taps[-1]}, height 1.5 less 5.5: ", digits=2,
            name="paired t-test")]
    return "\n\n".join(text), statements
