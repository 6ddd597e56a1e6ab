"""Results files: `open` gives a `Results`."""

from __future__ import annotations

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
from .guards import path_text, reading, reads_file, whole_number
from .point import Box, Point
from .program import beside, digest_of, joined_with_parts
from .results_file import ResultsFile, opened
from .seal import has_seal
from .tables import Tables, stored_tables
from .text import text

if TYPE_CHECKING:
    import pandas
    import xarray


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
        with reading(name), joined_with_parts(name, program) as joined, opened(name, name) as stored:
            state = text(stored["provenance"].attrs["state"])
            return Results(name, opened(joined, name), program, state, live=True)  # open, it outlives its name
    results = Results(name, opened(name, name), program)
    if parts.is_dir() and not live:
        warnings.warn(f"{name}: its run is not finished or was killed, and has more taps in its checkpoints: "
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


@reads_file
class Points(Sequence[Point]):
    """The sweep points of a file, in its order."""

    def __init__(self, results: ResultsFile, n: int) -> None:
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
class Results(ResultsFile):
    """A results file, open to read. Lengths are in sphere diameters, z points up, tap 0 is the start.

    It stays open until `close`, or the end of a `with`; a file that a run replaces meanwhile is still read in its old
    state. `file` is its h5py.File.
    """

    def __enter__(self) -> Results:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if not self._file:
            return f"<jostle results {self.path}: closed>"
        try:
            return (f"<jostle results {self.path}: {self.scene['name']}, {self.state}, {len(self.points)} sweep "
                    f"point{'s' if len(self.points) != 1 else ''} x {self.n_realizations} realizations>")
        except ResultsError:
            return f"<jostle results {self.path}: damaged>"

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
        """The ensemble as a table: one row per sweep point and tap, indexed by the axes of the sweep and the
        tap; a column each NAME_mean, NAME_sigma, NAME_error, NAME_count, of all or of these. Needs
        pandas."""
        from .frames import ensemble_frame
        return ensemble_frame(self, self.points, observables)

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

    def digest(self) -> str:
        """SHA-256 of data and scene, the same for equal runs of one scene (jostle info --digest of the file); of live
        results, of what there is now."""
        if self.live:
            with joined_with_parts(self.path, self._program) as joined:
                return digest_of(joined, self._program)
        return digest_of(self.path, self._program)

    def verify(self) -> None:
        """Raises ResultsError unless the file's checksum is right."""
        if not has_seal(self.path, whole=True):
            _verify_contents(self.path, self._program)
