"""The program jostle: where it is, and what it says when it refuses."""

from __future__ import annotations

import contextlib
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

from .errors import Fault, ProgramError, ProgramMissing, SceneError

OK, BAD_INPUT, FAILED, BROKEN, STOPPED = 0, 2, 3, 4, 75

Path = str | os.PathLike[str]


def program_path(program: Path | None = None) -> str:
    """The program: as named here, else by the environment variable JOSTLE, else on the PATH."""
    named = os.fspath(program) if program is not None else os.environ.get("JOSTLE", "")
    found = shutil.which(named or "jostle")
    if found is None:
        where = f"{named} is no program" if named else "it is not on the PATH"
        raise ProgramMissing(f"the program jostle was not found: {where}. Build it (./dev install PREFIX), "
                             "and name it with program=, the environment variable JOSTLE, or the PATH")
    return found


def call(arguments: Sequence[object], program: Path | None = None, folder: Path | None = None,
         show: bool = False, accept: Sequence[int] = (OK,), folded: bool = True) -> subprocess.CompletedProcess[str]:
    """Runs the program to its end; an exit code not in `accept` raises what `refusal` makes of it.

    folded: texts fit a terminal; else a paragraph is a line.
    show: what it says on stderr (progress) is shown as it comes. A KeyboardInterrupt is handed on as
    SIGINT, once: the program stores what it has and ends, and the interrupt goes on from here.
    """
    command = [program_path(program), *map(os.fspath, map(_word, arguments))]
    # A group of its own: Ctrl-C reaches it through here alone, and so once.
    environment = None if folded else {**os.environ, "COLUMNS": "10000"}
    process = subprocess.Popen(command, cwd=folder, env=environment, text=True, errors="replace", stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
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


def _word(argument: object) -> str:
    return os.fspath(argument) if isinstance(argument, os.PathLike) else str(argument)


def faults_in(stderr: str) -> list[Fault]:
    """Lines `pointer: message` below the line that counts them."""
    faults = []
    for line in stderr.splitlines():
        found = re.match(r"(\(scene\)|/.*?): (.*)", line)
        if found:
            faults.append(Fault("" if found[1] == "(scene)" else found[1], found[2]))
    return faults


def _refusals_in(stdout: str) -> str:
    """What a JSON report gives as reasons where nothing came of any table or fit, a line each."""
    try:
        report = json.loads(stdout)
    except ValueError:
        return ""
    tables = [(table["name"], table["notes"]) for table in report.get("tables", [])]
    fits = [(f"{curve['title']}, {fit['model']}", fit) for curve in report.get("curves", [])
            for fit in curve["fits"]]
    return "\n".join(f"{name}: {notes['refused']}" for name, notes in tables + fits if "refused" in notes)


def refusal(done: subprocess.CompletedProcess[str]) -> ProgramError:
    """The exception for an exit code."""
    about = {"exit_code": done.returncode, "stderr": done.stderr, "command": done.args}
    if re.search(r"^jostle: .*\b\d+ faults?\b", done.stderr, re.MULTILINE):
        faults = faults_in(done.stderr)
        if faults:
            return SceneError(faults, **about)
    said = done.stderr.strip().removeprefix("jostle: ") or _refusals_in(done.stdout) or done.stdout.strip()
    if done.returncode < 0:
        said = f"jostle was killed by {signal.Signals(-done.returncode).name}. {said}"
    return ProgramError(said or f"jostle ended with exit code {done.returncode}", **about)


def digest_of(path: Path, program: Path | None = None) -> str:
    """SHA-256 of the data of a results file."""
    return call(["info", path, "--digest"], program).stdout.strip()


@contextlib.contextmanager
def joined_with_parts(path: str, program: Path | None = None) -> Iterator[str]:
    """A file of a run's results with its checkpoints joined in; gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="jostle-live-") as folder:
        joined = pathlib.Path(folder) / "live.h5"
        call(["export", path, "--format", "results", "--live", "-o", joined], program)
        yield str(joined)
