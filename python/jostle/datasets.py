"""Results as xarray datasets, whose arrays are read when they are used."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np

from .guards import reads_file
from .point import FOLDS, STATUS
from .results_file import ResultsFile
from .text import attribute

try:
    import xarray
    from xarray.backends import BackendArray
    from xarray.core import indexing
except ImportError as error:
    raise ImportError("this needs xarray, which is not installed (Debian: python3-xarray; pip: xarray). "
                      "Without it, points[i].mean[name] and points[i].series[name] are numpy arrays") from error


@reads_file
class SweptArray(BackendArray):
    """A dataset of every sweep point as one array, [axes of the sweep ..., rest ...].

    `path`: of the dataset, with {} for the point's name. Where a point has none, or a shorter one, is
    `fill`.
    """

    def __init__(self, results: ResultsFile, path: str, rest: tuple[int, ...], dtype: Any,
                 fill: Any) -> None:
        self._results, self._path, self._fill = results, path, fill
        self._rest = rest
        self.shape = results.sweep.shape + rest
        self.dtype = np.dtype(dtype)

    def __getitem__(self, key: Any) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER,
                                                  self._read)

    def _read(self, key: tuple[Any, ...]) -> np.ndarray:
        n_axes = len(self._results.sweep.shape)
        numbers = np.arange(len(self._results.sweep.labels)).reshape(self._results.sweep.shape)
        chosen = _outer(numbers, key[:n_axes])
        rest = key[n_axes:]
        shape = _outer(np.broadcast_to(np.int8(0), self._rest), rest).shape
        found = np.empty(chosen.shape + shape, self.dtype)
        for place, number in np.ndenumerate(chosen):
            found[place] = _outer(self._of_point(int(number)), rest)
        return found

    def _of_point(self, number: int) -> np.ndarray:
        padded = np.full(self._rest, self._fill, self.dtype)
        dataset = self._results.file.get(self._path.format(f"point_{number:04}"))
        if dataset is not None:
            padded[tuple(slice(n) for n in dataset.shape)] = dataset[()]
        return padded


def _outer(values: np.ndarray, key: tuple[Any, ...]) -> np.ndarray:
    """values[key], each index applied to its own axis; whole numbers take the axis away."""
    for axis in reversed(range(len(key))):
        values = np.take(values, key[axis], axis) if not isinstance(key[axis], slice) else \
            values[(slice(None),) * axis + (key[axis],)]
    return np.asarray(values)


def _coordinates(results: ResultsFile) -> dict[str, Any]:
    found: dict[str, Any] = {}
    long_names = {name: f"value of {pointer}" for pointer, name in results.sweep.names.items()}
    for axis in results.sweep.axes:
        for name, values in axis.coordinates.items():
            about = {"long_name": long_names[name]} if name in long_names else {}
            found[name] = (axis.name, values, about)
        if axis.name not in axis.coordinates:
            found[axis.name] = (axis.name, np.arange(axis.size), {"long_name": "place in the sweep"})
    if results.sweep.axes:
        dims = tuple(axis.name for axis in results.sweep.axes)
        found["label"] = (dims, np.array(results.sweep.labels).reshape(results.sweep.shape),
                          {"long_name": "values of the sweep point"})
    return found


def _longest(results: ResultsFile) -> tuple[int, np.ndarray]:
    """Taps of the point that has come farthest, and their numbers."""
    scales = [results.file.get(f"observables/point_{number:04}/tap")
              for number in range(len(results.sweep.labels))]
    longest = max((scale for scale in scales if scale is not None), key=len, default=np.zeros(0, np.int64))
    return len(longest), longest[()].astype(np.int64)


class _Builder:
    """Collects variables over the sweep."""

    def __init__(self, results: ResultsFile) -> None:
        self._results = results
        self._dims = tuple(axis.name for axis in results.sweep.axes)
        self.variables: dict[str, Any] = {}

    def add(self, name: str, path: str, along: dict[str, int], dtype: Any, fill: Any) -> None:
        array = SweptArray(self._results, path, tuple(along.values()), dtype, fill)
        self.variables[name] = xarray.Variable(self._dims + tuple(along),
                                               indexing.LazilyIndexedArray(array), self._about(path))

    def _about(self, path: str) -> dict[str, str]:
        """units, long_name and source, of the first point that has the dataset."""
        for number in range(len(self._results.sweep.labels)):
            dataset = self._results.file.get(path.format(f"point_{number:04}"))
            if dataset is not None:
                return {name: value for name in ("units", "long_name", "source")
                        if (value := attribute(dataset, name))}
        return {}

    def dataset(self, taps: np.ndarray, more: dict[str, Any]) -> xarray.Dataset:
        coordinates = {**_coordinates(self._results), "tap": ("tap", taps, {
            "long_name": "taps made; 0 is the start"}), **more}
        about = {"title": self._results.scene["name"], "state": self._results.state,
                 "source": self._results.path}
        made = xarray.Dataset(self.variables, coordinates, about)
        made.set_close(_nothing)
        return made


def _nothing() -> None:
    """The file belongs to the Results."""


def ensemble(results: ResultsFile) -> xarray.Dataset:
    n, taps = _longest(results)
    builder = _Builder(results)
    for name in results.observables:
        for fold in FOLDS:
            whole = fold == "count"
            builder.add(f"{name}_{fold}", f"ensemble/{{}}/{name}_{fold}", {"tap": n},
                        np.int64 if whole else float, 0 if whole else np.nan)
    return builder.dataset(taps, {})


def series(results: ResultsFile) -> xarray.Dataset:
    n, taps = _longest(results)
    realizations = results.n_realizations
    builder = _Builder(results)
    for name in results.observables:
        builder.add(name, f"observables/{{}}/{name}", {"tap": n, "realization": realizations},
                    float, np.nan)
    builder.add("status", "observables/{}/status", {"realization": realizations}, np.uint8, 0)
    builder.variables["status"].attrs.update(
        flag_values=np.arange(len(STATUS), dtype=np.uint8), flag_meanings=" ".join(STATUS))
    numbers = ("realization", np.arange(realizations), {"long_name": "index of the realization"})
    return builder.dataset(taps, {"realization": numbers})


def opened(results: ResultsFile, make: Callable[[ResultsFile], xarray.Dataset]) -> xarray.Dataset:
    """A dataset that closes the file when it is closed."""
    made = make(results)
    made.set_close(results.close)
    return made
