"""Drawings of docs/validation in the forms of the papers that no table gives by itself. Each takes the axes."""
import numpy as np
from matplotlib.collections import EllipseCollection
from scipy import optimize, stats

import contrasts_of_lifts as two_taps
from contrasts import misfit_of_inverse_log
from contrasts_of_beds import CRYSTAL, FRICTIONS, LIFTS, ROUGH, from_crystal, whole_bed
from contrasts_of_campaign import CAMPAIGN, DRAWN, LAST, STRENGTHS, WIDTH, numbers_at, point_at
from contrasts_of_growth import growth, limits
from distributions import beds_of_point, distribution, kept_taps, label, numbers, series, spectrum, steady
from pictures import COLOURS, value_of
from reduce import REDUCED, read_table
from verdicts import Estimate

MARKS = "osD^v<>p"
LAYER = (2 / 3)**0.5
FLOOR_15 = "packing fraction, 0 to 15 d"
PRINTED_LABEL = "the paper"
PRINTED = ((0, 0.567), (50, 0.578), (250, 0.597))


def draw_parameters(axes):
    """[PB] eqs. 3 and 4: 95 % limits of X_inf and tau against eps^(1/2), and Phi_b of the last thousand taps."""
    strengths = np.sqrt(STRENGTHS)
    for panel, name in zip(axes, ("X_inf", "tau")):
        for x, (low, high) in zip(strengths, (limits(strength, name) for strength in STRENGTHS)):
            top = high if np.isfinite(high) else 1.2 * low
            panel.plot([x, x], [low, top], color=COLOURS[0])
            panel.plot(x, top, "_" if np.isfinite(high) else "^", color=COLOURS[0])
            panel.plot(x, low, "_", color=COLOURS[0], label="95 % limits (arrow: none)" if x == strengths[0] else None)
        panel.set(xlabel="eps^(1/2)", ylabel=f"{name} of eq. 3", xscale="log")
    values = [steady(CAMPAIGN, point_at(strength), "bottom_fraction").mean() for strength in STRENGTHS]
    axes[0].plot(strengths, values, "o", color=COLOURS[1], markersize=3, label="Phi_b, taps 3001 to 4000")
    axes[0].legend()
    axes[1].set(yscale="log")


def draw_two_taps(axes):
    """[DR] 2: packing fraction against taps, 0 to 15 d, lifts and held dilations of the same beds."""
    for k, (point, name) in enumerate(((two_taps.LIFT, "lift 0.25"), (two_taps.HELD, "held dilation 1.025"))):
        taps = [tap for tap in kept_taps(two_taps.RUN, point) if tap > 0]
        beds = [Estimate.of(series(two_taps.RUN, point, two_taps.WINDOW, tap)) for tap in taps]
        axes[0].errorbar(taps, [bed.value for bed in beds], yerr=[bed.half_width() for bed in beds], marker=MARKS[k],
                         color=COLOURS[k], markersize=3, capsize=1, elinewidth=.6, label=name)
    axes[0].set(xlabel="taps", ylabel=FLOOR_15, xscale="log")
    axes[0].legend()


def draw_profile(panel, quantity, mark_fits):
    """A profile, over radii, of the poured bed and after 4000 taps, eps = 0.1, with eq. 7 of each where asked for."""
    point = point_at(DRAWN)
    found = distribution(CAMPAIGN, point, quantity)
    for tap, colour, style in ((0, COLOURS[1], ":"), (LAST, COLOURS[0], "-")):
        x, mean, _ = found[tap]
        panel.plot(2 * x, mean, style, color=colour, label=f"tap {tap}")
        if mark_fits:
            phi_0, alpha, beta, z_star = (numbers(CAMPAIGN, point, f"profile/eq7_{name}", tap).mean()
                                          for name in ("phi_0", "alpha", "beta", "z_star"))
            z = 2 * x[x > 2.5]
            panel.plot(z, (phi_0 - alpha * z) / (1 + np.exp(beta * (z - z_star))), "k", linewidth=.7,
                       label="eq. 7" if tap else None)
    panel.set(ylabel="packing fraction")


def draw_vertical(axes):
    """[PB] 6: packing fraction against height."""
    draw_profile(axes[0], "profile/phi", True)
    axes[0].set(xlabel="z/R", xlim=(0, 36))
    axes[0].legend()


def draw_transverse(axes):
    """[PB] 7: packing fraction across the box, lines at 7 R from the walls."""
    draw_profile(axes[0], "sides/phi_xy", False)
    for place in (7, 2 * WIDTH - 7):
        axes[0].axvline(place, color="k", linestyle=":", linewidth=.8)
    axes[0].set(xlabel="x/R", xlim=(0, 2 * WIDTH))
    axes[0].legend(loc="lower center")


