"""Numbers of analyses recomputed from the raw data of small runs with numpy, by the rules of the documents."""

import json
import unittest

import h5py
import numpy as np
from scipy import spatial

from support import TINY, Case, changed

EXACT = {"rtol": 1e-9, "atol": 1e-12}
ROW, SPACING, SLACK = 3**0.5 / 2, (2 / 3) ** 0.5, 1e-9


def jackknife(left_out):
    n = len(left_out)
    return np.sqrt((n - 1) / n * ((left_out - left_out.mean()) ** 2).sum())


def places(length, first=0.0):
    """Places 1 apart on a line, the first of them at `first`."""
    return max(0.0, np.floor(length - first + SLACK) + 1)


def in_rectangle(along, across):
    """Places of a close-packed layer whose rows lie along one side; every second row is shifted by 1/2."""
    rows = np.floor(across / ROW + SLACK) + 1
    return (rows - rows // 2) * places(along) + rows // 2 * places(along, 0.5)


def in_disc(radius):
    """The most places of a close-packed layer over 24 x 24 positions of the axis in a cell of the layer."""
    most, reach = 0, radius * (1 + SLACK)
    j = np.arange(-30, 31)
    x, y = np.meshgrid(np.arange(-30, 31), j * ROW)
    x = x + 0.5 * (j % 2)[:, None]
    for a in range(24):
        for b in range(24):
            away = np.hypot(x - a / 24 - b / 48, y - b / 24 * ROW)
            most = max(most, int((away <= reach).sum()))
    return most


def full_layer(container):
    """Spheres of a full layer, and those of a close-packed layer on the area that centres can reach."""
    sides, width = container["sides"], container.get("width")
    if sides == "periodic":
        return width * width / ROW, width * width / ROW
    if sides == "walls":
        return in_rectangle(width - 1, width - 1), (width - 1) ** 2 / ROW
    if sides == "cylinder":
        radius = container["diameter"] / 2 - 0.5
        return in_disc(radius), np.pi * radius**2 / ROW
    gap = container["gap"] - 1
    along = (np.floor(gap / ROW + SLACK) + 1) * width
    across = (places(gap) + places(gap, 0.5)) / 2 * width / ROW
    return max(along, across), width * gap / ROW


def layers_of(z, full, by_area, tolerance=0.1, least_share=0.6, least_filling=0.7):
    """Found heights, fillings and shares of all layers, and the number of grown layers."""
    found, expected = [], 0.5
    while True:
        place = expected
        for _ in range(2):
            near = z[(z >= place - 0.3) & (z < place + 0.3)]
            if not len(near):
                break
            place = near.mean()
        found.append(place)
        expected = place + SPACING
        if expected - SPACING / 2 > z.max():
            break
    middles = [0, *((low + high) / 2 for low, high in zip(found, found[1:])), z.max() + SPACING]
    filling, share, grown, place, goes_on = [], [], 0, 0.5, True
    for height, low, high in zip(found, middles, middles[1:]):
        inside = z[(z >= low) & (z < high)]
        near = (np.abs(inside - height) <= tolerance).sum()
        filling.append(len(inside) / full)
        share.append(near / len(inside) if len(inside) else np.nan)
        goes_on = (goes_on and abs(height - place) <= tolerance and share[-1] >= least_share
                   and len(inside) / max(1, by_area) >= least_filling)
        grown += goes_on
        place = height + SPACING
    return found, filling, share, grown


def exponential_tail(low, high, counts):
    """v0 and A of A exp(-v / v0) by maximum likelihood of Poissonian counts in adjoining bins, and what it expects."""
    def masses(v0):
        return v0 * (np.exp(-low / v0) - np.exp(-high / v0))

    def slope(v0, step=1e-4):  # change of the likelihood with ln v0, A at its best
        log = [(counts * np.log(masses(v) / masses(v).sum())).sum() for v in (v0 * np.exp(step), v0 * np.exp(-step))]
        return log[0] - log[1]

    first, last = 1e-3, 10.0
    for _ in range(100):
        middle = (first * last) ** 0.5
        first, last = (middle, last) if slope(middle) > 0 else (first, middle)
    a = counts.sum() / masses(first).sum()
    return first, a, a * masses(first)


def p_of_counts(counts, expected, n_parameters):
    """P-value of a law: chi2 of the sums of counts over the scatter of shares between realizations, F test."""
    m, groups = len(counts), []
    for n, mu in zip(counts.T, m * expected):
        if groups and groups[-1][1] < 5:
            groups[-1] = (groups[-1][0] + n, groups[-1][1] + mu)
        else:
            groups.append((n, mu))
    if groups[-1][1] < 5 and len(groups) > 1:
        n, mu = groups.pop()
        groups[-1] = (groups[-1][0] + n, groups[-1][1] + mu)
    share = counts.sum(axis=1) / counts.sum()
    between = sum((n.sum() - mu) ** 2 / mu for n, mu in groups)
    within = sum(((n - share * n.sum()) ** 2 / (mu * share)).sum() for n, mu in groups)
    first, second = len(groups) - n_parameters, (len(groups) - 1) * (m - 1)
    return f_tail(between / first / max(within / second, 0.01), first, second)


def f_tail(f, first, second):
    """P(F > f) by the beta integral with x = sin^2 t."""
    nodes, weights = np.polynomial.legendre.leggauss(400)

    def integral(end):
        t = (nodes + 1) / 2 * end
        return (weights * np.sin(t) ** (second - 1) * np.cos(t) ** (first - 1)).sum() * end

    return integral(np.arcsin((second / (second + first * f)) ** 0.5)) / integral(np.pi / 2)


def least_squares(law, t, x, sigma, start):
    """Parameters, standard errors and chi2 by Gauss-Newton with numerical derivatives."""
    p = np.array(start, float)

    def residuals(q):
        return (x - law(t, *q)) / sigma

    for _ in range(50):
        steps = 1e-6 * np.abs(p)
        jacobian = np.array([(residuals(p + d) - residuals(p - d)) / (2 * h)
                             for h, d in zip(steps, np.diag(steps))]).T
        p = p - np.linalg.solve(jacobian.T @ jacobian, jacobian.T @ residuals(p))
    return p, np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian))), (residuals(p) ** 2).sum()


