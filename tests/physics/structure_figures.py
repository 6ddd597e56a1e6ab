"""Tables of the figures that look inside packings."""
import numpy as np

from page_text import at, quoted, table


def structure(run, part, point=0):
    return run.file[f"structure/point_{point:04}/{part}"]


def entry(table_of_part, name, *place, digits=4):
    """A number of a part of the structure with its error, at a tap and maybe elsewhere."""
    return quoted(table_of_part[name][place], table_of_part[name + "_error"][place], digits)


def nearest(places, wanted):
    return int(np.argmin(np.abs(places[:] - wanted)))


def profiles(run):
    """Of the last point: figs. 6 and 7; of all: fig. 8."""
    last_point = len(run.labels) - 1
    profile, sides = (structure(run, part, last_point) for part in ("profile", "sides"))
    last = profile["tap"].size - 1
    taps = profile["tap"][:]
    text = []
    heights = (0.25, 0.75, 1.25, 1.75, 2.25, 3.25, 5.25, 7.25, 9.25, 11.25)
    rows = [[f"Phi, tap {taps[k]}"] +
            [entry(profile, "phi", k, nearest(profile["height"], z)) for z in heights]
            for k in (0, last)]
    if run.labels[last_point]:
        text.append(f"Figs. 6 and 7 at {run.labels[last_point]}:")
    text.append(table(["fig. 6: height"] + [f"{z:.2f}" for z in heights], rows))
    if "phi_wall" in sides:
        places = (0.05, 0.25, 0.45, 0.55, 0.95, 1.35, 1.45, 1.85, 2.25, 2.35, 3.05, 5.05, 7.05)
        rows = [[f"Phi, tap {taps[k]}"] +
                [entry(sides, "phi_wall", k, nearest(sides["wall_distance"], x), digits=3)
                 for x in places] for k in (0, last)]
        text.append(table(["fig. 7: distance to a wall"] + [f"{x:.2f}" for x in places], rows))
    rows = []
    for point, label in enumerate(run.labels):
        profile, sides = (structure(run, part, point) for part in ("profile", "sides"))
        for k in (0, nearest(profile["tap"], 1), nearest(profile["tap"], 10),
                  nearest(profile["tap"], 100), last):
            row = [label or "periodic", str(taps[k])]
            row += [quoted(1e3 * profile["alpha"][k], 1e3 * profile["alpha_error"][k], 2),
                    entry(profile, "eq7_phi_0", k),
                    quoted(1e3 * profile["eq7_alpha"][k], 1e3 * profile["eq7_alpha_error"][k], 2),
                    entry(profile, "eq7_beta", k, digits=2),
                    entry(profile, "eq7_z_star", k, digits=2)]
            if "lateral_change" in sides:
                row += [entry(sides, "lateral_change", k), entry(sides, "central_change", k)]
            rows.append(row)
    header = ["fig. 8", "tap", "10^3 alpha R", "eq. 7: Phi_0", "10^3 alpha R", "beta R", "z*/R"]
    if "lateral_change" in sides:
        header += ["d Phi lateral", "central"]
    text.append(table(header, rows))
    return "\n\n".join(text)


def void_probability(run):
    voids = structure(run, "void_probability")
    taps = voids["tap"][:]
    rows = []
    for sigma in (0.5, 1, 1.2, 1.4, 1.6, 1.8, 2):
        k = nearest(voids["sigma"], sigma)
        row = [f"{sigma:g}"]
        for t in range(taps.size):
            row += [entry(voids, "p0", t, k, digits=5), entry(voids, "p0_gotoh", t, k, digits=5)]
        rows.append(row)
    header = ["sigma"]
    for tap in taps:
        header += [f"P0, tap {tap}", "Gotoh"]
    phi = ", ".join(f"{entry(voids, 'phi', t)} at tap {taps[t]}" for t in range(taps.size))
    return table(header, rows) + f"\n\nPhi of the region: {phi}."


