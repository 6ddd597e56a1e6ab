"""`./dev physics --hours` chooses the next run, continues after a stop and keeps reduced data, on beds of seconds."""
import contextlib
import csv
import io
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from unittest import mock

import h5py
import numpy as np

import beds
import fits_of_growth
import paper_runs
from packings import neighbours_of_all, peaks_of_layers, pores_of_four_centres
from reduce import read_table

JOSTLE = os.environ["JOSTLE"]
SCENE = {"name": "tiny", "description": ["two strengths"], "seed": 7, "realizations": 3,
         "container": {"sides": "walls", "width": 6}, "spheres": 200, "start": {"pour": "fitted"},
         "protocol": [{"tap": {"dilate": 0.02}, "count": 6}],
         "relax": {"polar": {}, "stop": {"mean_height": {"eta": 1e-3, "every_sweeps": 10}}},
         "observe": ["mean_height", {"bulk_fraction": {"name": "floor", "heights": [0, 2]}}],
         "snapshots": {"taps": [0, 6], "keep": ["positions", "height_histogram"], "bin_width": 0.5},
         "sweep": {"/protocol/0/tap/dilate": [0.02, 0.1]},
         "structure": {"profile": {}, "layers": {}, "pores": {}, "void_probability": {"points": 2000}}}


def check(holds, *found):
    if not holds:
        raise AssertionError(" ".join(map(str, found)))


