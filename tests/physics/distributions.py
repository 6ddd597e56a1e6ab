"""Reads what beds.py has reduced: means over beds of distributions, and numbers of each bed."""
import numpy as np

from reduce import REDUCED, read_table


def beds_of_points(run, *points):
    return sum(row[0] in map(str, points) for row in read_table(REDUCED / run / "beds.csv")[1:])


def distribution(run, *points_and_quantity):
    """{tap: (x, mean, standard error of the mean)} over the beds of a sweep point, or of several alike."""
    *points, quantity = points_and_quantity
    beds, sums = beds_of_points(run, *points), {}
    for row in read_table(REDUCED / run / "distributions.csv")[1:]:
        if row[0] in map(str, points) and row[2] == quantity:
            at = sums.setdefault(int(row[1]), {}).setdefault(float(row[3]), [0.0, 0.0])
            at[0] += float(row[4])
            at[1] += float(row[5])
    found = {}
    for tap, of_tap in sums.items():
        mean, square = np.array(list(of_tap.values())).T / beds
        error = np.sqrt(np.maximum(0.0, square - mean**2) / max(1, beds - 1))
        found[tap] = np.array(list(of_tap)), mean, error
    return found


def numbers(run, point, quantity, tap):
    """A number of a kept packing, [bed], in the order of the realizations."""
    return np.array([float(row[4]) for row in read_table(REDUCED / run / "structure.csv")[1:]
                     if row[0] == str(point) and row[2] == str(tap) and row[3] == quantity])


def series(run, point, observable, tap):
    """An observable at a kept tap, [bed], in the order of the realizations."""
    header, *rows = read_table(REDUCED / run / "series.csv")
    at = header.index(observable)
    return np.array([float(row[at]) for row in rows if row[0] == str(point) and row[2] == str(tap)])


def label(run, point):
    return dict(read_table(REDUCED / run / "origin.csv")[1:])[f"point {point}"]