class Recomputed(Case):
    def test_layers_in_every_container(self):
        most = 0
        for container, start in (({"sides": "periodic", "width": 6}, "steepest_descent"),
                                 ({"sides": "walls", "width": 6.2}, "steepest_descent"),
                                 ({"sides": "plates", "width": 6, "gap": 5}, "steepest_descent"),
                                 ({"sides": "plates", "width": 6, "gap": 3}, "crystal"),
                                 ({"sides": "walls", "width": 7}, "crystal"),
                                 ({"sides": "cylinder", "diameter": 5.6}, "steepest_descent")):
            with self.subTest(container=container):
                scene = changed(TINY, container=container, spheres=150, realizations=1,
                                start={"crystal": "hcp"} if start == "crystal" else {"pour": start},
                                protocol=[{"tap": {"dilate": 0.02}, "count": 2}],
                                snapshots={"taps": [0, 2]}, structure={"layers": {}})
                del scene["sweep"]
                self.write(scene)
                self.run_scene("--force")
                with h5py.File(self.folder / "tiny.h5") as file:
                    centres = file["particles/point_0000_realization_00000/position/value"][:]
                    table = {name: data[:] for name, data in file["structure/point_0000/layers"].items()}
                for tap in range(2):
                    found, filling, share, grown = layers_of(centres[tap, :, 2], *full_layer(container))
                    n = len(found)
                    np.testing.assert_allclose(table["layer_height"][:n], 0.5 + np.arange(n) * SPACING, **EXACT)
                    np.testing.assert_allclose(table["found_height"][tap, :n], found, **EXACT)
                    np.testing.assert_allclose(table["filling"][tap, :n], filling, **EXACT)
                    np.testing.assert_allclose(table["share"][tap, :n], share, **EXACT)
                    self.assertEqual(table["grown_layers"][tap], grown)
                    most = max(most, grown)
        self.assertGreater(most, 1)

    def test_realizations_are_added_until_the_target_is_met(self):
        scene = changed(TINY, realizations=3, snapshots={"taps": [0]},
                        until={"targets": [{"observable": "mean_height", "taps": [2], "standard_error": 0.012},
                                           {"observable": "bottom_fraction", "sigma": 0.0068}], "at_most": 40})
        del scene["sweep"]
        self.write(scene)
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as file:
            series = {name: file[f"observables/point_0000/{name}"][:] for name in ("mean_height", "bottom_fraction")}
            stored = {name: data[()] for name, data in file["analysis/target_precision"].items()}
        made = series["mean_height"].shape[1]
        n = 3
        while True:
            error = series["mean_height"][2, :n].std(ddof=1) / n**0.5
            sigma = series["bottom_fraction"][4, :n].std()
            wanted = [n if error <= 0.012 else min(np.ceil(n * (error / 0.012) ** 2), 2 * n),
                      n if sigma <= 0.0068 else np.ceil(1.25 * n)]
            if error <= 0.012 and sigma <= 0.0068 or n == 40:
                break
            n = int(min(max(n + 1, *wanted), 40))
            self.assertLessEqual(n, made)
        self.assertEqual(n, made)
        self.assertGreater(n, 3)
        np.testing.assert_allclose(stored["value"], [error, sigma], **EXACT)

    def test_the_tail_of_pores_and_its_p_value(self):
        width, tail_from = 0.02, 0.15
        scene = changed(TINY, container={"sides": "periodic", "width": 6}, spheres=250, realizations=3,
                        protocol=[{"tap": {"dilate": 0.05}, "count": 1}], snapshots={"taps": [1]},
                        structure={"pores": {"bin_width": width, "tail_from": tail_from}})
        del scene["sweep"]
        self.write(scene)
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as file:
            table = {name: data[0] for name, data in file["structure/point_0000/pores"].items()
                     if data.dtype != object and name != "xi"}
            middles = file["structure/point_0000/pores/xi"][:]
        counts = []
        for r in range(3):
            self.jostle("export", "tiny.h5", "--format", "extxyz", "--realization", r, "-o", f"{r}.xyz")
            own = json.loads(self.jostle("structure", f"{r}.xyz", "--part", "pores", "--json", "--settings", json.dumps(
                {"pores": {"bin_width": width, "tail_from": tail_from}})).stdout)["tables"][0]["quantities"]
            counts.append(np.array(own["rho_xi"]["values"][0]) * width)
        counts = np.array(counts)
        np.testing.assert_allclose(table["rho_xi"], counts.mean(axis=0) / width, **EXACT)
        tail = middles**3 >= tail_from
        low, high = (middles[tail] - width / 2) ** 3, (middles[tail] + width / 2) ** 3
        counts = counts[:, tail]
        v0, a, expected = exponential_tail(low, high, counts.mean(axis=0))
        without = [exponential_tail(low, high, np.delete(counts, r, axis=0).mean(axis=0)) for r in range(3)]
        for name, value, k in (("tail_v0", v0, 0), ("tail_a", a, 1)):
            np.testing.assert_allclose(table[name], value, rtol=1e-7)
            np.testing.assert_allclose(table[name + "_error"], jackknife(np.array([w[k] for w in without])), rtol=1e-5)
        np.testing.assert_allclose(table["tail_p"], p_of_counts(counts, expected, 2), rtol=1e-7)

    def test_pores_count_by_their_own_centres_or_those_of_their_spheres(self):
        scene = changed(TINY, container={"sides": "walls", "width": 6}, spheres=250, realizations=1,
                        protocol=[{"tap": {"dilate": 0.05}, "count": 1}], snapshots={"taps": [1]},
                        structure={"region": {"heights": [1, 5], "from_sides": 1}, "pores": {}})
        del scene["sweep"]
        self.write(scene)
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as file:
            centres = file["particles/point_0000_realization_00000/position/value"][0]
        four = spatial.Delaunay(centres).simplices
        side = np.linalg.solve(2 * (centres[four[:, 1:]] - centres[four[:, :1]]),
                               ((centres[four[:, 1:]]**2).sum(axis=2) - (centres[four[:, :1]]**2).sum(axis=2))[..., None])
        middles = side[..., 0]
        xi = (np.linalg.norm(middles - centres[four[:, 0]], axis=1) - 0.5) / 0.5
        low, high = np.array([1, 1, 1]), np.array([5, 5, 5])

        def inside(r):
            return np.all((r >= low) & (r <= high), axis=-1)

        for settings, counted in (({}, inside(middles)), ({"spheres_inside": True}, inside(centres)[four].all(axis=1))):
            table = json.loads(self.jostle("structure", "tiny.h5", "--no-store", "--json", "--settings", json.dumps(
                {"region": scene["structure"]["region"], "pores": settings})).stdout)["tables"][0]
            found = {name: quantity["values"][0] for name, quantity in table["quantities"].items()}
            self.assertGreater(counted.sum(), 100)
            self.assertEqual(found["n_pores"], counted.sum())
            np.testing.assert_allclose(found["nu"], (xi[counted]**3).mean(), **EXACT)

    def fitted(self, model, t, x, sigma):
        rows = "".join(f"{a!r},{b!r},{c!r}\n" for a, b, c in zip(t.tolist(), x.tolist(), sigma.tolist()))
        self.write("t,X,sigma\n" + rows, "curve.csv")
        found = json.loads(self.jostle("fit", "curve.csv", "--model", model, "--json").stdout)
        return found["curves"][0]["fits"][0]

    def test_fits_of_tables_by_least_squares(self):
        noise = np.random.default_rng(7)
        t = 0.01 * 1.3 ** np.arange(20)
        v = 0.15 + 0.02 * np.arange(25)
        lag = np.round(1.5 ** np.arange(1, 20))

        def power_law(t, a, s):
            return a * t**-s

        def ageing(t, a, b, tau):
            return a * (1 - 1 / (1 + b * np.log1p(t / tau)))

        def pore_tail(v, a, v0):
            return a * np.exp(-v / v0)

        for law, at, truth, relative in ((power_law, t, (2, 1.3), 0.05), (ageing, lag, (3, 0.8, 5), 0.01),
                                         (pore_tail, v, (5000, 0.1), 0.03)):
            with self.subTest(law=law.__name__):
                curve = law(at, *truth)
                x = curve * (1 + relative * noise.standard_normal(len(at)))
                sigma = relative * curve
                fit = self.fitted(law.__name__, at, x, sigma)
                p, errors, chi2 = least_squares(law, at, x, sigma, truth)
                found = [fit["parameters"][name] for name in fit["order"]]
                np.testing.assert_allclose([one["value"] for one in found], p, rtol=1e-7)
                np.testing.assert_allclose([one["standard_error"] for one in found], errors, rtol=1e-6)
                np.testing.assert_allclose(fit["residual_sum"], chi2, rtol=1e-9)

    def test_squared_changes_their_variances_and_the_errors_of_both(self):
        scene = changed(TINY, realizations=5, protocol=[{"tap": {"dilate": 0.05}, "count": 30}],
                        snapshots={"taps": [0]}, analyse={"ageing": [{"observable": "mean_height"}]})
        del scene["sweep"]
        self.write(scene)
        self.run_scene()
        with h5py.File(self.folder / "tiny.h5") as file:
            heights = file["observables/point_0000/mean_height"][:]
            table = file["analysis/point_0000/ageing/mean_height"]
            for name in ("a", "v", "a_inf", "b", "tau", "ageing_factor"):
                self.assertEqual(table[name + "_error"].attrs["long_name"],
                                 "standard error over realizations of ln of the value, times the value")
            for k, waiting in enumerate(table["waiting_time"][:]):
                for j, lag in enumerate(table["lag"][:]):
                    if waiting + lag > 30:
                        continue
                    change = heights[waiting + lag] - heights[waiting]
                    n = len(change)
                    without = [np.delete(change, r) for r in range(n)]
                    squares = np.array([(rest**2).mean() for rest in without])
                    variances = np.array([rest.var(ddof=1) for rest in without])
                    for name, value, left_out in (("a", (change**2).mean(), squares),
                                                  ("v", change.var(ddof=1), variances)):
                        np.testing.assert_allclose(table[name][k, j], value, **EXACT)
                        np.testing.assert_allclose(table[name + "_error"][k, j],
                                                   value * jackknife(np.log(left_out)), **EXACT)


if __name__ == "__main__":
    unittest.main()
