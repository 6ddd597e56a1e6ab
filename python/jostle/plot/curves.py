"""Curves of the ensemble, and profiles in height."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes

from ..errors import BadArgument, NotThere
from ..guards import takes_arguments
from ..point import Point
from ..results import Results
from ..student import half_width
from ..tables import Table
from .axes import axes_or_current, errorbars, label, tap_axis

LAYER = (2 / 3) ** 0.5  # diameters from one close-packed layer to the next


def _chosen(results: Results, points: Iterable[int] | int | None) -> list[Point]:
    if points is None:
        return [point for point in results.points if point.has_taps]
    return [results.points[number] for number in _several(points)]


def _several(numbers: Iterable[int] | int) -> list[int]:
    """One number, or many, of Python's or numpy's."""
    return np.atleast_1d(numbers if np.ndim(numbers) == 0 else list(numbers)).tolist()


@takes_arguments
def compaction(results: Results, observable: str, *, points: Iterable[int] | int | None = None,
               band: str = "error", ax: Axes | None = None) -> Axes:
    """The mean of an observable against the tap, of some sweep points (default: all), with a band.

    band: "error": 68 % interval of the mean; "sigma": one deviation of the realizations; "none".
    """
    ax = axes_or_current(ax)
    if band not in ("error", "sigma", "none"):
        raise BadArgument(f"band={band!r}: one of error, sigma, none")
    largest = 1
    chosen = _chosen(results, points)
    for point in chosen:
        if not point.has_taps:
            raise NotThere(f"sweep point {point.index}: none of its realizations has taps")
    for point in chosen:
        tap, mean = point.tap.astype(float), point.mean[observable]
        (line,) = ax.plot(tap, mean, label=point.label or results.scene["name"])
        if band != "none":
            half = point.sigma[observable] if band == "sigma" else \
                half_width(point.error[observable], point.count[observable].astype(float) - 1)
            ax.fill_between(tap, mean - half, mean + half, color=line.get_color(), alpha=0.25, linewidth=0)
        largest = max(largest, tap[-1])
    tap_axis(ax, largest)
    if chosen:
        ax.set_ylabel(label(observable, chosen[0].units(observable)))
    if len(chosen) > 1:
        ax.legend(fontsize="small")
    return ax


@takes_arguments
def height_histogram(results: Results, point: int = 0, taps: Iterable[int] | int | None = None, *,
                     layers: bool = True, ax: Axes | None = None) -> Axes:
    """n(z): the fraction of all centres by height, mean over realizations, of some taps (default: the
    first and the last that are kept). layers: mark where close-packed layers on the floor lie."""
    ax = axes_or_current(ax)
    snapshots = results.points[point].snapshots
    height, kept = snapshots["height"], snapshots["tap"].tolist()
    reached = [tap for tap, n in zip(kept, snapshots["height_histogram"]) if np.isfinite(n).any()]
    if not reached:
        raise NotThere(f"sweep point {point} has no histogram")
    for tap in ([*dict.fromkeys((*reached[:1], *reached[-1:]))] if taps is None else _several(taps)):
        if tap not in reached:
            raise NotThere(f"no histogram of tap {tap}; kept: {', '.join(map(str, reached))}")
        ax.plot(height, np.nanmean(snapshots["height_histogram"][kept.index(tap)], axis=0),
                label=f"tap {tap}")
    if layers:
        for place in np.arange(0.5, height[-1], LAYER):
            ax.axvline(place, color="0.8", linewidth=0.6, zorder=0)
    ax.set_xlabel("z (diameter)")
    ax.set_ylabel("n(z)")
    ax.legend(fontsize="small")
    return ax


@takes_arguments
def profile(table: Table, quantity: str = "phi", *, taps: Iterable[int] | int | None = None,
            ax: Axes | None = None) -> Axes:
    """A quantity of a structure table by height, of some taps (default: the first and the last); the
    error is that of the mean over realizations."""
    ax = axes_or_current(ax)
    table[quantity]
    along = table.quantities[quantity].axes
    if len(along) != 2 or along[0] != "tap":
        raise NotThere(f"{table.name}: {quantity} has the axes {', '.join(along) or 'none'}, not "
                       "the tap and one more axis")
    kept = table["tap"].tolist()
    error = table.error(quantity)
    for tap in ([kept[0], kept[-1]] if taps is None else _several(taps)):
        if tap not in kept:
            raise NotThere(f"{table.name} has no tap {tap}; it has {', '.join(map(str, kept))}")
        place = kept.index(tap)
        half = None if error is None else half_width(error[place], table["realizations"][place] - 1.0)
        errorbars(ax, table[along[1]], table[quantity][place], half, fmt="-", linewidth=1,
                  label=f"tap {tap}")
    ax.set_xlabel(label(along[1], table.axes[along[1]].units))
    ax.set_ylabel(label(quantity, table.quantities[quantity].units))
    ax.legend(fontsize="small")
    return ax
