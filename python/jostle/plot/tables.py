"""Figures of derived tables: fits and analyses."""

from __future__ import annotations

import re

import numpy as np
from matplotlib.axes import Axes

from ..errors import NotThere
from ..guards import takes_arguments
from ..student import half_width
from ..tables import Table
from ..text import finite_text
from .axes import axes_or_current, errorbars, label, tap_axis


def _require(table: Table, names: str, command: str) -> None:
    missing = [name for name in names.split() if name not in table]
    if missing:
        why = table.refused or f"it has no {', '.join(missing)}: this draws tables of {command}"
        raise NotThere(f"{table.name} cannot be drawn: {why}")


@takes_arguments
def fit(table: Table, *, ax: Axes | None = None) -> Axes:
    """A law over the curve that it was fitted to: a table of /fits."""
    _require(table, "t x fitted", "jostle fit")
    ax = axes_or_current(ax)
    t = table["t"]
    observable = table.notes.get("observable", "X")
    if "x_error" in table:  # absent for a single realization
        dof = float(table.notes.get("realizations", np.inf)) - 1
        half = half_width(table["x_error"], dof)
        ax.fill_between(t, table["x"] - half, table["x"] + half, color="0.85", linewidth=0)
    ax.plot(t, table["x"], "o", color="0.4", markersize=3, label=observable.replace("_", " "))
    ax.plot(t, table["fitted"], color="C3", zorder=2,
            label=f"{table.name.rsplit('/', 1)[-1]}: {table.notes.get('law', '')}")
    if t[0] >= 0 and "observable" in table.notes:
        tap_axis(ax, t[-1])
    ax.set_ylabel(label(observable, ""))
    ax.legend(fontsize="small")
    return ax


@takes_arguments
def ageing(table: Table, *, scaled: bool = False, ax: Axes | None = None) -> Axes:
    """A(t, t_W) against the lag, one curve per waiting time, with 68 % intervals. scaled: A/A_inf against
    t/tau of the shared law, where the realizations found one."""
    names = "scaled_lag scaled_a scaled_a_error" if scaled else "a a_low_68 a_high_68"
    _require(table, f"waiting_time lag {names}", "jostle analyse ageing")
    ax = axes_or_current(ax)
    if scaled and not np.isfinite(table["scaled_a"]).any():
        raise NotThere(f"{table.name} has no scaled curves: {table['shared_verdict'][0]}")
    for i, waited in enumerate(table["waiting_time"]):
        if scaled:
            x, y = table["scaled_lag"][i], table["scaled_a"][i]
            error = table["scaled_a_error"][i]
            bars = half_width(error, float(table["realizations_fitted"]) - 1)
        else:
            x, y = table["lag"].astype(float), table["a"][i]
            bars = np.array([y - table["a_low_68"][i], table["a_high_68"][i] - y])
        known = np.isfinite(x) & np.isfinite(y) & (y > 0)
        bars = np.where(np.isfinite(bars), bars, 0)[..., known]
        ax.errorbar(x[known], y[known], bars, fmt="o-", markersize=3, linewidth=0.8,
                    label=f"$t_W$ = {waited}")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel(r"$t / \tau$" if scaled else "lag t (taps)")
    ax.set_ylabel(r"$A / A_\infty$" if scaled else f"A ({table.quantities['a'].units})")
    ax.legend(fontsize="small")
    return ax


@takes_arguments
def spectrum(table: Table, *, ax: Axes | None = None) -> Axes:
    """Power spectral density against frequency, with the slope in its band, where there is one."""
    _require(table, "frequency density density_error slope", "jostle analyse spectrum")
    ax = axes_or_current(ax)
    frequency, density = table["frequency"], table["density"]
    half = half_width(table["density_error"], float(table["density_dof"]))
    errorbars(ax, frequency, density, half)
    slope = float(table["slope"])
    band = [float(end) for end in re.findall(r"[\d.e+-]+", table.notes.get("band", ""))[:2]]
    inside = (frequency >= min(band) * (1 - 1e-9)) & (frequency <= max(band) * (1 + 1e-9)) & (density > 0) \
        if len(band) == 2 else np.zeros(frequency.shape, bool)
    if np.isfinite(slope) and inside.any():
        middle = np.log(density[inside]).mean() - slope * np.log(frequency[inside]).mean()
        error = half_width(table["slope_error"], float(table["slope_dof"]))
        ax.plot(frequency[inside], np.exp(middle) * frequency[inside] ** slope, color="C3",
                label=f"slope {finite_text(slope, '.2f')} $\\pm$ {finite_text(float(error), '.2f')}")
        ax.legend(fontsize="small")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel("frequency (1/tap)")
    ax.set_ylabel(f"power spectral density ({table.quantities['density'].units})")
    return ax


@takes_arguments
def hysteresis(table: Table, *, ax: Axes | None = None) -> Axes:
    """The value of every step against the strength of its taps, a colour a branch; the step at which the
    strength turns belongs to both."""
    control, observable = table.notes.get("control", ""), table.notes.get("observable", "")
    _require(table, f"step branch {control or 'control'} {observable}", "jostle analyse hysteresis")
    ax = axes_or_current(ax)
    strength, value, branch = table[control], table[observable], table["branch"].astype(int)
    half = half_width(table.error(observable), table.quantities[f"{observable}_dof"].values)
    for number in range(branch.max() + 1):
        steps = np.flatnonzero(branch == number)
        if number > 0:
            steps = np.concatenate([[steps[0] - 1], steps])
        rises = strength[steps[-1]] >= strength[steps[0]]
        errorbars(ax, strength[steps], value[steps], half[steps], fmt="o-", linewidth=0.8,
                  label=f"branch {number}, {'up' if rises else 'down'}")
    ax.set_xlabel(label(control, ""))
    ax.set_ylabel(label(observable, table.quantities[observable].units))
    ax.legend(fontsize="small")
    return ax


@takes_arguments
def sweep(table: Table, *, ax: Axes | None = None) -> Axes:
    """A quantity against what is swept, with its maximum and its minimum where they were found."""
    against = next(iter(table.axes), "")
    quantity = next((name for name in table.quantities if f"{name}_error" in table), "")
    _require(table, f"{against or 'axis'} {quantity or 'quantity'} maximum_at", "jostle analyse sweep")
    ax = axes_or_current(ax)
    half = half_width(table.error(quantity), table.quantities[f"{quantity}_dof"].values)
    errorbars(ax, table[against], table[quantity], half, fmt="o-", linewidth=0.8)
    for extremum, place, colour in (("maximum", "top", "C3"), ("minimum", "bottom", "C0")):
        if f"{extremum}_at" not in table:
            continue  # Older files have no minimum.
        at = float(table[f"{extremum}_at"])
        if not (np.isfinite(at) and table[f"{extremum}_p"] < 0.05):
            continue
        ax.axvline(at, color=colour, linewidth=0.8, label=f"parabola's {place} at {finite_text(at, '.3g')}")
        low, high = float(table[f"{extremum}_at_low"]), float(table[f"{extremum}_at_high"])
        if np.isfinite(low) and np.isfinite(high):
            ax.axvspan(low, high, color=colour, alpha=0.15, linewidth=0)
        ax.legend(fontsize="small")
    ax.set_xlabel(label(against, table.axes[against].units))
    ax.set_ylabel(label(quantity, table.quantities[quantity].units))
    return ax
