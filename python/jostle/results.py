"""Results files: `open` gives a `Results`."""

from __future__ import annotations

import json
import os
import pathlib
import warnings
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from .contacts import Contacts
from .errors import NoSuchPoint, ProgramError, ProgramMissing, ResultsError, WrongType
from .guards import closed, path_text, reading, reads_file, whole_number
from .point import Box, Point
from .program import beside, digest_of, joined_with_parts
from .seal import has_seal
from .sweep import Sweep, read_sweep, swept_pointers
from .tables import Tables, stored_tables
from .text import text, texts

if TYPE_CHECKING:
    import pandas
    import xarray

LAYOUTS = (1, 2)  # attribute jostle_format of the root; 2: with mixtures
MONTE_CARLO = ["sweeps", "acceptance", "capped", "dropped_offsets"]  # unnamed in files


def open(path: str | os.PathLike[str], *, verify: bool = False, live: bool = False,
         program: str | os.PathLike[str] | None = None) -> Results:
    """Opens a results file to read.

    verify: check the SHA-256 of the whole file too; its last line must be there in any case.
    live: for a run in progress or a killed run, join its checkpoints to the file's data (a copy, made by
    the program in a temporary folder; nothing beside the file is touched).
    Raises ResultsError for what is no results file, or one of another layout. A file that another program
    opened for writing and did not change is verified by the program jostle, with a warning.
    """
    name = path_text(path)
    if not has_seal(name, whole=verify):
        _verify_contents(name, program)
    parts = pathlib.Path(beside(os.path.realpath(name), ".parts"))
    if live and parts.is_dir():
        with reading(name), joined_with_parts(name, program) as joined, _opened(name, name) as stored:
            state = text(stored["provenance"].attrs["state"])
            return Results(name, _opened(joined, name), program, state, live=True)  # open, it outlives its name
    results = Results(name, _opened(name, name), program)
    if parts.is_dir() and not live:
        warnings.warn(f"{name}: its run goes on or was killed, and has more taps in its checkpoints: "
                      "live=True reads them too", stacklevel=2)
    return results


def _verify_contents(path: str, program: str | os.PathLike[str] | None) -> None:
    """For a file that has lost its last line."""
    lost = f"{path}: another program opened it for writing and cut off its last line, the checksum"
    try:
        digest_of(path, program)
    except ProgramMissing as error:
        raise ResultsError(f"{lost}; only the program can verify its contents: {error}") from error
    except ProgramError as error:
        raise ResultsError(str(error)) from error
    warnings.warn(f"{lost}; its contents are the old ones. Seal the file again with jostle info --reseal",
                  stacklevel=3)


def _opened(path: str, known_as: str) -> h5py.File:
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise ResultsError(f"{known_as}: cannot read it: {error}") from error
    try:
        with reading(known_as):
            _require_layout(file, known_as)
    except BaseException:
        file.close()
        raise
    return file


def _require_layout(file: h5py.File, known_as: str) -> None:
    layout = file.attrs.get("jostle_format")
    whole = isinstance(layout, (int, np.integer)) and not isinstance(layout, bool)
    if not whole or int(layout) not in LAYOUTS:
        what = "not written by jostle" if layout is None else f"of layout {text(layout)}"
        raise ResultsError(f"{known_as}: {what}: this package reads results of jostle of layouts 1 and 2")


@reads_file
class Points(Sequence[Point]):
    """The sweep points of a file, in its order."""

    def __init__(self, results: Results, n: int) -> None:
        self._results, self._n = results, n

    def __len__(self) -> int:
        return self._n

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            try:
                chosen = range(*index.indices(self._n))
            except (TypeError, ValueError) as error:
                raise WrongType(f"sweep points of {self._results.path}: {error}") from None
            return [self[i] for i in chosen]
        asked = whole_number(index, "number of a sweep point")
        number = asked + (self._n if asked < 0 else 0)
        if not 0 <= number < self._n:
            raise NoSuchPoint(f"{self._results.path} has {self._n} sweep points, from 0; {asked} is none")
        return Point(self._results, number)


