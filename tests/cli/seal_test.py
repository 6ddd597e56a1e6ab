"""Results files that other programs opened for writing: HDF5 removes their last line, the checksum. Unchanged
contents are used, with a warning; changes are rejected by name."""

import random
import sys
import unittest

import h5py
import numpy as np

from crafted_files import SEAL
from support import BAD_INPUT, BROKEN, JOSTLE, OK, SOURCE, STOPPED, SLOW, TINY, Case, changed

sys.path.insert(0, str(SOURCE / "python"))
import jostle  # noqa: E402

TINY = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}], snapshots={"taps": [0, 40]})
GRAINS = changed(TINY, spheres=20, realizations=2, observe=["mean_height"], start={"random_settle": {}},
                 engine={"discrete_element": {"contact": {"walton_braun": {"stiffness": 1000}}}},
                 protocol=[{"tap": {"lift": 0.05}, "count": 2}], snapshots={"taps": [0, 2]})
del GRAINS["sweep"], GRAINS["relax"]
SERIES = "observables/point_0000"

COMMANDS = (["info", "file.h5"], ["info", "file.h5", "--json"], ["info", "file.h5", "--digest"],
            ["fit", "file.h5", "--observable", "mean_height", "--model", "inverse_log", "--no-store"],
            ["analyse", "file.h5", "--no-store", "steady", "--observable", "mean_height"],
            ["structure", "file.h5", "--part", "profile", "--no-store"],
            ["report", "file.h5", "-o", "page.html", "--force"],
            ["export", "file.h5", "--format", "lammps", "--force"],
            ["export", "file.h5", "--format", "results", "-o", "copy.h5", "--force"],
            ["merge", "file.h5", "-o", "merged.h5", "--force"],
            ["status", "file.h5"],
            ["run", "scene.json", "--no-progress", "--resume", "-o", "file.h5"])


def open_for_writing(path):
    h5py.File(path, "r+").close()


