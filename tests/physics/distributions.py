"""Reads what beds.py has reduced: means over beds of distributions, and numbers of each bed."""
import numpy as np

from reduce import REDUCED, read_table


def realizations(run, point):
    """The realizations of a sweep point that are at hand, ascending."""
    return [int(row[1]) for row in read_table(REDUCED / run / "beds.csv")[1:] if row[0] == str(point)]


def differences(beds, others):
    """Differences of two {realization: value}, of the realizations that both have."""
    return np.array([beds[bed] - others[bed] for bed in beds if bed in others])


def beds_of_point(run, point):
    return len(realizations(run, point))


def distribution(run, point, quantity):
    """{tap: (x, mean, standard error of the mean)} over the beds of a sweep point."""
    beds, found = beds_of_point(run, point), {}
    for row in read_table(REDUCED / run / "distributions.csv")[1:]:
        if row[0] == str(point) and row[2] == quantity:
            mean, square = float(row[4]) / beds, float(row[5]) / beds
            error = np.sqrt(max(0.0, square - mean**2) / max(1, beds - 1))
            found.setdefault(int(row[1]), []).append((float(row[3]), mean, error))
    return {tap: tuple(np.array(rows).T) for tap, rows in found.items()}


def numbers(run, point, quantity, tap):
    """A number of a kept packing, [bed], in the order of the realizations."""
    return np.array([float(row[4]) for row in read_table(REDUCED / run / "structure.csv")[1:]
                     if row[0] == str(point) and row[2] == str(tap) and row[3] == quantity])


def series(run, point, observable, tap):
    """An observable at a kept tap, [bed], in the order of the realizations."""
    header, *rows = read_table(REDUCED / run / "series.csv")
    at = header.index(observable)
    return np.array([float(row[at]) for row in rows if row[0] == str(point) and row[2] == str(tap)])


def kept_taps(run, point):
    """The taps at which series are kept, ascending."""
    return sorted({int(row[2]) for row in read_table(REDUCED / run / "series.csv")[1:] if row[0] == str(point)})


def label(run, point):
    return dict(read_table(REDUCED / run / "origin.csv")[1:])[f"point {point}"]


def steady(run, point, observable):
    """The mean over the last thousand taps, [bed], in the order of the realizations."""
    header, *rows = read_table(REDUCED / run / "steady.csv")
    at = header.index(observable)
    return np.array([float(row[at]) for row in rows if row[0] == str(point)])


def spectrum(run, point):
    """(frequencies in 1/taps, log-binned power of the mean height [bed, frequency]) of a sweep point."""
    rows = [row for row in read_table(REDUCED / run / "spectrum.csv")[1:] if row[0] == str(point)]
    beds = list(dict.fromkeys(row[1] for row in rows))
    frequencies, powers = (np.array([[float(row[at]) for row in rows if row[1] == bed] for bed in beds])
                           for at in (2, 3))
    return frequencies[0], powers


def point_of(run, label_of_point):
    """The sweep point with a label."""
    return next(int(key.split()[1]) for key, text in read_table(REDUCED / run / "origin.csv")[1:]
                if text == label_of_point)
