"""Running the program as a user does, on scenes of seconds."""

import copy
import inspect
import json
import os
import pathlib
import random
import shutil
import subprocess
import tempfile
import unittest

JOSTLE = os.environ["JOSTLE"]
# Environment of a program whose calls the shim answers; with sanitizers their runtime must come first.
SHIM = {"LD_PRELOAD": os.environ["FAULT_SHIM"], "ASAN_OPTIONS": "verify_asan_link_order=0"}
SOURCE = pathlib.Path(os.environ["SOURCE"])
# Built without intrinsics and without what only Linux has.
PORTABLE = os.environ.get("PORTABLE") == "1"

OK, BAD_INPUT, FAILED, BROKEN, STOPPED = 0, 2, 3, 4, 75

# Tens of milliseconds: two sweep points of three realizations and four taps.
TINY = {
    "name": "tiny",
    "seed": 4711,
    "realizations": 3,
    "container": {"sides": "periodic", "width": 4},
    "spheres": 48,
    "start": {"pour": "steepest_descent"},
    "protocol": [{"tap": {"dilate": 0.05}, "count": 4}],
    "relax": {"polar": {}, "stop": {"sweeps": 200}},
    "observe": ["mean_height", "bottom_fraction"],
    "snapshots": {"taps": [0, 4]},
    "sweep": {"/protocol/0/tap/dilate": [0.02, 0.1]},
}

# Only the necessary part of the environment, and nothing that configures the program.
PLAIN = {key: value for key, value in os.environ.items()
         if not key.startswith(("JOSTLE", "SLURM"))}


# Half the 68 % interval of a mean over three realizations, in its standard errors: Student's t of two
# degrees of freedom.
HALF_OF_THREE = 0.682689492137086 * (2 / (1 - 0.682689492137086 ** 2)) ** 0.5

# Sentences in one line each, however long.
UNFOLDED = {"COLUMNS": "1000"}


def changed(scene, **changes):
    return {**copy.deepcopy(scene), **changes}


def in_memory():
    """Where files cost no wait for a disk, if there is such a folder with room; else None."""
    memory = "/dev/shm"
    return memory if os.access(memory, os.W_OK) and shutil.disk_usage(memory).free > 2e9 else None


SCRATCH = in_memory()

# Two realizations of two relaxations of 5e7 trials each, a third of a second and more on any machine:
# a stop that comes as soon as the file is there falls inside one, and others find the run at work.
SLOW = changed(TINY, realizations=2, protocol=[{"tap": {"dilate": 0.05}, "count": 2}],
               relax={"polar": {}, "stop": {"sweeps": 1000000}}, snapshots={"taps": [0, 2]})
del SLOW["sweep"]


# Set where all cases of a script are tried, beside the test of every day that tries some.
EVERY = bool(os.environ.get("JOSTLE_EVERY"))


def some(cases, count):
    """`count` of the cases, the first and the last among them, the same at every call; all where EVERY is set. Called
    by a method of the test's class, as has_more_cases() expects."""
    cases = list(cases)
    if EVERY or len(cases) <= count:
        return cases
    if Case.running and not has_more_cases(type(Case.running), Case.running._testMethodName):
        raise AssertionError("call some() in a method of the class: elsewhere it is not seen where EVERY is set")
    inner = random.Random(len(cases)).sample(range(1, len(cases) - 1), count - 2)
    return [cases[0], *(cases[at] for at in sorted(inner)), cases[-1]]


def has_more_cases(cls, name, seen=()):
    """True if a method, or one of its class that it calls, refers to some() or EVERY: it tries more where EVERY is set.
    Decorators are not seen: `if not EVERY: self.skipTest(...)` in place of skipUnless(EVERY, ...)."""
    codes, names = [getattr(getattr(cls, name, None), "__code__", None)], set()
    while codes:
        if code := codes.pop():
            names |= set(code.co_names)
            codes += [part for part in code.co_consts if inspect.iscode(part)]
    return bool(names & {"some", "EVERY"}) or any(has_more_cases(cls, other, (*seen, name)) for other in names - {*seen, name})


class Case(unittest.TestCase):
    """A test in a folder of its own, where it runs the program. Where EVERY is set, tests without further cases are
    skipped, because the daily run has all their cases."""

    maxDiff = None
    running = None

    def __init_subclass__(cls):
        for name in dir(cls) if EVERY else ():
            if name.startswith("test") and not has_more_cases(cls, name):
                setattr(cls, name, unittest.skip("the daily run has all cases")(lambda self: None))

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="jostle-cli-", dir=SCRATCH)
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(os.path.realpath(folder.name))
        Case.running = self

    def write(self, scene, name="scene.json"):
        text = scene if isinstance(scene, str) else json.dumps(scene)
        (self.folder / name).write_text(text)
        return name

    def popen(self, *arguments, environment=None, folder=None):
        return subprocess.Popen([JOSTLE, *map(str, arguments)], cwd=folder or self.folder,
                                env={**PLAIN, **(environment or {})}, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)

    def jostle(self, *arguments, expect=OK, environment=None, folder=None):
        """Runs the program; an exit code other than `expect` (None: any) fails the test."""
        process = self.popen(*arguments, environment=environment, folder=folder)
        out, err = process.communicate(timeout=600)
        if expect is not None and process.returncode != expect:
            self.fail(f"jostle {' '.join(map(str, arguments))}\n  exit code {process.returncode}, "
                      f"not {expect}\n--- stdout\n{out}--- stderr\n{err}")
        return subprocess.CompletedProcess(arguments, process.returncode, out, err)

    def run_scene(self, *arguments, scene="scene.json", **keywords):
        return self.jostle("run", scene, "--no-progress", *arguments, **keywords)

    def digest(self, file, folder=None):
        digest = self.jostle("info", file, "--digest", folder=folder).stdout.strip()
        self.assertRegex(digest, r"^[0-9a-f]{64}$")
        return digest

    def info(self, file, folder=None):
        return json.loads(self.jostle("info", file, "--json", folder=folder).stdout)

    def files(self):
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*"))
