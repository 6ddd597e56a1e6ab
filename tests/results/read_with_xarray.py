"""Opens a results file as a user of Python would: h5py, and xarray through h5netcdf.

Usage: read_with_xarray.py SAMPLE_FILE, the program that writes the file. Exit code 77: skipped,
because a module is missing. The numbers expected here are those of synthetic.cpp.
"""
import os
import subprocess
import sys
import tempfile

try:
    import h5netcdf  # noqa: F401
    import h5py
    import numpy as np
    import xarray as xr
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)


def open_group(path, group):
    return xr.open_dataset(path, engine="h5netcdf", group=group)


def check_observables(path):
    table = open_group(path, "/observables/point_0001")
    assert table["mean_height"].dims == ("tap", "realization"), table["mean_height"].dims
    assert table["mean_height"].shape == (7, 3)
    assert table["tap"].values.tolist() == list(range(7))
    assert table["realization"].values.tolist() == [0, 1, 2]
    assert table["mean_height"].attrs["units"] == "diameter"
    assert table["mean_height"].attrs["long_name"] == "mean height"
    assert table["mean_height"].attrs["source"] == "a paper"
    for column in ("bulk_fraction", "sweeps", "acceptance", "capped", "dropped_offsets"):
        assert table[column].dims == ("tap", "realization"), column
    assert table["status"].dims == ("realization",)
    assert table["status"].values.tolist() == [2, 2, 3]
    assert table["status"].attrs["flag_meanings"].split()[3] == "failed"
    assert table["reason"].values.tolist() == ["", "", "requested by the test"]
    assert np.isfinite(table["mean_height"].values[:, :2]).all()
    assert np.isnan(table["mean_height"].values[:, 2]).all()
    assert len(set(table["trial_key"].values.tolist())) == 3
    assert table["mean_height"].sel(tap=6, realization=1) == table["mean_height"].values[6, 1]
    return table


def check_ensemble(path, table):
    ensemble = open_group(path, "/ensemble/point_0001")
    alive = table["mean_height"].values[:, :2]
    assert ensemble["mean_height_mean"].dims == ("tap",)
    assert ensemble["mean_height_mean"].attrs["units"] == "diameter"
    np.testing.assert_allclose(ensemble["mean_height_mean"], alive.mean(axis=1), rtol=1e-14)
    np.testing.assert_allclose(ensemble["mean_height_sigma"], alive.std(axis=1), rtol=1e-12)
    error = alive.std(axis=1, ddof=1) / np.sqrt(2)
    np.testing.assert_allclose(ensemble["mean_height_error"], error, rtol=1e-12)
    assert ensemble["mean_height_count"].values.tolist() == [2] * 7


def check_snapshots(path, table):
    """The synthetic observables: the sum of all z, and the sum of all x."""
    snapshots = open_group(path, "/snapshots/point_0001")
    assert snapshots["coordination"].dims == ("tap", "realization")
    assert snapshots["tap"].values.tolist() == [0, 2, 6]
    assert snapshots["height_histogram"].dims == ("tap", "realization", "height")
    np.testing.assert_allclose(snapshots["height"], [0.05, 0.15, 0.25])
    assert snapshots["height"].attrs["units"] == "diameter"
    assert np.isnan(snapshots["coordination"].values[:, 2]).all()
    position = open_group(path, "/particles/point_0001_realization_00001/position")
    assert position["value"].dims == ("step", "sphere", "direction"), position["value"].dims
    assert position["value"].attrs["units"] == "diameter"
    assert position["step"].values.tolist() == [0, 2, 6]
    heights = position["value"].values[:, :, 2].sum(axis=1)
    expected = table["mean_height"].sel(realization=1, tap=[0, 2, 6])
    np.testing.assert_allclose(heights, expected, rtol=1e-14)
    first_x = position["value"].values[:, 0, 0]
    assert (snapshots["coordination"].sel(realization=1).values == first_x).all()


