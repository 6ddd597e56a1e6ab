"""Draws the figures of docs/validation from the reduced data, the papers' printed numbers as black circles."""
import re

import matplotlib
import numpy as np

from pictures import COLOURS, Picture, curves_of
from reduce import REDUCED, read_table
from special_drawings import (PRINTED_LABEL, draw_ageing, draw_crystals, draw_densities, draw_free_volumes, draw_growth,
                              draw_increases, draw_layers, draw_map, draw_neighbours, draw_parameters, draw_pores, draw_pours,
                              draw_snapshots, draw_spectra, draw_steady_crystals, draw_surface, draw_tails,
                              draw_transverse, draw_two_taps, draw_vertical, draw_void_probability)
from scores import (COMPATIBLE, DECIDED, NOT, QUALITATIVE, REPRODUCED, SILENT, UNDERPOWERED)

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402

STYLE = {"svg.fonttype": "none", "svg.hashsalt": "jostle", "font.size": 8, "legend.fontsize": 6, "axes.grid": True,
         "grid.alpha": 0.25, "legend.framealpha": 0.7, "lines.linewidth": 1, "font.family": "DejaVu Sans"}
TAPS, STRENGTH, PHI, MARKS = "taps", "eps^(1/2)", "packing fraction", "osD^v<>p"

# figure: its panels, each a list of (run, table, picture).
PANELS = {
    "pb4": [[("pb4-bell", 1, Picture(STRENGTH, "Phi_c", columns="3001")),
             ("pb4-hysteresis", 1, Picture(STRENGTH, "Phi_c"))]],
    "pb-moves": [[("pb-moves", 1, Picture("d_max, diameters", "10^4 gain of Phi_c", across=True, log="x"))]],
    "pb-sides": [[("pb-sides", 1, Picture(TAPS, "Phi_c", across=True, log="x"))]],
    "dr3": [[("dr3", 1, Picture(PHI, "N_c", columns="N_c of the region", x_column=2))]],
    "dr4": [[("dr4", 1, Picture(TAPS, PHI, across=True, log="x"))],
            [("dr4", 1, Picture("lift, diameters", PHI, columns="^400$"))]],
    "dr10": [[("dr10-14", 1, Picture(TAPS, PHI, across=True, rows="Gamma = 2", log="x",
                                     paper=((0, 0.609), (898, 0.6997))))]],
    "dr11": [[("dr10-14", 1, Picture(TAPS, PHI, across=True, rows="^Gamma = [0-9.]*$", log="x"))]],
    "dr13": [[("dr10-14", 3, Picture("height, diameters", PHI, across=True))],
             [("dr10-14", 4, Picture("height, diameters", "n(z)", across=True, rows="2, tap|0.5"))]],
    "both-engines": [[("both-engines", 1, Picture(TAPS, PHI, across=True, log="x"))]],
}


# Legends' names of the curves of tables, in this order.
NAMES = ((r'tap = \{"lift":([0-9.]+)\}', r"lift \1"), (r'tap = \{"dilate_floor_held":0.025\}', "held dilation 1.025"),
         (r"^3001 to 4000 \(pb4-bell\)", "each from the poured bed"), (r"^Phi_c, (.*) \(pb4-hysteresis\)", r"one bed, \1"),
         (r"^400$", "after 400 taps"), ("^Gamma = 2$", "Gamma = 2, mean"), ("^Gamma = 2, realization", "bed"),
         (r"^([0-9.]+ pi)$", r"theta_0 = \1"))


def legend_of(name):
    for pattern, word in NAMES:
        name = re.sub(pattern, word, name)
    return name


def draw_curves(axes, parts):
    index, picture, lowest = 0, None, 1.0
    for run, number, picture in parts:
        for name, points in curves_of(read_table(REDUCED / run / f"{number}.csv"), picture):
            if not points:
                continue
            x, y, low, high = np.array(points, float).T
            hollow = run == "pb4-hysteresis"
            axes.errorbar(x, y, yerr=[y - low, high - y], label=legend_of(f"{name} ({run})" if len(parts) > 1 else name),
                          marker=MARKS[index % 8], color=COLOURS[index % 8], markersize=3, capsize=1, elinewidth=.6,
                          markerfacecolor="white" if hollow else COLOURS[index % 8])
            lowest, index = min(lowest, x.min()), index + 1
    if picture.paper:
        axes.plot(*zip(*picture.paper), "ko", markerfacecolor="none", label=PRINTED_LABEL, zorder=5)
    if "x" in picture.log:
        axes.set_xscale("symlog" if lowest <= 0 else "log", **({"linthresh": 1} if lowest <= 0 else {}))
    axes.set_yscale("log" if "y" in picture.log else "linear")
    axes.set(xlabel=picture.x, ylabel=picture.y)
    axes.margins(y=0.12)
    axes.legend(**({"ncols": 3, "loc": "lower center", "bbox_to_anchor": (0.5, 1.0)} if index > 5 else {}))


def save(figure, target):
    figure.savefig(target, format="svg", metadata={"Date": None})
    pyplot.close(figure)


