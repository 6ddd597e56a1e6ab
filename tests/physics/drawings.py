"""Draws the figures of docs/validation from the reduced data, the papers' printed numbers as black circles."""
import matplotlib
import numpy as np
from scipy import stats

from pictures import COLOURS, Picture, curves_of, value_of
from distributions import distribution
from reduce import REDUCED, read_table
from scores import (COMPATIBLE, DECIDED, NOT, QUALITATIVE, REPRODUCED, SILENT, UNDERPOWERED)

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402

STYLE = {"svg.fonttype": "none", "svg.hashsalt": "jostle", "font.size": 8, "legend.fontsize": 6, "axes.grid": True,
         "grid.alpha": 0.25, "legend.framealpha": 0.7, "lines.linewidth": 1, "font.family": "DejaVu Sans"}
TAPS, STRENGTH, PHI, MARKS = "taps", "eps^(1/2)", "packing fraction", "osD^v<>p"
PRINTED = ((0, 0.567), (50, 0.578), (250, 0.597))
NORMAL = tuple((n, float(stats.norm.pdf(n, 7.2713, 1.2550))) for n in range(3, 13))

# figure: its panels, each a list of (run, table, picture).
PANELS = {
    "pb2": [[("pb2", 1, Picture(TAPS, "Phi_b", across=True, log="x"))],
            [("pb2", 1, Picture(TAPS, "Phi_b", across=True))]],
    "pb3": [[("pb3", 1, Picture(STRENGTH, "sigma_Z, diameters", columns="^sigma_Z"))],
            [("pb3", 1, Picture(STRENGTH, "slope of the spectrum", columns="^slope"))]],
    "pb4": [[("pb4-bell", 1, Picture(STRENGTH, "Phi_c", columns="3001")),
             ("pb4-hysteresis", 1, Picture(STRENGTH, "Phi_c"))]],
    "pb5": [[("pb5", 1, Picture("lag, taps", "10^4 A, square diameters", across=True, columns="lag", log="xy"))]],
    "pb6": [[("pb6-8", 1, Picture("height, diameters", PHI, across=True))]],
    "pb7": [[("pb6-8", 2, Picture("distance to a wall, diameters", PHI, across=True))]],
    "pb9": [[("pb9", 1, Picture("sigma", "P0", columns="P0|Gotoh"))]],
    "pb10": [[("pb10", 1, Picture(TAPS, "sphere volumes", columns="^(nu|v0)$", log="x"))],
             [("pb10", 2, Picture("v, sphere volumes", "rho_v", across=True, log="y"))]],
    "pb-moves": [[("pb-moves", 1, Picture("d_max, diameters", "10^4 gain of Phi_c", across=True, log="x"))]],
    "pb-sides": [[("pb-sides", 1, Picture(TAPS, "Phi_c", across=True, log="x"))]],
    "dr2": [[("dr2-wide", 1, Picture(TAPS, PHI, across=True, log="x"))]],
    "dr3": [[("dr3", 1, Picture(PHI, "N_c", columns="N_c of the region", x_column=2))]],
    "dr4": [[("dr4", 1, Picture(TAPS, PHI, across=True, log="x"))]],
    "dr5": [[("dr5", 1, Picture(TAPS, PHI, across=True, log="x"))]],
    "dr7": [[("dr7-9", 1, Picture("friction", PHI, columns="^Phi, the", paper=((0, 0.6366), (0.1, 0.6088))))]],
    "dr8": [[("dr7-9", 2, Picture("neighbours", "share of the spheres", across=True, rows="0.1$", paper=NORMAL))]],
    "dr10": [[("dr10-14", 1, Picture(TAPS, PHI, across=True, rows="Gamma = 2", log="x",
                                     paper=((0, 0.609), (898, 0.6997))))]],
    "dr11": [[("dr10-14", 1, Picture(TAPS, PHI, across=True, rows="^Gamma = 0.5", log="x"))]],
    "dr13": [[("dr10-14", 3, Picture("height, diameters", PHI, across=True))],
             [("dr10-14", 4, Picture("height, diameters", "n(z)", across=True, rows="2, tap|0.5"))]],
    "both-engines": [[("both-engines", 1, Picture(TAPS, PHI, across=True, log="x"))]],
}


