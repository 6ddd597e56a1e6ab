"""One sweep point of a results file."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any, Callable

import h5py
import numpy as np

from .contacts import Contacts, contacts_of
from .errors import NotThere, ResultsError
from .guards import reading, reads_file, whole_number
from .results_file import ResultsFile
from .text import attribute, text, texts

STATUS = ("missing", "unfinished", "done", "failed")
FOLDS = ("mean", "sigma", "error", "count")


PERIODIC_DIRECTIONS = {"periodic": "xy", "walls": "", "cylinder": "", "fully_periodic": "xyz", "plates": "x"}


@dataclasses.dataclass(frozen=True)
class Box:
    """The container of the spheres. boundary: "periodic" or "none" along x, y, z; edges: [3], diameters. An open
    top ends at the highest point of any kept frame, and is infinite where there is none."""

    boundary: tuple[str, str, str]
    edges: np.ndarray


@reads_file
class Columns(Mapping[str, np.ndarray]):
    """Arrays by name, read when they are asked for."""

    def __init__(self, names: list[str], read: Callable[[str], np.ndarray], of: str, results: ResultsFile) -> None:
        self._names, self._read, self._of, self._results = names, read, of, results

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._names:
            raise NotThere(f"{self._of} has no {name!r}; it has {', '.join(self._names) or 'nothing'}")
        return self._read(name)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<{self._of}: {', '.join(self._names)}>"


@reads_file
class Point:
    """Sweep point `index` of a file. A point whose realizations have not begun has zero taps.

    label: its values for people. values: JSON pointer -> value that the sweep gives it.
    coordinates: the same by the names that `Results.ensemble` has. n_spheres; seed; planned_taps: of the
    protocol, whatever was reached.
    """

    def __init__(self, results: ResultsFile, index: int) -> None:
        self._results, self.index = results, index
        self._name = f"point_{index:04}"
        with reading(results.path):
            self._read_attributes()

    def _read_attributes(self) -> None:
        sweep = self._results.sweep
        self.label, self.values = sweep.labels[self.index], sweep.values[self.index]
        self.coordinates = {sweep.names[pointer]: value for pointer, value in self.values.items()}
        attributes = self._file[f"sweep/{self._name}"].attrs
        self.n_spheres, self.seed = int(attributes["n_spheres"]), int(attributes["seed"])
        self.planned_taps = int(attributes["taps"])

    @property
    def _file(self) -> h5py.File:
        return self._results.file

    def __repr__(self) -> str:
        return (f"<jostle sweep point {self.index}{': ' if self.label else ''}{self.label}, "
                f"{len(self.tap)} taps of {self.n_realizations} realizations>")

    @property
    def begun(self) -> bool:
        """True if any of its realizations has a stored tap."""
        return f"observables/{self._name}" in self._file

    @property
    def has_taps(self) -> bool:
        """True if any of its realizations has taps and did not fail: otherwise means have no numbers."""
        return any(status in ("unfinished", "done") for status in self.status)

    def _group(self, folder: str) -> h5py.Group:
        group = self._file.get(f"{folder}/{self._name}")
        if group is None:
            raise NotThere(f"{self._results.path}: /{folder} has nothing of sweep point {self.index}")
        return group

    @property
    def scene(self) -> dict[str, Any]:
        """The resolved scene with the values of this point in their places, without the sweep and what needs one."""
        scene = copy.deepcopy(self._results.scene)
        for key in ("sweep", "point_labels"):
            scene.pop(key, None)
        scene.get("analyse", {}).pop("sweep", None)
        for pointer, value in self.values.items():
            *above, last = [part.replace("~1", "/").replace("~0", "~")
                            for part in pointer.split("/")[1:]]
            place: Any = scene
            for part in above:
                place = place[int(part) if isinstance(place, list) else part]
            place[int(last) if isinstance(place, list) else last] = copy.deepcopy(value)
        if "discrete_element" in scene.get("engine", {}):  # grains come to rest by themselves
            for key in ("relax", "relax_start"):
                scene.pop(key, None)
        return scene

    # Taps and realizations.

    @property
    def n_realizations(self) -> int:
        return self._results.n_realizations

    @cached_property
    def tap(self) -> np.ndarray:
        """[tap]: 0 is the start; as far as the farthest realization has come."""
        return self._integers("tap", 0)

    @cached_property
    def observables(self) -> list[str]:
        """All columns: what the scene observes, then what the engine records of a tap."""
        own = ("tap", "realization", "status", "rows", "reason", "trial_key")
        if not self.begun:
            return self._results.observables
        there = [name for name in self._group("observables") if name not in own]
        first = [name for name in self._results.observables if name in there]
        return first + [name for name in there if name not in first]

    def units(self, name: str) -> str:
        """Units of a column: "diameter", "1", ..."""
        if name not in self.observables:
            raise NotThere(f"sweep point {self.index} has no {name!r}; it has {', '.join(self.observables)}")
        return attribute(self._group("observables")[name], "units")

    @property
    def series(self) -> Columns:
        """name -> [tap, realization]. NaN: not reached, failed, or undefined (no acceptance at tap 0)."""
        group = self._group("observables") if self.begun else None

        def read(name: str) -> np.ndarray:
            return np.zeros((0, self.n_realizations)) if group is None else group[name][()]
        return Columns(self.observables, read, f"sweep point {self.index}", self._results)

    def _fold(self, fold: str) -> Columns:
        group = self._group("ensemble") if self.begun else None

        def read(name: str) -> np.ndarray:
            found = np.zeros(0) if group is None else group[f"{name}_{fold}"][()]
            return found.astype(np.int64) if fold == "count" else found
        return Columns(self.observables, read, f"sweep point {self.index}", self._results)

    @property
    def mean(self) -> Columns:
        """name -> [tap], over the realizations that have a value; NaN where none has."""
        return self._fold("mean")

    @property
    def sigma(self) -> Columns:
        """name -> [tap]: population standard deviation (1/M) over realizations."""
        return self._fold("sigma")

    @property
    def error(self) -> Columns:
        """name -> [tap]: standard error of the mean; NaN of fewer than two values."""
        return self._fold("error")

    @property
    def count(self) -> Columns:
        """name -> [tap]: number of realizations that have a value."""
        return self._fold("count")

    @property
    def status(self) -> list[str]:
        """[realization]: "missing" (of another shard, or not begun), "unfinished", "done" or "failed"."""
        if not self.begun:
            return ["missing"] * self.n_realizations
        return [STATUS[code] for code in self._group("observables")["status"][()]]

    @property
    def rows(self) -> np.ndarray:
        """[realization]: taps recorded, the start included."""
        return self._integers("rows", self.n_realizations)

    def _integers(self, name: str, n: int) -> np.ndarray:
        """Signed, so that differences of them are."""
        if not self.begun:
            return np.zeros(n, np.int64)
        return self._group("observables")[name][()].astype(np.int64)

    @property
    def reasons(self) -> dict[int, str]:
        """Why realizations failed: number of the realization -> reason."""
        if not self.begun:
            return {}
        found = enumerate(texts(self._group("observables")["reason"]))
        return {number: reason for number, reason in found if reason}

    @property
    def timing(self) -> Columns:
        """name -> [realization]: seconds and start_seconds of processor time, trials (in units of the
        engine), distance_tests."""
        group = self._group("timing")
        return Columns([name for name in group if name != "realization"],
                       lambda name: group[name][()], f"timing of sweep point {self.index}", self._results)

    @property
    def fitting(self) -> Columns:
        """name -> [realization]: what fitting between walls did to the pours; empty of other starts."""
        group = self._file.get(f"fitting/{self._name}", {})
        return Columns([name for name in group if name != "realization"],
                       lambda name: group[name][()], f"fitting of sweep point {self.index}", self._results)

    @property
    def motion(self) -> Columns:
        """The motion of spheres, and its axes, by name: overlap, [waiting_time, lag,
        overlap_length, realization]; the others are in docs/reference/file-format.md. Empty where it was not followed."""
        group = self._file.get(f"motion/{self._name}", {})
        return Columns([name for name in group if name not in ("realization", "direction")],
                       lambda name: group[name][()], f"motion of sweep point {self.index}", self._results)

    # Snapshots.

    @property
    def snapshots(self) -> Columns:
        """Kept data of packings besides positions: tap: [tap]; coordination: [tap, realization];
        height_histogram: [tap, realization, height], fraction of all centres in a bin; height: [height],
        the middle of a bin, diameters; of discrete elements also the granular temperature and the forces
        of the bed (docs/reference/file-format.md)."""
        group = self._file.get(f"snapshots/{self._name}", {})
        axes = ("realization", "wall", "direction", "arm", "force")
        return Columns([name for name in group if name not in axes],
                       lambda name: group[name][()], f"snapshots of sweep point {self.index}", self._results)

    def _particles(self, realization: int) -> h5py.Group:
        realization = whole_number(realization, "realization")
        name = f"particles/{self._name}_realization_{realization:05}"
        if name not in self._file:
            start = f"{self._name}_realization_"
            kept = [int(one[len(start):]) for one in self._file.get("particles", {})
                    if one.startswith(start)]
            raise NotThere(f"{self._results.path}: no positions of sweep point {self.index}, "
                           f"realization {realization}; there are those of "
                           f"{', '.join(map(str, kept)) or 'none (snapshots of the scene)'}")
        return self._file[name]

    def position_taps(self, realization: int = 0) -> np.ndarray:
        """[frame]: the taps whose positions are kept."""
        return self._particles(realization)["position/step"][()]

    def positions(self, realization: int = 0, tap: int | None = None) -> np.ndarray:
        """[sphere, 3], diameters, z up: the centres after a tap (None: the last that is kept)."""
        group = self._particles(realization)
        frame = group["position/step"][()].tolist().index(self._kept_tap(group, tap))
        return group["position/value"][frame]

    # Spheres.

    @cached_property
    def _mixture(self) -> h5py.Group | None:
        """The group of kinds and diameters; None of equal spheres."""
        group = self._file.get(f"spheres/{self._name}")
        if group is not None and "has_spheres_of_point" in group.attrs:
            return self._file[f"spheres/point_{int(group.attrs['has_spheres_of_point']):04}"]
        return group

    @property
    def is_mixture(self) -> bool:
        """True if spheres have sizes of their own; else all have the diameter 1."""
        return self._mixture is not None

    @property
    def kinds(self) -> list[str]:
        """The names of the kinds of spheres, in the order of the scene; none of equal spheres."""
        return [] if self._mixture is None else texts(self._mixture["name"][()])

    @property
    def densities(self) -> np.ndarray:
        """[kind]: relative densities; none of equal spheres."""
        return np.zeros(0) if self._mixture is None else self._mixture["density"][()]

    @property
    def kind(self) -> np.ndarray:
        """[sphere]: the kind of every sphere, an index of `kinds`; 0 of equal spheres."""
        if self._mixture is None:
            return np.zeros(self.n_spheres, dtype=np.uint32)
        return self._mixture["kind"][()]

    def diameters(self, realization: int = 0) -> np.ndarray:
        """[sphere]: the diameters of a realization's spheres; 1 of equal spheres. NaN of a realization that draws
        its own and has not begun, or has failed."""
        realization = self._checked(realization)
        if self._mixture is None:
            return np.ones(self.n_spheres)
        if "diameter" in self._mixture and self._mixture["diameter"].ndim == 1:
            return self._mixture["diameter"][()]
        drawn = self._file.get(f"spheres/{self._name}/diameter")
        return np.full(self.n_spheres, np.nan) if drawn is None else drawn[realization]

    def contacts(self, realization: int = 0, tap: int | None = None) -> Contacts:
        """Contacts of grains whose snapshots keep them: those with force, after a tap (None: the last that is
        kept)."""
        group = self._particles(realization)
        if "contacts" not in group:
            raise NotThere(f"{self._results.path}: no contacts of sweep point {self.index}; they are kept "
                           "of discrete_element where \"snapshots\" keeps \"contacts\"")
        return contacts_of(group, self.diameters(realization), self._kept_tap(group, tap))

    def _kept_tap(self, group: h5py.Group, tap: int | None) -> int:
        taps = group["position/step"][()].tolist()
        tap = tap if tap is None else whole_number(tap, "tap")
        if tap is not None and tap not in taps:
            raise NotThere(f"{self._results.path}: no positions of tap {tap}; kept: "
                           f"{', '.join(map(str, taps))}")
        return taps[-1] if tap is None else tap

    def box(self, realization: int = 0) -> Box:
        """The box of a realization's packings."""
        realization = self._checked(realization)
        try:
            box = self._particles(realization)["box"]
        except NotThere:
            return self._planned_box()
        x, y, z = texts(box.attrs["boundary"])
        return Box((x, y, z), box["edges"][()])

    def _checked(self, realization: int) -> int:
        realization = whole_number(realization, "realization")
        if not 0 <= realization < self.n_realizations:
            raise NotThere(f"{self._results.path}: no realization {realization}: there are {self.n_realizations}")
        return realization

    def _planned_box(self) -> Box:
        attributes = self._file[f"sweep/{self._name}"].attrs
        x, y, z = attributes["widths"]
        kind = text(attributes["container"])
        if kind not in PERIODIC_DIRECTIONS:
            raise ResultsError(f"a container of a kind that this version does not know: {kind}")
        x_ends, y_ends, z_ends = ("periodic" if axis in PERIODIC_DIRECTIONS[kind] else "none" for axis in "xyz")
        if kind == "cylinder":
            y = x
        return Box((x_ends, y_ends, z_ends), np.array([x, y, z if z_ends == "periodic" else np.inf]))
