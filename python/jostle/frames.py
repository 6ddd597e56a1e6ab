"""Results as pandas data frames."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .errors import NotThere
from .point import FOLDS

try:
    import pandas
except ImportError as error:
    raise ImportError("this needs pandas, which is not installed (Debian: python3-pandas; pip: pandas)") \
        from error

if TYPE_CHECKING:
    from .results import Results
    from .tables import Table


def ensemble_frame(results: Results, observables: Sequence[str]) -> pandas.DataFrame:
    """A row a sweep point and tap that it has come to; all columns where none is named."""
    chosen = observables or results.observables
    unknown = [name for name in chosen if name not in results.observables]
    if unknown:
        raise NotThere(f"{results.path} has no {unknown[0]!r}; it has {', '.join(results.observables)}")
    names = [f"{name}_{fold}" for name in chosen for fold in FOLDS]
    coordinates = list(results.sweep.names.values())
    rows: dict[str, list[np.ndarray]] = {name: [] for name in [*coordinates, "tap", *names]}
    for point in results.points:
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


def _values(results: Results, number: int) -> list[object]:
    """Labels of the coordinates of a sweep point, in the form of the axes."""
    places = np.unravel_index(number, results.sweep.shape) if results.sweep.shape else ()
    found = {name: values[place] for axis, place in zip(results.sweep.axes, places)
             for name, values in axis.coordinates.items()}
    return [found[name] for name in results.sweep.names.values()]


def table_frame(table: Table) -> pandas.DataFrame:
    """The quantities with the most common set of axes: see Table.to_pandas."""
    along = max((quantity.axes for quantity in table.quantities.values()), key=len, default=())
    return frame_along(table, along)


def frame_along(table: Table, along: tuple[str, ...]) -> pandas.DataFrame:
    unknown = [name for name in along if name not in table.axes]
    if unknown:
        raise NotThere(f"{table.name} has no axis {unknown[0]!r}; it has {', '.join(table.axes) or 'none'}")
    chosen = {name: quantity.values.reshape(-1) if along else [quantity.values[()]]
              for name, quantity in table.quantities.items() if quantity.axes == along}
    if not along:
        return pandas.DataFrame(chosen)
    index = pandas.MultiIndex.from_product([table.axes[name].values for name in along], names=along)
    return pandas.DataFrame(chosen, index=index if len(along) > 1 else index.get_level_values(0))
