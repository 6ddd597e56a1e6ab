"""Reduces finished beds of results files to small CSV files, bed by bed, so that a run can go on where the results are not.

A folder holds origin.csv (scene, digest of its settings, labels of the sweep points), beds.csv (a row per finished bed),
series.csv (observables at log-spaced taps), steady.csv (means of the last taps), spectrum.csv (log-binned power of the
mean height), structure.csv (numbers of the kept packings) and distributions.csv (their means over the beds)."""
import hashlib
import json
import pathlib
import shutil
import subprocess
import tempfile

import h5py
import numpy as np
from scipy import signal

from packings import measured
from reduce import read_table, taps_to_keep, text_of, write_table

STEADY = 1000        # taps, as Philippe and Bideau average; runs of fewer have no steady.csv
WRITTEN = ("$schema", "name", "description", "realizations", "analyse")  # keys that change no bed
LONG_LIST = 6        # kept taps; for longer lists, distributions are kept at the taps that the scene lists singly
AXES = {"profile": "height", "sides": "x", "layers": "height", "coordination": "neighbours", "voronoi": "free_volume",
        "pores": "xi", "void_probability": "sigma"}
KEPT = {"profile": ("phi",), "sides": ("phi_xy",), "layers": ("n",), "coordination": ("neighbour_share",),
        "voronoi": ("free_volume_density",), "pores": ("rho_v", "v_rho_v"), "void_probability": ("p0", "p0_gotoh")}
SINGLE = {"void_probability": (1.2,)}  # places whose values are kept of each bed, for differences within beds
LAYERS = 15          # the lowest, whose shares are kept of each bed


class OtherScene(Exception):
    """The reduced data belong to other settings than the scene's."""


def digest_of(scene):
    """SHA-256 of what a scene computes: descriptions and the number of realizations change no bed."""
    settings = {key: value for key, value in scene.items() if key not in WRITTEN}
    return hashlib.sha256(json.dumps(settings, sort_keys=True).encode()).hexdigest()


def finished_beds(folder):
    """{(point, realization): core-seconds} of the beds that a folder holds."""
    path = folder / "beds.csv"
    if not path.exists():
        return {}
    return {(int(row[0]), int(row[1])): float(row[2]) for row in read_table(path)[1:]}


def check_origin(folder, scene):
    path = folder / "origin.csv"
    if path.exists() and (found := dict(read_table(path)[1:])["sha256 of the settings"]) != digest_of(scene):
        raise OtherScene(f"{folder} holds beds of other settings (digest {found[:16]}..., the scene's is "
                         f"{digest_of(scene)[:16]}...). Move the folder away to begin anew.")


def beds_of(file):
    """(point, column, realization) of every bed of a results file that has all its taps."""
    for name, group in sorted(file["observables"].items()):
        last = len(group["tap"])
        for column, realization in enumerate(group["realization"][:]):
            if group["rows"][column] == last and np.isfinite(group["mean_height"][last - 1, column]):
                yield int(name[-4:]), column, int(realization)


def figure_taps(scene, taps):
    """The kept taps whose distributions are kept: all of a short list, else those that the scene names."""
    if len(taps) <= LONG_LIST:
        return set(taps)
    named = scene["snapshots"]["taps"]
    return set(named["also"] if isinstance(named, dict) else ()) | {taps[0], taps[-1]}


def spectrum_of(heights):
    """(frequency in 1/taps, power) of a series about its mean, Hann window, twelve bins per decade."""
    frequency, power = signal.periodogram(heights, window="hann", detrend="constant")
    frequency, power = frequency[1:], power[1:]
    places = np.round(12 * np.log10(frequency)).astype(int)
    return [(10**np.log10(frequency[places == place]).mean(), power[places == place].mean())
            for place in np.unique(places)]


