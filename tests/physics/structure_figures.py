"""Figures 6 to 10 of Philippe & Bideau: what packings look like inside."""
import numpy as np

from page_text import at, table, window
from verdicts import Estimate, are_positive, is_positive, is_within, of_program, undecided


def nearest(places, wanted):
    return int(np.argmin(np.abs(np.asarray(places) - wanted)))


def kept_taps(run):
    """The kept taps of a run, ascending."""
    return [int(tap) for tap in run.ensemble_structure("profile")["tap"]]


class Profiles:
    """Parts profile and sides of one sweep point, realization by realization."""

    def __init__(self, run, point):
        self.packings = run.structure(["profile", "sides"], point)

    def of(self, part, name, frame):
        """[realization] or [realization, place], up to where all beds reach."""
        values = [packings[part][name][frame] for packings in self.packings]
        return np.array([value[:min(map(len, values))] if np.ndim(value) else value
                         for value in values])

    def near(self, part, name, axis, frame, place):
        found = self.packings[0][part]
        return self.of(part, name, frame)[:, nearest(found[axis], place)]


def contrast(near, peaks, trough):
    """How far a profile is higher at its peaks than between them, [realization]."""
    return np.mean([near(place) for place in peaks], axis=0) - near(trough)


HEIGHTS = (0.25, 0.75, 1.25, 1.75, 2.25, 3.25, 5.25, 7.25, 9.25, 11.25)
DISTANCES = (0.05, 0.25, 0.45, 0.55, 0.95, 1.35, 1.45, 1.85, 2.25, 2.35, 3.05, 5.05, 7.05)


def profile_tables(run, points, taps):
    """Figs. 6 and 7 of the last point; fig. 8 of all."""
    last, frames = points[-1], (0, len(taps) - 1)
    between_walls = "phi_wall" in last.packings[0]["sides"]
    rows = [[f"Phi, tap {taps[k]}"] +
            [Estimate.of(last.near("profile", "phi", "height", k, z)).text() for z in HEIGHTS]
            for k in frames]
    where = f"Figs. 6 and 7 at {run.labels[-1]}; heights" if run.labels[-1] else "Heights"
    text = [f"{where} and distances in diameters:"]
    text.append(table(["fig. 6: height"] + [f"{z:.2f}" for z in HEIGHTS], rows))
    if between_walls:
        rows = [[f"Phi, tap {taps[k]}"] +
                [Estimate.of(last.near("sides", "phi_wall", "wall_distance", k, x)).text(3)
                 for x in DISTANCES] for k in frames]
        text.append(table(["fig. 7: distance to a wall"] + [f"{x:.2f}" for x in DISTANCES], rows))
    rows = []
    for number, (label, profiles) in enumerate(zip(run.labels, points)):
        eq7 = run.ensemble_structure("profile", number)
        for k in [0] + [nearest(taps, tap) for tap in (1, 10, 100)] + [len(taps) - 1]:
            row = [label or "periodic", str(taps[k]),
                   Estimate.of(profiles.of("profile", "alpha", k)).text(2, 1e3),
                   f"{eq7['eq7_phi_0'][k]:.4f}", f"{1e3 * eq7['eq7_alpha'][k]:.2f}",
                   f"{eq7['eq7_beta'][k]:.2f}", f"{eq7['eq7_z_star'][k]:.2f}"]
            if between_walls:
                row += [Estimate.of(profiles.of("sides", name, k) -
                                    profiles.of("sides", name, 0)).text()
                        for name in ("lateral", "central")]
            rows.append(row)
    header = ["fig. 8", "tap", "10^3 alpha R", "eq. 7: Phi_0", "10^3 alpha R", "beta R", "z*/R"]
    text.append(table(header + (["d Phi lateral", "central"] if between_walls else []), rows))
    return "\n\n".join(text)


