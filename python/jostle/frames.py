"""Results as pandas data frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .point import FOLDS

try:
    import pandas
except ImportError as error:
    raise ImportError("this needs pandas, which is not installed (Debian: python3-pandas; pip: pandas)") \
        from error

if TYPE_CHECKING:
    from .results import Results
    from .tables import Table


def ensemble_frame(results: Results) -> pandas.DataFrame:
    """A row a sweep point and tap that it has come to."""
    names = [f"{name}_{fold}" for name in results.observables for fold in FOLDS]
    coordinates = list(results.sweep.names.values())
    rows: dict[str, list[np.ndarray]] = {name: [] for name in [*coordinates, "tap", *names]}
    for point in results.points:
        taps = point.tap
        for name, value in zip(coordinates, _values(results, point.index)):
            rows[name].append(np.full(len(taps), value))
        rows["tap"].append(taps)
        for name in names:
            observable, fold = name.rsplit("_", 1)
            here = observable in point.observables
            rows[name].append(getattr(point, fold)[observable] if here else
                              np.full(len(taps), 0 if fold == "count" else np.nan))
    frame = pandas.DataFrame({name: np.concatenate(parts) for name, parts in rows.items()})
    return frame.set_index([*coordinates, "tap"])


def _values(results: Results, number: int) -> list[object]:
    """Of the coordinates of a sweep point, as the axes have them."""
    places = np.unravel_index(number, results.sweep.shape) if results.sweep.shape else ()
    found = {name: values[place] for axis, place in zip(results.sweep.axes, places)
             for name, values in axis.coordinates.items()}
    return [found[name] for name in results.sweep.names.values()]


def table_frame(table: Table) -> pandas.DataFrame:
    """The quantities that stand along all axes of most of them: see Table.to_pandas."""
    along = max((quantity.axes for quantity in table.quantities.values()), key=len, default=())
    return frame_along(table, along)


def frame_along(table: Table, along: tuple[str, ...]) -> pandas.DataFrame:
    chosen = {name: quantity.values.reshape(-1) if along else [quantity.values[()]]
              for name, quantity in table.quantities.items() if quantity.axes == along}
    if not along:
        return pandas.DataFrame(chosen)
    index = pandas.MultiIndex.from_product([table.axes[name].values for name in along], names=along)
    return pandas.DataFrame(chosen, index=index if len(along) > 1 else index.get_level_values(0))