def structure_of(jostle, path, scene, point, realization, taps):
    """(numbers [(tap, name, value)], curves [(tap, name, x, value)]) of a bed's kept packings."""
    settings = scene.get("structure")
    if not settings or not taps:
        return [], []
    with tempfile.TemporaryDirectory() as folder:
        frames = pathlib.Path(folder) / "frames.xyz"
        subprocess.run([jostle, "export", path, "--format", "extxyz", "-o", frames, "--sweep-point", f"number={point}",
                        "--realization", str(realization), "--tap", "all"], check=True, capture_output=True)
        told = subprocess.run([jostle, "structure", frames, "--settings", json.dumps(settings), "--part",
                               ",".join(settings), "--no-store", "--json"], check=True, stdout=subprocess.PIPE)
    numbers, curves = [], []
    figures = figure_taps(scene, taps)
    for table in json.loads(told.stdout)["tables"]:
        part = table["name"]
        for name, quantity in table["quantities"].items():
            values, axes = quantity["values"], quantity["axes"]
            if axes == ["tap"] and name.rsplit("_", 1)[-1] not in ("error", "95", "status", "realizations"):
                numbers += [(tap, f"{part}/{name}", value) for tap, value in zip(taps, values) if value is not None]
            elif name in KEPT.get(part, ()) and axes == ["tap", AXES[part]]:
                places = table["axes"][AXES[part]]["values"]
                curves += [(tap, f"{part}/{name}", x, value) for tap, row in zip(taps, values) if tap in figures
                           for x, value in zip(places, row) if value]
                numbers += [(tap, f"{part}/{name}({x:g})", value) for tap, row in zip(taps, values)
                            for x, value in zip(places, row)
                            if value is not None and np.isclose(x, SINGLE.get(part, ())).any()]
            elif (part, name) == ("layers", "share"):
                numbers += [(tap, f"layers/share({layer + 1})", value) for tap, row in zip(taps, values)
                            for layer, value in enumerate(row[:LAYERS]) if value is not None]
    return numbers, curves


def kept_packings(file, point, realization):
    """(taps, [tap][sphere] centres) of a bed."""
    name = f"particles/point_{point:04}_realization_{realization:05}/position"
    return ([int(tap) for tap in file[name]["step"][:]], file[name]["value"][:]) if name in file else ([], [])


