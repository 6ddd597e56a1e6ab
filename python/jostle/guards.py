"""Turns errors below this package into a JostleError with the failure as its cause."""

from __future__ import annotations

import contextlib
import functools
import operator
import os
import reprlib
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from .errors import BadArgument, JostleError, NotThere, ProgramError, ResultsError, WrongType

T = TypeVar("T", bound=type)
F = TypeVar("F", bound=Callable[..., Any])

_PASSED_ON = (JostleError, ImportError, NameError, Warning)  # not faults of a file or an argument


@contextlib.contextmanager
def reading(path: str) -> Iterator[None]:
    """Raises ResultsError where a file is not laid out as a run writes it."""
    try:
        yield
    except _PASSED_ON:
        raise
    except MemoryError as error:
        raise ResultsError(f"{path}: it needs more memory than there is: {error}") from error
    except Exception as error:
        raise ResultsError(f"{path}: damaged, or changed by another program: {_in_words(error)}; "
                           "restore it from a copy") from error


def _in_words(error: Exception) -> str:
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


def reads_file(cls: T) -> T:
    """Has every method and property of a class that reads `self._results` (or is it) raise as reading() does, and report a closed file."""
    def guarded(method: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(method)
        def call(self: Any, *arguments: Any, **keywords: Any) -> Any:
            results = self.__dict__.get("_results", self)
            path = results.__dict__.get("path", "results")
            try:
                with reading(path):
                    return method(self, *arguments, **keywords)
            except ResultsError:
                file = results.__dict__.get("_file")
                if file is None or file:
                    raise
                raise closed(path) from None
        return call

    for name, member in list(vars(cls).items()):
        if isinstance(member, property):
            setattr(cls, name, property(guarded(member.fget), doc=member.__doc__))  # type: ignore[arg-type]
        elif isinstance(member, functools.cached_property):
            again = functools.cached_property(guarded(member.func))
            again.__set_name__(cls, name)
            setattr(cls, name, again)
        elif callable(member) and not name.startswith("__") or name in ("__getitem__", "__iter__"):
            setattr(cls, name, guarded(member))
    return cls


def closed(path: str) -> ResultsError:
    return ResultsError(f"{path}: closed; jostle.open reads it again")


def takes_arguments(function: F) -> F:
    """Has a function raise WrongType, BadArgument or NotThere for arguments that it cannot use."""
    name = function.__name__

    @functools.wraps(function)
    def call(*arguments: Any, **keywords: Any) -> Any:
        try:
            return function(*arguments, **keywords)
        except _PASSED_ON:
            raise
        except (TypeError, AttributeError) as error:
            raise WrongType(f"{name}: {error}; its documentation lists what it takes") from error
        except (ValueError, OverflowError, RecursionError) as error:
            raise BadArgument(f"{name}: {_in_words(error)}; its documentation lists what it takes") from error
        except LookupError as error:
            raise NotThere(f"{name}: there is no {error}") from error
        except OSError as error:
            raise ProgramError(f"{name}: {error.strerror or error}", 4) from error
    return call  # type: ignore[return-value]


def whole_number(value: Any, what: str) -> int:
    """value, of Python or numpy. what: its name, for the message."""
    try:
        return operator.index(value)
    except TypeError:
        raise WrongType(f"{what}: {reprlib.repr(value)} is no whole number") from None


def path_text(path: Any, what: str = "path") -> str:
    """A path as text; WrongType for what is none, BadArgument for what no file can be called."""
    try:
        text = os.fsdecode(path)
        os.fsencode(text)
    except TypeError:
        raise WrongType(f"{what}: {reprlib.repr(path)} is no path: a str, bytes or os.PathLike is expected") from None
    except ValueError as error:
        raise BadArgument(f"{what}: {reprlib.repr(path)} is no file's name: {error}") from error
    require_no_nul(text, what)
    return text


def require_no_nul(text: str, what: str) -> None:
    if "\0" in text:
        raise BadArgument(f"{what}: {reprlib.repr(text)} has a NUL character, which no file's name and no argument of a "
                          "program can hold; take it out")


def sweep_point_text(point: int | str | None) -> str | None:
    """A whole number is the number of a sweep point, even where a value of another is that number."""
    return point if point is None or isinstance(point, str) else f"number={point}"
