"""Figures of the catalogue (docs/developers/catalogue.md), which `jostle report --catalogue` describes, as matplotlib draws them.

Texts are text: no character of a figure begins mathematics or a command. "N_c", "Φ_b" get their subscript.
"""

from __future__ import annotations

import contextlib
import math
import re
from collections.abc import Iterator, Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import AutoMinorLocator, FixedLocator, FuncFormatter, MaxNLocator, NullFormatter, NullLocator
from matplotlib.transforms import blended_transform_factory

from .values import fixed, number, superscript, tick_text

COLUMN_WIDTHS = {1: 86.0, 1.5: 120.0, 2: 178.0}  # mm, of a journal
MM = 1 / 25.4
INK, RULE = "#222222", "#777777"
TAP_ZERO = 0.28    # where a logarithmic axis of taps shows tap 0
NARROW_TAPS = 30   # with no tap beyond, the axis of taps is linear
DASHES: list[Any] = ["solid", (0, (4, 2)), (0, (1.2, 1.4)), (0, (5, 1.5, 1.2, 1.5))]
SYMBOLS = "osD^vPX*"
LONGEST_NAMES = (60, 44, 32, 22, 14)  # letters in a legend: as many as there is room for
FONTS = ("Arial", "Helvetica", "Liberation Sans", "Nimbus Sans", "DejaVu Sans")

Description = dict[str, Any]


@contextlib.contextmanager
def style() -> Iterator[None]:
    """Settings of matplotlib that are equal on every machine: the user's settings do not count."""
    known = set(font_manager.fontManager.get_font_names())
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update({
            "font.family": [font for font in FONTS if font in known] or ["DejaVu Sans"], "font.size": 8,
            "mathtext.fontset": "dejavusans", "mathtext.default": "regular",
            "axes.linewidth": 0.6, "axes.labelsize": 8, "axes.titlesize": 8, "axes.unicode_minus": True,
            "axes.spines.top": False, "axes.spines.right": False, "text.color": INK, "axes.labelcolor": INK,
            "axes.edgecolor": INK, "xtick.color": INK, "ytick.color": INK, "xtick.labelsize": 7.5, "ytick.labelsize": 7.5,
            "xtick.major.width": 0.6, "ytick.major.width": 0.6, "xtick.minor.width": 0.4, "ytick.minor.width": 0.4,
            "xtick.major.size": 3, "ytick.major.size": 3, "xtick.minor.size": 1.7, "ytick.minor.size": 1.7,
            "lines.linewidth": 1.1, "lines.markersize": 3.2, "legend.fontsize": 7.5, "legend.frameon": False,
            "svg.fonttype": "none", "svg.hashsalt": "jostle", "pdf.fonttype": 42, "path.simplify": True})
        yield


def typeset(text: str) -> str:
    """A text as matplotlib shows it letter by letter, with the subscripts of symbols as "N_c"."""
    line = re.sub(r"\s", " ", text).replace("$", r"\$")
    # Mathematics of matplotlib ends at U+1FFFF.
    line = re.sub(r"(?<![\w\\$])([^\W\d_])_(\w|\u221e)(?<![\U00020000-\U0010ffff])(?!\w)", r"\1$_{\2}$", line)
    pieces = re.split(r"(\$_\{.\}\$)", line)
    if len(pieces) == 1:
        return line
    # Letters beside a subscript have the first font alone: the letters missing there become symbols of mathematics.
    # A letter behind a backslash stays, because the backslash would change the dollar.
    font = font_manager.get_font(font_manager.findfont(font_manager.FontProperties()))

    def symbol(letter: re.Match[str]) -> str:
        return letter[0] if font.get_char_index(ord(letter[0])) else f"${letter[0]}$"

    pieces[::2] = [re.sub(r"(?<!\\)[\u0080-\U0001ffff]", symbol, piece) for piece in pieces[::2]]
    return "".join(pieces)


