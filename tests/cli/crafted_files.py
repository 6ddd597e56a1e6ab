"""Changes of a results file by which it could crash a command, hang it, or lead it out of the file. Each is a function of
an open h5py.File."""

import hashlib
import json
import zlib

import h5py
import numpy as np

SEAL = len("\njostle-sha256 \n") + 64  # the last line of a results file
POINT = "sweep/point_0000"
SERIES = "observables/point_0000"


def sealed(data):
    """A file's bytes with the last line that jostle looks for."""
    return data + f"\njostle-sha256 {hashlib.sha256(data).hexdigest()}\n".encode()


def replace(file, name, data, **keywords):
    attributes = dict(file[name].attrs) if keywords.pop("keep", False) else {}
    del file[name]
    dataset = file.create_dataset(name, data=data, **keywords)
    for key, value in attributes.items():
        if key not in ("DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME"):
            dataset.attrs[key] = value


def text(file, name, value):
    del file[name]
    file.create_dataset(name, data=value, dtype=h5py.string_dtype())


def attribute(name, key, value):
    def change(file):
        file[name].attrs[key] = value
    return change


def deep_groups(file):
    group = file["analysis"] if "analysis" in file else file.create_group("analysis")
    for _ in range(20000):
        group = group.create_group("d")


def external(name, target="other.h5", path="/"):
    def change(file):
        if name in file:
            del file[name]
        file[name] = h5py.ExternalLink(target, path)
    return change


def soft(name, path):
    def change(file):
        del file[name]
        file[name] = h5py.SoftLink(path)
    return change


def circle(name, target):
    def change(file):
        file[name] = file[target]
    return change


def many_attributes(file):
    file["scene"].attrs.create("a", 1)
    for i in range(2000):  # 30 000 take minutes to make, and are refused alike
        file["scene"].attrs.create(f"a{i}", i)


def no_points(file):
    replace(file, "sweep/point", np.zeros(0, np.uint32))
    del file["sweep/point_0000"]


def no_processes(file):
    for name in list(file["provenance"]):
        replace(file, f"provenance/{name}", [], dtype=h5py.string_dtype())


def external_storage(file):
    shape = file[f"{SERIES}/mean_height"].shape
    del file[f"{SERIES}/mean_height"]
    file.create_dataset(f"{SERIES}/mean_height", shape, "f8", external=[("raw.bin", 0, 1 << 20)])


def virtual(file):
    shape = file[f"{SERIES}/mean_height"].shape
    layout = h5py.VirtualLayout(shape, "f8")
    layout[...] = h5py.VirtualSource("other.h5", f"{SERIES}/mean_height", shape)
    del file[f"{SERIES}/mean_height"]
    file.create_virtual_dataset(f"{SERIES}/mean_height", layout)


def wrong_axes(file):
    dataset = file[f"{SERIES}/mean_height"]
    del dataset.attrs["DIMENSION_LIST"]
    dataset.attrs["DIMENSION_LIST"] = np.arange(3000)


def nested_scene(file):
    text(file, "scene/resolved", '{"a":' * 100_000 + "1" + "}" * 100_000)


def shared_text(name, shape, value):
    """Texts that are references to one."""
    def change(file):
        if name in file:
            del file[name]
        dataset = file.create_dataset(name, shape, h5py.string_dtype(), chunks=shape,
                                      compression="gzip")
        first = (0,) * len(shape)
        dataset[first] = value
        file.flush()
        mask, raw = dataset.id.read_direct_chunk(first)
        forged = zlib.decompress(raw)[:16] * int(np.prod(shape))
        dataset.id.write_direct_chunk(first, zlib.compress(forged, 9), 0)
    return change


def shared_values(file):
    file.create_dataset("sweep/pointer", data=["/seed"] * 200_000, dtype=h5py.string_dtype())
    shared_text("sweep/value", (1, 200_000), "1" * 100_000)(file)


