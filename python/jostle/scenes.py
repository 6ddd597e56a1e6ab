"""Checking scenes."""

from __future__ import annotations

import dataclasses
import functools
import json
import pathlib
import re
from collections.abc import Mapping
from typing import Any

from .commands import Scene, scene_file, scene_text
from .errors import Fault, JostleError, ProgramError, ProgramMissing, SceneError
from .guards import path_text, takes_arguments
from .program import Path, answer, call


@dataclasses.dataclass(frozen=True)
class Checked:
    """resolved: the scene, every default written out; None where the schema alone was there to check it.
    warnings: what it may not mean, though it can be run. text: effects, size and cost in words."""

    resolved: dict[str, Any] | None
    warnings: list[str]
    text: str


@takes_arguments
def check(scene: Scene | Path, *, pilot: bool = False, threads: int | None = None,
          program: Path | None = None) -> Checked:
    """Raises SceneError with every fault of a scene; otherwise describes it.

    pilot: also try some taps (up to ten seconds, of grains a minute) for estimates of time and memory.
    Without the program, the JSON Schema is asked where jsonschema is installed; docs/reference/scene.md lists what
    it cannot see.
    """
    try:
        with scene_file(scene) as file:
            done = call(["check", *([] if pilot else ["--no-pilot"]),
                         *([] if threads is None else [f"--threads={threads}"])], [file], program=program, folded=False)
    except ProgramMissing as missing:
        return _check_by_schema(scene, missing)
    try:
        resolved, end = json.JSONDecoder().raw_decode(done.stdout)
    except ValueError:
        resolved, end = answer(done), 0
    if not isinstance(resolved, dict) or "name" not in resolved:
        raise ProgramError(f"{done.args[0]} did not answer with a scene as jostle does; is it the program of this "
                           "version?", done.returncode, done.stderr, done.args)
    if isinstance(resolved.get("description"), list):  # folded to the width of a terminal
        resolved["description"] = " ".join(resolved["description"])
    text = done.stdout[end:].strip()
    found = re.search(r"^warnings\n((?:  .*\n?)+)", text, re.MULTILINE)
    warnings = [line.strip() for line in found[1].splitlines()] if found else []
    return Checked(resolved, warnings, text)


@takes_arguments
@functools.cache
def schema(program: Path | None = None) -> dict[str, Any]:
    """The JSON Schema of scenes (draft-07): of the program, else of what is installed with this package."""
    try:
        return answer(call(["schema"], program=program))
    except ProgramMissing:
        here = pathlib.Path(__file__).resolve()
        for above in here.parents:
            for path in ("share/jostle/scene.schema.json", "build/release/scene.schema.json"):
                if (above / path).is_file():
                    return json.loads((above / path).read_text(encoding="utf-8"))
        raise


def _check_by_schema(scene: Scene | Path, missing: ProgramMissing) -> Checked:
    try:
        import jsonschema
    except ImportError:
        raise missing from None
    try:
        if isinstance(scene, Mapping):
            value = json.loads(scene_text(scene))
        else:
            value = json.loads(pathlib.Path(path_text(scene, "scene")).read_text(encoding="utf-8-sig"))
    except JostleError:
        raise
    except (ValueError, RecursionError) as error:
        raise SceneError([Fault("", f"not JSON: {error}")]) from error
    except OSError as error:
        raise JostleError(f"cannot read the scene: {scene}: {error.strerror}") from error
    found = jsonschema.Draft7Validator(schema()).iter_errors(value)
    faults = [Fault("".join("/" + str(part).replace("~", "~0").replace("/", "~1")
                            for part in error.absolute_path), error.message)
              for error in sorted(found, key=lambda one: [str(part) for part in one.absolute_path])]
    if faults:
        raise SceneError(faults)
    return Checked(None, ["checked by the schema alone: the program was not found"], "")
