"""The sweep of a study: its axes, and the values of every point."""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any, Sequence

import h5py
import numpy as np

from .text import texts

# Names with another meaning in /sweep and in datasets over the sweep.
_TAKEN = {"point", "label", "id", "pointer", "value", "tap", "realization", "status"}


@dataclasses.dataclass(frozen=True)
class Axis:
    """One dimension of a sweep: `name`, and the coordinates that vary along it, each [size]."""

    name: str
    coordinates: dict[str, np.ndarray]

    @property
    def size(self) -> int:
        return len(next(iter(self.coordinates.values())))


@dataclasses.dataclass(frozen=True)
class Sweep:
    """labels: [point], for people; values: of every point, JSON pointer -> value; names: pointer -> name
    of the coordinate; axes: slowest first. Points are numbered along the axes, the last one fastest.
    """

    labels: list[str]
    values: list[dict[str, Any]]
    names: dict[str, str]
    axes: list[Axis]

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(axis.size for axis in self.axes)


def swept_pointers(file: h5py.File) -> list[str]:
    """JSON pointers into the scene, in the order of the sweep; none without one."""
    return texts(file["sweep/pointer"]) if "pointer" in file["sweep"] else []


def read_sweep(file: h5py.File, scene: dict[str, Any], columns: Sequence[str]) -> Sweep:
    """columns: names of observables, which no coordinate may have."""
    group = file["sweep"]
    labels = texts(group["label"])
    pointers = swept_pointers(file)
    rows = group["value"][()] if pointers else np.empty((len(labels), 0))
    values = [{pointer: json.loads(value) for pointer, value in zip(pointers, row) if value}
              for row in rows]
    names = {pointer: _name(pointer, pointers, _TAKEN.union(columns)) for pointer in pointers}
    return Sweep(labels, values, names, _axes(scene, values, names))


def _name(pointer: str, pointers: Sequence[str], taken: set[str]) -> str:
    """The last part of the pointer if it is unique; else all of it, with _."""
    last = _part(pointer)
    alone = [_part(other) for other in pointers].count(last) == 1
    if alone and not last.isdigit() and last not in taken:
        return last
    return pointer.lstrip("/").replace("/", "_")


def _part(pointer: str) -> str:
    return pointer.rsplit("/", 1)[-1]


def _coordinate(values: Sequence[Any]) -> np.ndarray:
    """Numbers as they are; words as words; anything else as JSON."""
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
        return np.array(values, dtype=float)
    return np.array([value if isinstance(value, str) else
                     json.dumps(value, separators=(",", ":"), sort_keys=True) for value in values])


def _groups(scene: dict[str, Any]) -> list[list[str]]:
    """The pointers that vary together, group by group, the slowest first."""
    groups: list[list[str]] = []
    for key, value in scene.get("sweep", {}).items():
        if key == "zip":
            groups += [list(one) for one in (value if isinstance(value, list) else [value])]
        else:
            groups.append([key])
    return groups


def _axes(scene: dict[str, Any], values: list[dict[str, Any]], names: dict[str, str]) -> list[Axis]:
    """An axis a group of the scene, none without a sweep; one over all points where the values are no
    product of groups."""
    if not names:
        return []
    axes, step = [], len(values)
    for group in _groups(scene):
        n = len(_swept(scene, group[0]))
        if step % n:
            return [_whole(values, names)]
        step //= n
        along = values[:n * step:step]
        coordinates = {names[pointer]: _coordinate([value[pointer] for value in along])
                       for pointer in group}
        axes.append(Axis(_dimension(coordinates), coordinates))
    product = math.prod(axis.size for axis in axes) == len(values)
    return axes if product and _agree(axes, values, names) else [_whole(values, names)]


def _swept(scene: dict[str, Any], pointer: str) -> list[Any]:
    sweep = scene["sweep"]
    if pointer in sweep:
        return sweep[pointer]
    zipped = sweep["zip"] if isinstance(sweep["zip"], list) else [sweep["zip"]]
    return next(group[pointer] for group in zipped if pointer in group)


def _dimension(coordinates: dict[str, np.ndarray]) -> str:
    """The first coordinate that distinguishes all places; else the names of all."""
    for name, values in coordinates.items():
        if len(set(values.tolist())) == len(values):
            return name
    return "_and_".join(coordinates)


def _whole(values: list[dict[str, Any]], names: dict[str, str]) -> Axis:
    coordinates = {name: _coordinate([value.get(pointer, math.nan) for value in values])
                   for pointer, name in names.items()}
    return Axis("point", {"point": np.arange(len(values)), **coordinates})


def _agree(axes: list[Axis], values: list[dict[str, Any]], names: dict[str, str]) -> bool:
    """True if the axes give every point its values."""
    shape = [axis.size for axis in axes]
    for axis, places in zip(axes, np.indices(shape).reshape(len(shape), -1)):
        for pointer, name in names.items():
            if name in axis.coordinates:
                mine = _coordinate([value[pointer] for value in values])
                if not np.array_equal(mine, axis.coordinates[name][places]):
                    return False
    return True