def _numbers(series: Description, name: str) -> np.ndarray:
    known = {"inf": math.inf, "-inf": -math.inf, None: math.nan}
    values = series.get(name)
    if values is None:
        return np.full(len(series["x"]), math.nan)
    return np.array([known.get(value, value) if value is None or isinstance(value, str) else value for value in values], dtype=float)


class _Series:
    """One series with its places on the axes and the ends of its errors; rows that cannot be drawn are left out."""

    def __init__(self, description: Description, x_scale: str, y_scale: str) -> None:
        self.about = description
        x, y = _numbers(description, "x"), _numbers(description, "y")
        low, high, error = (_numbers(description, name) for name in ("low", "high", "error"))
        low = np.where(np.isnan(low), y - error, low)
        high = np.where(np.isnan(high), y + error, high)
        there = np.isfinite(x) & np.isfinite(y)
        there &= (x > 0) | (x_scale != "log")
        there &= (y > 0) | (y_scale != "log")
        self.zero = (x <= 0)[there] if x_scale == "taps" else np.zeros(int(there.sum()), bool)
        self.x, self.y = np.where(x <= 0, TAP_ZERO, x)[there] if x_scale == "taps" else x[there], y[there]
        self.low = np.where(np.isnan(low), y, low)[there]
        self.high = np.where(np.isnan(high), y, high)[there]
        labels = description.get("labels") or [""] * len(x)
        self.labels = [label for label, is_there in zip(labels, there) if is_there]

    @property
    def has_errors(self) -> bool:
        return bool((self.low < self.high).any())


def _x_scale(panels: list[Description]) -> str:
    scale = panels[0]["x"]["scale"]
    if scale != "taps":
        return str(scale)
    places = np.concatenate([_numbers(series, "x") for panel in panels for series in panel["series"]] or [np.zeros(1)])
    return "taps" if np.nanmax(places, initial=0) > NARROW_TAPS else "linear"


def _extent(series: list[_Series], axis: Description, scale: str, rules: list[float]) -> tuple[float, float]:
    """The values that an axis of y must show. A logarithmic axis leaves out errors as large as their value, which
    would reach down without end, and laws beside the data, which may have any size."""
    values = [np.array(rules)]
    for one in series:
        if scale == "log":
            if one.about.get("no_band"):
                continue
            values += [one.y, one.high, one.low[one.low > one.y / 10]]
        else:
            values += [one.y, one.low, one.high]
    return _with_margin(np.concatenate(values), axis, scale)


def _with_margin(values: np.ndarray, axis: Description, scale: str) -> tuple[float, float]:
    values = values[np.isfinite(values) & ((values > 0) | (scale != "log"))]
    if len(values) == 0:
        return (1, 10) if scale == "log" else (0, 1)
    low, high = float(values.min()), float(values.max())
    if scale in ("log", "taps"):
        margin = max((high / low) ** 0.04, 1.06)
        return low / margin, high * margin
    if axis.get("from_zero"):
        low, high = min(low, 0.0), max(high, 0.0)
    if low == high:
        return (0, 1) if low == 0 else (low - abs(low) * 0.1, high + abs(high) * 0.1)
    margin = 0.04 * (high - low)
    at_zero = axis.get("from_zero")
    return low - (0 if at_zero and low == 0 else margin), high + (0 if at_zero and high == 0 else margin)


def _power(value: float) -> str:
    power = round(math.log10(value))
    return f"10{superscript(power)}" if abs(power) > 3 else number(value, 3)


def _logarithmic(axis: Any, low: float, high: float) -> None:
    """Whole decades, or, where there are few, their 2, 3 and 5 too."""
    decades = range(math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9) + 1)
    step = max(1, math.ceil(math.log10(high / low) / 7))
    ticks = [10.0 ** k for k in decades if k % step == 0]
    between = [m * 10.0 ** k for k in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1) for m in range(2, 10)
               if low <= m * 10.0 ** k <= high]
    if len(ticks) < 2:
        few = [value for value in between if round(value / 10 ** math.floor(math.log10(value) + 1e-9)) in (2, 3, 5)]
        ticks = sorted(ticks + (few if len(few) + len(ticks) > 1 else between))
        if len(ticks) < 2:  # less than from one digit to the next
            ticks = [value for value in MaxNLocator(4).tick_values(low, high) if low <= value <= high]
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_minor_locator(FixedLocator(between) if step == 1 else NullLocator())
    axis.set_major_formatter(FuncFormatter(
        lambda value, _: _power(value) if abs(math.log10(value) % 1) < 1e-9 else number(value, 3)))
    axis.set_minor_formatter(NullFormatter())


