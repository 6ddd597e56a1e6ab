#!/usr/bin/env python3
"""Makes the sloppy sets of this folder and certifies their minima in long double.

Curves whose parameters can nearly make up for each other: an inverse log over 4000 taps (a few
points a decade, and every tap), and a stretched exponential over 1e5 taps that is 73 % relaxed.
The minimum is found by damped Gauss-Newton steps in 80-bit arithmetic, the 4 x 4 systems being
solved with 40 digits; the 95 % profile of the first parameter by holding it (threshold F(1, dof)).
Run it in this folder: python3 make_sloppy.py
"""
import json
import random

import mpmath
import numpy as np
from scipy.stats import f as fisher

mpmath.mp.dps = 40
real = np.longdouble


def inverse_log(t, p):
    """X_inf, dX, ln B, ln tau."""
    strength, tau = np.exp(p[2]), np.exp(p[3])
    log = np.log1p(t / tau)
    share = 1 / (1 + strength * log)
    slope = p[1] * share * share * strength
    return p[0] - p[1] * share, [np.ones_like(t), -share, slope * log, -slope * t / (tau + t)]


def stretched(t, p):
    """rho_inf, rho_0, ln tau, ln beta."""
    beta = np.exp(p[3])
    log = np.log(t) - p[2]
    power = np.exp(beta * log)
    left = np.exp(-power)
    change = (p[0] - p[1]) * left * power
    return p[0] - (p[0] - p[1]) * left, [1 - left, left, -change * beta, change * beta * log]


def solve(matrix, right):
    n = len(right)
    solution = mpmath.lu_solve(mpmath.matrix([[to_mp(v) for v in row] for row in matrix]),
                               mpmath.matrix([to_mp(v) for v in right]))
    return np.array([to_long(v) for v in solution])


def to_mp(value):
    high = float(value)
    return mpmath.mpf(high) + mpmath.mpf(float(value - real(high)))


def to_long(value):
    high = float(value)
    return real(high) + real(float(value - mpmath.mpf(high)))


def minimise(law, t, x, p, held=None):
    """Least squares from p; parameter number `held` keeps its value."""
    free = [j for j in range(len(p)) if j != held]
    p = np.array(p, dtype=real)
    damping = real(1e-3)
    cost = np.sum((x - law(t, p)[0]) ** 2)
    small = 0
    for _ in range(2000):
        fitted, columns = law(t, p)
        jacobian = np.array([columns[j] for j in free])
        normal = jacobian @ jacobian.T
        gradient = jacobian @ (x - fitted)
        step = solve(normal + damping * np.diag(np.diag(normal)), gradient)
        moved = p.copy()
        moved[free] += step
        new = np.sum((x - law(t, moved)[0]) ** 2)
        if np.isfinite(new) and new <= cost * (1 + real(1e-17)):
            p, cost, damping = moved, new, damping / 5
            if damping < 1e-25:
                damping = real(0)
            small = small + 1 if np.max(np.abs(step)) < 1e-15 else 0
            if small == 3:
                break
        else:
            damping = max(damping, real(1e-24)) * 4
    return p, cost, jacobian


def profile_end(law, t, x, p, cost, threshold, direction):
    """Where the profile of parameter 0 has risen by threshold x cost / dof."""
    dof = len(t) - len(p)
    limit = cost * (1 + threshold / dof)
    inner, step = p, real(direction) * real(1e-3)
    while True:
        trial = inner.copy()
        trial[0] += step
        outer, high, _ = minimise(law, t, x, trial, held=0)
        if high > limit:
            break
        inner = outer
    low_value, high_value = inner[0], outer[0]
    for _ in range(30):
        middle = inner.copy()
        middle[0] = (low_value + high_value) / 2
        found, value, _ = minimise(law, t, x, middle, held=0)
        if value > limit:
            high_value = middle[0]
        else:
            low_value, inner = middle[0], found
    return float((low_value + high_value) / 2)


def certify(law, t, x, start):
    p, cost, jacobian = minimise(law, t, x, start)
    n = len(p)
    normal = jacobian @ jacobian.T
    variance = cost / (len(t) - n)
    covariance = np.array([solve(normal, np.eye(n)[j]) for j in range(n)]) * variance
    values, errors = list(p), np.sqrt(np.diag(covariance))
    logarithmic = [2, 3]
    for j in logarithmic:
        values[j] = np.exp(p[j])
        errors[j] *= values[j]
    scale = 1 / np.sqrt(np.diag(normal))
    singular = np.linalg.svd((normal * np.outer(scale, scale)).astype(float), compute_uv=False)
    threshold = real(fisher.ppf(0.95, 1, len(t) - n))
    return {
        "certified_params": [float(v) for v in values],
        "certified_stderr": [float(e) for e in errors],
        "certified_rss": float(cost),
        "dof": len(t) - n,
        "scaled_condition_number": float(singular[0] / singular[-1]),
        "profile_95": [profile_end(law, t, x, p, cost, threshold, d) for d in (-1, 1)],
    }


def make(name, law, names, truth, taps, noise, ranges):
    draw = random.Random(20010222)
    t = np.array(taps, dtype=real)
    start = np.array([truth[0], truth[1], np.log(real(truth[2])), np.log(real(truth[3]))])
    exact = law(t, start)[0]
    y = [round(float(v) + noise * draw.gauss(0, 1), 9) for v in exact]
    x = np.array(y, dtype=real)
    result = {"name": name, "params": names, "true": truth, "noise_sd": noise,
              "x": [float(v) for v in taps], "y": y}
    result.update(certify(law, t, x, start))
    result["refits"] = []
    for last in ranges:
        part = t <= last
        p, cost, _ = minimise(law, t[part], x[part], start)
        result["refits"].append({"last": last, "params": [float(p[0]), float(p[1]), float(np.exp(p[2])),
                                                          float(np.exp(p[3]))], "rss": float(cost)})
    with open(name + ".json", "w") as file:
        json.dump(result, file, indent=None, separators=(", ", ": "))
        file.write("\n")
    print(name, {k: v for k, v in result.items() if k not in "xy"})


def spaced(last, n):
    """Taps 1 .. last, equally spaced in their logarithm, without repeats."""
    return sorted({round(last ** (k / (n - 1))) for k in range(n)})


law_names = ["X_inf", "dX", "B", "tau"]
make("IL_sloppy", inverse_log, law_names, [0.66, 0.076, 0.06, 15.0], spaced(4000, 96), 3e-4, [300, 1000])
make("IL_sloppy_every_tap", inverse_log, law_names, [0.66, 0.076, 0.06, 15.0], range(1, 4001), 3e-4,
     [1000])
make("KWW_sloppy", stretched, ["rho_inf", "rho_0", "tau", "beta"], [0.652, 0.536, 27180.0, 0.2],
     spaced(100000, 72), 3e-4, [4000])
