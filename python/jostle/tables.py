"""Tables derived from the data: /fits, /analysis and /structure of a results file."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from .errors import NotThere, ResultsError
from .guards import reading
from .text import attribute, text, texts

if TYPE_CHECKING:
    import pandas
    import xarray

GROUPS = ("fits", "analysis", "structure")


@dataclasses.dataclass(frozen=True)
class Quantity:
    """values: one dimension for each of `axes`; text is an array of objects. NaN: not known."""

    values: np.ndarray
    axes: tuple[str, ...]
    units: str = ""
    long_name: str = ""
    source: str = ""


@dataclasses.dataclass(frozen=True)
class Table:
    """axes: name -> its values, [size]. quantities: name -> values along some of the axes; the standard
    error of NAME is the quantity NAME_error, its degrees of freedom NAME_dof. notes: what was asked for,
    and what was found in words; `verdict` has the result, `refused` the reason of a missing one. made: version,
    git_revision, command_line, made (UTC); empty of tables that were not read from a file.
    """

    name: str
    axes: dict[str, Quantity]
    quantities: dict[str, Quantity]
    notes: dict[str, str]
    made: dict[str, str] = dataclasses.field(default_factory=dict)

    def __getitem__(self, name: str) -> np.ndarray:
        """Values of a quantity or an axis."""
        for place in (self.quantities, self.axes):
            if isinstance(name, str) and name in place:
                return place[name].values
        raise NotThere(f"{self.name} has no {name!r}; it has {', '.join([*self.axes, *self.quantities])}")

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and (name in self.quantities or name in self.axes)

    def __repr__(self) -> str:
        along = ", ".join(f"{name} {len(axis.values)}" for name, axis in self.axes.items())
        return f"<jostle table {self.name}: {len(self.quantities)} quantities{' along ' if along else ''}{along}>"

    def error(self, name: str) -> np.ndarray | None:
        """The standard error of a quantity; None where it has none. With few realizations it is uncertain: an interval
        is Student's t of NAME_dof degrees of freedom times it."""
        self[name]
        return self.quantities[f"{name}_error"].values if f"{name}_error" in self.quantities else None

    @property
    def refused(self) -> str | None:
        """Why there is nothing in it."""
        return self.notes.get("refused")

    def to_dataset(self) -> xarray.Dataset:
        """Axes as coordinates, quantities as variables, notes as attributes. Needs xarray."""
        try:
            import xarray
        except ImportError as error:
            raise ImportError("Table.to_dataset needs xarray, which is not installed (Debian: "
                              "python3-xarray; pip: xarray); table[name] is a numpy array") from error

        def variable(one: Quantity) -> tuple[Any, ...]:
            about = {"units": one.units, "long_name": one.long_name, "source": one.source}
            return one.axes, one.values, {name: value for name, value in about.items() if value}

        return xarray.Dataset({name: variable(one) for name, one in self.quantities.items()},
                              {name: variable(one) for name, one in self.axes.items()},
                              {"title": self.name, **self.notes})

    def to_pandas(self, *along: str) -> pandas.DataFrame:
        """The quantities with exactly these axes (default: the longest list), one row per place.
        Needs pandas."""
        try:
            import pandas
        except ImportError as error:
            raise ImportError("Table.to_pandas needs pandas, which is not installed (Debian: "
                              "python3-pandas; pip: pandas); table[name] is a numpy array") from error
        unknown = [name for name in along if name not in self.axes]
        if unknown:
            raise NotThere(f"{self.name} has no axis {unknown[0]!r}; it has {', '.join(self.axes) or 'none'}")
        axes = along or max((quantity.axes for quantity in self.quantities.values()), key=len, default=())
        chosen = {name: quantity.values.reshape(-1) if axes else [quantity.values[()]]
                  for name, quantity in self.quantities.items() if quantity.axes == axes}
        if not axes:
            return pandas.DataFrame(chosen)
        index = pandas.MultiIndex.from_product([self.axes[name].values for name in axes], names=axes)
        return pandas.DataFrame(chosen, index=index if len(axes) > 1 else index.get_level_values(0))


