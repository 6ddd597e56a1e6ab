"""Effects that the papers call small: periodic sides, the width of the box, lateral and
height-dependent displacements."""
import numpy as np

from ageing_figures import falls_with_age, squared_change
from page_text import at, table, window
from verdicts import Estimate, are_positive, is_positive, is_within

LITTLE = 0.005  # a difference of packing fractions
SIDES = ("walls", "periodic")


def sides(run):
    """Every strength between walls, then with periodic sides."""
    strengths = next(values for pointer, values in run.scene["sweep"].items() if "tap" in pointer)
    n = len(strengths)
    bottom, centre, height = (np.array(run.curves(name)).reshape(2, n, -1, run.realizations)
                              for name in ("bottom_fraction", "corrected_fraction", "mean_height"))
    last = bottom.shape[2] - 1
    end, taps = (last - 19, last), (0, 1, 10, 30, 100, 300)
    rows = [[f"{name}, eps = {strength:g}"] + [at(centre[k][i], tap) for tap in taps]
            for k, name in enumerate(SIDES) for i, strength in enumerate(strengths)]
    statements = []
    for k, name in enumerate(SIDES):
        ours = " (ours)" if name == "periodic" else ""  # not in the paper
        gains = [window(curve, *end) - curve[1] for curve in bottom[k]]
        early = [window(curve, 81, 120) - curve[1] for curve in bottom[k]]
        ends = [window(curve, *end) for curve in centre[k]]
        z = height[k]
        young, old = (np.mean([squared_change(curve, age, 10) for curve in z], axis=0)
                      for age in (3, 100))
        statements += [
            are_positive(f"fig. 2, {name}: Phi_b grows at every strength{ours}",
                         [Estimate.of(gain) for gain in gains],
                         f"taps {end[0]} to {end[1]} less tap 1: "),
            is_positive(f"fig. 2, {name}: slower for the smallest eps, in the first 100 taps{ours}",
                        Estimate.of(early[2] - early[0]), f"gain at {strengths[2]:g} less that at "
                        f"{strengths[0]:g}: ", name="paired t-test"),
            are_positive(f"fig. 4, {name}: Phi_c is largest at an intermediate strength (here: "
                         f"after {last} taps)",
                         [Estimate.of(ends[2] - ends[0]), Estimate.of(ends[2] - ends[3])],
                         f"Phi_c at {strengths[2]:g} less that at {strengths[0]:g} and at "
                         f"{strengths[3]:g}: ", name="paired t-tests"),
            falls_with_age(f"fig. 5, {name}: <Z> moves less over 10 taps from tap 100 than from tap "
                           f"3, mean of the strengths{ours}", young, old)]
    return table(["Phi_c, tap"] + [str(tap) for tap in taps], rows), statements


def widths(observable, of):
    """Compares the gain of each width with that of the widest bed."""
    def write(run):
        across = run.scene["sweep"]["zip"]["/container/width"]
        curves = run.curves(observable)
        last = len(curves[0]) - 1
        taps = (0, 1, 10, 30, 100, 200, 300)
        gains = [window(curve, last - 19, last) - curve[1] for curve in curves]
        rows = [[f"{width:g} d"] + [at(curve, tap) for tap in taps] + [Estimate.of(gain).text()]
                for width, curve, gain in zip(across, curves, gains)]
        statements = [
            is_within(f"a bed {width:g} d wide gains what one of {across[-1]:g} d does, "
                      f"{of} within {LITTLE:g} (ours)", Estimate.difference(gain, gains[-1]),
                      LITTLE, f"gain by taps {last - 19} to {last} from tap 1, less that of the "
                      f"widest: ")
            for width, gain in zip(across[:-1], gains)]
        return table([f"{of}, tap"] + [str(tap) for tap in taps] + ["gain from tap 1"],
                     rows), statements
    return write


def shakes(run):
    """A lift, then shakes by the radius of their lateral offsets."""
    names = ["lift 0.25"] + [f"shake, offsets within {tap['shake']['lateral_radius']:g} d"
                             for tap in run.scene["sweep"]["/protocol/0/tap"][1:]]
    parts = {name: run.curves(name) for name in ("bulk_fraction", "lower", "upper")}
    last = len(parts["upper"][0]) - 1
    end, taps = (last - 19, last), (0, 1, 10, 50, 100, 200)
    tables = [table([f"Phi, {where}, tap"] + [str(tap) for tap in taps],
                    [[name] + [at(curve, tap) for tap in taps]
                     for name, curve in zip(names, parts[part])])
              for part, where in (("bulk_fraction", "the middle 60 % of the spheres"),
                                  ("lower", "3 to 9 d"), ("upper", "11 to 17 d"))]
    bulk = [window(curve, *end) for curve in parts["bulk_fraction"]]
    upper = [window(curve, *end) - curve[0] for curve in parts["upper"]]
    statements = [
        is_within(f"lateral offsets change nothing ({LITTLE:g}): {name.split(', ')[1]}",
                  Estimate.of(phi - bulk[1]), LITTLE,
                  f"Phi, taps {end[0]} to {end[1]}, less that without offsets: ")
        for name, phi in zip(names[2:], bulk[2:])]
    statements += [
        is_within(f"a shake densifies the upper bed little or not at all ({LITTLE:g})",
                  Estimate.of(upper[1]), LITTLE,
                  f"11 to 17 d, without offsets, taps {end[0]} to {end[1]} less tap 0: "),
        is_positive("a shake leaves the bulk less dense than a lift does", Estimate.of(
            bulk[0] - bulk[1]), f"lift less shake, taps {end[0]} to {end[1]}: ",
            name="paired t-test")]
    return "\n\n".join(tables), statements
