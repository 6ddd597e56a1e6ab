"""The report of `jostle fit --json` as objects."""

from __future__ import annotations

import dataclasses
import math
from typing import Any


def _number(value: float | None, unknown: float = math.nan) -> float:
    return unknown if value is None else float(value)


@dataclasses.dataclass(frozen=True)
class Parameter:
    """value, error (standard error): NaN where the data do not limit the parameter. interval_68,
    interval_95: by the profile of the sum of squares, or Student's t where realizations differ in
    shape; an open end is infinite. statement: in words."""

    value: float
    error: float
    interval_68: tuple[float, float]
    interval_95: tuple[float, float]
    identifiability: str
    statement: str


@dataclasses.dataclass(frozen=True)
class Fit:
    """A law fitted to a curve. refused: why there is none (parameters is empty then). report: all that
    `jostle fit --json` has of it: reduced_chi2, r2, covariance, remarks and more."""

    model: str
    formula: str
    parameters: dict[str, Parameter]
    refused: str | None
    report: dict[str, Any]

    @property
    def limit(self) -> Fit | None:
        """The law of fewer parameters that was fitted, where the least squares lie at a limit of this law."""
        one = self.report.get("limit")
        return None if one is None else Fit(one["model"], one["formula"], _parameters(one), None, one)

    @property
    def reported(self) -> Fit:
        """The fit with which every report leads: that of the limit where the least squares are there, else this."""
        return self.limit or self

    @property
    def restated(self) -> Fit | None:
        """This fit in the parameters of the law with identical curves (eq. 4 for eq. 3), if any."""
        one = self.report.get("restated")
        if one is None:
            return None
        return Fit(one["model"], one["formula"], _parameters(one), None,
                   {key: value for key, value in self.report.items() if key != "restated"})


@dataclasses.dataclass(frozen=True)
class HeldOut:
    """How a law predicts realizations that were held out. squared_error: mean over points, in variances of one
    realization. difference: from the leading law, with its standard error. p: p-value of the hypothesis that the law is
    as close to the mean curve as the leading law, corrected for the number of laws. worse: p < 0.05."""

    squared_error: float
    difference: float
    error: float
    p: float
    worse: bool


@dataclasses.dataclass(frozen=True)
class Choice:
    """The choice of a law by held-out realizations. law: the chosen law, None where the data do not decide. candidates:
    laws that are not worse than the leading law. verdict: in words. laws: law -> HeldOut; empty where nothing was
    compared."""

    law: str | None
    candidates: tuple[str, ...]
    verdict: str
    laws: dict[str, HeldOut]


@dataclasses.dataclass(frozen=True)
class FittedCurve:
    """title: which curve. choice: of a law, None where one law was fitted. fits: law -> fit; a law that was fitted
    under another name is found by either."""

    title: str
    fits: dict[str, Fit]
    choice: Choice | None = None

    def __getitem__(self, model: str) -> Fit:
        if model not in self.fits:
            for fit in self.fits.values():
                if fit.restated is not None and fit.restated.model == model:
                    return fit.restated
        return self.fits[model]


def _interval(ends: list[float | None]) -> tuple[float, float]:
    return _number(ends[0], -math.inf), _number(ends[1], math.inf)


def _parameter(one: dict[str, Any]) -> Parameter:
    return Parameter(_number(one["value"]), _number(one["error"]), _interval(one["interval_68"]),
                     _interval(one["interval_95"]), one["identifiability"], one["statement"])


def _parameters(one: dict[str, Any]) -> dict[str, Parameter]:
    return {name: _parameter(value) for name, value in one.get("parameters", {}).items()}


def _fit(one: dict[str, Any]) -> Fit:
    return Fit(one["model"], one.get("formula", ""), _parameters(one), one.get("refused"), one)


def _choice(one: dict[str, Any] | None) -> Choice | None:
    if one is None:
        return None
    laws = {name: HeldOut(_number(law["held_out_error"]), _number(law["difference"]), _number(law["difference_error"]),
                          _number(law["p"]), law["worse"]) for name, law in one["laws"].items()}
    return Choice(one["leading"] if one["decided"] else None, tuple(one["candidates"]), one["choice"], laws)


def fitted_curves(report: dict[str, Any]) -> list[FittedCurve]:
    return [FittedCurve(curve["title"], {one["model"]: _fit(one) for one in curve["fits"]},
                        _choice(curve.get("comparison")))
            for curve in report["curves"]]