class Tables(Mapping[str, Table]):
    """Tables by their paths, as "fits/point_0000/bottom_fraction/kww"; read when they are asked for."""

    def __init__(self, groups: dict[str, h5py.Group], path: str) -> None:
        self._groups, self._path = groups, path

    def __getitem__(self, name: str) -> Table:
        group = self._groups.get(name.strip("/")) if isinstance(name, str) else None
        if group is not None:
            with reading(self._path):
                return _read(name, group)
        raise NotThere(f"{self._path} has no table {name!r}; it has {', '.join(self._groups) or 'none'}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._groups)

    def __len__(self) -> int:
        return len(self._groups)

    def __repr__(self) -> str:
        return f"<{len(self)} tables of {self._path}: {', '.join(self) or 'none'}>"

    def matching(self, *words: str, point: int | None = None) -> list[Table]:
        """Those whose path has all these parts, as matching("ageing", "mean_height", point=0)."""
        def fits(name: str) -> bool:
            parts = name.split("/")
            here = [int(part[6:]) for part in parts if re.fullmatch(r"point_\d+", part)]
            return all(word in parts for word in words) and (point is None or point in here)
        return [self[name] for name in self if fits(name)]

    def one(self, *words: str, point: int | None = None) -> Table:
        """The only one of matching(...); NotThere where there is none or several."""
        found = self.matching(*words, point=point)
        if len(found) != 1:
            wanted = "/".join(map(str, words)) + ("" if point is None else f" of sweep point {point}")
            there = ", ".join(table.name for table in found) or ", ".join(self) or "no table"
            raise NotThere(f"{self._path}: {'several tables are' if found else 'no table is'} {wanted}: "
                           f"there {'are' if found else 'is'} {there}")
        return found[0]


def stored_tables(file: h5py.File, path: str) -> Tables:
    found: dict[str, h5py.Group] = {}

    def walk(group: h5py.Group, name: str) -> None:
        if "jostle_quantities" in group.attrs:
            found[name] = group
            return
        for key, below in group.items():
            if isinstance(below, h5py.Group):
                walk(below, f"{name}/{key}")

    for name in GROUPS:
        if name in file:
            walk(file[name], name)
    return Tables(found, path)


def _read(name: str, group: h5py.Group) -> Table:
    axes = {axis: _quantity(group[axis], (axis,)) for axis in texts(group.attrs["jostle_axes"])}
    ids = {group[axis].id: axis for axis in axes}
    quantities = {one: _quantity(group[one], _along(group[one], group, ids))
                  for one in texts(group.attrs["jostle_quantities"])}
    notes = {key[5:]: text(value) for key, value in group.attrs.items() if key.startswith("note_")}
    for one, quantity in {**axes, **quantities}.items():
        expected = tuple(axes[along].values.size for along in quantity.axes)
        if quantity.values.shape != expected:
            raise ResultsError(f"{group.file.filename}: {name}/{one} has the shape {quantity.values.shape}, its "
                               f"axes {expected}; restore the file from a copy")
    made = {key: attribute(group, key) for key in ("version", "git_revision", "command_line", "made")}
    return Table(name, axes, quantities, notes, made)


def _along(dataset: h5py.Dataset, group: h5py.Group, axes: dict[Any, str]) -> tuple[str, ...]:
    """The names of a dataset's axes: HDF5 dimension scales."""
    references = dataset.attrs.get("DIMENSION_LIST", [])
    names = []
    for along in references:
        scale = group.file[along[0]].id
        names.append(next(name for one, name in axes.items() if one == scale))
    return tuple(names)


def _quantity(dataset: h5py.Dataset, axes: tuple[str, ...]) -> Quantity:
    values = np.asarray(dataset[()])
    if values.dtype == object:
        decoded = np.empty(values.shape, object)
        for place, value in np.ndenumerate(values):
            decoded[place] = text(value)
        values = decoded
    return Quantity(values, axes, *(attribute(dataset, name) for name in ("units", "long_name", "source")))


def table_from_json(one: dict[str, Any]) -> Table:
    """The table that the program prints with --json, where null is a number that does not exist, or infinite degrees
    of freedom."""
    def quantity(name: str, part: dict[str, Any]) -> Quantity:
        missing = np.inf if name.endswith("_dof") else np.nan
        values = np.array(part["values"], dtype=object)
        known = [value for value in values.reshape(-1) if value is not None]
        if not any(isinstance(value, str) for value in known):
            whole = len(known) == values.size and all(isinstance(value, int) for value in known)
            values = np.where(np.equal(values, None), missing, values).astype(np.int64 if whole else float)
        return Quantity(values, tuple(part["axes"]), part["units"], part["long_name"], part["source"])
    return Table(one["name"], {name: quantity(name, axis) for name, axis in one["axes"].items()},
                 {name: quantity(name, value) for name, value in one["quantities"].items()}, one["notes"])