def _taps(ax: Axes, high: float, has_zero: bool) -> None:
    decades = [10.0 ** k for k in range(math.floor(math.log10(high) + 1e-9) + 1)]
    ax.xaxis.set_major_locator(FixedLocator(([TAP_ZERO] if has_zero else []) + decades))
    ax.xaxis.set_minor_locator(FixedLocator([m * k for k in decades for m in range(2, 10) if m * k <= high]))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: "0" if value < 1 else _power(value)))
    ax.xaxis.set_minor_formatter(NullFormatter())
    if has_zero:  # the axis is broken between tap 0 and tap 1
        place = blended_transform_factory(ax.transData, ax.transAxes)
        ax.plot([0.5, 0.56], [0, 0], transform=place, clip_on=False, color=INK, linestyle="none", zorder=5,
                marker=[(-0.4, -1), (0.4, 1)], markersize=5, markeredgewidth=0.6)


def _linear(axis: Any, values: np.ndarray, most: int) -> None:
    whole = bool(len(values)) and bool(np.all(values == np.round(values)))
    axis.set_major_locator(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10], integer=whole))
    axis.set_minor_locator(NullLocator() if whole else AutoMinorLocator(2))
    low, high = axis.get_view_interval()
    ticks = [tick_text(value) for value in axis.get_major_locator().tick_values(low, high)]
    decimals = max(len(text.partition(".")[2]) for text in ticks)
    plain = not any("\u00d7" in text for text in ticks)
    axis.set_major_formatter(FuncFormatter(lambda value, _: fixed(value, decimals) if plain else tick_text(value)))


def _names(ax: Axes, names: list[str]) -> None:
    ax.xaxis.set_major_locator(FixedLocator(range(len(names))))
    ax.xaxis.set_minor_locator(NullLocator())
    shown = [typeset(name) for name in names]
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: shown[round(value)]))
    for label in ax.get_xticklabels():
        label.update({"rotation": 30, "ha": "right", "rotation_mode": "anchor"})
    ax.tick_params(axis="x", length=2)


def _look(series: Description) -> Description:
    """Draws the error bars of a series of points."""
    colour = series["colour"]["light"]
    return {"marker": SYMBOLS[series["symbol"] % len(SYMBOLS)], "markeredgewidth": 0.7, "markeredgecolor": colour, "color": colour,
            "markerfacecolor": "white" if series.get("hollow") else colour}


def _draw_series(ax: Axes, one: _Series, bottom: float, order: float) -> None:
    about = one.about
    colour, mark = about["colour"]["light"], about["mark"]
    later = ~one.zero
    low = np.maximum(one.low, bottom)
    dash = DASHES[about["dash"] % len(DASHES)]
    if about.get("thin"):
        ax.plot(one.x[later], one.y[later], color=colour, alpha=0.45, linewidth=0.4, zorder=order - 0.4)
        return
    if mark == "line":
        if one.has_errors and not about.get("no_band"):
            ax.fill_between(one.x[later], low[later], one.high[later], color=colour, alpha=0.2, linewidth=0, zorder=order - 0.5)
        ax.plot(one.x[later], one.y[later], color=colour, linestyle=dash, zorder=order)
        alone = one.zero | (later.sum() == 1)
        if alone.any() and not about.get("guide"):
            _draw_points(ax, one, low, alone, {**_look({**about, "symbol": 0}), "zorder": order})
        return
    if mark != "points":
        ax.plot(one.x[later], one.y[later], color=colour, linestyle=dash, linewidth=0.8, zorder=order - 0.2,
                drawstyle="steps-post" if mark == "steps" else "default")
    _draw_points(ax, one, low, np.ones(len(one.x), bool), {**_look(about), "zorder": order})
    if about.get("labelled"):
        for x, y, label in zip(one.x, one.y, one.labels):
            ax.annotate(typeset(_cut(label)), (x, y), (0, 4), textcoords="offset points", ha="center", fontsize=6.5, zorder=9)