def bed_of(jostle, path, file, scene, point, column, realization):
    """All rows of one bed, by file."""
    group = file[f"observables/point_{point:04}"]
    columns = names_of(scene)
    series = {name: group[name][:, column] for name in columns}
    last = len(group["tap"]) - 1
    key = [point, realization]
    timing = file[f"timing/point_{point:04}"]
    seconds = float(timing["seconds"][column] + timing["start_seconds"][column])
    rows = {"beds": [key + [f"{seconds:.1f}", text_of(file["provenance/git_revision"]),
                            text_of(file["provenance/version"])]],
            "series": [key + [tap] + [f"{series[name][tap]:.5f}" for name in columns] for tap in taps_to_keep(last)]}
    if last > STEADY:
        tail = slice(last - STEADY + 1, last + 1)
        rows["steady"] = [key + [f"{series[name][tail].mean():.5f}" for name in columns] +
                          [f"{series['mean_height'][tail].std():.5f}"]]
        rows["spectrum"] = [key + [f"{f:.4g}", f"{p:.4g}"] for f, p in
                            spectrum_of(series["mean_height"][last // 2:])]
    taps, packings = kept_packings(file, point, realization)
    numbers, curves = structure_of(jostle, path, scene, point, realization, taps)
    for tap, centres in zip(taps, packings):
        own_numbers, own_curves = measured(scene, centres)
        numbers += [(tap, *number) for number in own_numbers]
        if tap in figure_taps(scene, taps):
            curves += [(tap, *place) for place in own_curves]
    rows["structure"] = [key + [tap, name, f"{value:.6g}"] for tap, name, value in numbers]
    snapshots = f"snapshots/point_{point:04}"
    if snapshots in file and "height_histogram" in file[snapshots]:
        heights, kept = file[snapshots]["height"][:], file[snapshots]["height_histogram"]
        for frame, tap in enumerate(file[snapshots]["tap"][:]):
            if int(tap) in figure_taps(scene, taps):
                curves += [(int(tap), "n", x, n) for x, n in zip(heights, kept[frame, column]) if n > 0]
    return rows, {(point, tap, name, f"{x:.6g}"): float(value) for tap, name, x, value in curves}


def names_of(scene):
    """Columns of the observables of a scene, in its order."""
    def name(entry):
        if isinstance(entry, str):
            return entry
        kind, settings = next(iter(entry.items()))
        if kind == "kind_height":
            return f"height_{settings['kind']}"
        kinds = [settings[key] for key in ("large", "small", "kind") if key in settings]
        return "_".join([settings.get("name", kind), *kinds])
    return [name(entry) for entry in scene["observe"]]


def joined(former, curves):
    """distributions.csv with one more bed of a point: a place that a bed does not reach counts as 0.

    former: {(point, tap, name, x): (sum, sum of squares)}."""
    found = dict(former)
    for place, value in curves.items():
        total, squares = found.get(place, (0.0, 0.0))
        found[place] = (total + value, squares + value**2)
    return found


HEADERS = {"beds": ["point", "realization", "core-seconds", "revision", "version"],
           "spectrum": ["point", "realization", "frequency", "power"],
           "structure": ["point", "realization", "tap", "quantity", "value"],
           "distributions": ["point", "tap", "quantity", "x", "sum over beds", "sum of squares"]}


def read_distributions(folder):
    path = folder / "distributions.csv"
    rows = read_table(path)[1:] if path.exists() else []
    return {(int(point), int(tap), name, x): (float(total), float(squares))
            for point, tap, name, x, total, squares in rows}


def add_beds(jostle, path, scene, folder):
    """Adds the finished beds of a results file that the folder does not hold. Returns their keys.

    The folder is written anew beside the former and then renamed: a stop in between loses nothing."""
    check_origin(folder, scene)
    known, added = finished_beds(folder), []
    rows, distributions = {}, read_distributions(folder)
    with h5py.File(path) as file:
        if digest_of(json.loads(text_of(file["scene/verbatim"]))) != digest_of(scene):
            raise OtherScene(f"{path} was made with other settings than the scene {scene['name']} has.")
        for point, column, realization in beds_of(file):
            if (point, realization) in known:
                continue
            found, curves = bed_of(jostle, path, file, scene, point, column, realization)
            for name, more in found.items():
                rows.setdefault(name, []).extend(more)
            distributions = joined(distributions, curves)
            added.append((point, realization))
        labels = [label.decode() for label in file["sweep/label"][:]]
    if added:
        write_folder(folder, scene, labels, rows, distributions)
    return added


def write_folder(folder, scene, labels, rows, distributions):
    columns = names_of(scene)
    headers = HEADERS | {"series": ["point", "realization", "tap", *columns],
                         "steady": ["point", "realization", *columns, "sigma of mean_height"]}
    new, old = folder.with_name(folder.name + ".new"), folder.with_name(folder.name + ".old")
    for left in (new, old):
        shutil.rmtree(left, ignore_errors=True)
    if folder.exists():
        shutil.copytree(folder, new)
    new.mkdir(parents=True, exist_ok=True)
    for name, more in rows.items():
        path = new / f"{name}.csv"
        former = read_table(path)[1:] if path.exists() else []
        if more or former:
            write_table(path, headers[name], sorted(former + [list(map(str, row)) for row in more], key=place_of))
    if distributions:
        write_table(new / "distributions.csv", headers["distributions"],
                    [[*place, f"{total:.7g}", f"{squares:.7g}"] for place, (total, squares) in
                     sorted(distributions.items(), key=lambda entry: (entry[0][:3], float(entry[0][3])))])
    write_table(new / "origin.csv", ["key", "value"],
                [["scene", scene["name"]], ["sha256 of the settings", digest_of(scene)],
                 *([f"point {k}", label] for k, label in enumerate(labels))])
    if folder.exists():
        folder.rename(old)
    new.rename(folder)
    shutil.rmtree(old, ignore_errors=True)


def place_of(row):
    """Rows in the order of point and realization, as they came within a bed."""
    return int(row[0]), int(row[1])


def recovered(folder):
    """Puts back what a stop between two renames has left."""
    old = folder.with_name(folder.name + ".old")
    if old.exists() and not folder.exists():
        old.rename(folder)


