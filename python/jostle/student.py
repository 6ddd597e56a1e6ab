"""Half the 68 % interval of a value with a standard error, by Student's t."""

from __future__ import annotations

import functools
import math

import numpy as np

from .guards import takes_arguments

LEVEL = math.erf(1 / math.sqrt(2))  # probability of one standard deviation, 68.27 %


@functools.cache
def factor(dof: float) -> float:
    """Factor of a standard error with so many degrees of freedom: 1.84 for 1, 1.06 for 9.
    NaN for fewer than 1, 1 for infinitely many."""
    if not dof >= 1:
        return math.nan
    if math.isinf(dof) or dof > 1e6:
        return 1.0
    # With t = sqrt(dof) tan(angle), the density of Student's t is a power of the cosine.
    norm = math.exp(math.lgamma((dof + 1) / 2) - math.lgamma(dof / 2)) / math.sqrt(math.pi)
    low, high = 0.0, math.pi / 2
    for _ in range(60):
        middle = (low + high) / 2
        angles = np.linspace(0, middle, 2001)
        weights = np.ones(2001)
        weights[1:-1:2], weights[2:-1:2] = 4, 2  # Simpson
        inside = 2 * norm * (weights * np.cos(angles) ** (dof - 1)).sum() * middle / 6000
        low, high = (middle, high) if inside < LEVEL else (low, middle)
    return math.sqrt(dof) * math.tan(low)


@takes_arguments
def half_width(error: np.ndarray, dof: np.ndarray | float) -> np.ndarray:
    """Returns the b of `a +- b`. error, dof: of one shape, or one dof."""
    error, dof = np.broadcast_arrays(np.asarray(error, float), np.asarray(dof, float))
    return error * np.vectorize(factor, otypes=[float])(dof) if error.size else error.copy()