def draw_increases(axes):
    """[PB] 8: lateral and central increase of four strengths."""
    taps = sorted({int(row[2]) for row in read_table(REDUCED / CAMPAIGN / "structure.csv")[1:]})
    for panel, side in zip(axes, ("lateral", "central")):
        for k, strength in enumerate(STRENGTHS):
            beds = [Estimate.of(numbers_at(strength, f"sides/{side}_change", tap)) for tap in taps]
            errors = [bed.half_width() for bed in beds] if beds[0].dof > 0 else None
            panel.errorbar(taps, [bed.value for bed in beds], errors, marker=MARKS[k], color=COLOURS[k], markersize=3,
                           capsize=1, elinewidth=.6,
                           label=f"eps^(1/2) = {strength**0.5:.3g}")
        panel.set_xscale("symlog", linthresh=1)
        panel.set(xlabel="taps", ylabel="increase of Phi", title=side, ylim=(0, 0.13))
    axes[0].legend()


READINGS = ("first step 0.1 d", "first step 0.2 d", "0.2 d, stop 0 to 15 d", "0.2 d, so, start off")


def draw_densities(panel, points):
    """[DR] 6: the fraction from the floor to 15 d against taps, by readings, with the printed numbers."""
    taps = sorted({int(row[2]) for row in read_table(REDUCED / "dr6-windows" / "series.csv")[1:]})
    for point in points:
        values = [series("dr6-windows", point, "floor_15", tap) for tap in taps]
        panel.errorbar(taps, [v.mean() for v in values], [v.std(ddof=1) / len(v)**.5 for v in values],
                       color=COLOURS[point], label=READINGS[point], elinewidth=.6)
    panel.plot(*zip(*PRINTED), "ko", markerfacecolor="none", label=PRINTED_LABEL, zorder=5)
    panel.set(xlabel="taps", ylabel=FLOOR_15)
    panel.set_xscale("symlog", linthresh=1)
    panel.legend()


def draw_layers(axes):
    """[DR] 6: density from the floor, and n(y/d) at three taps with the heights of hcp layers."""
    draw_densities(axes[0], range(len(READINGS)))
    shares = distribution("dr6-windows", 1, "n")
    for panel, tap in zip(axes[1:], (0, 50, 250)):
        z, n, _ = shares[tap]
        for layer in range(10):
            panel.axvline(0.5 + layer * LAYER, color="#bbbbbb", linewidth=.5)
        panel.plot(z, n, color=COLOURS[0], linewidth=.7)
        panel.set(xlabel="y/d", ylabel="n", title=f"{tap} taps", xlim=(0, 23))


def draw_growth(axes):
    """[PB] 2: Phi_b against taps, logarithmic and linear, four strengths, with eq. 3 dotted."""
    for k, strength in enumerate(STRENGTHS):
        taps, beds = growth(strength, "bottom_fraction")
        half = [Estimate.of(row).half_width() for row in beds]
        means = beds.mean(axis=1)
        for panel in axes:
            panel.errorbar(taps, means, half, linestyle="none", marker=MARKS[k], color=COLOURS[k], markersize=2.5,
                           capsize=1, elinewidth=.6, label=f"eps^(1/2) = {strength**0.5:.3g}")
            panel.plot(taps, means - misfit_of_inverse_log(taps, means), "k:", label="eq. 3" if k == 3 else None)
            panel.set(xlabel="taps", ylabel="Phi_b")
    axes[0].set_xscale("log")
    axes[0].legend()


def draw_spectra(axes):
    """[PB] 3: power of the mean height of the last 2000 taps, 4096 spheres, and its deviation, 1024 spheres."""
    for point in range(4):
        frequency, power = spectrum(CAMPAIGN, point)
        strength = float(label(CAMPAIGN, point).split("= ")[1])
        axes[0].plot(frequency, power.mean(axis=0), color=COLOURS[point], marker=MARKS[point], markersize=2,
                     label=f"eps^(1/2) = {strength**0.5:.3g}")
    middle = np.array([0.004, 0.2])
    for slope, style in ((-1, ":"), (-1.5, "--")):
        axes[0].plot(middle, 1e-5 * (middle / middle[0])**slope, "k", linestyle=style, label=f"f^{slope:g}")
    axes[0].set(xscale="log", yscale="log", xlabel="frequency, 1/taps", ylabel="power of <Z>, square diameters x taps")
    header, *rows = read_table(REDUCED / "pb3" / "1.csv")
    found = [value_of(row[header.index("sigma_Z")]) for row in rows]
    axes[1].errorbar([float(row[0]) for row in rows], [v for v, _, _ in found], [high - v for v, _, high in found],
                     color=COLOURS[0], marker="o", markersize=3, capsize=1, linestyle="none", label="1024 spheres")
    axes[1].set(xlabel="eps^(1/2)", ylabel="sigma_Z, diameters", xlim=(0, None), ylim=(0, None))
    for panel in axes:
        panel.legend()