def _draw_points(ax: Axes, one: _Series, low: np.ndarray, chosen: np.ndarray, look: Description) -> None:
    bars = chosen & (low < one.high)
    ax.vlines(one.x[bars], low[bars], one.high[bars], color=look["color"], linewidth=0.7, zorder=look["zorder"] - 0.1)
    size = 2.0 if chosen.sum() > 120 else 3.2
    ax.plot(one.x[chosen], one.y[chosen], linestyle="none", markersize=size, **look)


def _draw_panel(ax: Axes, panel: Description, x_scale: str, width: float) -> None:
    y_scale = panel["y"]["scale"]
    series = [_Series(one, x_scale, y_scale) for one in panel["series"]]
    rules = panel.get("rules", [])
    xs = np.concatenate([one.x for one in series] + [np.array([rule["x"] for rule in rules if "x" in rule], dtype=float)])
    if any(one.about.get("labelled") for one in series) and x_scale == "log" and len(xs):
        xs = np.append(xs, [xs.min() / 2, xs.max() * 2])  # room for the labels at the ends
    low, high = _with_margin(xs, panel["x"], x_scale)
    bottom, top = _extent(series, panel["y"], y_scale, [rule["y"] for rule in rules if "y" in rule])
    low, high = panel["x"].get("low", low), panel["x"].get("high", high)
    bottom, top = panel["y"].get("low", bottom), panel["y"].get("high", top)
    has_zero = x_scale == "taps" and any(one.zero.any() for one in series)
    if x_scale in ("log", "taps"):
        ax.set_xscale("log")
    if y_scale == "log":
        ax.set_yscale("log")
    ax.set_xlim(*((-0.5, len(panel["x"]["names"]) - 0.5) if x_scale == "names" else (low, high)))
    ax.set_ylim(bottom, top)
    if x_scale == "taps":
        _taps(ax, high, has_zero)
    elif x_scale == "log":
        _logarithmic(ax.xaxis, low, high)
    elif x_scale == "names":
        _names(ax, panel["x"]["names"])
    else:
        _linear(ax.xaxis, xs, 5 if width < 100 else 9)
    if y_scale == "log":
        _logarithmic(ax.yaxis, bottom, top)
    else:
        _linear(ax.yaxis, np.concatenate([one.y for one in series] or [np.zeros(0)]), 6)
    for rule in rules:
        (ax.axvline if "x" in rule else ax.axhline)(rule.get("x", rule.get("y")), color=RULE, linewidth=0.6, linestyle=(0, (2, 2)), zorder=1)
    for i, one in enumerate(series):
        _draw_series(ax, one, bottom if y_scale == "log" else -math.inf, 2 + 0.01 * i)
    ax.set_ylabel(typeset(panel["y"]["label"]))


def _cut(name: str, longest: int = LONGEST_NAMES[0]) -> str:
    return name if len(name) <= longest else name[:longest - 1] + "\u2026"


def _legend_entries(panel: Description) -> tuple[list[Line2D], list[str]]:
    """None where only one series has a name."""
    named = [series for series in panel["series"] if series["name"] and not series.get("thin")]
    if len(named) < 2:
        return [], []
    handles = []
    for series in named:
        is_line = series["mark"] == "line"
        look = {"color": series["colour"]["light"]} if is_line else _look(series)
        dash = "none" if series["mark"] == "points" else DASHES[series["dash"] % len(DASHES)]
        handles.append(Line2D([], [], linestyle=dash, linewidth=1.1 if is_line else 0.8, **look))
    return handles, [series["name"] for series in named]


