"""The last line of a results file: the SHA-256 of everything before it (docs/format.md)."""

from __future__ import annotations

import hashlib
import os
from typing import BinaryIO

from .errors import ResultsError

_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_START = b"\njostle-sha256 "
_SIZE = len(_START) + 64 + 1
_PIECE = 4 << 20


def _last_line(file: BinaryIO, path: str) -> tuple[bytes, int]:
    """The line, and the number of bytes before it."""
    if file.read(len(_SIGNATURE)) != _SIGNATURE:
        raise ResultsError(f"{path}: not an HDF5 file, so no results of jostle")
    size = file.seek(0, os.SEEK_END)
    if size < _SIZE:
        raise ResultsError(f"{path}: truncated; restore it from a copy")
    file.seek(size - _SIZE)
    return file.read(_SIZE), size - _SIZE


def require_seal(path: str | os.PathLike[str], whole: bool) -> None:
    """Raises ResultsError unless the file ends with the line; `whole`: unless its sum is right too.

    Reading the whole file takes about a second a gigabyte.
    """
    name = os.fspath(path)
    if os.path.exists(name) and not os.path.isfile(name):
        raise ResultsError(f"{name}: not a file: results cannot be read from a folder, pipe or device")
    try:
        with open(name, "rb") as file:
            line, size = _last_line(file, name)
            if not line.startswith(_START):
                raise ResultsError(
                    f"{name}: truncated, changed by another program, or not written by jostle (it does "
                    "not end with its checksum); restore it from a copy")
            if not whole:
                return
            file.seek(0)
            found = hashlib.sha256()
            while size > 0:
                piece = file.read(min(_PIECE, size))
                if not piece:
                    break
                found.update(piece)
                size -= len(piece)
    except OSError as error:
        raise ResultsError(f"{name}: cannot read it: {error.strerror}") from error
    if line != _START + found.hexdigest().encode() + b"\n":
        raise ResultsError(f"{name}: damaged, or changed by another program (its checksum is wrong); "
                           "restore it from a copy")
