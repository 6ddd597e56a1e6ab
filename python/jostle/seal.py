"""The last line of a results file: the SHA-256 of everything before it (docs/reference/file-format.md)."""

from __future__ import annotations

import hashlib
import os
from typing import BinaryIO

from .errors import ResultsError

_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_START = b"\njostle-sha256 "
_SIZE = len(_START) + 64 + 1
_PIECE = 4 << 20
_END_AT = (40, 44, 28, 28)  # offset of the end of file in a superblock, by its version


def _last_line(file: BinaryIO, path: str) -> tuple[bytes, int]:
    """The line, and the number of bytes before it; no line where HDF5 cut it off."""
    start = file.read(64)
    if not start.startswith(_SIGNATURE):
        raise ResultsError(f"{path}: not an HDF5 file, so no results of jostle")
    size = file.seek(0, os.SEEK_END)
    if size < _SIZE:
        raise ResultsError(f"{path}: truncated; restore it from a copy")
    file.seek(size - _SIZE)
    line = file.read(_SIZE)
    if line.startswith(_START):
        return line, size - _SIZE
    version = start[8]
    if version < len(_END_AT) and size == int.from_bytes(start[_END_AT[version]:][:8], "little"):
        return b"", size
    raise ResultsError(
        f"{path}: truncated, changed by another program, or not written by jostle (it does "
        "not end with its checksum); restore it from a copy")


def has_seal(path: str | os.PathLike[str], whole: bool) -> bool:
    """True if the file ends with the line; False where another program opened the file for writing, which
    cuts the line off. `whole`: verify the sum too. Raises ResultsError for every other file.

    Reading the whole file takes about a second per gigabyte.
    """
    name = os.fspath(path)
    if os.path.exists(name) and not os.path.isfile(name):
        raise ResultsError(f"{name}: not a file: results cannot be read from a folder, pipe or device")
    try:
        with open(name, "rb") as file:
            line, size = _last_line(file, name)
            if not line or not whole:
                return bool(line)
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
    return True