# Kinds of the first list crashed once, of the second hung, of the third are their kin.
CRASHED = {
    "no sweep points": no_points,
    "no processes": no_processes,
    "no realizations": attribute("scene", "realizations", np.uint32(0)),
    "-5 realizations": attribute("scene", "realizations", np.int32(-5)),
    "shard (0, 0)": attribute("provenance", "shard", np.array([0, 0], np.uint32)),
    "shard of 2^32 - 1": attribute("provenance", "shard", np.array([1, 2 ** 32 - 1], np.uint32)),
    "fewer taps than are stored": attribute(POINT, "taps", np.uint64(3)),
    "2^64 - 1 taps": attribute(POINT, "taps", np.uint64(2**64 - 1)),
    "rows too small": lambda file: replace(file, f"{SERIES}/rows", np.zeros(1, np.uint64)),
    "rows too large": lambda file: replace(file, f"{SERIES}/rows", np.full(3, 2**40, np.uint64)),
    "a longer count column": lambda file: replace(
        file, "ensemble/point_0000/mean_height_count", np.ones(4000, np.uint32)),
    "a scene nested 100 000 deep": nested_scene,
    "groups 20 000 deep": deep_groups,
    "widths of 1e308": attribute(POINT, "widths", np.array([1e308, 1e308, 0])),
    "widths of 0": attribute(POINT, "widths", np.zeros(3)),
}
HUNG = {
    "a circle in /observables": circle("observables/again", "observables"),
    "a circle from the root": circle("fits", "/"),
    "a circle of tables": circle("analysis", "/"),
    "a link to a FIFO": external("observables", "fifo"),
    "a link to a FIFO among the tables": external("analysis", "fifo"),
    "a link to a device": external("fits", "/dev/zero"),
    "2 000 attributes": many_attributes,
}
KIN = {
    "observables in an unsealed file": external("observables", "other.h5", "/observables"),
    "a point in an unsealed file": external(SERIES, "other.h5", "/" + SERIES),
    "a column in an unsealed file": external(f"{SERIES}/mean_height", "other.h5",
                                             f"/{SERIES}/mean_height"),
    "the provenance in an unsealed file": external("provenance", "other.h5", "/provenance"),
    "raw values in an unsealed file": external_storage,
    "a virtual dataset": virtual,
    "a soft link": soft("scene", "/sweep"),
    "a soft link to nothing": soft("ensemble", "/nowhere"),
    "a group for a dataset": lambda file: (file.__delitem__("scene/resolved"),
                                           file.create_group("scene/resolved")),
    "a named type for a dataset": lambda file: (
        file.__delitem__(f"{SERIES}/mean_height"),
        file.__setitem__(f"{SERIES}/mean_height", np.dtype("f8"))),
    "axes that are none": wrong_axes,
    "statuses that mean nothing": lambda file: replace(file, f"{SERIES}/status",
                                                       np.full(3, 99, np.uint8)),
    "series of one row": lambda file: replace(file, f"{SERIES}/mean_height", np.zeros((1, 3))),
    "series of texts": lambda file: replace(file, f"{SERIES}/mean_height", ["x"] * 123,
                                            dtype=h5py.string_dtype()),
    "an axis with a hole": lambda file: file.__delitem__(f"{SERIES}/tap"),
    "a point that keeps what it keeps itself": attribute(
        POINT, "keeps_what_point_keeps", np.uint32(0)),
    "a point that keeps what point -1 keeps": attribute(
        POINT, "keeps_what_point_keeps", np.int64(-1)),
    "half a realization": attribute("scene", "realizations", np.float64(1.5)),
    "20 GB of one text": shared_text("provenance/host", (200_000,), "x" * 100_000),
    "20 GB of one value": shared_values,
    "4 billion spheres": attribute(POINT, "n_spheres", np.uint32(2**32 - 1)),
    "no spheres": attribute(POINT, "n_spheres", np.uint32(0)),
    "other spheres": attribute(POINT, "n_spheres", np.uint32(47)),
    "snapshots out of order": lambda file: replace(file, f"{POINT}/snapshot_taps",
                                                   np.array([40, 0], np.uint64)),
    "a restart state of nothing": lambda file: replace(
        file, "restart/point_0000/realization_00001", np.zeros(0, np.uint8)),
    "a restart state of 255s": lambda file: replace(
        file, "restart/point_0000/realization_00001", np.full(4000, 255, np.uint8)),
    "an observable with a path": lambda file: replace(
        file, f"{POINT}/observables", ["../../scene", "mean_height"], dtype=h5py.string_dtype()),
    "a scene that is a list": lambda file: text(file, "scene/resolved", "[1, 2]"),
    "a scene of escapes": lambda file: text(file, "scene/resolved",
                                            json.dumps({"name": "\x1b[2J", "description": "\x07"})),
    "a scene with another name's type": lambda file: text(file, "scene/resolved", '{"name": 17}'),
    "a sweep value that is no JSON": lambda file: (
        replace(file, f"{POINT}/pointers", ["/seed"], dtype=h5py.string_dtype()),
        replace(file, f"{POINT}/values", ["{"], dtype=h5py.string_dtype())),
    "a terabyte of nothing": lambda file: (
        file.__delitem__("restart/point_0000/realization_00001"),
        file.create_dataset("restart/point_0000/realization_00001", (1 << 40,), "u1",
                            chunks=(1 << 20,))),
    "positions of other numbers": lambda file: replace(
        file, "particles/point_0000_realization_00000/position/value", np.zeros((2, 47, 3))),
    "positions of NaN": lambda file: replace(
        file, "particles/point_0000_realization_00000/position/value", np.full((2, 48, 3), np.nan)),
    "positions at 1e300": lambda file: replace(
        file, "particles/point_0000_realization_00000/position/value", np.full((2, 48, 3), 1e300)),
}