def wall_profiles(run):
    taps = kept_taps(run)
    points = [Profiles(run, point) for point in range(len(run.labels))]
    first, last = nearest(taps, 1), len(taps) - 1
    alpha = [profiles.of("profile", "alpha", last) for profiles in points]

    def over_strengths(values):
        """The mean over strengths: with matched streams a realization is one bed."""
        return Estimate.of(np.mean([values(profiles) for profiles in points], axis=0))

    def changed(name, frame, since=0):
        return lambda profiles: (profiles.of("sides", name, frame) -
                                 profiles.of("sides", name, since))

    def jump(profiles):
        return changed("lateral", first)(profiles) - changed("central", first)(profiles)

    def at_end(profiles):
        return changed("lateral", last)(profiles) - changed("central", last)(profiles)

    def by_floor(profiles):
        return contrast(lambda z: profiles.near("profile", "phi", "height", last, z),
                        (1.25, 2.25), 1.75)

    def by_wall(peaks, trough):
        return lambda profiles: contrast(lambda x: profiles.near(
            "sides", "phi_wall", "wall_distance", last, x), peaks, trough)
    tap = taps[last]
    statements = [
        is_positive("peaks at the floor", over_strengths(by_floor),
                    f"Phi at heights 1.25 and 2.25 less 1.75, tap {tap}: "),
        is_positive("density falls upward (alpha > 0)", over_strengths(
            lambda profiles: profiles.of("profile", "alpha", last)),
            f"10^3 alpha R at tap {tap}: ", digits=2, scale=1e3),
        is_positive("alpha is bell-shaped: it rises at first", Estimate.of(
            np.mean(alpha[1:-1], axis=0) - alpha[0]),
            "10^3 alpha R, the inner strengths less the weakest: ", digits=2, scale=1e3,
            name="paired t-test"),
        is_positive("alpha is bell-shaped: it falls at last", Estimate.of(
            alpha[-2] - alpha[-1]),
            "10^3 alpha R, the second strongest less the strongest: ", digits=2, scale=1e3,
            name="paired t-test")]
    for name, peaks, trough in (("first", (0.55, 1.45), 0.95), ("second", (1.45, 2.35), 1.85),
                                ("third", (2.35, 3.25), 2.75)):
        statements.append(is_positive(
            f"wall layers: peaks about the {name} gap", over_strengths(by_wall(peaks, trough)),
            f"Phi at {peaks[0]} and {peaks[1]} from a wall less {trough}: "))
    statements += [
        is_positive("the first tap fills the walls: lateral above central", over_strengths(jump),
                    "d Phi lateral less central, tap 1: "),
        is_positive(f"Phi grows less in the centre, by tap {tap}", over_strengths(at_end),
                    f"d Phi lateral less central, tap {tap}: "),
        is_positive(f"Phi grows less in the centre, from tap 1 to {tap}", over_strengths(
            lambda profiles: changed("lateral", last, first)(profiles) -
            changed("central", last, first)(profiles)), "d Phi lateral less central: ")]
    return profile_tables(run, points, taps), statements


def periodic_profiles(run, walls):
    """`walls`: the finished run between walls, or None."""
    taps = kept_taps(run)
    profiles = Profiles(run, 0)
    last = len(taps) - 1
    here = run.curves("corrected_fraction")[0]
    end = taps[last] - 49, taps[last]
    sides = contrast(lambda x: profiles.near("sides", "phi_xy", "x", last, x), (0.55, 1.45), 0.95)
    statements = [is_within("no peaks at the sides (0.02)", Estimate.of(sides), 0.02,
                            f"Phi at 0.55 and 1.45 from a side less 0.95, tap {taps[last]}: ")]
    names = ("Phi_c is larger than between walls", "Phi_c grows less than between walls")
    if walls is None:
        statements += [undecided(name, "the run between walls is not there", "none")
                       for name in names]
    else:
        there = walls.curves("corrected_fraction")[-1]
        statements += [
            is_positive(names[0], Estimate.difference(window(here, *end), window(there, *end)),
                        f"periodic less walls, taps {end[0]} to {end[1]}: ", name="Welch's t-test"),
            is_positive(names[1] + ", from tap 1", Estimate.difference(
                window(there, *end) - there[1], window(here, *end) - here[1]),
                "growth between walls less periodic: ", name="Welch's t-test")]
    return profile_tables(run, [profiles], taps), statements


