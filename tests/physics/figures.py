#!/usr/bin/env python3
"""Runs the reduced scenes of the papers' figures and writes a page with their tests.

figures.py JOSTLE FOLDER PAGE [--hours H] [FIGURE ...]: results are kept in FOLDER, and a finished
one is not run again. After H hours the run under way stops, and the next call continues it.
Sections of other figures stay as they are."""
import argparse
import pathlib
import re
import time

import numpy as np
from scipy import stats

from ageing_figures import ageing
from box_figures import shakes, sides, widths
from compaction_figures import (bell, bell_and_stop, compaction, fluctuations, hysteresis, moves,
                                turns)
from grain_figures import both_engines, columns, poured, shaken, tapped
from lift_figures import (best_lift, contacts, from_crystal, layers, lift_or_dilation,
                          published_rules, readings)
from page_text import verdict_table
from pictures import Picture, draw
from runs import Run
from structure_figures import periodic_profiles, pore_sizes, void_probability, wall_profiles

PB, DR = "philippe-bideau-2001", "rosato-dybenko-2010"
PB_SETUP = "4096 spheres in 16 x 16 d"
DR_SETUP = "3456 spheres in 12 x 12 d, periodic; realizations added until sigma <= 0.001"
DR_GRAINS = "3456 grains in 12 x 12 d, periodic, 20 realizations"

