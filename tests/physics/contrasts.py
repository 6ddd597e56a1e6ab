"""Contrasts of the reduced tables: means of points less means of others, variances pooled over all points of a
column (Estimate.pooled), or each point's own (Welch 1947) where they differ. The
contrasts_of_*.py have those of data bed by bed."""
import re

import numpy as np
from scipy import optimize, stats

from reduce import REDUCED, read_table
from verdicts import Estimate

T68 = 0.5 + 0.3413447460685429


def column(run, number, name, dof, rows=None):
    """[(first cell, value, standard error)] of a column of a reduced table."""
    header, *body = read_table(REDUCED / run / f"{number}.csv")
    at = header.index(name)
    found = []
    for row in body:
        if "±" in row[at] and (rows is None or rows(row)):
            value, half = row[at].split(";")[0].split(" ± ")
            found.append((row[0], float(value), float(half) / stats.t.ppf(T68, dof)))
    return found


def contrast(points, weights, dof, pooled):
    """The weighted sum; pooled: one variance for all points of the column, of all their degrees of freedom."""
    errors = np.array([error for _, _, error in points])
    weights = np.asarray(weights, float)
    value = float(weights @ [value for _, value, _ in points])
    if pooled:
        error = np.sqrt(np.mean(errors**2) * np.sum(weights**2))
        return Estimate(value, float(error), dof * len(points))
    parts = (weights * errors)**2
    return Estimate(value, float(np.sqrt(parts.sum())), float(parts.sum()**2 / np.sum(parts**2 / dof)))


def top_of(points, x, dof):
    """The 95 % interval of the top of a parabola through all points (Fieller 1954), pooled variance."""
    x, y = np.asarray(x, float), np.array([value for _, value, _ in points])
    basis = np.column_stack([np.ones_like(x), x, x**2])
    inverse = np.linalg.inv(basis.T @ basis)
    a, b, c = inverse @ basis.T @ y
    freedom = len(points) * dof
    # Misfit of the parabola widens the interval, where it exceeds the scatter of beds.
    scatter = np.mean([error**2 for _, _, error in points])
    misfit = np.sum((y - basis @ (a, b, c))**2) / max(len(points) - 3, 1)
    cov = inverse * max(scatter, misfit)
    if misfit > scatter:
        freedom = max(len(points) - 3, 1)
    t = stats.t.ppf(0.975, freedom)
    # b + 2 c x = 0 within t errors: a quadratic in x.
    q = (4 * (c**2 - t**2 * cov[2, 2]), 4 * (b * c - t**2 * cov[1, 2]), b**2 - t**2 * cov[1, 1])
    under = q[1]**2 - 4 * q[0] * q[2]
    if q[0] <= 0 or under <= 0:
        return float(x.min()), float(x.max())
    low, high = sorted(((-q[1] - np.sqrt(under)) / (2 * q[0]), (-q[1] + np.sqrt(under)) / (2 * q[0])))
    return float(max(low, x.min())), float(min(high, x.max()))


def most_within(points, inside, outside, dof):
    """The mean of the points inside less each of those outside, own variances: where all are positive, the largest of
    the points is one of those inside."""
    weights = np.zeros((len(outside), len(points)))
    weights[:, inside] = 1 / len(inside)
    weights[np.arange(len(outside)), outside] = -1
    return [contrast(points, row, dof, False) for row in weights]


def bell():
    return column("pb4-bell", 1, "3001 to 4000", 3)


def bell_left():
    """0.10, 0.15 and 0.20 less 0.05."""
    return [contrast(bell(), [-1, 1 / 3, 1 / 3, 1 / 3, 0, 0, 0], 3, True)]


def bell_right():
    """0.10, 0.15 and 0.20 less 0.40."""
    return [contrast(bell(), [0, 1 / 3, 1 / 3, 1 / 3, 0, 0, -1], 3, True)]


def bell_within():
    """0.10, 0.15 and 0.20 less 0.05, 0.25 and every larger strength."""
    names = [float(name) for name, _, _ in bell()]
    assert names[:5] == [0.05, 0.1, 0.15, 0.2, 0.25], names
    return most_within(bell(), [1, 2, 3], [0, *range(4, len(names))], 3)


def alpha_of_strengths():
    return column("pb6-8", 3, "10^3 alpha R", 3, lambda row: row[1] == "1000")


def alpha_falls():
    return [contrast(alpha_of_strengths(), [0, 0, 1, -1], 3, True)]


def increase(name, weights):
    return contrast(column("pb6-8", 3, name, 3, lambda row: row[1] == "1000"), weights, 3, True)


def lateral_bell():
    """0.01 and 0.04 less either end."""
    return [increase("d Phi lateral", w) for w in ([-1, .5, .5, 0], [0, .5, .5, -1])]


def central_bell():
    return [increase("central", w) for w in ([-1, .5, .5, 0], [0, .5, .5, -1])]


def weak_is_frozen():
    """The gain in the centre from tap 1 to 1000 at 0.0025, minus a fifth of the gain at 0.04."""
    first = column("pb6-8", 3, "central", 3, lambda row: row[1] == "1")
    last = column("pb6-8", 3, "central", 3, lambda row: row[1] == "1000")
    return [contrast([last[0], first[0], last[2], first[2]], [-1, 1, 0.2, -0.2], 3, True)]


def lifts():
    return column("dr4", 1, "400", 2)


def best_lift():
    """0.25 and 0.3 less the weakest and less the strongest lift: variances differ as beds order."""
    return [contrast(lifts(), w, 2, False) for w in ([-1, 0, .5, .5, 0], [0, 0, .5, .5, -1])]


