"""The program jostle: its place, and its error messages."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from typing import Any

from . import installed
from .errors import BadArgument, Fault, ProgramError, ProgramMissing, SceneError
from .guards import path_text, require_no_nul

OK, BAD_INPUT, FAILED, BROKEN, STOPPED = 0, 2, 3, 4, 75

Path = str | os.PathLike[str]


def program_path(program: Path | None = None) -> str:
    """The program: as named here, else by the environment variable JOSTLE, else installed with this package by
    pip, else on the PATH."""
    named = path_text(program, "program") if program is not None else os.environ.get("JOSTLE", "")
    found = shutil.which(named) if named else installed.program() or shutil.which("jostle")
    if found is None:
        where = f"{named} is no program" if named else "it is not on the PATH"
        raise ProgramMissing(f"the program jostle was not found: {where}. Build it (pip install ., or ./dev install PREFIX), "
                             "and name it with program=, the environment variable JOSTLE, or the PATH")
    return found


def call(words: Sequence[str], files: Sequence[Path] = (), behind: Sequence[str] = (),
         program: Path | None = None, show: bool = False, accept: Sequence[int] = (OK,),
         folded: bool = True) -> subprocess.CompletedProcess[str]:
    """Runs the program to its end; an exit code not in `accept` raises what `refusal` makes of it.

    words: the command and its options. files: what it works on, which "--" keeps from being options.
    behind: the words of a subcommand, which follow the files.
    folded: texts fit a terminal; else a paragraph is a line.
    show: its messages on stderr (progress) are shown at once. A KeyboardInterrupt is handed on as
    SIGINT, once: the program stores what it has and ends, and the interrupt is raised again here.
    """
    operands = ["--", *map(operand, files)] if files else []
    command = [program_path(program), *words, *operands, *behind]
    for word in command:
        require_no_nul(word, words[0])
    environment = None if folded else {**os.environ, "COLUMNS": "10000"}
    try:
        # A group of its own: Ctrl-C reaches it through here alone, and so once.
        process = subprocess.Popen(command, env=environment, text=True, errors="replace",
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   start_new_session=True)
    except UnicodeEncodeError as error:
        raise BadArgument(f"{words[0]}: {error.object!r} cannot be handed to a program: {error.reason}") from error
    except OSError as error:
        raise ProgramMissing(f"{command[0]} cannot be started: {error.strerror}; name another with "
                             "program=, or give fewer or shorter arguments") from error
    try:
        out, err = _output_of(process, show)
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
    done = subprocess.CompletedProcess(command, process.returncode, out, err)
    if done.returncode not in accept:
        raise refusal(done)
    return done


def _output_of(process: subprocess.Popen[str], show: bool) -> tuple[str, str]:
    """stdout and stderr, when both have ended."""
    said: dict[str, list[str]] = {"stdout": [], "stderr": []}

    def listen(name: str) -> None:
        with getattr(process, name) as stream:
            for line in stream:
                said[name].append(line)
                if show and name == "stderr":
                    print(line, end="", file=sys.stderr, flush=True)

    listeners = [threading.Thread(target=listen, args=(name,), daemon=True) for name in said]
    for listener in listeners:
        listener.start()
    try:
        process.wait()
    except KeyboardInterrupt:
        process.send_signal(signal.SIGINT)
        process.wait()  # a second interrupt ends it at once
        raise
    finally:
        if process.poll() is not None:
            for listener in listeners:
                listener.join()
    return "".join(said["stdout"]), "".join(said["stderr"])


def operand(path: Path) -> str:
    """A path that is not read as an option, as "-x.h5", a list, as "[x]", or a subcommand, as "steady"."""
    text = path_text(path)
    return f"./{text}" if re.match(r"[-[]|[a-z]+$", text) else text


def answer(done: subprocess.CompletedProcess[str]) -> Any:
    """The JSON that a command printed."""
    try:
        return json.loads(done.stdout)
    except (ValueError, RecursionError) as error:
        raise ProgramError(f"{done.args[0]} did not answer in JSON as jostle does: {error}; is it the program "
                           "of this version?", done.returncode, done.stderr, done.args) from error


def faults_in(stderr: str) -> list[Fault]:
    """Lines `pointer: message` below the line that counts them."""
    faults = []
    for line in stderr.splitlines():
        found = re.match(r"(\(scene\)|/.*?): (.*)", line)
        if found:
            faults.append(Fault("" if found[1] == "(scene)" else found[1], found[2]))
    return faults


def _refusals_in(stdout: str) -> str:
    """The reasons in a JSON report without any table or fit, one line each."""
    try:
        report = json.loads(stdout)
    except ValueError:
        return ""
    tables = [(table["name"], table["notes"]) for table in report.get("tables", [])]
    fits = [(f"{curve['title']}, {fit['model']}", fit) for curve in report.get("curves", [])
            for fit in curve["fits"]]
    return "\n".join(f"{name}: {notes['refused']}" for name, notes in tables + fits if "refused" in notes)


# The advice of the program names its options; callers of this package have arguments.
_ARGUMENTS = (("with --resume", "with resume=True"), ("with -o FILE", "with output=FILE"),
              ("to another file with -o.", "to another file with output=FILE."), ("with --force", "with force=True"),
              ("--no-store", "store=False"), ("--budget", "budget"), ("--replicates", "replicates"),
              ("(--force)", "(force=True)"), ("(--wait DURATION waits longer)", "(wait=DURATION waits longer)"))


def _with_arguments(said: str) -> str:
    for option, argument in _ARGUMENTS:
        said = said.replace(option, argument)
    return said


def refusal(done: subprocess.CompletedProcess[str]) -> ProgramError:
    """The exception for an exit code."""
    about = {"exit_code": done.returncode, "stderr": done.stderr, "command": done.args}
    if re.search(r"^jostle: .*\b\d+ faults?\b", done.stderr, re.MULTILINE):
        faults = faults_in(done.stderr)
        if faults:
            return SceneError(faults, **about)
    said = done.stderr.strip().removeprefix("jostle: ") or _refusals_in(done.stdout) or done.stdout.strip()
    if done.returncode < 0:
        said = f"jostle was killed by {_signal_name(-done.returncode)}. {said}"
    return ProgramError(_with_arguments(said) or f"jostle ended with exit code {done.returncode}", **about)


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:  # a real-time signal
        return f"signal {number}"


def beside(path: str, ending: str) -> str:
    """The path with an ending, as the program names what it puts beside a results file: where the name would
    be too long for its folder, its first bytes and 16 digits of its SHA-256 stand for it."""
    folder, name = os.path.split(os.fsencode(path))
    longest = os.pathconf(folder or b".", "PC_NAME_MAX")
    if len(name) + len(ending) <= longest:
        return path + ending
    kept = longest - len(ending) - 17
    while kept > 0 and name[kept] & 0xC0 == 0x80:  # inside a character
        kept -= 1
    short = name[:kept] + b"~" + hashlib.sha256(name).hexdigest()[:16].encode() + ending.encode()
    return os.fsdecode(os.path.join(folder, short))


def digest_of(path: Path, program: Path | None = None) -> str:
    """SHA-256 of the data of a results file."""
    done = call(["info", "--digest"], [path], program=program)
    digest = done.stdout.strip()
    if not re.fullmatch("[0-9a-f]{64}", digest):
        raise ProgramError(f"{done.args[0]} did not answer with a digest as jostle does; is it the program of "
                           "this version?", done.returncode, done.stderr, done.args)
    return digest


@contextlib.contextmanager
def joined_with_parts(path: str, program: Path | None = None) -> Iterator[str]:
    """A file of a run's results with its checkpoints joined in; gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="jostle-live-") as folder:
        joined = pathlib.Path(folder) / "live.h5"
        call(["export", "--format=results", "--live", f"--output={joined}"], [path], program=program)
        yield str(joined)
