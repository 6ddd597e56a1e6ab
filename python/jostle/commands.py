"""The program's commands as functions. docs/reference/commands.md describes them."""

from __future__ import annotations

import contextlib
import functools
import json
import math
import os
import re
import reprlib
import tempfile
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from . import results as results_files
from .errors import BadArgument, ProgramError, WrongType
from .fits import FittedCurve, fitted_curves
from .guards import path_text, sweep_point_text, takes_arguments
from .program import BROKEN, FAILED, OK, STOPPED, Path, answer, call, refusal
from .results import Results
from .tables import Table, table_from_json

Scene = Mapping[str, Any]
_NAME = r"[A-Za-z0-9][A-Za-z0-9._-]*"  # name of a scene


class UnfinishedRun(ProgramError):
    """A run that ended without all of its taps; all that it made is stored. results: the file, open."""

    results: Results | None = None


class RunStopped(UnfinishedRun):
    """Stopped by a signal or its time limit (exit code 75): run(..., resume=True) continues."""


class RealizationsFailed(UnfinishedRun):
    """Some realizations failed (exit code 3): results.points[i].reasons has the reasons."""


@contextlib.contextmanager
def scene_file(scene: Scene | Path) -> Iterator[str]:
    """A scene's file: its path, or that of a dict, written for a while. Packings that a dict starts from
    are named from the current folder, where it is written then."""
    if not isinstance(scene, Mapping):
        yield path_text(scene, "scene")
        return
    text = scene_text(scene)
    beside = os.getcwd() if '"file"' in text else None
    with tempfile.NamedTemporaryFile("w", dir=beside, prefix=".scene-", suffix=".json") as file:
        file.write(text)
        file.flush()
        yield file.name


def scene_text(scene: Scene) -> str:
    return _json_text(scene, "a scene", indent=1)


def _json_text(value: Any, what: str, indent: int | None = None) -> str:
    try:
        return json.dumps(value, indent=indent, default=functools.partial(_plain, what))
    except TypeError as error:
        raise WrongType(f"{what} has JSON values alone: {error}") from error
    except (ValueError, RecursionError) as error:
        raise BadArgument(f"{what} cannot be written as JSON: {error}; it must not contain itself, nor be "
                          "nested deeply") from error


