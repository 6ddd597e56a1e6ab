"""jostle export: stored packings for OVITO, ParaView, and back."""

import base64
import json
import re
import struct
import unittest
import xml.etree.ElementTree

import h5py

from support import BAD_INPUT, BROKEN, TINY, UNFOLDED, Case, changed

N = TINY["spheres"]


def bits(numbers):
    return [struct.pack("<d", number) for number in numbers]


class Export(Case):
    def setUp(self):
        super().setUp()
        self.write(TINY)
        self.run_scene()

    def centres(self, point=0, realization=0, frame=-1):
        """Positions in the results file, read by h5py."""
        with h5py.File(self.folder / "tiny.h5") as file:
            group = f"particles/point_{point:04}_realization_{realization:05}"
            return file[group + "/position/value"][frame].tolist()

    def lines(self, name):
        return (self.folder / name).read_text().splitlines()

    def test_extended_xyz_has_the_stored_bits_and_is_a_start(self):
        out = self.jostle("export", "tiny.h5", "--format", "extxyz", "--sweep-point", 1,
                          "--realization", 2).stdout
        self.assertEqual(out, f"tiny_point1_realization2.xyz: sweep point 1 (dilate = 0.1), realization 2, tap 4, {N} spheres\n")
        lines = self.lines("tiny_point1_realization2.xyz")
        self.assertEqual(len(lines), N + 2)
        for line, centre in zip(lines[2:], self.centres(1, 2)):
            words = line.split()
            self.assertEqual(bits(map(float, words[1:4])), bits(centre))
            self.assertEqual(float(words[4]), 0.5)
            self.assertTrue(0 < int(words[5]) <= 12)
            self.assertTrue(0.7 < float(words[6]) < 4)
        scene = changed(TINY, name="again", start={"file": {"path": "tiny_point1_realization2.xyz"}})
        del scene["sweep"]
        self.write(scene, "again.json")
        self.run_scene(scene="again.json")
        with h5py.File(self.folder / "again.h5") as file:
            start = file["particles/point_0000_realization_00000/position/value"][0].tolist()
        self.assertEqual([bits(r) for r in start], [bits(r) for r in self.centres(1, 2)])

    def test_packings_of_other_points_and_realizations_have_other_names(self):
        for arguments in ([], ["--sweep-point", 1], ["--realization", 1],
                          ["--sweep-point", 1, "--realization", 1]):
            self.jostle("export", "tiny.h5", "--format", "extxyz", *arguments)
        self.assertEqual([name for name in self.files() if name.endswith(".xyz")],
                         ["tiny_point0.xyz", "tiny_point0_realization1.xyz", "tiny_point1.xyz",
                          "tiny_point1_realization1.xyz"])

    def test_lammps_dump_has_a_frame_a_tap(self):
        self.jostle("export", "tiny.h5", "--format", "lammps", "--tap", "all")
        lines = self.lines("tiny_point0.dump")
        self.assertEqual(len(lines), 2 * (N + 9))
        for frame, tap in enumerate((0, 4)):
            part = lines[frame * (N + 9):][:N + 9]
            self.assertEqual(part[:5], ["ITEM: TIMESTEP", str(tap), "ITEM: NUMBER OF ATOMS", str(N),
                                        "ITEM: BOX BOUNDS pp pp ff"])
            self.assertEqual(part[8], "ITEM: ATOMS id type x y z radius coordination "
                             "voronoi_volume q6 structure_type")
            for line, centre in zip(part[9:], self.centres(frame=frame)):
                self.assertEqual(bits(map(float, line.split()[2:5])), bits(centre))

    def arrays(self, name):
        """Every DataArray of a .vtp file."""
        root = xml.etree.ElementTree.parse(self.folder / name).getroot()
        self.assertEqual((root.get("type"), root.get("byte_order"), root.get("header_type")),
                         ("PolyData", "LittleEndian", "UInt64"))
        piece = root.find("PolyData/Piece")
        self.assertEqual((piece.get("NumberOfPoints"), piece.get("NumberOfVerts")),
                         (str(N), str(N)))
        found = {}
        for array in piece.iter("DataArray"):
            raw = base64.b64decode(array.text.strip(), validate=True)
            (size,) = struct.unpack("<Q", raw[:8])
            self.assertEqual(size, len(raw) - 8)
            code = {"Float64": "d", "Int64": "q", "UInt32": "I"}[array.get("type")]
            found[array.get("Name")] = [value for (value,) in struct.iter_unpack("<" + code, raw[8:])]
        return found, float(root.find("PolyData/FieldData/DataArray").text)

    def test_vtk_points_have_the_stored_bits(self):
        self.jostle("export", "tiny.h5", "--format", "vtp", "-o", "a.vtp")
        arrays, tap = self.arrays("a.vtp")
        self.assertEqual(tap, 4)
        self.assertEqual(bits(arrays["Points"]),
                         bits(x for centre in self.centres() for x in centre))
        self.assertEqual(arrays["connectivity"], list(range(N)))
        self.assertEqual(arrays["offsets"], list(range(1, N + 1)))
        self.assertEqual(arrays["radius"], [0.5] * N)
        self.assertEqual(len(arrays["coordination"]), N)
        # Cells fill the box up to the top of the highest sphere.
        top = max(z for _, _, z in self.centres()) + 0.5
        self.assertAlmostEqual(sum(arrays["voronoi_volume"]) / (16 * top), 1, places=10)

    def test_a_name_with_a_dot_is_kept_whole(self):
        for name in ("eps0.02", "eps0.05"):
            self.jostle("export", "tiny.h5", "--format", "vtp", "--tap", "0,4", "-o", name)
            self.assertTrue((self.folder / f"{name}_tap4.vtp").exists())

    def test_several_taps_in_vtk_are_listed_in_time(self):
        self.jostle("export", "tiny.h5", "--format", "vtp", "--tap", "0,4")
        root = xml.etree.ElementTree.parse(self.folder / "tiny_point0.pvd").getroot()
        listed = {item.get("timestep"): item.get("file") for item in root.iter("DataSet")}
        self.assertEqual(listed, {"0": "tiny_point0_tap0.vtp", "4": "tiny_point0_tap4.vtp"})
        for tap, name in listed.items():
            self.assertEqual(self.arrays(name)[1], float(tap))

    def test_an_extended_xyz_can_be_exported_too(self):
        self.jostle("export", "tiny.h5", "--format", "extxyz", "--tap", "all", "-o", "all.xyz")
        self.jostle("export", "all.xyz", "--format", "vtp", "--tap", 0)
        self.assertEqual(bits(self.arrays("all.vtp")[0]["Points"]),
                         bits(x for centre in self.centres(frame=0) for x in centre))

    def test_a_value_that_several_sweep_points_have_chooses_none(self):
        self.write(changed(TINY, sweep={"/protocol/0/tap/dilate": [0.05, 0.1], "/container/width": [4, 5]},
                           snapshots={"taps": [0]}))
        self.run_scene("-o", "two.h5")
        refused = self.jostle("export", "two.h5", "--format", "extxyz", "--sweep-point", "dilate=0.05",
                              expect=BAD_INPUT)
        self.assertIn("--sweep-point dilate=0.05: points 0, 1 have this value, and the command uses only one point: choose it by "
                      "number, as number=0", refused.stderr)
        self.jostle("export", "two.h5", "--format", "extxyz", "--sweep-point", "number=1", "-o", "numbered.xyz")
        self.jostle("export", "two.h5", "--format", "extxyz", "--sweep-point", "1")

    def test_files_that_exist_are_kept_without_force(self):
        (self.folder / "tiny_point0.pvd").write_text("mine")
        refused = ["export", "tiny.h5", "--format", "vtp", "--tap", "all"]
        self.assertIn("tiny_point0.pvd exists and is kept",
                      self.jostle(*refused, expect=BAD_INPUT).stderr)
        self.assertEqual((self.folder / "tiny_point0.pvd").read_text(), "mine")
        self.assertFalse((self.folder / "tiny_point0_tap0.vtp").exists())
        self.jostle(*refused, "--force")
        self.assertNotEqual((self.folder / "tiny_point0.pvd").read_text(), "mine")
        self.assertIn("would destroy it", self.jostle("export", "tiny.h5", "--format", "lammps", "-o",
                                                  "tiny.h5", "--force", expect=BAD_INPUT).stderr)

    def test_links_at_names_made_up_here_are_not_followed(self):
        victim = self.folder / "victim"
        victim.write_text("mine")
        for name in ("all_tap4.vtp", "all.pvd"):
            with self.subTest(name=name):
                (self.folder / name).symlink_to(victim)
                err = self.jostle("export", "tiny.h5", "--format", "vtp", "--tap", "all", "-o",
                                  "all.vtp", "--force", expect=BROKEN).stderr
                self.assertIn(f"{name}: is a link that jostle did not make", err)
                self.assertEqual(victim.read_text(), "mine")
                (self.folder / name).unlink()
        (self.folder / "tiny_point0.dump").symlink_to(victim)
        self.jostle("export", "tiny.h5", "--format", "lammps", "--force", expect=BROKEN)
        self.assertEqual(victim.read_text(), "mine")
        self.jostle("export", "tiny.h5", "--format", "lammps", "-o", "tiny_point0.dump", "--force")
        self.assertNotEqual(victim.read_text(), "mine")  # named: followed

    def test_what_is_not_there_is_answered_with_what_is(self):
        for arguments, answer in (
                (["--tap", 3], "no positions of tap 3; kept: 0, 4"),
                (["--realization", 3], "sweep point 1, realization 2: taps 0, 4"),
                (["--sweep-point", 2], "there is none. The sweep points are\n  0  /protocol/0/tap/dilate=0.02\n"),
                (["--sweep-point", "number=2"], "there is none. The sweep points are"),
                (["--sweep-point", "dilat=0.02"], 'Did you mean "dilate = 0.02"? The sweep points are'),
                (["--tap", "x"], "--tap x: neither a whole number from 0 on nor"),
                (["--format", "pdb"], "pdb")):
            with self.subTest(arguments=arguments):
                before = self.files()
                command = ["export", "tiny.h5"]
                if "--format" not in arguments:
                    command += ["--format", "extxyz"]
                self.assertIn(answer, self.jostle(*command, *arguments, expect=BAD_INPUT).stderr)
                self.assertEqual(self.files(), before)
        self.assertIn("neither a results file", self.jostle("export", "scene.json", "--format",
                                                            "vtp", expect=BROKEN).stderr)

    def test_a_file_without_positions_says_so(self):
        self.write(changed(TINY, name="bare", snapshots={"taps": [0, 4], "keep": ["coordination"]}))
        self.run_scene()
        self.assertIn("the file keeps no positions", self.jostle(
            "export", "bare.h5", "--format", "extxyz", expect=BAD_INPUT).stderr)