def draw_steady_crystals(panel, **style):
    """[DR] 5b: the mean fraction of taps 4001 to 5000, from the floor to 15 d, against the lift."""
    beds = [Estimate.of(steady(CRYSTAL, from_crystal(lift), "floor_15")) for lift in LIFTS]
    panel.errorbar(LIFTS, [bed.value for bed in beds], [bed.half_width() for bed in beds], markersize=3, capsize=1,
                   **style)


def draw_crystals(axes):
    """[DR] 5: the fraction against taps of two lifts, thin lines for single beds, with an inset; and against the lift."""
    taps = sorted({int(row[2]) for row in read_table(REDUCED / CRYSTAL / "series.csv")[1:]})
    inset = axes[0].inset_axes([.45, .55, .5, .4])
    for k, lift in enumerate((0.2, 0.25)):
        beds = np.array([series(CRYSTAL, from_crystal(lift), "floor_15", tap) for tap in taps])
        for panel in (axes[0], inset):
            panel.plot(taps, beds, color=COLOURS[k], linewidth=.3)
            panel.plot(taps, beds.mean(axis=1), color=COLOURS[k], label=f"lift {lift}")
    inset.set_xlim(0, 60)
    inset.tick_params(labelsize=6)
    axes[0].set(xlabel="taps", ylabel=FLOOR_15, ylim=(0.55, 0.75))
    axes[0].legend(loc="lower right")
    draw_steady_crystals(axes[1], marker="o", color=COLOURS[0], label="taps 4001 to 5000")
    axes[1].set(xlabel="lift, diameters", ylabel=FLOOR_15)
    axes[1].legend()


def gotoh(sigma, phi):
    """P0 by Percus-Yevick (Gotoh; Philippe and Bideau 2001, eqs. 8 and 9, with 1 + 2 Phi, which is continuous)."""
    outer = (1 - phi) * np.exp(phi / (1 - phi)**2 * (-(1 + 2 * phi) * sigma**3 + 4.5 * phi * sigma**2 + 1 - 2.5 * phi))
    return np.where(sigma <= 1, 1 - phi * sigma**3, outer)


def draw_void_probability(axes):
    """[PB] 9: P0 of the packings, strength 0.02, and Gotoh's at the later fraction."""
    fine = np.linspace(0, 2, 200)
    phi = numbers("pb-voids", 0, "void_probability/phi", 4000).mean()
    axes[0].plot(fine, gotoh(fine, phi), "k", linewidth=2, label=f"Gotoh, Phi = {phi:.3f}")
    found = distribution("pb-voids", 0, "void_probability/p0")
    for k, (tap, marks) in enumerate(((4000, {"marker": "o", "markerfacecolor": "none"}),
                                      (0, {"marker": "_", "markersize": 8}))):
        sigma, mean, _ = found[tap]
        axes[0].plot(sigma, mean, color=COLOURS[1 - k], label=f"tap {tap}", linestyle="none", **marks)
    axes[0].set(xlabel="sigma", ylabel="P0", xlim=(0, 2))
    axes[0].legend()


def pore_densities():
    """(v, rho_v, style) at the three taps of [PB] 10."""
    header, *rows = read_table(REDUCED / "pb10" / "2.csv")
    v = np.array([float(name) for name in header[1:]])
    for k, row in enumerate(row for row in rows if row[0] in ("0", "99", "9999")):
        yield (v, np.array([value_of(cell)[0] for cell in row[1:]]),
               {"marker": MARKS[k], "color": COLOURS[k], "markersize": 3, "label": f"t + 1 = {int(row[0]) + 1}"})


def draw_tails(panel):
    """[PB] 10b: ln rho_v."""
    for v, rho, style in pore_densities():
        panel.plot(v, np.log(rho), **style)
    panel.set(xlabel="v, sphere volumes", ylabel="ln rho_v")
    panel.legend()


