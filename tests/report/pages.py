"""The results whose pages are looked at: one with all that a page can show, one with hardly anything,
one of each other kind, and one whose texts are markup."""

import json

import h5py

from crafted_files import SEAL, sealed
from report_pages import EVERYTHING, HOSTILE
from support import TINY, changed

WHOLE = changed(EVERYTHING, structure={**EVERYTHING["structure"], "sides": {}, "coordination": {},
                                       "pores": {}, "void_probability": {"points": 500}, "holes": {}})
LOOP = changed(TINY, name="loop", snapshots={"taps": []}, protocol=[
    {"ramp": {"dilate": {"from": 0.05, "to": 0.2, "step": 0.05}}, "count": 4},
    {"ramp": {"dilate": {"from": 0.15, "to": 0.05, "step": 0.05}}, "count": 4}],
    analyse={"hysteresis": [{"observable": "mean_height"}]})
del LOOP["sweep"]
GRAINS = {
    "name": "grains", "seed": 2010, "realizations": 2, "spheres": 60,
    "container": {"sides": "periodic", "width": 4}, "start": {"random_settle": {"dilute_fraction": 0.2}},
    "engine": {"discrete_element": {}}, "observe": ["mean_height"],
    "snapshots": {"taps": [0, 2]},
    "protocol": [{"tap": {"half_sine": {"amplitude": 0.4413, "frequency": 7.5}}, "count": 2}]}
STATES = changed(
    TINY, name="states", realizations=4, motion={"layers": 2},
    protocol=[{"tap": {"dilate": 0.05}, "count": 40}], snapshots={"taps": [0, 10, 40]},
    sweep={"/protocol/0/tap/dilate": [0.02, 0.1, 0.3]},
    analyse={"ordering": [{"observable": "bottom_fraction", "threshold": 0.45, "hold": 2}],
             "volumes": [{"observable": "mean_height", "last": 32}]},
    structure={"gaps": {}, "structure_factor": {}, "clusters": {"largest": 4}})
MEMORY = changed(TINY, name="memory", snapshots={"taps": []}, streams="matched", protocol=[
    {"tap": {"dilate": 0.05}, "count": 5}, {"tap": {"dilate": 0.05}, "count": 12}],
    analyse={"memory": [{"observable": "mean_height"}, {"observable": "bottom_fraction"}]})
PLAIN = changed(TINY, name="plain", snapshots={"taps": []}, realizations=1)
del PLAIN["sweep"]
MARKUP = changed(WHOLE, name="hostile", description=HOSTILE, realizations=2,
                 sweep={"/protocol/0/tap/dilate": [0.02, 0.05]})
MIXTURE = changed(
    TINY, name="mixture", container={"sides": "periodic", "width": 6},
    spheres=[{"name": "small", "count": 60, "diameter": {"lognormal": {"mean": 1, "deviation": 0.05}}},
             {"name": "large", "count": 8, "diameter": 1.5}],
    observe=["mean_height", {"kind_height": {"kind": "small"}}, {"kind_height": {"kind": "large"}}, "segregation"],
    structure={"coordination": {}, "pair_correlation": {"bin_width": 0.1}, "gaps": {}, "voronoi": {"cut_cells": True}})
del MIXTURE["sweep"]
SCENES = {"whole": WHOLE, "plain": PLAIN, "loop": LOOP, "grains": GRAINS, "states": STATES,
          "memory": MEMORY, "mixture": MIXTURE, "hostile": MARKUP}
CATALOGUED = ("whole", "loop", "grains", "states", "memory", "mixture", "cost")


def make_pages(case):
    """NAME.h5 and NAME.html of every scene and of a study of cost, and two.html, in the case's folder."""
    for name, scene in SCENES.items():
        case.write(scene, f"{name}.json")
        case.run_scene("-o", f"{name}.h5", scene=f"{name}.json")
    forge(case.folder / "hostile.h5")
    spread_pores(case.folder / "whole.h5", case.folder / "spread.h5")
    case.write(changed(TINY, name="cost"), "cost.json")
    case.jostle("cost", "cost.json", "--replicates", 2, "--taps", 2, "-o", "cost.h5")
    for name in (*SCENES, "cost", "spread"):
        case.jostle("report", f"{name}.h5")
    for name in CATALOGUED:
        case.jostle("report", f"{name}.h5", "--catalogue", f"{name}-figures.json")
    case.jostle("report", "plain.h5", "loop.h5", "-o", "two.html")


def spread_pores(path, copy):
    """A copy whose pore densities have errors that are, but for rounding, as large as they."""
    copy.write_bytes(path.read_bytes()[:-SEAL])
    with h5py.File(copy, "r+") as file:
        def spread(name, item):
            if name.endswith("/rho_v_error"):
                item[()] = file["structure"][name.removesuffix("_error")][()] * (1 - 1e-15)
        file["structure"].visititems(spread)
    copy.write_bytes(sealed(copy.read_bytes()))


def forge(path):
    """A results file whose labels, notes and meanings are markup."""
    path.write_bytes(path.read_bytes()[:-SEAL])
    with h5py.File(path, "r+") as file:
        scene = json.loads(file["scene/resolved"].asstr()[()])
        file["scene/resolved"][()] = json.dumps({**scene, "name": HOSTILE})
        for point in ("point_0000", "point_0001"):
            file[f"sweep/{point}"].attrs["label"] = HOSTILE

        def forged(name, item):
            for key, value in item.attrs.items():
                if key.startswith("note_") or key in ("long_name", "source"):
                    item.attrs[key] = HOSTILE if isinstance(value, str) else value
        for group in ("fits", "analysis", "structure", "observables"):
            file[group].visititems(forged)
    path.write_bytes(sealed(path.read_bytes()))