def check_other_tables(path):
    sweep = open_group(path, "/sweep")
    assert sweep["value"].dims == ("point", "pointer")
    assert sweep["value"].values.tolist() == [["0"], ["1"]]
    assert sweep["pointer"].values.tolist() == ["/tap/epsilon"]
    assert sweep["label"].values.tolist() == ["epsilon = 0", "epsilon = 1"]
    assert [int(i) for i in sweep["id"]] == [0xFEDCBA9876543210, 0xFEDCBA9876543211]
    timing = open_group(path, "/timing/point_0000")
    assert timing["seconds"].dims == ("realization",)
    assert timing["seconds"].attrs["units"] == "s"
    assert (timing["seconds"].values == 0.5).all()
    assert (timing["distance_tests"] == 2 * timing["trials"]).all()


def check_every_group_opens(path):
    """And no dimension is nameless."""
    groups = []
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: groups.append("/" + name)
                        if isinstance(item, h5py.Group) else None)
    for group in groups:
        for name, variable in open_group(path, group).load().variables.items():
            assert not any("phony" in dim for dim in variable.dims), (group, name, variable.dims)
    expected = ["/provenance", "/sweep/point_0000", "/restart/point_0001",
                "/particles/point_0000_realization_00002/box"]
    assert set(expected) <= set(groups), groups
    point = open_group(path, "/sweep/point_0000")
    assert point["units"].dims == point["sources"].dims == ("observables",)
    assert point["units"].sel(observables="mean_height") == "diameter"
    assert open_group(path, "/provenance")["host"].dims == ("process",)
    box = open_group(path, "/particles/point_0000_realization_00002/box")
    assert box["edges"].dims == ("direction",)


def check_sweep_values_are_coordinates(path):
    sweep = open_group(path, "/sweep")
    assert {"epsilon", "label"} <= set(sweep.coords), sweep.coords
    assert sweep["epsilon"].dims == ("point",) and sweep["epsilon"].dtype == np.float64
    points = [open_group(path, f"/ensemble/point_{p:04}") for p in sweep["point"].values]
    joined = xr.concat(points, dim="point").assign_coords(
        epsilon=("point", sweep["epsilon"].values))
    second = joined["mean_height_mean"].swap_dims(point="epsilon").sel(epsilon=1.0)
    assert (second == points[1]["mean_height_mean"]).all()


def check_h5md(path):
    """The required elements of H5MD 1.1, and what docs/reference/file-format.md adds."""
    with h5py.File(path, "r") as file:
        assert file.attrs["jostle_format"] == 1
        assert file["h5md"].attrs["version"].tolist() == [1, 1]
        assert isinstance(file["h5md/author"].attrs["name"], str)
        assert file["h5md/creator"].attrs["name"] == "jostle"
        assert isinstance(file["h5md/creator"].attrs["version"], str)
        assert {"particles", "observables"} <= set(file)
        assert len(file["particles"]) == 5  # all but the failed realization
        for group in file["particles"].values():
            box = group["box"]
            assert box.attrs["dimension"] == 3
            assert box.attrs["boundary"].tolist() == ["periodic", "periodic", "none"]
            assert box["edges"].shape == (3,)
            assert box["edges"][:2].tolist() == [4, 5]
            value, step = group["position/value"], group["position/step"]
            assert value.shape == (len(step), 5, 3)
            assert box["edges"][2] == value[:, :, 2].max() + 0.5
        scene = file["scene/verbatim"][()].decode()
        assert scene == '{"name": "synthetic"} // as typed, with an \u00fc\n'
        assert file["provenance"].attrs["state"] == "complete"
        assert file["provenance/host"].shape == (1,)
        assert file["observables/point_0000/mean_height"].dims[0].label == ""
        assert file["observables/point_0000/mean_height"].dims[1][0].name.endswith("/realization")


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "sample.h5")
        subprocess.run([sys.argv[1], path], check=True)
        table = check_observables(path)
        check_ensemble(path, table)
        check_snapshots(path, table)
        check_other_tables(path)
        check_every_group_opens(path)
        check_sweep_values_are_coordinates(path)
        check_h5md(path)
    print("h5py and xarray read the file as documented")


if __name__ == "__main__":
    main()
