#!/usr/bin/env python3
"""Runs the scenes of the papers' figures, bed after bed, and keeps reduced data of each finished bed.

paper_runs.py JOSTLE FOLDER --hours H [--only NAME ...] or --list. The runs are those of paper_runs.csv, in its order.
One bed is one shard of its scene, and continues from FOLDER after a stop. The reduced data alone record the finished
beds: on another machine only the unfinished bed begins anew."""
import argparse
import contextlib
import csv
import dataclasses
import json
import math
import pathlib
import signal
import subprocess
import sys
import time

from beds import OtherScene, add_beds, check_origin, finished_beds, recovered
from reduce import REDUCED

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = pathlib.Path(__file__).resolve().parent / "paper_runs.csv"
STOPPED = 75  # exit code of a run that a signal or its time limit has stopped


@dataclasses.dataclass(frozen=True)
class PaperRun:
    """A row of the table: `realizations` beds of each sweep point of a scene."""
    name: str
    scene_path: pathlib.Path
    realizations: int
    core_hours: float   # all beds together, measured or predicted
    figures: str

    @property
    def scene(self):
        return json.loads(self.scene_path.read_text())

    @property
    def points(self):
        """Sweep points: the product of the lists, of which those of `zip` count once."""
        sweep = dict(self.scene.get("sweep", {}))
        zipped = sweep.pop("zip", {})
        groups = zipped if isinstance(zipped, list) else [zipped]
        lengths = [len(values) for values in sweep.values()]
        lengths += [len(values) for group in groups for values in list(group.values())[:1]]
        return math.prod(lengths)

    def beds(self):
        """(point, realization) in the order in which they run: every point has one bed before any has two."""
        return [(point, realization) for realization in range(self.realizations) for point in range(self.points)]

    def shard(self, bed):
        """Number and count of the shard that is this bed alone."""
        point, realization = bed
        return realization * self.points + point + 1, self.points * self.scene["realizations"]


def table_of(path=TABLE, scenes=ROOT / "config" / "scenes"):
    with path.open(newline="") as file:
        return [PaperRun(row["name"], scenes / (row["scene"] + ".json"), int(row["realizations"]),
                         float(row["core-hours"]), row["figures"]) for row in csv.DictReader(file)]


def left_of(run, reduced):
    """The beds of a run that the reduced data do not hold, in order."""
    recovered(reduced / run.name)
    check_origin(reduced / run.name, run.scene)
    done = finished_beds(reduced / run.name)
    return [bed for bed in run.beds() if bed not in done]


def hours_of(run, reduced):
    """(core-hours spent, core-hours left): those left as the finished beds took, else as the table foretells."""
    done = finished_beds(reduced / run.name)
    beds = run.beds()
    spent = sum(done.values()) / 3600
    finished = sum(bed in done for bed in beds)
    each = spent / len(done) if done else run.core_hours / len(beds)
    return spent, each * (len(beds) - finished)


def listing(runs, reduced):
    """The table of what is done, what is next, and core-hours."""
    lines = [f"{'run':18}{'beds':>10}  {'core-h':>7}  {'left':>6}  figures"]
    spent_in_all = left_in_all = 0.0
    following = None
    for run in runs:
        waiting = left_of(run, reduced)
        spent, left = hours_of(run, reduced)
        following = following or (waiting and run.name) or None
        spent_in_all, left_in_all = spent_in_all + spent, left_in_all + left
        beds = f"{len(run.beds()) - len(waiting)}/{len(run.beds())}"
        lines.append(f"{run.name:18}{beds:>10}  {spent:7.2f}  {left:6.2f}  {run.figures}")
    lines.append(f"{'all':18}{'':>10}  {spent_in_all:7.2f}  {left_in_all:6.2f}")
    return "\n".join(lines + [f"next: {following}" if following else "all runs are finished"])


def yield_processors(session):
    """Lowers the share of a session: Linux weighs it as a whole, whatever the niceness in it (sched(7), autogroup)."""
    with contextlib.suppress(OSError):
        pathlib.Path(f"/proc/{session}/autogroup").write_text("19")