def _add_legend(ax: Axes, handles: list[Line2D], names: list[str], width: float, renderer: Any) -> float:
    """Above the axes, in as many columns as there is room for; the height that it takes, mm."""
    layouts = [(LONGEST_NAMES[0], columns) for columns in range(min(len(handles), 6), 0, -1)]
    for most, columns in layouts + [(most, 1) for most in LONGEST_NAMES[1:]]:
        rows = math.ceil(len(handles) / columns)
        order = [row * columns + column for column in range(columns) for row in range(rows) if row * columns + column < len(handles)]
        legend = ax.legend([handles[i] for i in order], [typeset(_cut(names[i], most)) for i in order], loc="lower left",
                           bbox_to_anchor=(0, 1), ncol=columns, borderaxespad=0.2, borderpad=0, handlelength=2, columnspacing=1.2, labelspacing=0.25)
        box = legend.get_window_extent(renderer)
        if box.width <= width * MM * ax.figure.dpi:
            break
    return float(box.height / ax.figure.dpi / MM) + 1.2


def draw(figure: Description, *, columns: float = 1) -> Figure:
    """A figure of the catalogue for a journal of so many columns' width: 1 (86 mm), 1.5 (120 mm) or 2 (178 mm). Returns
    matplotlib's figure, with one of its axes for each panel."""
    if columns not in COLUMN_WIDTHS:
        raise ValueError(f"columns={columns!r}: 1, 1.5 or 2")
    with style():
        return _draw(figure["panels"], COLUMN_WIDTHS[columns])


def _draw(panels: list[Description], width: float) -> Figure:
    first, other, between, margin = (48.0, 20.0, 3.0, 2.5) if width < 100 else (80.0, 32.0, 4.0, 2.5)
    x_scale = _x_scale(panels)
    heights = [first] + [other] * (len(panels) - 1)
    figure = Figure(figsize=(width * MM, (sum(heights) + 40) * MM), dpi=100)
    renderer = FigureCanvasAgg(figure).get_renderer()
    all_axes = [figure.add_axes((0.2, 0.8 - 0.1 * i, 0.75, 0.1), label=f"panel {i}") for i in range(len(panels))]
    for ax, panel, height in zip(all_axes, panels, heights):
        ax.set_position((0.2, 0.2, (width - 20) / width, height / (sum(heights) + 40)))
        _draw_panel(ax, panel, x_scale, width)
        if ax is not all_axes[-1]:
            ax.tick_params(labelbottom=False)
    all_axes[-1].set_xlabel(typeset(panels[-1]["x"]["label"]))

    def mm(pixels: float) -> float:
        return float(pixels / figure.dpi / MM)

    left = max(mm(ax.bbox.x0 - ax.yaxis.get_tightbbox(renderer).x0) for ax in all_axes) + margin
    bottom = mm(all_axes[-1].bbox.y0 - all_axes[-1].xaxis.get_tightbbox(renderer).y0) + margin
    handles, names = _legend_entries(panels[0])
    above = _add_legend(all_axes[0], handles, names, width - left - margin, renderer) if handles else 0.0
    height = bottom + sum(heights) + between * (len(panels) - 1) + above + margin
    figure.set_size_inches(width * MM, height * MM)
    top = height - margin - above
    for ax, own in zip(all_axes, heights):
        ax.set_position((left / width, (top - own) / height, (width - left - margin) / width, own / height))
        top -= own + between
    figure.align_ylabels(all_axes)
    return figure


def save(figure: Figure, path: Any, *, kinds: Sequence[str] = ("pdf", "svg")) -> None:
    """Writes PATH.pdf and PATH.svg, the same bytes on every day; letters are text in both. One of these suffixes at the
    end of PATH is dropped."""
    name = str(path)
    for kind in kinds:
        name = name.removesuffix(f".{kind}")
    with style():
        for kind in kinds:
            figure.savefig(f"{name}.{kind}", metadata={"Creator": "jostle", "Date" if kind == "svg" else "CreationDate": None})