def void_probability(run):
    kept = [packings["void_probability"] for packings in run.structure(["void_probability"])]
    taps, sigmas = run.scene["snapshots"]["taps"], kept[0]["sigma"]
    fraction = run.curves("corrected_fraction")[0]

    def of(name, t, sigma):
        return np.array([table_of[name][t, nearest(sigmas, sigma)] for table_of in kept])
    rows = [[f"{sigma:g}"] + [Estimate.of(of(name, t, sigma)).text(5) for t in range(len(taps))
                              for name in ("p0", "p0_gotoh")]
            for sigma in (0.5, 1, 1.2, 1.4, 1.6, 1.8, 2)]
    header = ["sigma"]
    for tap in taps:
        header += [f"P0, tap {tap}", "Gotoh"]
    statements = [is_within("Phi = 58.4 % at the start (0.2 %)", Estimate.of(fraction[0] - 0.584),
                            0.002, f"Phi_c {at(fraction, 0)}; from it "),
                  undecided("Phi = 60.6 % after 4000 taps",
                            f"{at(fraction, taps[-1])} after {taps[-1]}", "too few taps")
                  if taps[-1] < 4000 else
                  is_within("Phi = 60.6 % after 4000 taps (0.2 %)", Estimate.of(
                      fraction[4000] - 0.606), 0.002, f"Phi_c {at(fraction, 4000)}; from it ")]
    # A tenth of P0 is what points of a figure on a logarithmic axis can be read to.
    for t, tap in enumerate(taps):
        for sigma in (1.2, 1.4):
            statements.append(is_within(
                f"P0({sigma}) is near Gotoh's at the packing's own Phi (a tenth), tap {tap}",
                Estimate.of(of("p0", t, sigma) / of("p0_gotoh", t, sigma) - 1), 0.1,
                "their ratio less 1: ", 3))
    for sigma in (1.2, 1.4):
        statements.append(is_within(
            f"P0({sigma}) hardly changes (a tenth)",
            Estimate.of(of("p0", -1, sigma) / of("p0", 0, sigma) - 1), 0.1,
            f"tap {taps[-1]} over tap 0, less 1: ", 3))
    phi = np.array([table_of["phi"] for table_of in kept])
    return table(header, rows) + "\n\nPhi of the region: " + ", ".join(
        f"{Estimate.of(phi[:, t]).text()} at tap {tap}" for t, tap in enumerate(taps)) + \
        ".", statements


OCTAHEDRAL = (np.sqrt(2) - 1)**3


def pore_sizes(run):
    packings = run.structure(["pores", "holes"])  # a realization each
    kept = [parts["pores"] for parts in packings]
    pores, holes = (run.ensemble_structure(part) for part in ("pores", "holes"))
    fraction, taps = run.curves("corrected_fraction")[0], [int(tap) for tap in pores["tap"]]

    def of(name):
        return np.array([table_of[name] for table_of in kept])  # [realization, tap]
    n_pores, nu, v0 = of("n_pores"), of("nu"), of("tail_v0")
    rows = [[str(tap), at(fraction, tap), Estimate.of(n_pores[:, k]).text(0)] +
            [Estimate.of(values[:, k]).text()
             for values in (nu, v0, of("tetrahedral"), of("octahedral"))]
            for k, tap in enumerate(taps)]
    text = ["nu, v0 and v in sphere volumes; tetrahedral, octahedral: the share of the pores whose "
            "radius is within 0.02 sphere radii of 0.225 and 0.414.",
            table(["tap", "Phi_c", "pores", "nu", "v0", "tetrahedral", "octahedral"], rows)]
    volumes = (0.011, 0.03, 0.071, 0.12, 0.2, 0.3, 0.4, 0.5)
    xi = [nearest(pores["xi"], v ** (1 / 3)) for v in volumes]
    text.append(table(["rho_v at v ="] + [f"{pores['xi'][i] ** 3:.3f}" for i in xi],
                      [[str(tap)] + [Estimate.of(of("rho_v")[:, k, i]).text(0) for i in xi]
                       for k, tap in enumerate(taps)]))
    text += hole_tables(holes, [parts["holes"] for parts in packings], taps)
    sizes = of("xi")[0]
    small, large = sizes**3 <= OCTAHEDRAL, sizes**3 > 0.15
    counts = of("rho_xi")
    shrunk = [np.log(counts[:, -1, part].sum(axis=1) / counts[:, 0, part].sum(axis=1))
              for part in (small, large)]
    return "\n\n".join(text), pore_statements(pores, taps, fraction, nu, v0, n_pores, shrunk)