# figure: scene, writer, other finished runs it may look at, the paper's setup, its statement.
FIGURES = {
    "pb2": (f"{PB}/fig2", compaction, [], f"{PB_SETUP}, walls; taps and realizations not printed",
            "Phi_b grows as the inverse log, slower for smaller eps; at small eps tau rises "
            "spectacularly and X_inf may exceed 0.64."),
    "pb3": (f"{PB}/fig3", fluctuations, [], f"{PB_SETUP}; strengths, taps and sides not printed",
            "The spectrum of <Z> falls as f^-s with s between 1 and 1.5; sigma_Z of the steady "
            "state is proportional to eps^(1/2)."),
    "pb4-bell": (f"{PB}/fig4-bell", bell, [], f"{PB_SETUP}, 4000 taps per strength",
                 "A bell with its maximum at eps^(1/2) between 0.1 and 0.2."),
    "pb4-eta": (f"{PB}/bell-eta", bell_and_stop, [], f"{PB_SETUP}, 4000 taps per strength; eta not "
                "printed", "At eps^(1/2) = 0.15 Phi_c is larger than at 0.05."),
    "pb4-hysteresis": (f"{PB}/fig4-hysteresis", hysteresis, [],
                       f"{PB_SETUP}, 4000 taps per strength, steps of 0.025 in eps^(1/2)",
                       "Above eps^(1/2) of about 0.15 the way down is a reversible branch of higher "
                       "Phi, on which Phi_c falls with eps^(1/2); below, it rises a bit more to a "
                       "maximum. (Beds that stay below 0.15: pb4-turns.)"),
    "pb4-turns": (f"{PB}/turns", turns, [], f"{PB_SETUP}, 4000 taps per strength, steps of 0.025",
                  "Where eps^(1/2) went beyond (eps^(1/2))* of about 0.15 on the way up, Phi_c "
                  "increases a bit more on the way down; else it is nearly frozen."),
    "pb5": (f"{PB}/fig5", ageing, [], f"{PB_SETUP}, 10 realizations; strength and ages not printed",
            "A(t, t_W) falls with the age t_W at equal lag t, and collapses."),
    "pb6-8": (f"{PB}/fig6-8", wall_profiles, [], f"{PB_SETUP}, walls, 4000 taps",
              "Peaks at the floor, a density that falls upward as eq. 7, three layers at the walls; "
              "alpha is bell-shaped in eps^(1/2); Phi grows less in the centre than near the walls, "
              "which jump at the first tap."),
    "pb6-8-periodic": (f"{PB}/fig6-8-periodic", periodic_profiles, [f"{PB}/fig6-8"],
                       f"{PB_SETUP}, periodic, 4000 taps",
                       "With periodic sides Phi is larger, grows less, and has no peaks at the "
                       "sides."),
    "pb9": (f"{PB}/fig9", void_probability, [], f"{PB_SETUP}, periodic, 4000 taps",
            "From Phi = 58.4 % to 60.6 % P0 shows no significant difference, and is near Gotoh's."),
    "pb10": (f"{PB}/fig10", pore_sizes, [], f"{PB_SETUP}, walls, 9999 taps, one packing",
             "The tail of large pores shrinks and is exponential, small pores hardly change; nu "
             "moves as Phi_c does, v0 follows nu; 9550 to 10 250 pores. Table I is Bernal's, from "
             "models built by hand."),
    "pb-moves": (f"{PB}/moves", moves, [],
                 f"{PB_SETUP}, d_max = R/5; strength and taps not printed",
                 "theta_0 = pi/4 gives the greatest rate of compaction: a very small one decompacts, "
                 "a large one is less efficient; a very small or large d_max nearly freezes the "
                 "packing; of the law of the angle only the width matters."),
    "pb-sides": (f"{PB}/sides", sides, [], f"{PB_SETUP}, walls and periodic",
                 "Periodic sides do not qualitatively affect its figs. 3 and 4; no statement on "
                 "figs. 2 and 5."),
    "pb-widths": (f"{PB}/widths", widths("corrected_fraction", "Phi_c"), [], f"{PB_SETUP}",
                  "One width."),
    "dr2": (f"{DR}/fig2", lift_or_dilation, [], f"{DR_SETUP}; \"many thousand taps\"",
            "The lift of 0.25 densifies much faster than the held dilation by 1.025, which gives "
            "little or nothing."),
    "dr2-wide": (f"{DR}/fig2-wide", lift_or_dilation, [], f"{DR_SETUP}; \"many thousand taps\"",
                 "The lift of 0.25 densifies much faster than the held dilation by 1.025, which "
                 "gives little or nothing."),
    "dr-shakes": (f"{DR}/shakes", shakes, [], f"{DR_SETUP}; from its refs. 33 and 37",
                  "Random lateral displacements leave the packing fraction statistically as it is; "
                  "displacements proportional to height densify the upper part of beds 22 d high "
                  "little or not at all, so that the bulk stays relatively loose."),
    "dr-widths": (f"{DR}/widths", widths("bulk_fraction", "Phi"), [], f"{DR_SETUP}", "One width."),
    "dr3": (f"{DR}/fig6", contacts, [], f"{DR_SETUP}", "N_c rises with Phi, along one line."),
    "dr4": (f"{DR}/fig4", best_lift, [], f"{DR_SETUP}; 10 000 to 90 000 taps",
            "Phi grows as KWW, and most at an intermediate lift, near 0.25 to 0.3."),
    "dr5": (f"{DR}/fig5", from_crystal, [], f"{DR_SETUP}; many thousand taps",
            "From a crystal Phi falls within 60 taps and flattens; its final value is largest at "
            "about the same lift as from a poured bed."),
    "dr6": (f"{DR}/fig6", layers, [], f"{DR_SETUP}; 90 000 taps",
            "rho = 0.567, 0.578, 0.597 and 0.654 after 0, 50, 250 and 90 000 taps; layers grow "
            "upwards from the floor."),
    "dr6-published": (f"{DR}/fig6-published", published_rules, [], f"{DR_SETUP}; 90 000 taps",
                      "rho = 0.567, 0.578, 0.597 and 0.654 after 0, 50, 250 and 90 000 taps."),
    "dr6-readings": (f"{DR}/fig6-readings", readings, [], f"{DR_SETUP}; 90 000 taps",
                     "rho = 0.578 and 0.597 after 50 and 250 taps."),
    "dr7-9": (f"{DR}/fig7-9", poured, [], DR_GRAINS,
              "Phi falls with friction, from that of random packings without; at a friction of "
              "0.1 the range is 0.6088 +- 0.0035, and nearest neighbours are normal with mean "
              "7.2713 +- 0.0558 and width 1.2550 +- 0.0262 (cut not printed)."),
    "dr7-columns": (f"{DR}/fig7-columns", columns, [], f"{DR_GRAINS}; K1, column and window not "
                    "printed", "0.6088 +- 0.0035 at a friction of 0.1."),
    "dr10-14": (f"{DR}/fig10", tapped, [], f"{DR_GRAINS}; 898 taps",
                "At Gamma = 2 Phi grows from 0.609 to 0.6997 +- 0.0058, single beds in jumps, and "
                "layers grow from the floor; at Gamma = 0.5 almost nothing happens."),
    "both-engines": (f"{DR}/both-engines", both_engines, [], "no such figure",
                     "A comparison of Monte Carlo redeposition with discrete elements."),
    "dr15": (f"{DR}/fig15", shaken, [], "8000 spheres, periodic, L/d = 25; time of vibration and "
             "realizations not printed", "Over 0.02 <= a/d <= 0.48 and 10 <= f <= 90 Hz the solids "
             "fraction improves by at most about 5 %; none above about 0.66 was found."),
}

