"""The ensemble of a results file as a pandas data frame."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .errors import NotThere
from .point import FOLDS, Point
from .results_file import ResultsFile

try:
    import pandas
except ImportError as error:
    raise ImportError("this needs pandas, which is not installed (Debian: python3-pandas; pip: pandas)") \
        from error


def ensemble_frame(results: ResultsFile, points: Sequence[Point], observables: Sequence[str]) -> pandas.DataFrame:
    """One row per sweep point and tap that it has come to; all columns where none is named."""
    chosen = list(dict.fromkeys(observables or results.observables))
    unknown = [name for name in chosen if name not in results.observables]
    if unknown:
        raise NotThere(f"{results.path} has no {unknown[0]!r}; it has {', '.join(results.observables)}")
    names = [f"{name}_{fold}" for name in chosen for fold in FOLDS]
    coordinates = list(results.sweep.names.values())
    rows: dict[str, list[np.ndarray]] = {name: [] for name in [*coordinates, "tap", *names]}
    for point in points:
        taps = point.tap
        for name, value in zip(coordinates, _values(results, point.index)):
            rows[name].append(np.full(len(taps), value))
        rows["tap"].append(taps)
        for fold in FOLDS:
            columns, absent = getattr(point, fold), np.full(len(taps), 0 if fold == "count" else np.nan)
            for name in chosen:
                rows[f"{name}_{fold}"].append(columns[name] if name in columns else absent)
    frame = pandas.DataFrame({name: np.concatenate(parts) for name, parts in rows.items()})
    return frame.set_index([*coordinates, "tap"])


def _values(results: ResultsFile, number: int) -> list[object]:
    """Labels of the coordinates of a sweep point, in the form of the axes."""
    places = np.unravel_index(number, results.sweep.shape) if results.sweep.shape else ()
    found = {name: values[place] for axis, place in zip(results.sweep.axes, places)
             for name, values in axis.coordinates.items()}
    return [found[name] for name in results.sweep.names.values()]
