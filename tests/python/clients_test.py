"""Programs that others wrote open our files: each is skipped, by name, where it is not installed."""

import importlib
import json
import unittest
import warnings

import h5py
import jostle
import numpy as np

from support import TINY, Case, changed, made

BED = changed(TINY, sweep=None)


def client(name):
    """The module; the test is skipped where there is none."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return importlib.import_module(name)
    except ImportError as error:
        raise unittest.SkipTest(f"{name} is not installed") from error


class Clients(Case):
    def setUp(self):
        super().setUp()
        self.path = made(BED)
        self.file = h5py.File(self.path)
        self.addCleanup(self.file.close)
        self.centres = self.file["particles/point_0000_realization_00001/position/value"][()]

    def export(self, name, format, **keywords):
        return jostle.export(self.path, name, format=format, realization=1, tap="all", **keywords)

    def test_h5netcdf(self):
        h5netcdf = client("h5netcdf")
        with h5netcdf.File(self.path, "r") as file:
            group = file["ensemble/point_0000"]
            self.assertEqual(group["mean_height_mean"].dimensions, ("tap",))
            np.testing.assert_array_equal(group["mean_height_mean"][()],
                                          self.file["ensemble/point_0000/mean_height_mean"][()])
            self.assertEqual(file["observables/point_0000/mean_height"].dimensions,
                             ("tap", "realization"))

    def test_netcdf4(self):
        netcdf4 = client("netCDF4")
        with netcdf4.Dataset(self.path) as file:
            group = file["ensemble/point_0000"]
            self.assertEqual(group["mean_height_mean"].dimensions, ("tap",))
            np.testing.assert_array_equal(np.asarray(group["mean_height_mean"][:]),
                                          self.file["ensemble/point_0000/mean_height_mean"][()])
            self.assertEqual(group["mean_height_mean"].units, "diameter")
            np.testing.assert_array_equal(
                np.asarray(file["particles/point_0000_realization_00001/position/value"][:]), self.centres)

    def test_ase_reads_extended_xyz(self):
        io = client("ase.io")
        self.export("a.xyz", "extxyz")
        frames = io.read("a.xyz", index=":")
        self.assertEqual(len(frames), 3)
        for atoms, centres in zip(frames, self.centres):
            np.testing.assert_array_equal(atoms.positions, centres)
            self.assertEqual(atoms.pbc.tolist(), [True, True, False])
            self.assertEqual(atoms.cell.lengths()[:2].tolist(), [4, 4])
            self.assertEqual(set(atoms.arrays["radius"]), {0.5})

    def test_vtk_reads_points(self):
        vtk = client("vtk")
        from vtk.util.numpy_support import vtk_to_numpy
        self.export("a.vtp", "vtp")
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName("a_tap10.vtp")
        reader.Update()
        read = reader.GetOutput()
        np.testing.assert_array_equal(vtk_to_numpy(read.GetPoints().GetData()), self.centres[1])
        columns = read.GetPointData()
        names = {columns.GetArrayName(i) for i in range(columns.GetNumberOfArrays())}
        self.assertEqual(names, {"radius", "coordination", "voronoi_volume", "q6", "structure_type"})

    def trajectory_is_ours(self, trajectory, with_height):
        self.assertEqual(len(trajectory), 3)
        for frame, centres in zip(trajectory, self.centres):
            # MDAnalysis keeps single precision.
            np.testing.assert_allclose(frame.positions, centres, rtol=1e-6)
            np.testing.assert_allclose(frame.dimensions[:2], [4, 4])
            if with_height:
                np.testing.assert_allclose(frame.dimensions[2:],
                                           [centres[:, 2].max() + 0.5, 90, 90, 90], rtol=1e-6)

    def test_mdanalysis_reads_lammps_dumps(self):
        mda = client("MDAnalysis")
        self.export("a.dump", "lammps")
        universe = mda.Universe("a.dump", format="LAMMPSDUMP", topology_format="LAMMPSDUMP")
        self.trajectory_is_ours(universe.trajectory, with_height=True)

    def test_mdanalysis_reads_h5md(self):
        """The examples of docs/reference/python.md."""
        mda = client("MDAnalysis")
        self.export("a.h5md", "h5md")
        universe = mda.Universe.empty(48, trajectory=True)
        universe.load_new("a.h5md", convert_units=False)
        self.trajectory_is_ours(universe.trajectory, with_height=True)
        self.assertEqual([frame.time for frame in universe.trajectory], [0, 10, 40])
        self.assertEqual([frame.data["step"] for frame in universe.trajectory], [0, 10, 40])
        self.assertEqual(len(universe.select_atoms("prop z < 1")),
                         int((self.centres[0, :, 2] < 1).sum()))


class H5md(Case):
    """The file for other readers of H5MD, by its specification."""

    def test_elements_have_steps_times_and_values(self):
        path = made(BED)
        jostle.export(path, "a.h5md", format="h5md", realization=2, tap=[0, 40])
        with h5py.File(path) as results, h5py.File("a.h5md") as file:
            centres = results["particles/point_0000_realization_00002/position/value"][[0, 2]]
            self.assertEqual(file["h5md"].attrs["version"].tolist(), [1, 1])
            self.assertEqual(list(file["particles"]), ["trajectory"])
            trajectory = file["particles/trajectory"]
            for name in ("position", "radius", "coordination", "voronoi_volume", "q6", "structure_type",
                         "box/edges"):
                self.assertEqual(trajectory[name]["step"][()].tolist(), [0, 40])
                self.assertEqual(trajectory[name]["time"][()].tolist(), [0, 40])
                self.assertEqual(trajectory[name]["step"].id, trajectory["position/step"].id)
            np.testing.assert_array_equal(trajectory["position/value"][()], centres)
            self.assertEqual(trajectory["coordination/value"].shape, (2, 48))
            self.assertEqual(trajectory["box"].attrs["boundary"].tolist(), ["periodic", "periodic", "none"])
            self.assertEqual(int(trajectory["box"].attrs["dimension"]), 3)
            edges = trajectory["box/edges/value"][()]
            np.testing.assert_allclose(edges, [np.diag([4, 4, frame[:, 2].max() + 0.5])
                                               for frame in centres])

    def test_the_same_packing_gives_the_same_bytes(self):
        for name in ("a.h5md", "b.h5md"):
            jostle.export(made(BED), name, format="h5md", tap="all")
        self.assertEqual((self.folder / "a.h5md").read_bytes(), (self.folder / "b.h5md").read_bytes())

    def test_frames_of_several_sizes_are_refused(self):
        for name, n in (("a.xyz", 48), ("b.xyz", 24)):
            jostle.export(made(changed(BED, spheres=n)), name, format="extxyz")
        (self.folder / "both.xyz").write_text((self.folder / "a.xyz").read_text() +
                                              (self.folder / "b.xyz").read_text())
        with self.assertRaisesRegex(jostle.ProgramError, "frames of one number of spheres"):
            jostle.export("both.xyz", "both.h5md", format="h5md", tap="all")
        self.assertFalse((self.folder / "both.h5md").exists())

    def test_existing_files_are_kept_without_force(self):
        (self.folder / "a.h5md").write_text("mine")
        with self.assertRaisesRegex(jostle.ProgramError, "a.h5md exists and is kept"):
            jostle.export(made(BED), "a.h5md", format="h5md")
        jostle.export(made(BED), "a.h5md", format="h5md", force=True)
        self.assertTrue(h5py.is_hdf5("a.h5md"))


class Copies(Case):
    """jostle export --format results."""

    def test_a_copy_has_the_data_without_tables(self):
        scene = changed(BED, fits=[{"observable": "mean_height", "model": "kww"}])
        path = made(scene)
        jostle.export(path, "copy.h5", format="results")
        copy = self.open("copy.h5", verify=True)
        self.assertEqual(copy.digest(), self.open(path).digest())
        self.assertEqual(json.loads(copy.scene_verbatim), scene)
        self.assertEqual(list(copy.tables), [])

    def test_what_means_nothing_is_refused(self):
        path = made(BED)
        (self.folder / "mine.h5").write_text("mine")
        for keywords, pattern in (({"realization": 1}, "mean nothing"), ({"tap": "all"}, "mean nothing"),
                                  ({}, "mine.h5 exists and is kept"), ({"force": True}, "mine.h5")):
            with self.subTest(pattern=pattern), self.assertRaisesRegex(jostle.ProgramError, pattern):
                jostle.export(path, "mine.h5", format="results", **keywords)
        self.assertEqual((self.folder / "mine.h5").read_text(), "mine")


if __name__ == "__main__":
    unittest.main()