def best_lift_within():
    """0.2, 0.25 and 0.3 less 0.1 and 0.5."""
    return most_within(lifts(), [1, 2, 3], [0, 4], 2)


def melted():
    return column("dr5", 1, "500", 3)


def best_melted():
    return [contrast(melted(), w, 3, False) for w in ([-1, 0, .5, .5, 0], [0, 0, .5, .5, -1])]


def best_melted_top():
    return top_of(melted(), [.1, .2, .25, .3, .5], 3)


def third_layer_fills():
    """Share of the centres at 2.1 d, tap 100 less tap 0, Gamma = 2."""
    first, last = (column("dr10-14", 4, "2.1", 3, lambda row, tap=tap: row[0] == f"Gamma = 2, tap {tap}")
                   for tap in (0, 100))
    return [contrast(last + first, [1, -1], 3, False)]


def stated(run, numbers, dof):
    """The numbers that a run's statements print, [(statement, which)] -> Estimates with one variance for all of them:
    the same kind of difference between beds of one size."""
    rows = {row[0]: row[1] for row in read_table(REDUCED / run / "statements.csv")[1:]}
    pairs = [re.findall(r"(-?\d+\.?\d*) ± (\d+\.?\d*)", rows[statement])[which] for statement, which in numbers]
    halves = np.array([float(half) for _, half in pairs])
    error = np.sqrt(np.mean(halves**2)) / stats.t.ppf(T68, dof)
    return [Estimate(float(value), float(error), dof * len(pairs)) for value, _ in pairs]


SLOPE = "the spectrum falls as f^-s, s from 1 to 1.5, at eps^(1/2) = {:.3f}"


def slopes():
    """Slopes of the spectra at four strengths, one variance."""
    return stated("pb3", [(SLOPE.format(x), 0) for x in (0.15, 0.2, 0.25, 0.3)], 3)


def alpha_hysteresis():
    """10^3 alpha R at 0.40, up again less up: two visits of one strength."""
    header, *rows = read_table(REDUCED / "pb4-hysteresis" / "2.csv")
    found = [(row[0], *map(float, row[3].split(" ± "))) for row in rows if row[0] in ("8000", "22000")]
    points = [(tap, value, half / stats.t.ppf(T68, 3)) for tap, value, half in found]
    return [contrast(points, [-1, 1], 3, False)]


def grown_by_tap_100():
    """Phi at Gamma = 2, tap 100 less tap 0."""
    first, last = (column("dr10-14", 1, tap, 3, lambda row: row[0] == "Gamma = 2") for tap in ("0", "100"))
    return [contrast(first + last, [-1, 1], 3, False)]


def ages(lag):
    """ln A at a lag, age 3 less age 1000: the sum of five steps, their errors added as if they went together."""
    steps = ((3, 10), (10, 30), (30, 100), (100, 300), (300, 1000))
    parts = [stated("pb5", [(f"A falls with age: from t_W = {a} to {b} at lag {lag}", 0)], 47)[0] for a, b in steps]
    return [Estimate(sum(p.value for p in parts), sum(p.error for p in parts), 47)]


def ages_at_10():
    return ages(10)


def ages_at_100():
    return ages(100)


def eq6_is_concave():
    """ln 9 less ln A(9) / A(1), each age from 3 to 100: eq. 6 is concave in the lag and begins at 0, so that A(9) is at
    most 9 A(1). The half widths of both are added."""
    found = []
    for row in read_table(REDUCED / "pb5" / "1.csv")[1:5]:
        (first, low, high), (ninth, low_9, high_9) = (
            map(float, re.fullmatch(r"([\d.e+]+) \(([\d.e+]+) to ([\d.e+]+)\)", cell).groups()) for cell in row[1:3])
        half = np.log(high / low) / 2 + np.log(high_9 / low_9) / 2
        found.append(Estimate(float(np.log(9 * first / ninth)), float(half), 47))
    return found


def inverse_log_at_weak_lift():
    """Phi less the inverse log fitted to the means, lift 0.1, at each kept tap; the variance of all of them."""
    header, *rows = read_table(REDUCED / "dr4" / "1.csv")
    taps = np.array([0.0] + [float(name) for name in header[2:8]])
    pairs = [cell.split(" ± ") for cell in rows[0][1:8]]
    phi = np.array([float(value) for value, _ in pairs])
    error = np.sqrt(np.mean([float(half)**2 for _, half in pairs])) / stats.t.ppf(T68, 2)
    return [Estimate(float(value), float(error), 2 * len(taps)) for value in misfit_of_inverse_log(taps, phi)]


def misfit_of_means(beds, misfit):
    """Estimates of the misfit of a law to the means of beds [tap, bed]: beds differ in their levels, which are none."""
    means = beds.mean(axis=1)
    fitted = means - misfit
    return [Estimate.of(row) for row in beds - beds.mean(axis=0) - (fitted - fitted.mean())[:, None]]


def misfit_of_inverse_log(taps, phi, log_taus=np.arange(-4, 8, 0.25)):
    """Residuals of the least squares of eq. 3 of Philippe and Bideau 2001, tau from a list."""
    return min((misfit_at_tau(taps, phi, log_tau) for log_tau in log_taus), key=lambda misfit: np.sum(misfit**2))


def misfit_at_tau(taps, phi, log_tau):
    """Those of the other three parameters at one tau."""
    grown = np.log1p(taps / np.exp(log_tau))

    def residuals(b):
        basis = np.column_stack([np.ones_like(taps), 1 / (1 + np.exp(b) * grown)])
        return phi - basis @ np.linalg.lstsq(basis, phi, rcond=None)[0]
    best = optimize.minimize_scalar(lambda b: np.sum(residuals(b)**2), bounds=(-8, 4), method="bounded")
    return residuals(best.x)