def pore_sizes(run):
    pores, holes = structure(run, "pores"), structure(run, "holes")
    fraction = run.curves("corrected_fraction")[0]
    rows, taps = [], pores["tap"][:]
    for k, tap in enumerate(taps):
        rows.append([str(tap), at(fraction, tap), entry(pores, "n_pores", k, digits=0),
                     entry(pores, "nu", k), entry(pores, "tail_v0", k),
                     entry(pores, "tetrahedral", k), entry(pores, "octahedral", k)])
    text = [table(["tap", "Phi_c", "pores", "nu", "v0", "tetrahedral", "octahedral"], rows)]
    volumes = (0.011, 0.03, 0.071, 0.12, 0.2, 0.3, 0.4, 0.5)
    xi = [nearest(pores["xi"], v ** (1 / 3)) for v in volumes]
    rows = [[str(tap)] + [entry(pores, "rho_v", k, i, digits=0) for i in xi]
            for k, tap in enumerate(taps)]
    text.append(table(["rho_v at v ="] + [f"{pores['xi'][i] ** 3:.3f}" for i in xi], rows))
    rows = []
    for i, name in enumerate(holes["hole"][:]):
        row = [name.decode()]
        for kind in ("number", "volume"):
            row += [entry(holes, f"{kind}_fraction", k, i, digits=3) for k in (0, taps.size - 1)]
            row.append(f"{holes[f'{kind}_fraction_published'][0, i]:.3f}")
        rows.append(row)
    header = ["table I"]
    for kind in ("number", "volume"):
        header += [f"{kind}, tap 0", f"tap {taps[-1]}", "Bernal"]
    text.append(table(header, rows))
    text.append("Unclassified part of the volume: " + ", ".join(
        f"{entry(holes, 'unclassified', k, digits=3)} at tap {tap}"
        for k, tap in enumerate(taps)) + ".")
    return "\n\n".join(text)


def contacts(run):
    coordination, profile = structure(run, "coordination"), structure(run, "profile")
    bulk = run.curves("bulk_fraction")[0]
    rows = [[str(tap), at(bulk, tap), entry(profile, "phi_region", k),
             entry(coordination, "n_c", k, digits=3), entry(coordination, "n_c_all", k, digits=3)]
            for k, tap in enumerate(coordination["tap"][:])]
    return table(["tap", "bulk Phi", "Phi of the region", "N_c of the region", "N_c of all"], rows)


def layers(run):
    grown, order = structure(run, "layers"), structure(run, "order")
    bulk = run.curves("bulk_fraction")[0]
    rows = []
    for k, tap in enumerate(grown["tap"][:]):
        rows.append([str(tap), at(bulk, tap), entry(grown, "grown_layers", k, digits=2)] +
                    [entry(grown, "share", k, layer, digits=2) for layer in range(8)])
    text = [table(["tap", "Phi", "grown layers"] +
                  [f"share, layer {layer + 1}" for layer in range(8)], rows)]
    found = grown["found_height"][-1, :6]
    text.append(f"Layers of tap {grown['tap'][-1]} lie at " +
                ", ".join(f"{height:.2f}" for height in found) + " (hcp: " +
                ", ".join(f"{height:.2f}" for height in grown["layer_height"][:6]) + "). fcc and "
                f"hcp make {entry(order, 'fcc', -1, digits=3)} and "
                f"{entry(order, 'hcp', -1, digits=3)} of the spheres of the region.")
    rows = []
    heights = order["height"][:]
    for k, tap in enumerate(order["tap"][:]):
        rows.append([str(tap)] + [
            quoted(1 - order["disordered_at_height"][k, i],
                   order["disordered_at_height_error"][k, i], 3)
            for i in range(1, 13, 2)])
    text.append(table(["fcc and hcp at height"] + [f"{heights[i]:g}" for i in range(1, 13, 2)],
                      rows))
    return "\n\n".join(text)