# figure: its pictures, of the tables of its section; points are those that the paper prints.
TAPS, STRENGTH, PHI = "taps", "eps^(1/2)", "packing fraction"
LAYERED = ((0, 0.567), (50, 0.578), (250, 0.597))
NORMAL = tuple((n, round(float(stats.norm.pdf(n, 7.2713, 1.2550)), 4)) for n in range(3, 13))
PICTURES = {
    "pb2": [Picture(TAPS, "bottom fraction", across=True, log="x")],
    "pb3": [Picture(STRENGTH, "sigma_Z, diameters", columns="^sigma_Z")],
    "pb4-bell": [Picture(STRENGTH, "corrected fraction", columns="to")],
    "pb4-eta": [Picture(TAPS, "corrected fraction", across=True, columns=r"^\d+$", log="x")],
    "pb4-hysteresis": [Picture(STRENGTH, "corrected fraction")],
    "pb4-turns": [Picture("turned back at eps^(1/2)", "corrected fraction", columns="^at|way up")],
    "pb5": [Picture("waiting time, taps", "10^4 A, square diameters", columns="lag", log="xy")],
    "pb6-8": [Picture("height, diameters", PHI, across=True),
              Picture("distance to a wall, diameters", PHI, across=True, table=1)],
    "pb6-8-periodic": [Picture("height, diameters", PHI, across=True)],
    "pb9": [Picture("sigma", "P0", columns="P0|Gotoh", log="y")],
    "pb10": [Picture(TAPS, "sphere volumes", columns="^(nu|v0)$", log="x"),
             Picture("corrected fraction", "sphere volumes", columns="^(nu|v0)$", x_column=1),
             Picture("volume of a pore, sphere volumes", "rho_v", across=True, table=1, log="y")],
    "pb-moves": [Picture("longest step, diameters", "10^4 (Phi_c(30) - Phi_c(0))", columns=r"10\^4",
                         rows="^0.25 pi", x_column=1, log="x")],
    "pb-sides": [Picture(TAPS, "corrected fraction", across=True, log="x")],
    "pb-widths": [Picture(TAPS, "corrected fraction", across=True, columns=r"^\d+$", log="x")],
    "dr2": [Picture(TAPS, PHI, across=True, log="x")],
    "dr2-wide": [Picture(TAPS, PHI, across=True, log="x")],
    "dr-shakes": [Picture(TAPS, "packing fraction, 11 to 17 d", across=True, table=2, log="x")],
    "dr-widths": [Picture(TAPS, PHI, across=True, columns=r"^\d+$", log="x")],
    "dr3": [Picture("packing fraction of the region", "neighbours within 1.05 d",
                    columns="N_c of the region", x_column=2)],
    "dr4": [Picture(TAPS, PHI, across=True, log="x")],
    "dr5": [Picture(TAPS, PHI, across=True, log="x")],
    "dr6": [Picture(TAPS, PHI, columns="^Phi$", paper=LAYERED + ((90000, 0.654),), log="x"),
            Picture("height, diameters", "share of fcc and hcp", across=True, table=1,
                    rows="^(0|50|100|250|600)$")],
    "dr6-published": [Picture(TAPS, PHI, across=True, paper=LAYERED)],
    "dr6-readings": [Picture(TAPS, PHI, across=True, paper=LAYERED[1:])],
    "dr7-9": [Picture("friction", PHI, columns="^Phi", paper=((0, 0.6366), (0.1, 0.6088))),
              Picture("neighbours within 1.05 d", "share of the spheres", across=True, table=1,
                      paper=NORMAL),
              Picture("free volume, sphere volumes", "probability density", across=True, table=2)],
    "dr7-columns": [Picture("packing fraction of the column", PHI, columns="^Phi", x_column=1,
                            rows="^100000$")],
    "dr10-14": [Picture(TAPS, PHI, across=True, paper=((0, 0.609), (898, 0.6997)), log="x"),
                Picture("height, diameters", PHI, across=True, table=2),
                Picture("height, diameters", "n(z), share of the centres in 0.2 d", across=True,
                        table=3)],
    "both-engines": [Picture(TAPS, PHI, across=True, log="x"),
                     Picture(TAPS, "nu, sphere volumes", across=True, table=2, log="x")],
    "dr15": [Picture("frequency, Hz", "improvement, %", across=True)],
}

