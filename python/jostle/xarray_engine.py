"""xr.open_dataset("x.h5", engine="jostle"): the ensemble of a results file, its sweep as coordinates."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import xarray
from xarray.backends import BackendEntrypoint

from . import datasets
from .errors import BadArgument
from .results import open as open_results

CONTENTS = {"ensemble": datasets.ensemble, "series": datasets.series}


class JostleBackendEntrypoint(BackendEntrypoint):
    """content: "ensemble" (default: mean, sigma, error and count over realizations) or "series" (every
    realization). live: with the checkpoints of a run in progress; it needs the program."""

    description = "Open results of jostle, the whole sweep as one dataset"
    open_dataset_parameters = ("filename_or_obj", "drop_variables", "content", "live")

    def open_dataset(self, filename_or_obj: str | os.PathLike[str], *,
                     drop_variables: str | Iterable[str] | None = None, content: str = "ensemble",
                     live: bool = False, **_: Any) -> xarray.Dataset:
        if not isinstance(content, str) or content not in CONTENTS:
            raise BadArgument(f"content={content!r}: one of {', '.join(CONTENTS)}")
        made = datasets.opened(open_results(filename_or_obj, live=live), CONTENTS[content])
        dropped = [drop_variables] if isinstance(drop_variables, str) else list(drop_variables or [])
        close = made._close
        made = made.drop_vars([name for name in dropped if name in made.variables])
        made.set_close(close)
        return made