def draw_curves(axes, parts):
    index, picture, lowest = 0, None, 1.0
    for run, number, picture in parts:
        for name, points in curves_of(read_table(REDUCED / run / f"{number}.csv"), picture):
            if not points:
                continue
            x, y, low, high = np.array(points, float).T
            hollow = run == "pb4-hysteresis"
            axes.errorbar(x, y, yerr=[y - low, high - y], label=f"{name} ({run})" if len(parts) > 1 else name,
                          marker=MARKS[index % 8], color=COLOURS[index % 8], markersize=3, capsize=1, elinewidth=.6,
                          markerfacecolor="white" if hollow else COLOURS[index % 8])
            lowest, index = min(lowest, x.min()), index + 1
    if picture.paper:
        axes.plot(*zip(*picture.paper), "ko", markerfacecolor="none", label="the paper", zorder=5)
    if "x" in picture.log:
        axes.set_xscale("symlog" if lowest <= 0 else "log", **({"linthresh": 1} if lowest <= 0 else {}))
    axes.set_yscale("log" if "y" in picture.log else "linear")
    axes.set(xlabel=picture.x, ylabel=picture.y)
    axes.legend()


def save(figure, target):
    figure.savefig(target, format="svg", metadata={"Date": None})
    pyplot.close(figure)


def draw_increases(axes):
    """[PB] 8: lateral and central increase of four strengths."""
    header, *rows = read_table(REDUCED / "pb6-8" / "3.csv")
    for panel, name in zip(axes, ("d Phi lateral", "central")):
        at = header.index(name)
        for k, point in enumerate(dict.fromkeys(row[0] for row in rows)):
            taps, values = zip(*((float(row[1]), value_of(row[at])[0]) for row in rows if row[0] == point))
            panel.plot(taps, values, marker=MARKS[k], color=COLOURS[k], markersize=3, label=point)
        panel.set_xscale("symlog", linthresh=1)
        panel.set(xlabel=TAPS, ylabel=name)
    axes[0].legend()


def draw_layers(axes):
    """[DR] 6: density from the floor, and n(y/d) at three taps with the heights of hcp layers."""
    header, *rows = read_table(REDUCED / "dr6-windows" / "series.csv")
    for k, (point, name) in enumerate((("0", "first step 0.1"), ("1", "0.2"), ("2", "0.2, stop 0 to 15 d"),
                                       ("3", "0.2, so, start off"))):
        taps = sorted({int(row[2]) for row in rows})
        values = [np.array([float(row[header.index("floor_15")]) for row in rows
                            if row[0] == point and row[2] == str(tap)]) for tap in taps]
        axes[0].errorbar(taps, [v.mean() for v in values], [v.std(ddof=1) / len(v)**.5 for v in values],
                         color=COLOURS[k], label=name, elinewidth=.6)
    axes[0].plot(*zip(*PRINTED), "ko", markerfacecolor="none", label="the paper", zorder=5)
    axes[0].set(xlabel=TAPS, ylabel="packing fraction, 0 to 15 d")
    axes[0].set_xscale("symlog", linthresh=1)
    axes[0].legend()
    shares = distribution("dr6-windows", 1, "n")
    for panel, tap in zip(axes[1:], (0, 50, 250)):
        z, n, _ = shares[tap]
        for layer in range(10):
            panel.axvline(0.5 + layer * (2 / 3)**.5, color="#bbbbbb", linewidth=.5)
        panel.plot(z, n, color=COLOURS[0], linewidth=.7)
        panel.set(xlabel="y/d", ylabel="n", title=f"{tap} taps", xlim=(0, 23))


def draw_map(axes):
    """[DR] 15: improvement over amplitude and frequency."""
    header, *rows = read_table(REDUCED / "dr15" / "1.csv")
    values = [[value_of(cell)[0] for cell in row[1:]] for row in rows]
    image = axes.imshow(values, origin="lower", cmap="viridis", aspect="auto")
    axes.set_xticks(range(len(header) - 1), header[1:])
    axes.set_yticks(range(len(rows)), [row[0] for row in rows])
    axes.grid(False)
    for i, line in enumerate(values):
        for j, value in enumerate(line):
            axes.text(j, i, f"{value:g}", ha="center", va="center", color="white" if value < 1.5 else "black")
    axes.figure.colorbar(image, label="improvement, %")


def draw_figure(name, target):
    with pyplot.rc_context(STYLE):
        panels = {"pb8": 2, "dr6": 4, "dr15": 1}.get(name) or len(PANELS[name])
        rows, columns = (2, 2) if panels == 4 else (1, panels)
        figure, axes = pyplot.subplots(rows, columns, figsize=(3.6 * columns + .4, 2.7 * rows), squeeze=False,
                                       layout="constrained")
        axes = axes.ravel()
        if name in ("pb8", "dr6"):
            (draw_increases if name == "pb8" else draw_layers)(axes)
        elif name == "dr15":
            draw_map(axes[0])
        else:
            for panel, parts in zip(axes, PANELS[name]):
                draw_curves(panel, parts)
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