@reads_file
class Results:
    """A results file, open to read. Lengths are in sphere diameters, z points up, tap 0 is the start.

    It stays open until `close`, or the end of a `with`; a file that a run replaces meanwhile is still read in its old
    state. `file` is its h5py.File.
    """

    def __init__(self, path: str, file: h5py.File,
                 program: str | os.PathLike[str] | None = None, state: str | None = None, live: bool = False) -> None:
        self.path, self._file, self._program, self._state = path, file, program, state
        self.live = live  # checkpoints are joined in

    def __enter__(self) -> Results:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._file.close()

    @property
    def file(self) -> h5py.File:
        """The file; ResultsError after `close`."""
        if not self._file:
            raise closed(self.path)
        return self._file

    def __repr__(self) -> str:
        if not self._file:
            return f"<jostle results {self.path}: closed>"
        try:
            return (f"<jostle results {self.path}: {self.scene['name']}, {self.state}, {len(self.points)} sweep "
                    f"point{'s' if len(self.points) != 1 else ''} x {self.n_realizations} realizations>")
        except ResultsError:
            return f"<jostle results {self.path}: damaged>"

    # The request.

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The scene, every default written out."""
        scene = json.loads(self.scene_text("resolved"))
        if not isinstance(scene, dict) or not isinstance(scene.get("name"), str):
            raise ResultsError(f"{self.path}: damaged: its scene is none; restore it from a copy")
        return scene

    @property
    def scene_verbatim(self) -> str:
        """The text of the scene as it was written."""
        return self.scene_text("verbatim")

    def scene_text(self, which: str) -> str:
        return text(self.file[f"scene/{which}"])

    @cached_property
    def sweep(self) -> Sweep:
        """Axes, labels and values of what is swept."""
        return read_sweep(self.file, self.scene, self.observables)

    @property
    def n_realizations(self) -> int:
        """At every sweep point."""
        return int(self.file["scene"].attrs["realizations"])

    @cached_property
    def observables(self) -> list[str]:
        """The columns of the first sweep point, and what others have besides."""
        names: dict[str, None] = {}
        for observed in (True, False):
            for group in self._kept():
                own = texts(group["diagnostics"]) if "diagnostics" in group else MONTE_CARLO
                names.update(dict.fromkeys(texts(group["observables"]) if observed else own))
        return list(names)

    def _kept(self) -> list[h5py.Group]:
        """Groups of /sweep that name columns: of all points where the sweep changes them."""
        swept = any(pointer.startswith(("/observe", "/engine")) for pointer in swept_pointers(self.file))
        numbers = range(len(self.file["sweep/label"]) if swept else 1)
        groups = [self.file[f"sweep/point_{number:04}"] for number in numbers]
        return [group for group in groups if "observables" in group]

    # The result.

    @property
    def points(self) -> Points:
        return Points(self, len(self.sweep.labels))

    def __iter__(self) -> Iterator[Point]:
        return iter(self.points)

    @cached_property
    def ensemble(self) -> xarray.Dataset:
        """One dataset of the whole sweep: NAME_mean, NAME_sigma, NAME_error and NAME_count of every
        column, [axes of the sweep ..., tap], read when they are used. NaN (count 0) where a point has not
        come to a tap. Needs xarray; points[i].mean and the like do without."""
        from .datasets import ensemble
        return ensemble(self)

    @cached_property
    def series(self) -> xarray.Dataset:
        """Every column of every realization, [axes of the sweep ..., tap, realization], and `status`
        [axes ..., realization]; read when they are used. Needs xarray."""
        from .datasets import series
        return series(self)

    def to_pandas(self, *observables: str) -> pandas.DataFrame:
        """The ensemble as a table: a row a sweep point and tap, indexed by the axes of the sweep and the
        tap; a column each NAME_mean, NAME_sigma, NAME_error, NAME_count, of all or of these. Needs
        pandas."""
        from .frames import ensemble_frame
        return ensemble_frame(self, observables)

    def positions(self, point: int = 0, realization: int = 0, tap: int | None = None) -> np.ndarray:
        """[sphere, 3], diameters, z up: the centres after a tap (None: the last that is kept)."""
        return self.points[point].positions(realization, tap)

    def contacts(self, point: int = 0, realization: int = 0, tap: int | None = None) -> Contacts:
        """Contacts of grains, their forces, and the moments of the forces."""
        return self.points[point].contacts(realization, tap)

    def box(self, point: int = 0, realization: int = 0) -> Box:
        """The box of these positions."""
        return self.points[point].box(realization)

    @property
    def tables(self) -> Tables:
        """Tables derived from the data: fits, analyses, structure."""
        return stored_tables(self.file, self.path)

    # How it came about.

    @property
    def state(self) -> str:
        """"running" (also of a run that was killed), "interrupted" or "complete"."""
        return self._state or text(self.file["provenance"].attrs["state"])

    @property
    def shard(self) -> tuple[int, int]:
        """(i, n): share i of n; (1, 1) of a whole run."""
        index, count = self.file["provenance"].attrs["shard"]
        return int(index), int(count)

    @property
    def run_id(self) -> str:
        return text(self.file["provenance"].attrs["run_id"])

    @property
    def provenance(self) -> list[dict[str, str]]:
        """For every process that worked on the file: version, git_revision, libraries, host, cpu,
        instruction_set, threads, command_line, started (UTC)."""
        group = self.file["provenance"]
        columns = {name: texts(group[name]) for name in group if name != "process"}
        n = len(next(iter(columns.values()), []))
        return [{name: column[i] for name, column in columns.items()} for i in range(n)]

    def digest(self) -> str:
        """SHA-256 of the data alone, the same for equal runs (jostle info --digest of the file); of live
        results, of what there is now."""
        if self.live:
            with joined_with_parts(self.path, self._program) as joined:
                return digest_of(joined, self._program)
        return digest_of(self.path, self._program)

    def verify(self) -> None:
        """Raises ResultsError unless the file's checksum is right."""
        if not has_seal(self.path, whole=True):
            _verify_contents(self.path, self._program)