# figure: how many panels, and what draws them.
SPECIAL = {"pb2": (2, draw_growth), "pb2-laws": (2, draw_parameters), "pb3": (2, draw_spectra), "pb5": (2, draw_ageing), "pb6": (1, draw_vertical),
           "pb7": (1, draw_transverse), "pb8": (2, draw_increases),
           "pb9": (1, draw_void_probability), "pb10": (3, draw_pores), "dr1": (2, draw_snapshots),
           "dr2": (1, draw_two_taps), "dr5": (2, draw_crystals), "dr6": (4, draw_layers), "dr7": (1, draw_pours), "dr8": (1, draw_neighbours),
           "dr9": (1, draw_free_volumes), "dr15": (1, draw_map)}


def draw_figure(name, target):
    """Draws a figure and returns whether it contains numbers that the paper prints."""
    with pyplot.rc_context(STYLE):
        panels = SPECIAL[name][0] if name in SPECIAL else len(PANELS[name])
        rows, columns = (2, 2) if panels == 4 else (1, panels)
        surface = name == "dr13"  # beside its panels
        size = (5.2, 4.4) if name == "dr1" else (3.6 * (columns + surface) + .4, 2.7 * rows)
        figure, axes = pyplot.subplots(rows, columns + surface, figsize=size, squeeze=False, layout="constrained")
        axes = axes.ravel()
        if name in SPECIAL:
            SPECIAL[name][1](axes)
        else:
            for panel, parts in zip(axes, PANELS[name]):
                draw_curves(panel, parts)
        if surface:
            axes[-1].remove()
            draw_surface(figure.add_subplot(rows, columns + 1, columns + 1, projection="3d"))
        printed = any(label == PRINTED_LABEL for panel in axes for label in panel.get_legend_handles_labels()[1])
        save(figure, target)
        return printed


def draw_strongest(target):
    """The six strongest results, one panel each, for the README."""
    with pyplot.rc_context(STYLE | {"font.size": 7, "axes.titlesize": 7}):
        figure, axes = pyplot.subplots(2, 3, figsize=(9, 4.6), layout="constrained")
        axes = axes.ravel()
        draw_curves(axes[0], PANELS["pb4"][0])
        draw_transverse([axes[1]])
        draw_tails(axes[2])
        draw_densities(axes[3], (1,))
        draw_pours([axes[4]])
        ((_, points),) = curves_of(read_table(REDUCED / "dr4" / "1.csv"), Picture("", "", columns="^400$"))
        x, y, low, high = np.array(points).T
        axes[5].errorbar(x, y, [y - low, high - y], marker=MARKS[0], color=COLOURS[0], markersize=3, capsize=1,
                         label="poured, 400 taps")
        draw_steady_crystals(axes[5], marker=MARKS[1], color=COLOURS[1], label="from a crystal, 5000 taps")
        axes[5].set(xlabel="lift, diameters", ylabel=PHI)
        axes[5].legend()
        for panel, title in zip(axes, (
                "PB 4: a bell, and denser beds on the way down", "PB 7: three layers at the walls",
                "PB 10: the tail of large pores shrinks", "DR 6: compatible with 0.567, 0.578, 0.597",
                "DR 7: poured beds are looser with friction", "DR 4, 5: densest at an intermediate lift")):
            panel.set_title(title)
        save(figure, target)


SIDE = (REPRODUCED, COMPATIBLE, QUALITATIVE, NOT, UNDERPOWERED, SILENT)
LOOK = {REPRODUCED: "#009e73", COMPATIBLE: "#0072b2", QUALITATIVE: "#b07800", NOT: "#d55e00",
        UNDERPOWERED: "#777777", SILENT: "#bbbbbb"}


def draw_overview(scores, names, target):
    """A row per figure, a mark per statement: distances from printed numbers, other statements by status."""
    with pyplot.rc_context(STYLE):
        figure, (left, right) = pyplot.subplots(1, 2, figsize=(8.4, .26 * len(names) + 1), sharey=True,
                                                width_ratios=(1.2, 1), layout="constrained")
        seen = {}
        for s in scores:
            if s.claim.own or s.claim.figure not in names:
                continue
            row = names.index(s.claim.figure)
            printed = np.isfinite(s.distance)
            panel = left if printed else right
            key = (row, None if printed else s.status)
            seen[key] = seen.get(key, -1) + 1
            x = s.distance if printed else SIDE.index(s.status) + .11 * seen[key] - .4
            y = row + (.12 * (seen[key] - 1.5) if printed else 0)
            fill = LOOK[s.status] if s.status in DECIDED else "white"
            if printed and s.status not in DECIDED:
                panel.plot([-s.needed, s.needed], [y, y], color=LOOK[s.status], linewidth=.7)
            panel.plot(x, y, marker="s" if s.claim.full else "o", color=LOOK[s.status], markerfacecolor=fill,
                       markersize=3.5, linestyle="none")
        left.set_xscale("symlog", linthresh=3)
        left.axvspan(-2, 2, color="#009e73", alpha=.1)
        left.set(xlabel="(found - printed) / combined error", xlim=(-30, 30))
        left.set_yticks(range(len(names)), names)
        left.set_ylim(len(names) - .5, -.5)
        right.set_xticks(range(len(SIDE)), SIDE, rotation=25, ha="right")
        right.set_xlim(-.6, len(SIDE) - .3)
        right.set_title("statements without a printed number", fontsize=8)
        left.set_title("squares: the paper's number of spheres; circles: reduced", fontsize=8)
        save(figure, target)
