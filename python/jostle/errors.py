"""Everything that this package raises of its own is a JostleError."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class JostleError(Exception):
    """Base of all errors of this package."""


class BadArgument(JostleError, ValueError):
    """An argument that no call can mean: circular, with a NUL character, out of range."""


class WrongType(JostleError, TypeError):
    """An argument of a type that the function does not take."""


class ResultsError(JostleError):
    """A file that cannot be read as results: none of jostle's, damaged, cut short, of another layout."""


class NotThere(JostleError, KeyError):
    """The file does not contain the requested item; the message lists its items."""

    __str__ = Exception.__str__  # KeyError shows its message in quotes


class NoSuchPoint(NotThere, IndexError):
    """A number that no sweep point of the file has."""


class ProgramMissing(JostleError):
    """The program jostle was not found."""


class Fault(NamedTuple):
    """One fault of a scene: where (a JSON pointer, "" for the whole), and what is wrong with it."""

    pointer: str
    message: str

    def __str__(self) -> str:
        return f"{self.pointer or '(scene)'}: {self.message}"


class ProgramError(JostleError):
    """The program refused or failed.

    exit_code: as in docs/reference/commands.md (2 bad input, 4 files, disk, memory); negative: the signal that
    killed it. stderr: its messages. command: its command line.
    """

    def __init__(self, message: str, exit_code: int = 2, stderr: str = "",
                 command: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.exit_code, self.stderr, self.command = exit_code, stderr, tuple(command)


class SceneError(ProgramError):
    """A scene with faults; nothing was run. faults: every one of them, in the order of the scene."""

    def __init__(self, faults: Sequence[Fault], **of_program: object) -> None:
        self.faults = list(faults)
        n = len(self.faults)
        super().__init__("\n".join([f"{n} fault{'s' if n != 1 else ''} in the scene",
                                    *map(str, self.faults)]), **of_program)  # type: ignore[arg-type]
