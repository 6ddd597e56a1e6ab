"""The program's commands as functions. docs/cli.md says what each does."""

from __future__ import annotations

import contextlib
import json
import math
import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from . import results as results_files
from .errors import RealizationsFailed, RunStopped
from .fits import FittedCurve, fitted_curves
from .program import BAD_INPUT, FAILED, OK, STOPPED, Path, call, refusal
from .results import Results
from .tables import Table, table_from_json

Scene = Mapping[str, Any]


@contextlib.contextmanager
def scene_file(scene: Scene | Path) -> Iterator[str]:
    """A scene's file: its path, or that of a dict, written for a while. Packings that a dict starts from
    are named from the current folder, where it is written then."""
    if not isinstance(scene, Mapping):
        yield os.fspath(scene)
        return
    text = scene_text(scene)
    beside = os.getcwd() if '"file"' in text else None
    with tempfile.NamedTemporaryFile("w", dir=beside, prefix=".scene-", suffix=".json") as file:
        file.write(text)
        file.flush()
        yield file.name


def scene_text(scene: Scene) -> str:
    return json.dumps(scene, indent=1, default=_plain)


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy as JSON has them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a scene has JSON values alone, and {value!r} is none")


def _options(**values: object) -> list[object]:
    """--name value for what is given; a True is a flag; sequences are joined by commas."""
    words: list[object] = []
    for name, value in values.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(option)
        elif value is not None and value is not False:
            several = isinstance(value, Iterable) and not isinstance(value, str)
            words += [option, ",".join(map(str, value)) if several else value]  # type: ignore[arg-type]
    return words


def _output(scene: Scene | Path, output: Path | None) -> Path:
    if output is not None:
        return output
    if isinstance(scene, Mapping):
        named = scene.get("name", "scene")
    else:
        named = "scene"  # what cannot be read is refused by the program, in its words
        with contextlib.suppress(OSError, ValueError), open(scene, encoding="utf-8") as file:
            read = json.load(file)
            named = read.get("name", named) if isinstance(read, dict) else named
    return f"{named}.h5"


def _opened(done: Any, path: Path, program: Path | None) -> Results:
    """The results of a run or cost; raises where they are unfinished."""
    if done.returncode == OK:
        return results_files.open(path, program=program)
    error = refusal(done)
    kind = RunStopped if done.returncode == STOPPED else RealizationsFailed
    said = str(error)
    if kind is RunStopped:  # the program names its own options, and a dict's file is gone
        said = f"{path}: {said.split('; resume with')[0]}; resume=True goes on"
    unfinished = kind(said, error.exit_code, error.stderr, error.command)
    if os.path.exists(path):
        unfinished.results = results_files.open(path, program=program)
    raise unfinished


def run(scene: Scene | Path, output: Path | None = None, *, threads: int | None = None,
        resume: bool = False, retry_failed: bool = False, force: bool = False,
        time_limit: str | None = None, checkpoint_every: str | None = None, shard: str | None = None,
        progress: bool = False, program: Path | None = None) -> Results:
    """Runs a scene (a dict, or the path of one) to its end and opens its results.

    output: default the scene's name + .h5, in the current folder. time_limit, checkpoint_every: "90s",
    "30m", "1h30m". shard: "i/n". progress: show it on stderr. The other options are those of `jostle run`.
    KeyboardInterrupt (Ctrl-C) stops the run as the program does: all taps are stored, resume=True goes on.
    Raises SceneError with every fault; RunStopped after a time limit or a signal, RealizationsFailed: both
    have the results that there are; ProgramError for everything else.
    """
    path = _output(scene, output)
    with scene_file(scene) as file:
        done = call(["run", file, "-o", path, *([] if progress else ["--quiet"]),
                     *_options(threads=threads, resume=resume, retry_failed=retry_failed, force=force,
                               time_limit=time_limit, checkpoint_every=checkpoint_every, shard=shard)],
                    program, show=progress, accept=(OK, FAILED, STOPPED))
    return _opened(done, path, program)


def cost(scene: Scene | Path, output: Path | None = None, *, observable: str | None = None,
         target: float | None = None, budget: str | None = None, replicates: int | None = None,
         taps: int | None = None, sweep_point: int | str | None = None, resume: bool = False,
         force: bool = False, program: Path | None = None) -> tuple[Results, str]:
    """What the accuracy of a scene costs: its results file (tables in `.tables`), and the report's text.

    output: default NAME-cost.h5. target: recommend the cheapest way to this total error of `observable`.
    """
    path = output if output is not None else f"{os.fspath(_output(scene, None))[:-3]}-cost.h5"
    with scene_file(scene) as file:
        done = call(["cost", file, "-o", path,
                     *_options(observable=observable, target=target, budget=budget, taps=taps,
                               replicates=replicates, sweep_point=sweep_point, resume=resume,
                               force=force)], program, accept=(OK, FAILED, STOPPED))
    return _opened(done, path, program), done.stdout


def _paths(results: Results | Path | Sequence[Path]) -> list[Path]:
    if isinstance(results, Results):
        return [results.path]
    if isinstance(results, (str, os.PathLike)):
        return [results]
    return [one.path if isinstance(one, Results) else one for one in results]