class Stop:
    """Asks the program to stop at Ctrl-C or SIGTERM, as the time limit does: the bed under way is kept."""

    def __init__(self):
        self.asked, self.process = False, None
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self)

    def __call__(self, *_):
        self.asked = True
        if self.process:
            self.process.send_signal(signal.SIGTERM)

    def run(self, command):
        """The exit code of a command at the lowest priority; it does not see the terminal's Ctrl-C itself."""
        self.process = subprocess.Popen(["nice", "-n", "19", *map(str, command)], stdout=subprocess.DEVNULL,
                                        start_new_session=True)
        yield_processors(self.process.pid)
        if self.asked:
            self.process.send_signal(signal.SIGTERM)
        code = self.process.wait()
        self.process = None
        return code


def run_bed(jostle, run, bed, folder, deadline, stop):
    """Runs one bed to its end (True) or to the deadline. Its file stays until the reduced data hold it."""
    number, count = run.shard(bed)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{run.name}-{number}.h5"
    command = [jostle, "run", run.scene_path, "-o", path, "--shard", f"{number}/{count}", "--resume", "--no-progress",
               "--quiet", "--threads", "1"]
    if math.isfinite(deadline):
        command += ["--time-limit", f"{max(1, int(deadline - time.monotonic()))}s"]
    code = stop.run(command)
    if code not in (0, STOPPED):
        sys.exit(f"{run.name}: bed {bed} was not run (exit code {code}); its file is {path}")
    return code == 0, path


def advance(jostle, runs, folder, reduced, deadline, say=print):
    """Runs beds until the deadline, a signal or the end, and reduces each as it ends."""
    stop = Stop()
    for run in runs:
        for bed in left_of(run, reduced):
            if stop.asked or time.monotonic() >= deadline:
                return False
            finished, path = run_bed(jostle, run, bed, folder, deadline, stop)
            if not finished:
                say(f"{run.name}: bed {bed} has stopped; the next call continues it")
                return False
            if add_beds(jostle, path, run.scene, reduced / run.name) != [bed]:
                sys.exit(f"{run.name}: bed {bed} is not in {path}")
            path.unlink()
            say(f"{run.name}: bed {bed} is finished and reduced", flush=True)
    return True


def arguments(command=None):
    parser = argparse.ArgumentParser(prog="./dev physics", allow_abbrev=False)
    for path in ("jostle", "folder"):
        parser.add_argument(path, type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--hours", type=float, metavar="H", help="stop after H hours; the next call continues")
    parser.add_argument("--only", action="append", metavar="NAME", help="a run of the list; may be repeated")
    parser.add_argument("--list", action="store_true", help="print what is done, what is next, and core-hours")
    parser.add_argument("--add", type=pathlib.Path, metavar="FILE",
                        help="reduce the finished beds of this results file into the run of --only")
    parser.add_argument("--reduced", type=pathlib.Path, default=REDUCED, help=argparse.SUPPRESS)
    parser.add_argument("--table", type=pathlib.Path, default=TABLE, help=argparse.SUPPRESS)
    parser.add_argument("--scenes", type=pathlib.Path, default=ROOT / "config" / "scenes", help=argparse.SUPPRESS)
    found = parser.parse_args(command)
    if found.hours is not None and not found.hours > 0:
        parser.error(f"--hours must be more than 0, not {found.hours:g}")
    if not found.list and not found.add and found.hours is None:
        parser.error("give --hours H to run what is next, or --list")
    if found.add and len(found.only or ()) != 1:
        parser.error("--add requires one --only NAME, the run that the file belongs to")
    return found, parser


def main(command=None):
    asked, parser = arguments(command)
    runs = table_of(asked.table, asked.scenes)
    for name in asked.only or ():
        if name not in [run.name for run in runs]:
            parser.error(f"--only {name}: no such run; there are {', '.join(run.name for run in runs)}")
    runs = [run for run in runs if run.name in (asked.only or run.name)]
    try:
        if asked.add:
            added = add_beds(asked.jostle, asked.add, runs[0].scene, asked.reduced / runs[0].name)
            print(f"{runs[0].name}: {len(added)} beds of {asked.add} are reduced")
        elif asked.hours is not None:
            advance(asked.jostle, runs, asked.folder, asked.reduced, time.monotonic() + 3600 * asked.hours)
        print(listing(runs, asked.reduced))
    except OtherScene as problem:
        sys.exit(str(problem))


if __name__ == "__main__":
    main()
