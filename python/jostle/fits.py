"""What `jostle fit --json` says, as objects."""

from __future__ import annotations

import dataclasses
import math
from typing import Any


def _number(value: float | None, unknown: float = math.nan) -> float:
    return unknown if value is None else float(value)


@dataclasses.dataclass(frozen=True)
class Parameter:
    """value, error (standard error): NaN where the data do not limit the parameter. interval_68,
    interval_95: by the profile of the sum of squares; an open end is infinite. statement: in words."""

    value: float
    error: float
    interval_68: tuple[float, float]
    interval_95: tuple[float, float]
    identifiability: str
    statement: str


@dataclasses.dataclass(frozen=True)
class Fit:
    """A law fitted to a curve. refused: why there is none (parameters is empty then). report: all that
    `jostle fit --json` has of it: reduced_chi2, r2, aic, covariance, remarks and more."""

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
    def restated(self) -> Fit | None:
        """The same fit in the parameters of the law that draws the same curves (eq. 4 for eq. 3), if any."""
        one = self.report.get("restated")
        if one is None:
            return None
        return Fit(one["model"], one["formula"], _parameters(one), None,
                   {key: value for key, value in self.report.items() if key != "restated"})


@dataclasses.dataclass(frozen=True)
class FittedCurve:
    """title: which curve. fits: law -> fit; a law that was fitted under another name is found by either."""

    title: str
    fits: dict[str, Fit]

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


def fitted_curves(report: dict[str, Any]) -> list[FittedCurve]:
    return [FittedCurve(curve["title"], {one["model"]: _fit(one) for one in curve["fits"]})
            for curve in report["curves"]]
