"""The catalogue of figures, which the program describes."""

from __future__ import annotations

import json
import pathlib
import tempfile
from typing import Any

from ..guards import path_text, sweep_point_text, takes_arguments
from ..program import Path, call
from ..results import Results


@takes_arguments
def figures(results: Results | Path, *, point: int | str | None = None,
            program: Path | None = None) -> dict[str, dict[str, Any]]:
    """The figures that the page of `jostle report` shows, by name, as docs/developers/catalogue.md describes them; draw()
    draws one. point: those of these sweep points alone, by number or as `jostle report --sweep-point` takes them."""
    path = results.path if isinstance(results, Results) else path_text(results)
    live = isinstance(results, Results) and results.live
    with tempfile.TemporaryDirectory(prefix="jostle-figures-") as folder:
        written = pathlib.Path(folder) / "catalogue.json"
        chosen = sweep_point_text(point)
        call(["report", f"--catalogue={written}", *([f"--sweep-point={chosen}"] if chosen is not None else []),
              *(["--live"] if live else [])], [path], program=program)
        return {figure["name"]: figure for figure in json.loads(written.read_text(encoding="utf-8"))["figures"]}
