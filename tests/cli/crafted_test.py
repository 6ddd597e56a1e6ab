"""Results files that were changed with intent and sealed again: the seal is a checksum, not a signature.
No command crashes, hangs, or follows a link out of the file; what is refused names the file."""

import hashlib
import json
import os
import random
import shutil
import subprocess
import unittest
import zlib

import h5py
import numpy as np

from support import BAD_INPUT, BROKEN, FAILED, JOSTLE, OK, PLAIN, TINY, Case, changed, some

SMALL = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}], snapshots={"taps": [0, 40]})
del SMALL["sweep"]
SEAL = len("\njostle-sha256 \n") + 64
POINT = "sweep/point_0000"
SERIES = "observables/point_0000"

# Every one opens the file; run begins or resumes with it.
COMMANDS = (["info", "file.h5"], ["info", "file.h5", "--json"], ["info", "file.h5", "--digest"],
            ["fit", "file.h5", "--observable", "mean_height", "--model", "inverse_log"],
            ["analyse", "file.h5", "steady", "--observable", "mean_height"],
            ["structure", "file.h5", "--part", "profile,order"],
            ["report", "file.h5", "-o", "page.html", "--force"],
            ["export", "file.h5", "--format", "lammps", "--tap", "all", "--force"],
            ["merge", "file.h5", "-o", "merged.h5", "--force"],
            ["status", "file.h5"],
            ["run", "scene.json", "--no-progress", "--resume", "-o", "file.h5"],
            ["run", "longer.json", "--no-progress", "--resume", "-o", "file.h5"],
            ["check", "from.json", "--no-pilot"])


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


