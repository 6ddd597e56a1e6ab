"""Results files, their curves, and the tables of `jostle analyse`, `fit` and `structure`."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

from verdicts import Estimate

STOPPED = 75  # exit code of a run that a signal or its time limit has stopped
ROOT = pathlib.Path(__file__).resolve().parents[2]


class Table:
    """A table of the program's JSON. What does not exist is nan."""

    def __init__(self, table):
        self.notes = table["notes"]
        self.quantities = table["axes"] | table["quantities"]

    def __contains__(self, name):
        return name in self.quantities

    def __getitem__(self, name):
        values = self.quantities[name]["values"]
        if not self.quantities[name]["axes"]:
            return np.nan if values is None else values
        return np.array(values) if isinstance(values[0], str) else np.array(values, float)

    def estimate(self, name, place=()):
        """A value with its standard error and degrees of freedom."""
        def number(ending):
            value = np.asarray(self[name + ending], float)[place]
            return float(value)
        dof = number("_dof")  # null: known
        return Estimate(number(""), number("_error"), np.inf if np.isnan(dof) else dof)


class Run:
    """A finished run of a reduced scene, its file in `folder`."""

    def __init__(self, jostle, scene, folder):
        self.jostle, self.name = str(jostle), scene
        self.path = pathlib.Path(folder) / (scene.replace("/", "-") + ".h5")
        paper, figure = scene.split("/")
        self.scene_path = ROOT / "config" / "scenes" / paper / "reduced" / (figure + ".json")
        self.scene = json.loads(self.scene_path.read_text())
        self.seconds = 0.0  # core-seconds; known once the file is read

    def make(self, deadline=np.inf):
        """Runs the missing part at low priority, and reads the file. Returns False if the deadline
        (time.monotonic()) has passed first; finished taps are kept."""
        command = [self.jostle, "run", self.scene_path, "-o", self.path, "--resume",
                   "--no-progress"]
        if np.isfinite(deadline):
            command += ["--time-limit", f"{max(1, int(deadline - time.monotonic()))}s"]
        code = subprocess.run(["nice", "-n", "19", *map(str, command)],
                              stdout=subprocess.DEVNULL).returncode
        if code == STOPPED:
            return False
        if code != 0:
            sys.exit(f"{self.name} was not run; if {self.path} belongs to another scene, move it away")
        self.read()
        return True

    def read(self):
        with h5py.File(self.path) as file:
            self.labels = [label.decode() for label in file["sweep/label"][:]]
            self.observables = {point: {name: data[:] for name, data in group.items()}
                                for point, group in sorted(file["observables"].items())}
            self.seconds = sum(float(point[name][:].sum()) for point in file["timing"].values()
                               for name in ("start_seconds", "seconds"))

    @property
    def is_complete(self):
        """True if the file exists and holds all that the scene requests."""
        if not self.path.exists():
            return False
        with h5py.File(self.path) as file:
            return file["provenance"].attrs["state"] in ("complete", b"complete")

    @property
    def realizations(self):
        return self.scene["realizations"]

    def curves(self, observable):
        """[tap, realization] of each sweep point."""
        return [columns[observable] for columns in self.observables.values()]

    def values(self):
        """The swept number of each point."""
        return [float(re.search(r"([0-9.e-]+)}?$", label).group(1)) for label in self.labels]

    def asked(self, *arguments):
        answer = subprocess.run([self.jostle, *map(str, arguments), "--json"], check=True,
                                stdout=subprocess.PIPE)
        return json.loads(answer.stdout)

    def analyse(self, kind, *options):
        """The tables of an analysis, by name; the file keeps them too."""
        answer = self.asked("analyse", self.path, kind, *options)
        return {table["name"]: Table(table) for table in answer["tables"]}

    def fits(self, observable, law, *options):
        """The fit of a law at each sweep point."""
        answer = self.asked("fit", self.path, "--observable", observable, "--model", law, *options)
        return [curve["fits"][0] for curve in answer["curves"]]

    def full_size(self):
        """The scene of the paper's size, from the project's root; None where there is none."""
        scene = self.scene_path.parent.parent / self.scene_path.name
        return scene.relative_to(ROOT) if scene.exists() else None

    def core_hours(self, scene):
        """Core-hours of a scene, scaled from this run by spheres and taps (without taps, by realizations): a
        pilot sees the first taps alone, which cost more or less than later ones. If the run was not read,
        the estimate of `jostle check`."""
        if not self.seconds:
            told = subprocess.run([self.jostle, "check", ROOT / scene], check=True, text=True,
                                  stdout=subprocess.PIPE).stdout
            return " ".join(re.search(r"time: (about|at least).*? ([0-9.e-]+ core-hours|[0-9.]+ m?s of core time)", told,
                                      re.S).groups())

        def work(path):
            told = subprocess.run([self.jostle, "check", ROOT / path, "--no-pilot"], check=True,
                                  text=True, stdout=subprocess.PIPE).stdout
            points, realizations, spheres, taps = map(int, re.search(
                r"(\d+) sweep points? x (\d+) realizations?, (\d+) spheres, (\d+) taps",
                told).groups())
            return spheres * max(taps, points * realizations)
        hours = self.seconds / 3600 * work(scene) / work(self.scene_path)
        return f"about {float(f'{hours:.2g}'):g} core-hours"

    def residual(self, curve, law):
        """The mean square of one realization's residuals from a law, from tap 1 on."""
        taps = np.arange(1, len(curve))
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as text:
            np.savetxt(text, np.column_stack([taps, curve[1:]]), delimiter=",", header="t,X",
                       comments="", fmt="%.17g")
            text.flush()
            fit = self.asked("fit", text.name, "--model", law)["curves"][0]["fits"][0]
        return fit["residual_sum"] / len(taps) if "refused" not in fit else np.nan

    def structure(self, parts, point=0):
        """[realization]{part: Table} of the kept packings; frame k is the k-th kept tap."""
        found = []
        for realization in range(self.realizations):
            frames = self.path.with_suffix(f".p{point}r{realization}.xyz")
            subprocess.run([self.jostle, "export", self.path, "--format", "extxyz", "-o", frames,
                            "--sweep-point", f"number={point}", "--realization", str(realization),
                            "--tap", "all", "--force"], check=True, stdout=subprocess.DEVNULL)
            settings = {part: self.scene.get("structure", {}).get(part, {}) for part in parts}
            tables = self.asked("structure", frames, "--settings", json.dumps(settings),
                                "--no-store")["tables"]
            frames.unlink()
            found.append({table["name"]: Table(table) for table in tables})
        return found

    def ensemble_structure(self, part, point=0):
        """The means over realizations that the run ended with."""
        with h5py.File(self.path) as file:
            group = file[f"structure/point_{point:04}/{part}"]
            return {name: data[()] for name, data in group.items()}
