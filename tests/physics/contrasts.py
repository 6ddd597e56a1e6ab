"""Contrasts of the reduced tables: means of points less means of others, variances pooled over all points of a
column (Estimate.pooled), or each point's own (Welch 1947) where they differ."""
import numpy as np
from scipy import stats

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
    t = stats.t.ppf(0.975, freedom)
    # b + 2 c x = 0 within t errors: a quadratic in x.
    q = (4 * (c**2 - t**2 * cov[2, 2]), 4 * (b * c - t**2 * cov[1, 2]), b**2 - t**2 * cov[1, 1])
    under = q[1]**2 - 4 * q[0] * q[2]
    if q[0] <= 0 or under <= 0:
        return float(x.min()), float(x.max())
    low, high = sorted(((-q[1] - np.sqrt(under)) / (2 * q[0]), (-q[1] + np.sqrt(under)) / (2 * q[0])))
    return float(max(low, x.min())), float(min(high, x.max()))


def bell():
    return column("pb4-bell", 1, "3001 to 4000", 3)


def bell_left():
    """0.10, 0.15 and 0.20 less 0.05."""
    return [contrast(bell(), [-1, 1 / 3, 1 / 3, 1 / 3, 0, 0, 0], 3, True)]


def bell_right():
    """0.10, 0.15 and 0.20 less 0.40."""
    return [contrast(bell(), [0, 1 / 3, 1 / 3, 1 / 3, 0, 0, -1], 3, True)]


def bell_top():
    """From 0.05 to 0.25, symmetrical about the printed interval: a parabola does not fit all seven."""
    points = bell()[:5]
    return top_of(points, [float(name) for name, _, _ in points], 3)


def alpha_of_strengths():
    return column("pb6-8", 3, "10^3 alpha R", 3, lambda row: row[1] == "1000")


def alpha_rises():
    return [contrast(alpha_of_strengths(), [-1, 1 / 3, 1 / 3, 1 / 3], 3, True)]


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
    """What 0.0025 gains in the centre from tap 1 to 1000, as a share of what 0.04 does, less a fifth."""
    first = column("pb6-8", 3, "central", 3, lambda row: row[1] == "1")
    last = column("pb6-8", 3, "central", 3, lambda row: row[1] == "1000")
    return [contrast([last[0], first[0], last[2], first[2]], [-1, 1, 0.2, -0.2], 3, True)]


def nu_steps():
    """Falls of nu from each kept tap to the next, where Phi_c rises each time."""
    points = column("pb10", 1, "nu", 2)
    return [contrast(points, [float(i == k) - float(i == k + 1) for i in range(5)], 2, True) for k in range(4)]


def moves(*weights):
    """Of gains at d_max = 0.1, weights over theta_0; the variance of all thirty settings."""
    header = read_table(REDUCED / "pb-moves" / "1.csv")[0]
    points = [column("pb-moves", 1, name, 2) for name in header[1:]]
    error = np.sqrt(np.mean([e**2 for names in points for _, _, e in names]))
    gains = [[value for _, value, _ in names] for names in points]
    value = sum(weight * 1e-4 * gains[j][i] for i, j, weight in weights)
    return Estimate(float(value), float(1e-4 * error * np.sqrt(sum(w**2 for *_, w in weights))), 60)


def optimum_of_angle():
    """The gain at pi/4 less that at pi/8, 3 pi/8 and pi/2."""
    return [moves((3, 2, 1), (k, 2, -1)) for k in (1, 4, 5)]


def wide_angle_loses():
    return [moves((3, 2, 1), (5, 2, -1))]


def small_angle_decompacts():
    return [moves((0, 2, -1))]


def short_steps_freeze():
    return [moves((3, 2, 1), (3, 0, -1))]


def long_steps_freeze():
    return [moves((3, 2, 1), (3, 4, -1))]


def lifts():
    return column("dr4", 1, "400", 2)


def best_lift():
    """0.25 and 0.3 less the weakest and less the strongest lift: variances differ as beds order."""
    return [contrast(lifts(), w, 2, False) for w in ([-1, 0, .5, .5, 0], [0, 0, .5, .5, -1])]


def best_lift_top():
    return top_of(lifts(), [.1, .2, .25, .3, .5], 2)


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


def window(observable, point, tap, other=None):
    """The mean over realizations of a series of dr6-windows at a tap, less that at another."""
    header, *rows = read_table(REDUCED / "dr6-windows" / "series.csv")
    at = header.index(observable)

    def values(when):
        return np.array([float(row[at]) for row in rows if row[0] == str(point) and row[2] == str(when)])
    return [Estimate.of(values(tap) - (0 if other is None else values(other)))]


def floor_15_at_0():
    return window("floor_15", 1, 0)


def floor_15_at_50():
    return window("floor_15", 1, 50)


def floor_15_at_250():
    return window("floor_15", 1, 250)


def floor_15_gain():
    return window("floor_15", 1, 250, 50)


def floor_18_at_0():
    return window("floor_18", 1, 0)


def floor_18_at_50():
    return window("floor_18", 1, 50)


def floor_18_at_250():
    return window("floor_18", 1, 250)


def short_step_at_50():
    return window("floor_15", 0, 50)


def short_step_at_250():
    return window("floor_15", 0, 250)


def floor_stop_at_250():
    return window("floor_15", 2, 250)


def floor_stop_later_at_250():
    return window("floor_15", 3, 250)


def middle_at_250():
    return window("bulk_fraction", 1, 250)


def neighbours_are_normal():
    """R2 of a normal law with its own mean and width through the shares at a friction of 0.1."""
    header, *rows = read_table(REDUCED / "dr7-9" / "2.csv")
    row = next(row for row in rows if row[0].endswith("friction 0.1"))
    shares = np.array([float(cell.split(" ± ")[0]) for cell in row[1:]])
    counts = np.array(header[1:], float)
    mean = shares @ counts / shares.sum()
    width = np.sqrt(shares @ (counts - mean)**2 / shares.sum())
    misfit = np.sum((shares - stats.norm.pdf(counts, mean, width))**2)
    r2 = float(1 - misfit / np.sum((shares - shares.mean())**2))
    return r2, r2