class Crafted(Case):
    @classmethod
    def setUpClass(cls):
        cls.tried = {}

    def setUp(self):
        super().setUp()
        self.write(SMALL)
        self.write(changed(SMALL, protocol=[{"tap": {"dilate": 0.05}, "count": 44}]), "longer.json")
        self.write(changed(SMALL, name="from", start={"file": {"path": "file.h5"}}), "from.json")
        self.run_scene("-o", "good.h5")
        os.mkfifo(self.folder / "fifo")
        data = (self.folder / "good.h5").read_bytes()[:-SEAL]
        (self.folder / "other.h5").write_bytes(data)  # not sealed
        (self.folder / "raw.bin").write_bytes(bytes(1 << 20))

    def craft(self, change):
        path = self.folder / "file.h5"
        path.unlink(missing_ok=True)
        path.write_bytes((self.folder / "good.h5").read_bytes()[:-SEAL])
        with h5py.File(path, "r+") as file:
            change(file)
        path.write_bytes(sealed(path.read_bytes()))

    def use(self, command):
        process = subprocess.run([JOSTLE, *command], cwd=self.folder, env=PLAIN, text=True,
                                 errors="replace", stdin=subprocess.DEVNULL, capture_output=True,
                                 timeout=300)
        self.assertIn(process.returncode, (OK, BAD_INPUT, FAILED, BROKEN), process.stderr[-500:])
        for library in ("vector::", "basic_string", "json.exception", "map::at", "std::"):
            self.assertNotIn(library, process.stderr)
        self.assertNotIn("\x1b", process.stdout + process.stderr)
        return process

    def try_all(self, kinds, commands=COMMANDS):
        refusals = 0
        kinds = some(kinds.items(), 5)
        for kind, change in kinds:
            self.craft(change)
            shutil.copy(self.folder / "file.h5", self.folder / "kept.h5")
            refused = 0
            for command in commands:
                with self.subTest(kind=kind, command=" ".join(command)):
                    shutil.copy(self.folder / "kept.h5", self.folder / "file.h5")
                    if self.use(command).returncode in (BAD_INPUT, BROKEN):
                        refused += 1
            self.assertGreater(refused, 0, f"{kind}: nothing refused it")
            refusals += refused
        print(f"{len(kinds)} kinds, {len(kinds) * len(commands)} uses, {refusals} refused")

    def test_the_good_file_is_used_by_all(self):
        self.craft(lambda file: None)
        for command in COMMANDS:
            self.assertEqual(self.use(command).returncode, OK, command)

    def test_kinds_that_could_crash(self):
        self.try_all(CRASHED)

    def test_kinds_that_could_hang(self):
        self.try_all(HUNG)

    def test_their_kin(self):
        self.try_all({kind: change for kind, change in KIN.items() if "escapes" not in kind})

    def test_a_damaged_record_of_free_room(self):
        data = bytearray((self.folder / "good.h5").read_bytes()[:-SEAL])
        header, record = data.index(b"FSHD"), data.index(b"FSSE")
        for at in some((header + 12, header + 28, record + 6), 2):
            changed_data = data.copy()
            changed_data[at] ^= 0xff
            (self.folder / "kept.h5").write_bytes(sealed(bytes(changed_data)))
            for command in COMMANDS:
                with self.subTest(at=at - header, command=" ".join(command)):
                    shutil.copy(self.folder / "kept.h5", self.folder / "file.h5")
                    self.use(command)

    def test_a_digest_survives_bytes_on_which_hdf5_crashes(self):
        """HDF5 1.10 crashes where it lists attributes whose headers are damaged, or closes the file after that."""
        self.write_grains()
        data = (self.folder / "good.h5").read_bytes()[:-SEAL]
        rng = random.Random(20261125)
        crashes = 0
        for _ in some(range(40), 8):
            changed_data = bytearray(data)
            for _ in range(rng.randint(1, 4)):
                changed_data[rng.randrange(len(data))] = rng.randrange(256)
            (self.folder / "file.h5").write_bytes(sealed(bytes(changed_data)))
            done = self.use(["info", "file.h5", "--digest"])
            crashes += "HDF5 crashes when it reads" in done.stderr.replace("\n", " ")
        print(f"{crashes} files crashed HDF5")

    def write_grains(self):
        grains = changed(SMALL, spheres=20, realizations=2, observe=["mean_height"], name="file",
                         start={"random_settle": {}}, snapshots={"taps": [0, 2]},
                         engine={"discrete_element": {"contact": {"walton_braun": {
                             "stiffness": 1000}}}},
                         protocol=[{"tap": {"lift": 0.05}, "count": 2}])
        grains.pop("relax", None)
        self.write(grains)
        self.write(changed(grains, protocol=[{"tap": {"lift": 0.05}, "count": 3}]), "longer.json")
        (self.folder / "good.h5").unlink()
        self.run_scene("-o", "good.h5")

    def test_snapshots_of_grains(self):
        self.write_grains()
        commands = [command for command in COMMANDS if command[0] not in ("fit", "analyse", "check")]
        self.craft(lambda file: None)
        for command in commands:
            self.assertEqual(self.use(command).returncode, OK, command)
        self.try_all(OF_GRAINS, commands)

    def test_escapes_in_a_stored_scene_stay_in_it(self):
        self.craft(KIN["a scene of escapes"])
        for command in COMMANDS:
            with self.subTest(command=command):
                self.use(command)

    def test_few_bytes_do_not_become_gigabytes_of_text(self):
        shared = shared_text("scene/extra", (200_000,), "x" * 100_000)  # only a digest reads it
        for change, command in ((KIN["20 GB of one text"], ["info", "file.h5"]),
                                (shared_values, ["info", "file.h5"]),
                                (shared, ["info", "file.h5", "--digest"])):
            with self.subTest(command=command):
                self.craft(change)
                refused = self.use(command)
                self.assertEqual(refused.returncode, BROKEN)
                self.assertIn("has longer texts than the file has room for", refused.stderr)

    def test_a_file_that_no_command_uses_has_no_digest(self):
        for kind in ("a point that keeps what it keeps itself", "a point that keeps what point -1 keeps",
                     "half a realization"):
            with self.subTest(kind=kind):
                self.craft(KIN[kind])
                for command in (["info", "file.h5"], ["info", "file.h5", "--digest"]):
                    self.assertEqual(self.use(command).returncode, BROKEN)

    def test_no_number_comes_from_an_unsealed_file(self):
        for kind in ("observables in an unsealed file", "a point in an unsealed file",
                     "a column in an unsealed file", "raw values in an unsealed file",
                     "a virtual dataset"):
            self.craft(KIN[kind])
            for command in (["info", "file.h5", "--digest"],
                            ["analyse", "file.h5", "steady", "--observable", "mean_height"],
                            ["fit", "file.h5", "--observable", "mean_height"]):
                with self.subTest(kind=kind, command=command):
                    done = self.use(command)
                    self.assertEqual(done.returncode, BROKEN)
                    self.assertIn("not written by jostle", done.stderr)


if __name__ == "__main__":
    unittest.main()
