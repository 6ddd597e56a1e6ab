"""Small runs, made once per test program."""

import atexit
import copy
import functools
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import jostle

PROGRAM = os.environ["JOSTLE"]
SOURCE = pathlib.Path(os.environ["SOURCE"])
# Set where all cases are tried, beside the test of every day that tries some.
EVERY = bool(os.environ.get("JOSTLE_EVERY"))

# Two strengths in two boxes, three realizations, with everything that is stored of a run.
TINY = {
    "name": "tiny", "seed": 4711, "realizations": 3, "spheres": 48,
    "container": {"sides": "periodic", "width": 4},
    "protocol": [{"tap": {"dilate": 0.05}, "count": 40}],
    "relax": {"polar": {}, "stop": {"sweeps": 60}},
    "observe": ["mean_height", "bottom_fraction"],
    "snapshots": {"taps": [0, 10, 40]},
    "sweep": {"/protocol/0/tap/dilate": [0.02, 0.1], "/container/width": [4, 5]},
}
GRAINS = {
    "name": "grains", "seed": 2010, "realizations": 2, "spheres": 60,
    "container": {"sides": "periodic", "width": 4}, "start": {"random_settle": {"dilute_fraction": 0.2}},
    "engine": {"discrete_element": {}}, "observe": ["mean_height"],
    "snapshots": {"taps": [0, 2]},
    "protocol": [{"tap": {"half_sine": {"amplitude": 0.4413, "frequency": 7.5}}, "count": 2}],
}
# Hours of taps that take a millisecond each.
ENDLESS = {
    "name": "endless", "seed": 1, "realizations": 2, "spheres": 24,
    "container": {"sides": "periodic", "width": 3},
    "protocol": [{"tap": {"dilate": 0.05}, "count": 1_000_000}],
    "relax": {"polar": {}, "stop": {"sweeps": 100}},
    "observe": ["mean_height"], "snapshots": {"taps": [0, 20]},
}


def changed(scene, **changes):
    """A copy with other keys; None takes a key away."""
    scene = {**copy.deepcopy(scene), **changes}
    return {key: value for key, value in scene.items() if value is not None}


@functools.cache
def _made():
    folder = tempfile.TemporaryDirectory(prefix="jostle-python-")
    atexit.register(folder.cleanup)
    return folder, {}


def made(scene, *arguments):
    """The path of a scene's results, run once in this process; to be read only."""
    folder, paths = _made()
    key = json.dumps([scene, arguments])
    if key not in paths:
        path = pathlib.Path(folder.name) / f"{len(paths)}.h5"
        (path.with_suffix(".json")).write_text(json.dumps(scene, indent=1))
        subprocess.run([PROGRAM, "run", path.with_suffix(".json"), "-o", path, "--quiet", "--threads",
                        "2", *arguments], check=True)
        paths[key] = path
    return paths[key]


class Case(unittest.TestCase):
    """A test in a folder of its own."""

    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="jostle-python-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(os.path.realpath(folder.name))
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)

    def open(self, *arguments, **keywords):
        results = jostle.open(*arguments, **keywords)
        self.addCleanup(results.close)
        return results
