"""Where this package is installed: its version, and the program that pip installed with it."""

from __future__ import annotations

import functools
import importlib.metadata
import os
import pathlib
import re

_PACKAGE = pathlib.Path(__file__).resolve().parent


@functools.cache
def version() -> str:
    """The version of the source tree that this package is in, else of the installed distribution.

    "unknown" if the package was copied without its metadata.
    """
    citation = _PACKAGE.parents[1] / "CITATION.cff"
    if _PACKAGE.parent.name == "python" and citation.is_file():
        found = re.search(r"^version: (\S+)$", citation.read_text(encoding="utf-8"), re.MULTILINE)
        if found:
            return found[1]
    distribution = _distribution()
    return distribution.version if distribution else "unknown"


@functools.cache
def program() -> str | None:
    """The program that pip installed together with this package; None if the package came in another way."""
    distribution = _distribution()
    for file in (distribution.files or []) if distribution else []:
        path = os.path.realpath(os.fspath(file.locate()))
        if file.name == "jostle" and os.path.basename(os.path.dirname(path)) == "bin" and os.access(path, os.X_OK):
            return path
    return None


def _distribution() -> importlib.metadata.Distribution | None:
    """The installed distribution whose package is this one, not another that the path names as well."""
    for distribution in importlib.metadata.distributions(name="jostle"):
        installed = pathlib.Path(os.fspath(distribution.locate_file("jostle"))).resolve()
        if installed == _PACKAGE:
            return distribution
    return None