HEAD = """# Which published figures jostle reproduces

Made by `./dev physics [--hours H] [FIGURE ...]` at low priority from scenes of reduced size ([config/scenes/](../config/scenes/)*/reduced); each scene's description lists the reductions and their biases. The scene of full size is named with its core-hours, scaled from the run here by spheres and taps. a ± b: b is half the 68 % interval by Student's t over realizations.

**Verdicts** are about the runs as they were made here, each with its test. "agrees" and "disagrees": p, corrected for all tests of the figure together (Holm 1979), is below 5 %, or the 95 % interval that is named decides (these are not corrected: one in twenty errs). Else "cannot decide", with what the same test would have found with 80 % probability. Nothing is carried over from a small bed to the paper's. Pictures show numbers of the tables below them."""

REMARK = "**Remark**: "
OUTDATED = "(Of earlier numbers.) "


def remark_of(page, figure, numbers):
    """The remark that a person wrote below the numbers, marked as outdated if the numbers have
    changed."""
    section = re.search(rf"^## {re.escape(figure)}\n.*?(?=^## |\Z)", page, re.S | re.M)
    found = section and re.match(rf"(.*)\n{re.escape(REMARK)}(.*)", section[0], re.S)
    if not found:
        return ""
    remark = found.group(2).strip()
    same = numbers in found.group(1) or remark.startswith(OUTDATED)
    return REMARK + (remark if same else OUTDATED + remark)


def setup(run):
    scene = run.scene
    zipped = scene.get("sweep", {}).get("zip", {})

    def swept(pointer, otherwise):
        values = zipped.get(pointer, [otherwise])
        return ", ".join(map(str, values[:-1])) + " and " * (len(values) > 1) + str(values[-1])
    width = scene["container"]["width"]
    size = " x ".join(f"{side:.4g}" for side in (width if isinstance(width, list) else [width] * 2))
    if "/container/width" in zipped:
        size = swept("/container/width", width)
    lengths = sorted({len(curve) - 1 for curve in run.curves("mean_height")})
    taps = str(lengths[0]) + f" to {lengths[-1]}" * (len(lengths) > 1)
    streams = ", matched streams" if scene.get("streams") == "matched" else ""
    return (f"{swept('/spheres', scene['spheres'])} spheres in {size} d, "
            f"{swept('/container/sides', scene['container']['sides'])}, {taps} taps, "
            f"{run.realizations} realizations{streams}")


def with_pictures(figure, text, page):
    """A section with its pictures, drawn beside the page, below the lines on this run and the paper."""
    text = re.sub(r"^!\[.*\n\n", "", text, flags=re.M)
    shown = []
    for k, picture in enumerate(PICTURES.get(figure, [])):
        name = figure + (f"-{k + 1}" if k else "")
        if draw(text, picture, page.parent / "figures" / f"{name}.svg"):
            circles = "; circles: the paper's numbers" if picture.paper else ""
            shown.append(f"![{figure}: {picture.y} against {picture.x}{circles}]"
                         f"(figures/{name}.svg)\n\n")
    return re.sub(r"^(\*\*Here\*\*.*\n\n)", lambda found: found[1] + "".join(shown), text, count=1,
                  flags=re.M)


def section(figure, run, others, page):
    _, write, _, paper_setup, claim = FIGURES[figure]
    numbers, statements = write(run, *others)
    verdicts = verdict_table(statements)
    parts = [f"## {figure}", f"`./dev physics {figure}`, {run.seconds / 60:.0f} core-minutes. " +
             " ".join(run.scene["description"]), f"**Here**: {setup(run)}. **The paper**: "
             f"{paper_setup}. {claim} {full_size(run)}".strip(), numbers, verdicts,
             remark_of(page, figure, numbers + "\n\n" + verdicts)]
    return "\n\n".join(part for part in parts if part) + "\n"


