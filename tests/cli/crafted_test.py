"""Results files that were changed with intent and sealed again: the seal is a checksum, not a signature.
No command crashes, hangs, or follows a link out of the file; what is refused names the file."""

import os
import random
import shutil
import subprocess
import unittest

import h5py

from crafted_files import CRASHED, HUNG, KIN, OF_GRAINS, SEAL, sealed, shared_text, shared_values
from support import BAD_INPUT, BROKEN, FAILED, JOSTLE, OK, PLAIN, TINY, Case, changed, some

SMALL = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}], snapshots={"taps": [0, 40]})
del SMALL["sweep"]

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