PARTICLES = "particles/point_0000_realization_00000"
TAKEN = "snapshots/point_0000"

# A file of grains, whose snapshots keep more.
OF_GRAINS = {
    "velocities of other numbers": lambda file: replace(
        file, f"{PARTICLES}/velocity/value", np.zeros((2, 19, 3))),
    "velocities of NaN": lambda file: replace(
        file, f"{PARTICLES}/velocity/value", np.full((2, 20, 3), np.nan)),
    "contacts that end before they begin": lambda file: replace(
        file, f"{PARTICLES}/contacts/offset", np.array([0, 2**63], np.uint64)),
    "contacts from the middle on": lambda file: replace(
        file, f"{PARTICLES}/contacts/offset", np.array([1, 2], np.uint64)),
    "offsets of other steps": lambda file: replace(
        file, f"{PARTICLES}/contacts/offset", np.zeros(3, np.uint64)),
    "contacts of no sphere": lambda file: replace(
        file, f"{PARTICLES}/contacts/first",
        np.full(len(file[f"{PARTICLES}/contacts/first"]), 2**32 - 1, np.uint32)),
    "contacts with no wall": lambda file: replace(
        file, f"{PARTICLES}/contacts/second",
        np.full(len(file[f"{PARTICLES}/contacts/first"]), 21, np.uint32)),
    "one contact again and again": lambda file: (
        replace(file, f"{PARTICLES}/contacts/first",
                np.zeros(len(file[f"{PARTICLES}/contacts/first"]), np.uint32)),
        replace(file, f"{PARTICLES}/contacts/second",
                np.ones(len(file[f"{PARTICLES}/contacts/first"]), np.uint32))),
    "forces without end": lambda file: replace(
        file, f"{PARTICLES}/contacts/normal_force",
        np.full(len(file[f"{PARTICLES}/contacts/first"]), np.inf)),
    "normals of other contacts": lambda file: replace(
        file, f"{PARTICLES}/contacts/normal", np.zeros((3, 3))),
    "a terabyte of contacts": lambda file: [
        (file[f"{PARTICLES}/contacts"].__delitem__(name),
         file.create_dataset(f"{PARTICLES}/contacts/{name}", (1 << 37, *shape), kind, chunks=True))
        for name, kind, shape in (("first", "u4", ()), ("second", "u4", ()), ("overlap", "f8", ()),
                                  ("normal_force", "f8", ()), ("normal", "f8", (3,)),
                                  ("tangential_force", "f8", (3,)))],
    "forces of other walls": lambda file: replace(
        file, f"{TAKEN}/wall_normal_force", np.zeros((2, 2, 7))),
    "a tensor of two directions": lambda file: replace(
        file, f"{TAKEN}/force_moment", np.zeros((2, 2, 2, 2))),
    "temperatures of other taps": lambda file: replace(
        file, f"{TAKEN}/granular_temperature_lateral", np.zeros((1, 2, 9))),
    "more kept than there is": attribute(POINT, "snapshots_keep", np.ones(9, np.uint8)),
    "less kept than there is": attribute(POINT, "snapshots_keep", np.ones(2, np.uint8)),
}