NOT_REACHED = "**Not reached** in the time that was given: the scene, which the next call continues."
# Put by hand where tests have changed and the run is not at hand; it goes when the figure is made.
EARLIER_TESTS = "**Of earlier tests**: the run is not at hand, and how some statements are tested has changed."
OLDER = "**Not reached** in the time that was given: the scene as it is now. Below: an earlier run."


def not_reached(figure, run, former):
    """The section of a figure whose run has not ended; the former section is kept and marked."""
    if former is None:
        return "\n\n".join([f"## {figure}", " ".join(run.scene["description"]), NOT_REACHED,
                            full_size(run)]).strip() + "\n"
    if NOT_REACHED in former or OLDER in former:
        return former
    return former.replace(f"## {figure}\n\n", f"## {figure}\n\n{OLDER}\n\n", 1)


def full_size(run):
    """The scene of the paper's size, and its cost on this machine, if a run has measured it."""
    scene = run.full_size()
    hours = scene and run.core_hours(scene)
    return f"**Full size**: [{scene.name}](../{scene}), {hours}." if scene else ""


def summary(sections):
    """One item a figure: how many of its statements hold, and which do not or are undecided."""
    items = []
    for figure in FIGURES:
        text = sections.get(figure, "")
        words = re.findall(r"^\| ([^|]*) \|.*\| \*\*(agrees|disagrees|cannot decide)\*\* \|$", text,
                           re.M)
        name = f"[{figure}](#{figure})" if text else figure
        if not words:
            items.append(f"- {name}: " + ("not reached" if text else "not made yet"))
            continue
        earlier = "an earlier run: " if OLDER in text or EARLIER_TESTS in text else ""
        parts = [earlier + f"{sum(said == 'agrees' for _, said in words)} of {len(words)} agree"]
        for word in ("disagrees", "cannot decide"):
            named = [statement for statement, said in words if said == word]
            if named:
                parts.append(f"**{word}**: " + "; ".join(named))
        items.append(f"- {name}: " + ". ".join(parts))
    return "\n".join(items)


def finished(jostle, scene, folder):
    """A run that is there already; it is not made for another figure's sake."""
    run = Run(jostle, scene, folder)
    if run.is_complete:
        run.read()
        return run
    return None


def main(jostle, folder, page, figures, deadline):
    folder.mkdir(parents=True, exist_ok=True)
    text = page.read_text() if page.exists() else ""
    sections = {part.split("\n", 1)[0]: "## " + part
                for part in re.split(r"^## ", text, flags=re.M)[1:]}
    for figure in figures or FIGURES:
        print(f"{figure} ...", flush=True)
        scene, _, others, _, _ = FIGURES[figure]
        run = Run(jostle, scene, folder)
        if not run.make(deadline):
            print(f"{figure} is not reached; the next call continues {run.path}")
            sections[figure] = not_reached(figure, run, sections.get(figure))
            write_page(page, sections)
            break
        others = [finished(jostle, other, folder) for other in others]
        sections[figure] = section(figure, run, others, text)
        print(sections[figure], flush=True)
        write_page(page, sections)


def write_page(page, sections):
    """The page, in the order of the figures, with a picture of every section."""
    ordered = [with_pictures(name, sections[name], page).strip() for name in FIGURES
               if name in sections]
    page.write_text("\n\n".join([HEAD, summary(sections)] + ordered) + "\n")


def arguments(command=None):
    parser = argparse.ArgumentParser(prog="./dev physics", allow_abbrev=False)
    for path in ("jostle", "folder", "page"):
        parser.add_argument(path, type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--hours", type=float, default=np.inf, metavar="H",
                        help="stop after H hours; the next call continues")
    parser.add_argument("figures", nargs="*", metavar="FIGURE",
                        help=f"all, or some of {', '.join(FIGURES)}")
    found = parser.parse_intermixed_args(command)
    for figure in found.figures:
        if figure not in FIGURES:
            parser.error(f"{figure}: no such figure; there are {', '.join(FIGURES)}")
    if not found.hours > 0:
        parser.error("--hours is more than 0")
    return found


if __name__ == "__main__":
    asked = arguments()
    main(asked.jostle, asked.folder, asked.page, asked.figures,
         time.monotonic() + 3600 * asked.hours)