class Place:
    """A folder with two scenes, their table, and reduced data."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.reduced = self.folder / "reduced"
        self.write("tiny", SCENE)
        self.write("other", SCENE | {"name": "other", "seed": 8, "sweep": {}})
        self.table = self.folder / "runs.csv"
        self.table.write_text("name,scene,realizations,core-hours,figures\n"
                              "first,tiny,2,0.5,fig. 1\nsecond,other,1,1,fig. 2\n")

    def write(self, name, scene):
        (self.folder / f"{name}.json").write_text(json.dumps(scene))

    def call(self, *arguments, code=0):
        told, status = io.StringIO(), 0
        try:
            with contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
                paper_runs.main([JOSTLE, str(self.folder / "raw"), "--reduced", str(self.reduced), "--table",
                                 str(self.table), "--scenes", str(self.folder), *map(str, arguments)])
        except SystemExit as stopped:
            status = stopped.code if isinstance(stopped.code, int) else 1
            told.write(str(stopped.code))
        check(status == code, status, told.getvalue())
        return told.getvalue()

    def runs(self):
        return paper_runs.table_of(self.table, self.folder)

    def rows(self, run, name):
        with (self.reduced / run / f"{name}.csv").open(newline="") as file:
            return list(csv.reader(file))[1:]


def the_next_bed_is_the_first_that_is_missing(place):
    first, second = place.runs()
    check(first.points == 2 and second.points == 1, "points", first.points, second.points)
    check(first.beds() == [(0, 0), (1, 0), (0, 1), (1, 1)], "order", first.beds())
    check(first.shard((1, 1)) == (4, 6), "shard", first.shard((1, 1)))
    check("next: first" in place.call("--list"), "list")
    stopping = [0]

    def after_one(*_, **__):
        stopping[0] += 1
    # A deadline that passes during the second bed: the first is kept, the others wait.
    paper_runs.advance(JOSTLE, place.runs()[:1], place.folder / "raw", place.reduced,
                       Deadline(2), say=after_one)
    check(paper_runs.left_of(first, place.reduced) == [(0, 1), (1, 1)], paper_runs.left_of(first, place.reduced))
    check(stopping[0] == 2, "beds reduced", stopping)
    told = place.call("--list")
    check("2/4" in told and "next: first" in told, told)


class Deadline(float):
    """A deadline that has passed once it has been looked at `beds` times: no test waits for a clock."""

    def __new__(cls, beds):
        made = super().__new__(cls, np.inf)
        made.left = beds
        return made

    def __le__(self, _):
        self.left -= 1
        return self.left < 0


def a_call_goes_on_to_the_end_and_from_another_machine(place):
    told = place.call("--hours", 1)
    check("next" not in told and "all runs are finished" in told, told)
    check(not list((place.folder / "raw").glob("*.h5")), "raw files stay")
    before = {path: path.read_bytes() for path in place.reduced.rglob("*.csv")}
    place.call("--hours", 1)
    check(before == {path: path.read_bytes() for path in place.reduced.rglob("*.csv")}, "a finished run ran again")
    # Reduced data alone decide what is done; `--only` leaves the others.
    (place.reduced / "second").rename(place.folder / "away")
    check("next: second" in place.call("--list"), "a lost folder")
    check(not (place.reduced / "second").exists(), "--only")
    place.call("--hours", 1, "--only", "first")
    check(not (place.reduced / "second").exists(), "--only")
    (place.folder / "away").rename(place.reduced / "second")


def reduced_data_are_those_of_one_run(place):
    """Bed by bed as in one piece: the same rows from a results file of all beds."""
    whole = place.folder / "whole.h5"
    subprocess.run([JOSTLE, "run", place.folder / "tiny.json", "-o", whole, "--quiet", "--no-progress"], check=True)
    copy = place.folder / "copy"
    check(len(beds.add_beds(JOSTLE, whole, SCENE, copy)) == 6, "beds of a whole file")
    for name in ("series", "structure"):
        with (copy / f"{name}.csv").open(newline="") as file:
            rows = [row for row in list(csv.reader(file))[1:] if int(row[1]) < 2]
        check(rows == place.rows("first", name), name, "differs from that of one run")
    with h5py.File(whole) as file:
        height = file["observables/point_0001/mean_height"][6, 1]
        n = file["snapshots/point_0001/height_histogram"][1, :2, :]
    row = next(row for row in place.rows("first", "series") if row[:3] == ["1", "1", "6"])
    check(abs(float(row[3]) - height) < 1e-5, "mean height", row, height)
    found = [(float(total), float(squares)) for point, tap, quantity, _, total, squares in
             place.rows("first", "distributions") if (point, tap, quantity) == ("1", "6", "n")]
    places = n.max(axis=0) > 0
    check(np.allclose(np.array(found), np.array([n.sum(axis=0), (n**2).sum(axis=0)]).T[places], rtol=1e-5), "n", found)
    single = [float(row[4]) for row in place.rows("first", "structure")
              if row[0] == "1" and row[2:4] == ["6", "void_probability/p0(1.2)"]]
    total = next(float(row[4]) for row in place.rows("first", "distributions")
                 if row[:4] == ["1", "6", "void_probability/p0", "1.2"])
    check(len(single) == 2 and np.isclose(sum(single), total, rtol=1e-5), "P0 of each bed", single, total)
    shares = [float(row[4]) for row in place.rows("first", "structure") if row[3] == "layers/share(1)"]
    check(len(shares) == 8 and all(0 <= share <= 1 for share in shares), "shares of layers", shares)
    check(not beds.add_beds(JOSTLE, whole, SCENE, copy), "beds are added twice")


def other_settings_are_refused(place):
    place.write("tiny", SCENE | {"description": ["other words"], "realizations": 9})
    place.call("--list")
    place.write("tiny", SCENE | {"seed": 9})
    told = place.call("--hours", 1, code=1)
    check("beds of other settings" in told, told)
    place.write("tiny", SCENE)
    told = place.call("--add", place.folder / "whole.h5", "--only", "second", code=1)
    check("other settings" in told, told)
    check("no such run; there are first, second" in place.call("--only", "third", "--list", code=2), "--only third")
    check("--hours H" in place.call(code=2), "neither --hours nor --list")


def a_stop_between_two_renames_loses_nothing(place):
    folder = place.reduced / "first"
    folder.rename(folder.with_name("first.old"))
    check("4/4" in place.call("--list"), "recovered")


def a_signal_stops_a_bed_which_goes_on(place):
    """Ctrl-C during a bed of many taps: its file stays, nothing is reduced, and the next call continues it."""
    place.write("other", SCENE | {"name": "other", "seed": 8, "sweep": {}, "snapshots": {"taps": [0]},
                                  "protocol": [{"tap": {"dilate": 0.02}, "count": 1000000}]})
    shutil.rmtree(place.reduced / "second")
    process = subprocess.Popen([sys.executable, paper_runs.__file__, JOSTLE, place.folder / "raw", "--hours", "1",
                                "--only", "second", "--reduced", place.reduced, "--table", place.table, "--scenes",
                                place.folder], stdout=subprocess.PIPE, text=True)
    while not list((place.folder / "raw").glob("second-1.h5")):
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    told = process.communicate()[0]
    check("has stopped" in told and "0/1" in told and process.returncode == 0, told, process.returncode)
    with h5py.File(place.folder / "raw" / "second-1.h5") as file:
        check(file["provenance"].attrs["state"] in ("interrupted", b"interrupted"), dict(file["provenance"].attrs))
    check(not (place.reduced / "second").exists(), "reduced")


def a_run_leaves_the_processors_to_others():
    """Its niceness is 19 more, that of its session 19; a kernel without autogroups has the former alone."""
    waits = 'for _ in $(seq 1000); do grep -q "nice 19" /proc/self/autogroup && exit 0; sleep 0.01; done; exit 1'
    signals = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    stop = paper_runs.Stop()
    try:
        check(stop.run(["sh", "-c", f"test $(nice) = {min(19, os.nice(0) + 19)}"]) == 0, "niceness")
        if pathlib.Path("/proc/self/autogroup").exists():
            check(stop.run(["sh", "-c", waits]) == 0, "niceness of the session")
    finally:
        for number, handler in signals.items():
            signal.signal(number, handler)


def packings_are_measured():
    """Crystals and lattices whose counts are known."""
    spacing = (2 / 3)**0.5
    layers = np.concatenate([np.full(60, 0.5 + k * spacing) for k in range(6)])
    check(np.allclose(peaks_of_layers(layers), 0.5 + spacing * np.arange(4), atol=0.006), peaks_of_layers(layers))
    cubic = np.stack(np.meshgrid(*[np.arange(6) + 0.5] * 3), axis=-1).reshape(-1, 3)
    counts = neighbours_of_all(cubic, (6, 6))
    check(sorted(set(counts)) == [5, 6] and (counts == 5).sum() == 72, "neighbours of a cubic lattice", counts)
    random = np.random.default_rng(1)
    shaken = cubic + random.uniform(-0.01, 0.01, cubic.shape)
    found = pores_of_four_centres(shaken, 6)  # 4 x 4 x 5 centres are inside, 3 x 3 x 4 cubes of five or six tetrahedra
    check(36 * 5 <= found <= 36 * 8, "pores", found)


def fits_are_those_of_the_beds():
    """fits.csv is made from the series beside it, to the digits that other libraries' sums may change."""
    stored, made = read_table(fits_of_growth.FITS)[1:], fits_of_growth.fitted(JOSTLE)
    check([row[:2] for row in stored] == [list(row[:2]) for row in made], "parameters")
    for row, fresh in zip(stored, made):
        for end, again in zip(row[2:], fresh[2:]):
            check(bool(end) == bool(again), row, fresh)
            check(not end or abs(float(again) / float(end) - 1) < 0.02, row, fresh)


def every_run_of_the_table_has_its_scene():
    runs = paper_runs.table_of()
    check(len({run.name for run in runs}) == len(runs), "names")
    for run in runs:
        check(run.realizations <= run.scene["realizations"], run.name, "realizations")
        paper_runs.left_of(run, paper_runs.REDUCED)


def main():
    a_run_leaves_the_processors_to_others()
    packings_are_measured()
    fits_are_those_of_the_beds()
    every_run_of_the_table_has_its_scene()
    # Yielding to other tests, these beds would wait until those end.
    with tempfile.TemporaryDirectory() as folder, mock.patch.object(paper_runs, "yield_processors"):
        place = Place(folder)
        for test in (the_next_bed_is_the_first_that_is_missing, a_call_goes_on_to_the_end_and_from_another_machine,
                     reduced_data_are_those_of_one_run, a_stop_between_two_renames_loses_nothing,
                     other_settings_are_refused, a_signal_stops_a_bed_which_goes_on):
            test(place)


if __name__ == "__main__":
    main()