def _live(results: Results | Path | Sequence[Path], live: bool) -> bool:
    """With checkpoints where it is asked for, or where results were opened so."""
    return live or isinstance(results, Results) and results.live


def fit(results: Results | Path, observable: str | None = None, *, model: str | None = None,
        law: str | None = None, start: Mapping[str, float] | None = None,
        bounds: Mapping[str, tuple[float | None, float | None]] | None = None,
        law_name: str | None = None, sweep_point: int | str | None = None, range: str | None = None,
        fix: Mapping[str, float] | None = None, realizations: bool = False, resample: str | None = None,
        resamples: int | None = None, seed: int | None = None, store: bool = True, live: bool = False,
        program: Path | None = None) -> list[FittedCurve]:
    """Fits laws to the mean curve of an observable at every sweep point, or to a measured curve (CSV).

    Kept in the file under /fits unless store=False; a Results that is open shows them once it is opened
    anew. range: "first:last" of t. The laws and what a report means: docs/fitting.md.

    model: a law, or "all" (default). law: one of your own, a formula of t and of parameters that start at
    `start` and stay between `bounds`, (lower, upper), None for no bound; it is called law_name ("own").
    """
    named = [word for option, values in (("--fix", fix), ("--start", start))
             for name, value in (values or {}).items() for word in (option, f"{name}={float(value)!r}")]
    for name, (lower, upper) in (bounds or {}).items():
        ends = ["" if end is None or math.isinf(end) else repr(float(end)) for end in (lower, upper)]
        named += ["--bounds", f"{name}={':'.join(ends)}"]
    if law is not None:
        named.append(f"--law={law}")  # one word: it may begin with a minus
    done = call(["fit", *_paths(results), "--json", *named,
                 *_options(observable=observable, model=model, law_name=law_name,
                           sweep_point=sweep_point, range=range, realizations=realizations,
                           resample=resample, resamples=resamples, seed=seed, no_store=not store,
                           live=_live(results, live))], program)
    return fitted_curves(json.loads(done.stdout))


def analyse(results: Results | Path | Sequence[Path], what: str,
            observable: str | Sequence[str] | None = None, *, sweep_point: int | str | None = None, last: int | None = None,
            waiting_times: Sequence[int] | None = None, lags: Sequence[int] | None = None,
            quantity: str | None = None, against: str | None = None, reference: float | None = None,
             spheres: float | None = None, segment: int | None = None, window: str | None = None,
             detrend: str | None = None, band: str | None = None, threshold: float | None = None,
             hold: int | None = None, equilibrium: str | None = None, threads: int | None = None,
             store: bool = True, live: bool = False, program: Path | None = None) -> list[Table]:
    """what: "steady", "spectrum", "ageing", "hysteresis", "ordering", "sweep", "volumes" or "memory" of observables, or
    "motion", which is of none; docs/analysis.md and docs/volumes.md have the equations.

    Kept in the files under /analysis unless store=False.
    """
    names = [observable] if isinstance(observable, str) else list(observable or [])
    done = call(["analyse", *_paths(results), what, "--json", *(["--observable", *names] if names else []),
                 *_options(sweep_point=sweep_point, last=last, waiting_times=waiting_times, lags=lags,
                           quantity=quantity, against=against, reference=reference, spheres=spheres,
                           segment=segment, window=window, detrend=detrend, band=band, threshold=threshold,
                           hold=hold, equilibrium=equilibrium, threads=threads,
                           no_store=not store, live=_live(results, live))], program)
    return [table_from_json(one) for one in json.loads(done.stdout)["tables"]]


def structure(results: Results | Path | Sequence[Path], *, part: Sequence[str] | None = None,
              settings: Mapping[str, Any] | None = None, tap: Sequence[int] | None = None,
              sweep_point: int | str | None = None, threads: int | None = None, store: bool = True,
              live: bool = False, program: Path | None = None) -> list[Table]:
    """What kept packings, or extended XYZ files, look like inside; docs/structure.md says what.

    Kept in a results file under /structure unless store=False.
    """
    done = call(["structure", *_paths(results), "--json",
                 *_options(part=part, settings=None if settings is None else json.dumps(settings),
                           tap=tap, sweep_point=sweep_point, threads=threads, no_store=not store,
                           live=_live(results, live))], program)
    return [table_from_json(one) for one in json.loads(done.stdout)["tables"]]


def report(results: Results | Path | Sequence[Path], output: Path, *, live: bool = False,
           force: bool = False, threads: int | None = None, program: Path | None = None) -> Path:
    """Writes one page for a browser that shows all that results hold; docs/report.md says what. Returns
    `output`."""
    call(["report", *_paths(results), "-o", output,
          *_options(live=_live(results, live), force=force, threads=threads)], program)
    return output


def export(results: Results | Path, output: Path, *, format: str, point: int | None = None,
           realization: int | None = None, tap: Sequence[int] | str | None = None, live: bool = False,
           force: bool = False, program: Path | None = None) -> Path:
    """Writes kept packings for other programs; format: "extxyz", "lammps", "vtp", "h5md". tap: None the
    last, "all", or some. Returns `output`."""
    call(["export", *_paths(results), "--format", format, "-o", output,
          *_options(sweep_point=point, realization=realization, tap=tap, live=_live(results, live),
                    force=force)], program)
    return output