class Seal(Case):
    def setUp(self):
        super().setUp()
        self.write(TINY)
        self.path = self.folder / "file.h5"

    def make(self, scene=TINY, *arguments, **keywords):
        self.write(scene)
        self.path.unlink(missing_ok=True)
        self.run_scene("-o", "file.h5", *arguments, **keywords)
        self.good = self.path.read_bytes()

    def change(self, change):
        self.path.write_bytes(self.good)
        with h5py.File(self.path, "r+") as file:
            change(file)

    def sealed(self):
        return self.path.read_bytes()[-SEAL:].startswith(b"\njostle-sha256 ")

    def use_by_all(self, commands, digest):
        self.change(lambda file: None)
        for command in commands:
            with self.subTest(command=" ".join(command)):
                done = self.jostle(*command)
                self.assertIn("file.h5: another program opened it for writing", done.stderr.replace("\n", " "))
                self.assertIn("jostle info --reseal", done.stderr)
                self.assertFalse(self.sealed())
                if "--digest" in command:
                    self.assertEqual(done.stdout.strip(), digest)
        for copy in ("merged.h5", "copy.h5"):
            if (self.folder / copy).exists():
                self.assertEqual(self.digest(copy), digest)

    def test_what_was_not_changed_is_used_by_every_command(self):
        for name, scene in (("sweep", TINY), ("grains", GRAINS)):
            with self.subTest(name):
                self.make(scene)
                digest = self.digest("file.h5")
                commands = [one for one in COMMANDS if name == "sweep" or one[0] not in ("fit", "analyse")]
                self.use_by_all(commands, digest)
                warned = self.jostle("info", "file.h5").stderr
                self.assertEqual(warned.count("warning"), 1)

    def test_it_is_sealed_again_on_demand_and_on_the_next_write(self):
        self.make()
        digest = self.digest("file.h5")
        self.change(lambda file: None)
        self.assertIn("sealed again", self.jostle("info", "--reseal", "file.h5").stdout)
        self.assertTrue(self.sealed())  # HDF5 1.14 has moved bytes, of which none counts
        self.assertEqual(self.digest("file.h5"), digest)
        self.assertIn("nothing to do", self.jostle("info", "--reseal", "file.h5").stdout)
        self.assertIn("--json", self.jostle("info", "--reseal", "--json", "file.h5", expect=BAD_INPUT).stderr)
        for command in (["fit", "file.h5", "--observable", "mean_height", "--model", "inverse_log"],
                        ["analyse", "file.h5", "steady", "--observable", "mean_height"],
                        ["structure", "file.h5", "--part", "profile"]):
            self.change(lambda file: None)
            self.jostle(*command)
            self.assertTrue(self.sealed(), command)
            self.assertEqual(self.jostle("info", "file.h5", "--digest").stderr, "")
            self.assertEqual(self.digest("file.h5"), digest)
        self.change(lambda file: None)
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 42}]))
        self.run_scene("--resume", "-o", "file.h5")
        self.assertTrue(self.sealed())

    def test_tables_that_were_stored_are_verified_too(self):
        self.make()
        self.jostle("fit", "file.h5", "--observable", "mean_height", "--model", "inverse_log")
        self.jostle("analyse", "file.h5", "steady", "--observable", "mean_height")
        self.good = self.path.read_bytes()
        self.change(lambda file: None)
        self.jostle("info", "--reseal", "file.h5")

        def change_a_fit(file):
            file["fits/point_0000/mean_height/inverse_log"].attrs["version"] = "another"

        self.change(change_a_fit)
        refused = self.jostle("info", "file.h5", expect=BROKEN).stderr
        self.assertIn("attribute version of /fits/point_0000/mean_height/inverse_log", refused)

    def test_shards_and_runs_that_were_stopped(self):
        self.write(TINY)
        for i in (1, 2):
            self.run_scene("--shard", f"{i}/2", "-o", f"{i}.h5")
            open_for_writing(self.folder / f"{i}.h5")
        done = self.jostle("merge", "1.h5", "2.h5", "-o", "all.h5")
        self.assertEqual(done.stderr.count("warning"), 2)
        self.assertEqual(self.jostle("status", "1.h5", "2.h5").stderr.count("warning"), 2)
        self.run_scene("-o", "whole.h5")
        self.assertEqual(self.digest("all.h5"), self.digest("whole.h5"))
        self.write(changed(SLOW, relax={"polar": {}, "stop": {"sweeps": 500000}}))
        self.run_scene("-o", "slow.h5", "--time-limit", "0.1", expect=STOPPED)
        open_for_writing(self.folder / "slow.h5")
        self.run_scene("--resume", "-o", "slow.h5")
        self.run_scene("-o", "straight.h5")
        self.assertEqual(self.digest("slow.h5"), self.digest("straight.h5"))

    def test_what_was_changed_is_named_and_refused_by_every_command(self):
        self.make()

        def value(file):
            file[f"{SERIES}/mean_height"][1, 0] += 1

        def without_an_attribute(file):
            del file[f"{SERIES}/mean_height"].attrs["units"]

        def one_bit_of_a_text(file):
            file["scene/resolved"][()] = file["scene/resolved"][()].decode().replace("48", "49")

        kinds = (
            ("attribute note of /observables/point_0000/mean_height",
             lambda file: file[f"{SERIES}/mean_height"].attrs.create("note", "mine")),
            ("attribute note of /", lambda file: file.attrs.create("note", "mine")),
            ("/scene attribute flag", lambda file: file["scene"].attrs.create("flag", True)),
            ("attribute state of /provenance", lambda file: file["provenance"].attrs.create("state", "x")),
            ("attributes of /observables/point_0000/mean_height", without_an_attribute),
            ("/observables/point_0000/mean_height", value),
            ("/scene/resolved", one_bit_of_a_text),
            ("/observables/mine", lambda file: file["observables"].create_group("mine")),
            ("/mine", lambda file: file.create_dataset("mine", data=np.arange(3))),
            ("members of /observables/point_0000", lambda file: file.__delitem__(f"{SERIES}/bottom_fraction")),
            ("/timing/point_0000/seconds", lambda file: file["timing/point_0000/seconds"].write_direct(np.ones(3))),
            ("/provenance/contents/mine", lambda file: file.create_group("provenance/contents/mine")),
        )
        for name, change in kinds:
            with self.subTest(name):
                self.change(change)
                before = self.path.read_bytes()
                storing = ["fit", "file.h5", "--observable", "mean_height"]
                for command in (*(COMMANDS if change is value else COMMANDS[:1]), storing,
                                ["info", "--reseal", "file.h5"]):
                    done = self.jostle(*command, expect=BROKEN)
                    self.assertIn("file.h5", done.stderr, command)
                    if "contents" not in name:
                        self.assertIn(name, done.stderr.replace("\n", " "), command)
                self.assertEqual(self.path.read_bytes(), before)

    def test_a_change_that_is_undone_is_none(self):
        self.make()

        def add_and_remove(file):
            file["scene"].attrs["note"] = "mine"
            file.create_group("mine").create_dataset("numbers", data=np.arange(1000))
            del file["scene"].attrs["note"], file["mine"]

        self.change(add_and_remove)
        self.assertNotEqual(self.path.read_bytes(), self.good[:-SEAL])
        self.jostle("info", "--reseal", "file.h5")
        self.assertEqual(self.jostle("info", "file.h5").stderr, "")

    def test_what_is_cut_short_is_refused(self):
        self.make()
        unsealed = self.good[:-SEAL]
        for data in (self.good[:-1], self.good[:-SEAL + 1], unsealed[:-1], unsealed[:-4096],
                     unsealed[:len(unsealed) // 2], unsealed[:100], unsealed + b"\n", unsealed + bytes(80),
                     self.good + b"\n"):
            self.path.write_bytes(data)
            for command in (["info", "file.h5"], ["info", "--reseal", "file.h5"], ["status", "file.h5"]):
                self.assertIn("file.h5", self.jostle(*command, expect=BROKEN).stderr)

    def test_bytes_that_were_flipped_are_refused_or_change_nothing(self):
        rng = random.Random(20261125)
        for scene in (TINY, GRAINS):
            self.make(scene)
            digest = self.digest("file.h5")
            unsealed, refused = self.good[:-SEAL], 0
            for _ in range(30):
                data = bytearray(unsealed)
                for _ in range(rng.randint(1, 4)):
                    data[rng.randrange(len(data))] ^= rng.randrange(1, 256)
                self.path.write_bytes(data)
                done = self.jostle("info", "file.h5", "--digest", expect=None)
                self.assertIn(done.returncode, (OK, BROKEN), done.stderr)
                refused += done.returncode == BROKEN
                if done.returncode == OK:  # bytes that hold nothing
                    self.assertEqual(done.stdout.strip(), digest)
            self.assertGreater(refused, 15)
            # Every byte of a column's values counts.
            with h5py.File(self.path, "w") as file:
                pass
            self.path.write_bytes(unsealed)
            with h5py.File(self.path, "r") as file:
                column = file[f"{SERIES}/mean_height"]
                first, size = column.id.get_offset(), column.id.get_storage_size()
            for at in range(first, first + size, 17):
                data = bytearray(unsealed)
                data[at] ^= 1
                self.path.write_bytes(data)
                self.assertIn("mean_height", self.jostle("info", "file.h5", expect=BROKEN).stderr)

    def test_a_user_block_is_named(self):
        self.make()
        for data in (bytes(512) + self.good, bytes(1024) + self.good[:-SEAL]):
            self.path.write_bytes(data)
            for command in (["info", "file.h5"], ["fit", "file.h5", "--observable", "mean_height"],
                            ["merge", "file.h5", "-o", "merged.h5"]):
                self.assertIn("user block", self.jostle(*command, expect=BROKEN).stderr)

    def test_files_without_hashes_of_their_contents(self):
        """Files of earlier versions and of other programs."""
        self.make()
        self.change(lambda file: file.__delitem__("provenance/contents"))
        self.assertIn("no hashes of its contents", self.jostle("info", "file.h5", expect=BROKEN).stderr)
        with h5py.File(self.path, "w") as file:
            file.create_dataset("x", data=np.arange(1000))
        self.assertIn("not written by jostle", self.jostle("info", "file.h5", expect=BROKEN).stderr)

    def test_python_reads_it_with_a_warning(self):
        self.make()
        self.change(lambda file: None)
        with self.assertWarnsRegex(UserWarning, "cut off its last line"):
            with jostle.open(self.path, verify=True, program=JOSTLE) as results:
                self.assertEqual(len(results.points), 2)
                with self.assertWarns(UserWarning):
                    results.verify()
        self.change(lambda file: file.attrs.create("note", "mine"))
        with self.assertRaisesRegex(jostle.ResultsError, "attribute note of /"):
            jostle.open(self.path, program=JOSTLE)
        self.path.write_bytes(self.good[:-1])
        with self.assertRaisesRegex(jostle.ResultsError, "truncated"):
            jostle.open(self.path, program=JOSTLE)
        self.change(lambda file: None)
        with self.assertRaisesRegex(jostle.ResultsError, "only the program can verify"):
            jostle.open(self.path, program="/nowhere/jostle")


if __name__ == "__main__":
    unittest.main()