def draw_pores(axes):
    """[PB] 10: mean pore and tail against taps; v rho_v with both sites; ln rho_v."""
    header, *rows = read_table(REDUCED / "pb10" / "1.csv")
    for k, name in enumerate(("nu", "v0")):
        found = [value_of(row[header.index(name)]) for row in rows]
        axes[0].errorbar([float(row[0]) + 1 for row in rows], [v for v, _, _ in found], [h - v for v, _, h in found],
                         marker=MARKS[k], color=COLOURS[k], markersize=3, capsize=1, label=name)
    axes[0].set(xscale="log", xlabel="t + 1, taps", ylabel="sphere volumes", ylim=(0, None))
    for v, rho, style in pore_densities():
        axes[1].plot(v, v * rho, **style)
    for site, place in (("T", 0.0114), ("O", 0.0711)):
        axes[1].axvline(place, color="#888888", linewidth=.6, linestyle=":")
        axes[1].text(place, 0.95, site, ha="center", fontsize=7, transform=axes[1].get_xaxis_transform())
    axes[1].set(xlabel="v, sphere volumes", ylabel="v rho_v")
    draw_tails(axes[2])
    for panel in axes[:2]:
        panel.legend()


def draw_snapshots(axes):
    """[DR] 1: a poured bed and one after 250 taps, the two foremost diameters of the box."""
    rows = np.array([list(map(float, row)) for row in read_table(REDUCED / "dr6-windows" / "snapshot.csv")[1:]])
    for panel, tap, title in zip(axes, (0, 250), ("(a) poured", "(b) after 250 taps")):
        found = rows[rows[:, 0] == tap]  # the farthest first
        shades = (1 - 0.35 * found[:, 2])[:, None] * np.array([0.35, 0.62, 0.85]) + 0.1
        panel.add_collection(EllipseCollection(1, 1, 0, units="xy", offsets=found[:, [1, 3]], facecolors=shades,
                                               edgecolors="#202020", linewidths=.25, offset_transform=panel.transData))
        phi = series("dr6-windows", 1, "floor_15", tap)[0]
        panel.set(xlim=(-.6, 12.6), ylim=(0, 24), aspect="equal", xlabel="x/d", ylabel="y/d",
                  title=f"{title}: {phi:.3f}")
        panel.grid(False)


def draw_pours(axes):
    """[DR] 7: the fraction of poured beds against friction, means and deviations of beds."""
    frictions = [float(label("dr-pours", point).split("= ")[1]) for point in range(FRICTIONS)]
    for k, (name, of_point) in enumerate((("whole bed", whole_bed),
                                          ("0 to 15 d", lambda p: series("dr-pours", p, "floor_15", 0)),
                                          ("middle 60 %", lambda p: series("dr-pours", p, "bulk_fraction", 0)))):
        beds = [of_point(point) for point in range(FRICTIONS)]
        axes[0].errorbar(frictions, [v.mean() for v in beds], [v.std(ddof=1) for v in beds], marker=MARKS[k],
                         color=COLOURS[k], markersize=3, capsize=2, label=name)
    axes[0].errorbar([0.1], [0.6088], [0.0035], color="k", capsize=3, marker="o", markerfacecolor="none",
                     linestyle="none", label=PRINTED_LABEL, zorder=5)
    axes[0].plot([0], [0.6366], "k*", markerfacecolor="none", label="random packings", zorder=5)
    axes[0].set(xlabel="friction", ylabel="packing fraction")
    axes[0].legend()


def draw_neighbours(axes):
    """[DR] 8: share of spheres against neighbours, all spheres of all beds, and the normal laws."""
    n, share, error = distribution("dr-pours", ROUGH, "all/neighbour_share")[0]
    axes[0].errorbar(n, share, error, linestyle="none", marker="o", markersize=3.5, color=COLOURS[0], capsize=1,
                     label=f"{beds_of_point('dr-pours', ROUGH)} beds")
    fine = np.linspace(1, 12.5, 200)
    mean, width = (numbers("dr-pours", ROUGH, f"all/normal_{name}", 0).mean() for name in ("mean", "width"))
    axes[0].plot(fine, stats.norm.pdf(fine, mean, width), color=COLOURS[0], label=f"normal: {mean:.2f}, {width:.2f}")
    axes[0].plot(fine, stats.norm.pdf(fine, 7.2713, 1.2550), "k--", label="the paper: 7.27, 1.26")
    axes[0].set(xlabel="neighbours within 1.05 d", ylabel="share of the spheres", xlim=(1, 12.5), ylim=(0, None))
    axes[0].legend()


