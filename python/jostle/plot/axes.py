"""Common parts of all figures."""

from __future__ import annotations

import numpy as np
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter


def axes_or_current(ax: Axes | None) -> Axes:
    return pyplot.gca() if ax is None else ax


def label(name: str, units: str) -> str:
    """A label such as "mean_height (diameter)"; a number without a unit has none."""
    words = name.replace("_", " ")
    return words if units in ("", "1") else f"{words} ({units})"


def tap_axis(ax: Axes, largest: float) -> None:
    """Logarithmic in the tap from 1 on, with tap 0 to the left of it."""
    ax.set_xscale("symlog", linthresh=1, linscale=0.4, subs=range(2, 10))
    ax.set_xlim(-0.15, max(largest * 1.2, 1.5))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda tap, _: f"{tap:g}"))
    ax.set_xlabel("tap")


def errorbars(ax: Axes, x: np.ndarray, y: np.ndarray, half: np.ndarray | None, **style: object) -> None:
    """Points that have a value, with a bar where there is an error."""
    known = np.isfinite(y)
    bars = None if half is None else np.where(np.isfinite(half), half, 0)[known]
    ax.errorbar(x[known], y[known], bars, **{"fmt": "o", "markersize": 3, **style})