def _plain(what: str, value: Any) -> Any:
    """Numbers and arrays of numpy as JSON has them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise WrongType(f"{what} has JSON values alone, and {reprlib.repr(value)} is none")


def _option(name: str, value: object) -> list[str]:
    """--name=value in one word, as the value may begin with a minus; the parser takes the next word for an
    empty value there."""
    text = os.fsdecode(value) if isinstance(value, (os.PathLike, bytes)) else str(value)
    return [f"--{name}={text}"] if text else [f"--{name}", ""]


def _options(**values: object) -> list[str]:
    """--name=value for what is given; a True is a flag; sequences are joined by commas."""
    words: list[str] = []
    for keyword, value in values.items():
        name = keyword.replace("_", "-")
        if value is True:
            words.append(f"--{name}")
        elif value is not None and value is not False:
            several = isinstance(value, Iterable) and not isinstance(value, (str, bytes, os.PathLike))
            words += _option(name, ",".join(map(str, value)) if several else value)  # type: ignore[arg-type]
    return words


def _output(scene: Scene | Path, output: Path | None) -> str:
    if output is not None:
        return path_text(output, "output")
    if isinstance(scene, Mapping):
        named = scene.get("name", "scene")
    else:
        named = "scene"  # the program reports what cannot be read
        with contextlib.suppress(OSError, ValueError, RecursionError), \
                open(path_text(scene, "scene"), encoding="utf-8-sig") as file:
            read = json.load(file)
            named = read.get("name", named) if isinstance(read, dict) else named
    # A name that the program refuses must not lead anywhere before it does.
    return f"{named if isinstance(named, str) and re.fullmatch(_NAME, named) else 'scene'}.h5"


def _opened(done: Any, path: Path, program: Path | None) -> Results:
    """The results of a run or cost; raises where they are unfinished."""
    if done.returncode == OK:
        return results_files.open(path, program=program)
    error = refusal(done)
    kind = RunStopped if done.returncode == STOPPED else RealizationsFailed
    said = str(error)
    if kind is RunStopped:  # the program names its own options, and a dict's file is gone
        said = f"{path}: {said.split('; resume with')[0]}; resume=True continues it"
    unfinished = kind(said, error.exit_code, error.stderr, error.command)
    if os.path.exists(path):
        unfinished.results = results_files.open(path, program=program)
    raise unfinished


@takes_arguments
def run(scene: Scene | Path, output: Path | None = None, *, threads: int | None = None,
        resume: bool = False, retry_failed: bool = False, force: bool = False,
        time_limit: str | None = None, checkpoint_every: str | None = None, shard: str | None = None,
        wait: str | None = None, progress: bool = False, program: Path | None = None) -> Results:
    """Runs a scene (a dict, or the path of one) to its end and opens its results.

    output: default the scene's name + .h5, in the current folder. time_limit, checkpoint_every: "90s",
    "30m", "1h30m". wait: how long another process that works on `output` is waited for, in the same form,
    as in all functions that have it. shard: "i/n". progress: show it on stderr. The other options are those of `jostle
    run`.
    KeyboardInterrupt (Ctrl-C) stops the run as the program does: all taps are stored, resume=True continues.
    Raises SceneError with every fault; RunStopped after a time limit or a signal, RealizationsFailed: both
    have the results that there are; ProgramError for everything else.
    """
    path = _output(scene, output)
    with scene_file(scene) as file:
        done = call(["run", *_option("output", path), *([] if progress else ["--quiet"]),
                     *_options(threads=threads, resume=resume, retry_failed=retry_failed, force=force,
                               time_limit=time_limit, checkpoint_every=checkpoint_every, shard=shard,
                               wait=wait)],
                    [file], program=program, show=progress, accept=(OK, FAILED, STOPPED))
    return _opened(done, path, program)


@takes_arguments
def cost(scene: Scene | Path, output: Path | None = None, *, observable: str | None = None,
         target: float | None = None, budget: str | None = None, replicates: int | None = None,
         taps: int | None = None, sweep_point: int | str | None = None, resume: bool = False,
         force: bool = False, wait: str | None = None, program: Path | None = None) -> tuple[Results, str]:
    """Measures the cost of a scene's accuracy. Returns its results file (tables in `.tables`) and the report's text.

    output: default NAME-cost.h5. target: recommend the cheapest way to this total error of `observable`.
    """
    path = _output(scene, output) if output is not None else f"{_output(scene, None)[:-3]}-cost.h5"
    with scene_file(scene) as file:
        done = call(["cost", *_option("output", path),
                     *_options(observable=observable, target=target, budget=budget, taps=taps,
                               replicates=replicates, sweep_point=sweep_point_text(sweep_point), resume=resume,
                               force=force, wait=wait)], [file], program=program,
                    accept=(OK, FAILED, STOPPED))
    return _opened(done, path, program), done.stdout


def _report(done: Any) -> Any:
    """The JSON of a command that also stores its tables: where it could not, there is a warning."""
    if done.returncode == BROKEN:
        if not done.stdout.strip():
            raise refusal(done)
        warnings.warn(done.stderr.strip(), stacklevel=4)
    return answer(done)


def _paths(results: Results | Path | Sequence[Path]) -> list[str]:
    if isinstance(results, Results):
        return [results.path]
    if isinstance(results, (str, bytes, os.PathLike)):
        return [path_text(results, "results")]
    paths = [one.path if isinstance(one, Results) else path_text(one, "results") for one in results]
    if not paths:
        raise BadArgument("results: there is none in the list; name at least one file")
    return paths


def _live(results: Results | Path | Sequence[Path], live: bool) -> bool:
    """With checkpoints where it is asked for, or where some results were opened so."""
    opened = results if isinstance(results, (list, tuple)) else [results]
    return live or any(isinstance(one, Results) and one.live for one in opened)


@takes_arguments
def fit(results: Results | Path, observable: str | None = None, *, model: str | None = None,
        law: str | None = None, start: Mapping[str, float] | None = None,
        bounds: Mapping[str, tuple[float | None, float | None]] | None = None,
        law_name: str | None = None, sweep_point: int | str | None = None, range: str | None = None,
        fix: Mapping[str, float] | None = None, realizations: bool = False, gaps: str | None = None,
        independent: bool = False, figures: Path | None = None, page: Path | None = None,
        resample: str | None = None,
        resamples: int | None = None, seed: int | None = None, store: bool = True, force: bool = False,
        live: bool = False, wait: str | None = None, program: Path | None = None) -> list[FittedCurve]:
    """Fits laws to the mean curve of an observable at every sweep point, or to a measured curve (CSV).

    Kept in the file under /fits unless store=False; a Results that is open shows them once it is opened
    anew. range: "first:last" of t. The laws and what a report means: docs/reference/laws.md.

    model: a law, or "all" (default). law: one of your own, a formula of t and of parameters that start at
    `start` and stay between `bounds`, (lower, upper), None for no bound; it is called law_name ("own").
    A measured curve: realizations=True takes every column but t for a realization; gaps is "use-others"
    (default) or "drop-row"; independent=True looks for no memory in the residuals; figures is a
    folder and page an HTML file to draw it into, which force=True replaces.
    """
    named = [f"--{option}={name}={float(value)!r}" for option, values in (("fix", fix), ("start", start))
             for name, value in (values or {}).items()]
    for name, (lower, upper) in (bounds or {}).items():
        ends = ["" if end is None or math.isinf(end) else repr(float(end)) for end in (lower, upper)]
        named.append(f"--bounds={name}={':'.join(ends)}")
    done = call(["fit", "--json", *named,
                 *_options(observable=observable, model=model, law=law, law_name=law_name,
                           sweep_point=sweep_point_text(sweep_point), range=range, realizations=realizations,
                           gaps=gaps, independent=independent, figures=figures, page=page, resample=resample,
                           resamples=resamples, seed=seed, no_store=not store, force=force,
                           wait=wait, live=_live(results, live))], _paths(results), program=program,
                accept=(OK, BROKEN))
    return fitted_curves(_report(done))


@takes_arguments
def analyse(results: Results | Path | Sequence[Path], what: str,
            observable: str | Sequence[str] | None = None, *, sweep_point: int | str | None = None,
            last: int | None = None, waiting_times: Sequence[int] | None = None, lags: Sequence[int] | None = None,
            quantity: str | None = None, against: str | None = None, reference: float | None = None,
            spheres: float | None = None, segment: int | None = None, window: str | None = None,
            detrend: str | None = None, band: str | None = None, threshold: float | None = None,
            hold: int | None = None, equilibrium: str | None = None, threads: int | None = None,
            store: bool = True, live: bool = False, wait: str | None = None,
            program: Path | None = None) -> list[Table]:
    """what: "steady", "spectrum", "ageing", "hysteresis", "ordering", "sweep", "volumes" or "memory" of observables, or
    "motion", which has none; docs/reference/analyses.md and docs/reference/volumes.md have the equations.

    Kept in the files under /analysis unless store=False.
    """
    names = [observable] if isinstance(observable, str) else list(observable or [])
    done = call(["analyse"], _paths(results), program=program, accept=(OK, BROKEN), behind=[
        str(what), "--json", *(word for name in names for word in _option("observable", name)),
        *_options(sweep_point=sweep_point_text(sweep_point), last=last, waiting_times=waiting_times, lags=lags,
                  quantity=quantity, against=against, reference=reference, spheres=spheres,
                  segment=segment, window=window, detrend=detrend, band=band, threshold=threshold,
                  hold=hold, equilibrium=equilibrium, threads=threads,
                  no_store=not store, wait=wait, live=_live(results, live))])
    return [table_from_json(one) for one in _report(done)["tables"]]


@takes_arguments
def structure(results: Results | Path | Sequence[Path], *, part: Sequence[str] | None = None,
              settings: Mapping[str, Any] | None = None, tap: Sequence[int] | None = None,
              sweep_point: int | str | None = None, threads: int | None = None, store: bool = True,
              live: bool = False, wait: str | None = None, program: Path | None = None) -> list[Table]:
    """Measures kept packings or extended XYZ files (docs/reference/structure.md).

    Kept in a results file under /structure unless store=False.
    """
    done = call(["structure", "--json",
                 *_options(part=part, settings=None if settings is None else _json_text(settings, "settings"),
                           tap=tap, sweep_point=sweep_point_text(sweep_point), threads=threads,
                           no_store=not store, wait=wait, live=_live(results, live))], _paths(results), program=program, accept=(OK, BROKEN))
    return [table_from_json(one) for one in _report(done)["tables"]]


@takes_arguments
def report(results: Results | Path | Sequence[Path], output: Path, *, live: bool = False,
           force: bool = False, threads: int | None = None, program: Path | None = None) -> Path:
    """Writes one page for a browser with all contents of results (docs/reference/report.md). Returns
    `output`."""
    call(["report", *_option("output", path_text(output, "output")),
          *_options(live=_live(results, live), force=force, threads=threads)], _paths(results), program=program)
    return output


@takes_arguments
def export(results: Results | Path, output: Path, *, format: str, point: int | str | None = None,
           realization: int | None = None, tap: Sequence[int] | str | None = None, live: bool = False,
           force: bool = False, wait: str | None = None, program: Path | None = None) -> Path:
    """Writes kept packings for other programs; format: "extxyz", "lammps", "vtp", "h5md". tap: None the
    last, "all", or some. Returns `output`."""
    call(["export", *_option("format", format), *_option("output", path_text(output, "output")),
          *_options(sweep_point=sweep_point_text(point), realization=realization, tap=tap,
                    live=_live(results, live), force=force, wait=wait)], _paths(results), program=program)
    return output
