"""An open results file, and what it holds of the whole run: scene, sweep, columns, provenance."""

from __future__ import annotations

import json
import os
from functools import cached_property
from typing import Any

import h5py
import numpy as np

from .errors import ResultsError
from .guards import closed, reading, reads_file
from .sweep import Sweep, read_sweep, swept_pointers
from .text import text, texts

LAYOUTS = (1, 2)  # attribute jostle_format of the root; 2: with mixtures
MONTE_CARLO = ["sweeps", "acceptance", "capped", "dropped_offsets"]  # unnamed in files


def opened(path: str, known_as: str) -> h5py.File:
    """Opens a file to read. Raises ResultsError for a file that is no results file, or has another layout. The message
    names the file `known_as`."""
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
class ResultsFile:
    """A results file, open to read. It stays open until `close`. `file` is its h5py.File."""

    def __init__(self, path: str, file: h5py.File,
                 program: str | os.PathLike[str] | None = None, state: str | None = None, live: bool = False) -> None:
        self.path, self._file, self._program, self._state = path, file, program, state
        self.live = live  # checkpoints are joined in

    def close(self) -> None:
        self._file.close()

    @property
    def file(self) -> h5py.File:
        """The file; ResultsError after `close`."""
        if not self._file:
            raise closed(self.path)
        return self._file

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