def pore_statements(pores, taps, fraction, nu, v0, n_pores, shrunk):
    def slopes(x, y):
        return Estimate.of([np.polyfit(x[r], y[r], 1)[0] for r in range(len(y))])
    phi = fraction[taps].T  # [realization, tap]
    statements = [
        is_positive("the tail shrinks (v0 falls)", Estimate.of(v0[:, 0] - v0[:, -1]),
                    f"v0 at tap {taps[0]} less tap {taps[-1]}: ", name="paired t-test"),
        is_positive("nu falls as the bed densifies", Estimate.of(nu[:, 0] - nu[:, -1]),
                    f"nu at tap {taps[0]} less tap {taps[-1]}: ", name="paired t-test"),
        are_positive("nu falls wherever Phi_c rises",
                     [Estimate.of((nu[:, k] - nu[:, k + 1]) * np.sign(phi[:, k + 1] - phi[:, k]))
                      for k in range(len(taps) - 1)],
                     f"its falls from each of taps {taps} to the next: ", name="paired t-tests"),
        is_positive("v0 follows nu", slopes(nu, v0), f"slope of v0 against nu, taps {taps}: ",
                    digits=2),
        is_positive("small pores change less than large ones",
                    Estimate.of(np.abs(shrunk[1]) - np.abs(shrunk[0])),
                    f"ln N changes by {Estimate.of(shrunk[1]).text(2)} above v = 0.15, by "
                    f"{Estimate.of(shrunk[0]).text(2)} up to the octahedral; sizes' difference: ",
                    digits=2, name="paired t-test")]
    for k, tap in enumerate(taps):
        # The status has two words; the table judges the first at another level.
        found = pores["tail_status"][k].decode().split(": ", 1)[-1]
        statements.append(of_program(
            f"the tail is exponential, tap {tap}", found,
            "F-test of the law, which can only refute", pores["tail_p"][k], False,
            "a Weibull tail of shape 0.7 would have been refuted"))
    for k in (0, -1):
        statements.append(is_within(
            f"9550 to 10 250 pores, tap {taps[k]}", Estimate.of(n_pores[:, k] - 9900), 350,
            f"{Estimate.of(n_pores[:, k]).text(0)}; from 9900: ", 0))
    return statements


def hole_tables(holes, kept, taps):
    def of(name, tap, *hole):
        return Estimate.of([table_of[name][(tap, *hole)] for table_of in kept]).text(3)
    rows = []
    for i, name in enumerate(holes["hole"]):
        row = [name.decode()]
        for kind in ("number", "volume"):
            row += [of(f"{kind}_fraction", k, i) for k in (0, -1)]
            row.append(f"{holes[f'{kind}_fraction_published'][0, i]:.3f}")
        rows.append(row)
    header = ["table I"]
    for kind in ("number", "volume"):
        header += [f"{kind}, tap 0", f"tap {taps[-1]}", "Bernal"]
    return [table(header, rows), "Unclassified part of the volume: " + ", ".join(
        f"{of('unclassified', k)} at tap {tap}" for k, tap in enumerate(taps)) + "."]
