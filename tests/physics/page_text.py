"""Numbers and tables as docs/physics-results.md has them."""
import numpy as np


def mean_and_error(values):
    values = np.asarray(values)
    return values.mean(), values.std(ddof=1) / np.sqrt(values.size)


def quoted(value, error, digits=4):
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def at(curve, tap):
    return quoted(*mean_and_error(curve[tap]))


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])