def draw_free_volumes(axes):
    """[DR] 9: probability density of the free volume, in sphere volumes."""
    x, density, error = distribution("dr-pours", ROUGH, "voronoi/free_volume_density")[0]
    axes[0].errorbar(x, density, error, marker="o", markersize=2.5, color=COLOURS[0], elinewidth=.6,
                     label=f"friction 0.1, {beds_of_point('dr-pours', ROUGH)} beds")
    axes[0].set(xlabel="free volume, sphere volumes", ylabel="probability density", xlim=(0.3, 1.2), ylim=(0, None))
    axes[0].legend()


def ageing_curves():
    """[(age, lags, A, half width of ln A)], 10^4 A in square diameters."""
    header, *rows = read_table(REDUCED / "pb5" / "1.csv")
    lags = np.array([float(name.rsplit(" ", 1)[1]) for name in header[1:-1]])
    for row in rows:
        found = np.array([value_of(cell) for cell in row[1:-1]])
        yield float(row[0]), lags, found[:, 0], np.log(found[:, 2] / found[:, 1]) / 2


def collapse_of_ages(curves):
    """ln of (A_inf, tau) of each age, and B, common to all: least squares of ln A by eq. 6."""
    def unpacked(p):
        return p[:-1].reshape(-1, 2), np.exp(p[-1])

    def misfit(p):
        scales, b = unpacked(p)
        return np.concatenate([(np.log(a) - ln_a - np.log1p(-1 / (1 + b * np.log1p(lags / np.exp(ln_tau))))) / half
                               for (_, lags, a, half), (ln_a, ln_tau) in zip(curves, scales)])
    first = np.array([*sum(([np.log(2 * a[-1]), 4.0] for _, _, a, _ in curves), []), 0.0])
    return unpacked(optimize.least_squares(misfit, first, bounds=(-12, 25), max_nfev=2000).x)


def draw_ageing(axes):
    """[PB] 5: A against the lag, and the curves over their scales beside eq. 6 with one B."""
    curves = list(ageing_curves())
    scales, b = collapse_of_ages(curves)
    for k, ((age, lags, a, half), (ln_a, ln_tau)) in enumerate(zip(curves, scales)):
        style = {"marker": MARKS[k], "markersize": 3, "color": COLOURS[k], "capsize": 1, "elinewidth": .6}
        errors = a * (1 - np.exp(-half)), a * (np.exp(half) - 1)
        axes[0].errorbar(lags, a, errors, label=f"t_W = {age:g}", **style)
        axes[1].errorbar(lags / np.exp(ln_tau), a / np.exp(ln_a), np.array(errors) / np.exp(ln_a), linestyle="none",
                         **style)
    spans = [lags[[0, -1]] / np.exp(ln_tau) for (_, lags, _, _), (_, ln_tau) in zip(curves, scales)]
    fine = np.geomspace(min(s[0] for s in spans), max(s[1] for s in spans), 100)
    axes[1].plot(fine, 1 - 1 / (1 + b * np.log1p(fine)), "k:", label=f"eq. 6, B = {b:.2g}")
    for panel in axes:
        panel.set(xscale="log", yscale="log")
        panel.legend()
    axes[0].set(xlabel="lag t, taps", ylabel="10^4 A, square diameters")
    axes[1].set(xlabel="t / tau", ylabel="A / A_inf")


def draw_surface(panel):
    """[DR] 14: n over height and taps at Gamma = 2."""
    header, *rows = read_table(REDUCED / "dr10-14" / "4.csv")
    rows = [row for row in rows if row[0].startswith("Gamma = 2")]
    taps = [float(row[0].rsplit(" ", 1)[1]) for row in rows]
    heights = [float(name) for name in header[1:]]
    n = np.array([[value_of(cell)[0] for cell in row[1:]] for row in rows])
    y, t = np.meshgrid(heights, taps)
    panel.plot_surface(y, t, n, cmap="viridis", rstride=1, cstride=1, linewidth=.2, edgecolor="#333333")
    panel.set(xlabel="y/d", ylabel="taps", zlabel="n")
    panel.view_init(35, -60)


def draw_map(axes):
    """[DR] 15: improvement over amplitude and frequency."""
    header, *rows = read_table(REDUCED / "dr15" / "1.csv")
    values = [[value_of(cell)[0] for cell in row[1:]] for row in rows]
    image = axes[0].imshow(values, origin="lower", cmap="viridis", aspect="auto")
    axes[0].set_xticks(range(len(header) - 1), header[1:])
    axes[0].set_yticks(range(len(rows)), [row[0] for row in rows])
    axes[0].grid(False)
    for i, line in enumerate(values):
        for j, value in enumerate(line):
            axes[0].text(j, i, f"{value:g}", ha="center", va="center", color="white" if value < 1.5 else "black")
    axes[0].figure.colorbar(image, label="improvement, %")