class SweepPoints(Case):
    def test_the_help_gives_the_forms_of_a_sweep_point_and_the_columns_of_mixtures(self):
        for command in ("fit", "analyse", "structure", "cost", "report", "export"):
            text = " ".join(self.jostle(command, "--help", environment=UNFOLDED).stdout.split())
            self.assertRegex(text, r"--sweep-point TEXT [^-]*number, VALUE or NAME=VALUE", command)
        self.assertIn("the volume of its Voronoi cell, radical in a mixture. Equal spheres also have q6", text)

    def points(self, name, wanted):
        """Sweep points that fit finds."""
        told = self.jostle("fit", name, "--observable", "mean_height", "--model", "kww", "--json", "--no-store",
                           "--sweep-point", wanted).stdout
        titles = [curve["title"] for curve in json.loads(told)["curves"]]
        return [int(re.search(r"sweep point (\d+)", title).group(1)) for title in titles]

    def refused(self, name, wanted):
        return self.jostle("fit", name, "--observable", "mean_height", "--no-store", "--sweep-point", wanted,
                           expect=BAD_INPUT, environment=UNFOLDED).stderr

    def test_a_number_that_is_a_value_of_another_point_names_none(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}],
                           sweep={"/protocol/0/tap/dilate": [0.02, 2, 1, 3]}))
        self.run_scene()
        for wanted, point in (("0", 0), ("3", 3), ("0.02", 0), ("dilate=1", 2), ("number=1", 1), ("number=2", 2)):
            self.assertEqual(self.points("tiny.h5", wanted), [point], wanted)
        self.assertIn("--sweep-point 2: 2 is the number of a sweep point (dilate = 1) and a value or label of another, "
                      "number 1 (dilate = 2): write number=2 or dilate=2\n", self.refused("tiny.h5", "2"))
        out = self.jostle("export", "tiny.h5", "--format", "extxyz", "--tap", 4, "--sweep-point", "number=2").stdout
        self.assertIn("tiny_point2.xyz: sweep point 2 (dilate = 1), realization 0", out)

    def test_a_label_that_reads_as_a_number_of_a_point_does_not_count(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}],
                           point_labels=["number=1", "strong"]))
        self.run_scene()
        for wanted, point in (("number=0", 0), ("number=1", 1), ("strong", 1)):
            self.assertEqual(self.points("tiny.h5", wanted), [point], wanted)

    def test_a_number_that_is_a_label_of_another_point_names_none(self):
        self.write(changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 40}],
                           point_labels=["1", "weak"]))
        self.run_scene()
        self.assertIn("write number=1 or number=0\n", self.refused("tiny.h5", "1"))
        for wanted, point in (("weak", 1), ("number=0", 0), ("number=1", 1)):
            self.assertEqual(self.points("tiny.h5", wanted), [point], wanted)
        refused = self.refused("tiny.h5", "wek")
        self.assertIn('--sweep-point wek: there is none. Did you mean "weak"? The sweep points are\n'
                      "  0  1  /protocol/0/tap/dilate=0.02\n  1  weak  /protocol/0/tap/dilate=0.1\n", refused)

    def test_a_part_names_the_value_that_it_makes(self):
        scene = changed(TINY, protocol=[{"tap": {"dilate": 0.05}, "count": 8}],
                        sweep={"/engine": ["monte_carlo", {"discrete_element": {}}]})
        del scene["relax"]
        self.write(scene)
        self.run_scene()
        for wanted, point in (("monte_carlo", 0), ("engine=monte_carlo", 0), ("engine=discrete_element", 1)):
            self.assertEqual(self.points("tiny.h5", wanted), [point], wanted)


if __name__ == "__main__":
    unittest.main()
