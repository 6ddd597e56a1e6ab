"""Contrasts of what beds.py reduced: numbers of each bed, so that differences are taken within beds."""
import numpy as np
from scipy import stats

from contrasts import contrast, misfit_of_means, most_within
from distributions import kept_taps, label, numbers, point_of, series, steady
from verdicts import Estimate

SPHERE = np.pi / 6
FRICTIONS, ROUGH = 7, 2   # sweep points of dr-pours; the point of friction 0.1


def window(observable, point, tap, other=None):
    """The mean over realizations of a series of dr6-windows at a tap, less that at another."""
    values = series("dr6-windows", point, observable, tap)
    return [Estimate.of(values - (0 if other is None else series("dr6-windows", point, observable, other)))]


def floor_15_at_0():
    return window("floor_15", 1, 0)


def floor_15_at_50():
    return window("floor_15", 1, 50)


def floor_15_at_250():
    return window("floor_15", 1, 250)


def floor_15_by_250():
    return window("floor_15", 1, 250, 0)


def floor_15_gain():
    return window("floor_15", 1, 250, 50)


def floor_18_at_0():
    return window("floor_18", 1, 0)


def floor_18_at_50():
    return window("floor_18", 1, 50)


def floor_18_at_250():
    return window("floor_18", 1, 250)


def short_step_at_50():
    return window("floor_15", 0, 50)


def short_step_at_250():
    return window("floor_15", 0, 250)


def floor_stop_at_250():
    return window("floor_15", 2, 250)


def floor_stop_later_at_250():
    return window("floor_15", 3, 250)


def stretched_exponential_fits():
    """The means of the beds at each kept tap from 1 on less the stretched exponential fitted to them, beyond the levels
    of the beds: lift 0.25, 0 to 15 d."""
    taps = [tap for tap in kept_taps("dr6-windows", 1) if tap >= 1]
    beds = np.array([series("dr6-windows", 1, "floor_15", tap) for tap in taps])
    return misfit_of_means(beds, misfit_of_stretched_exponential(np.array(taps, float), beds.mean(axis=1)))


def misfit_of_stretched_exponential(taps, phi):
    """Residuals of least squares: tau and beta from a grid, both levels linear."""
    def residuals(tau, beta):
        basis = np.column_stack([np.ones_like(taps), np.exp(-(taps / tau)**beta)])
        return phi - basis @ np.linalg.lstsq(basis, phi, rcond=None)[0]
    return min((residuals(tau, beta) for tau in np.exp(np.arange(-1, 12, 0.1)) for beta in np.arange(0.1, 1.55, 0.05)),
               key=lambda misfit: np.sum(misfit**2))


def middle_at_250():
    return window("bulk_fraction", 1, 250)


def layer_offsets(tap, layers=(2, 3)):
    """Peaks of n(y/d) less the heights of hcp layers, first step 0.2."""
    return [Estimate.of(numbers("dr6-windows", 1, f"layers/peak_{k}", tap) - (0.5 + (k - 1) * (2 / 3)**0.5))
            for k in layers]


def hcp_peaks():
    return layer_offsets(250)


def hcp_peaks_grow():
    """How many of the lowest four peaks of n(y/d) are within 0.1 d of hcp heights, tap 250 less tap 0."""
    def near(tap):
        return sum(np.abs(numbers("dr6-windows", 1, f"layers/peak_{k}", tap) - (0.5 + (k - 1) * (2 / 3)**0.5)) < 0.1
                   for k in range(1, 5))
    return [Estimate.of(near(250) - near(0))]


def whole_bed(point):
    """The fraction of a poured bed, [bed]: N spheres over the floor times twice the mean height."""
    return SPHERE * 3456 / (144 * 2 * series("dr-pours", point, "mean_height", 0))


def pours_fall():
    """The fall of the fraction of the whole bed from each friction to the next, the same columns in pairs."""
    beds = min(len(whole_bed(point)) for point in range(FRICTIONS))
    return [Estimate.of(whole_bed(point)[:beds] - whole_bed(point + 1)[:beds]) for point in range(FRICTIONS - 1)]


MOVES = "pb-move-settings"   # its first point is [PB]'s move: theta_0 = pi/4, d_max = 0.1, the Gaussian law


def gain_of_move(point, setting):
    """The gain of Phi_c from tap 1 to 30, [bed]: the first tap loosens the pour."""
    assert label(MOVES, point).startswith(setting), label(MOVES, point)
    return series(MOVES, point, "corrected_fraction", 30) - series(MOVES, point, "corrected_fraction", 1)


def gain_above(*points_and_settings):
    """The gain of [PB]'s move less that of others, in pairs."""
    best = gain_of_move(0, "theta0 = 0.7854, max_step = 0.1")
    return [Estimate.of(best - gain_of_move(*other)) for other in points_and_settings]


def optimum_of_angle():
    """The gain at pi/4 less that at pi/8, 3 pi/8 and pi/2."""
    return gain_above((2, "theta0 = 0.3927"), (4, "theta0 = 1.1781"), (5, "theta0 = 1.5708"))


def wide_angle_loses():
    return gain_above((5, "theta0 = 1.5708"))


def small_angle_decompacts():
    return [Estimate.of(-gain_of_move(1, "theta0 = 0.0982"))]


def short_steps_freeze():
    return gain_above((6, "theta0 = 0.7854, max_step = 0.003"))


def long_steps_freeze():
    return gain_above((9, "theta0 = 0.7854, max_step = 1"))


def width_above_form(point, setting):
    """The change of the gain by the next width of the ladder, to either side, less that by another form with
    the same mean square angle, of either sign."""
    best, form = gain_of_move(0, "theta0 = 0.7854"), gain_of_move(point, setting)
    narrow, wide = gain_of_move(3, "theta0 = 0.589"), gain_of_move(4, "theta0 = 1.1781")
    return [Estimate.of(width - sign * (form - best)) for width in (best - narrow, wide - best) for sign in (1, -1)]


def exponential_form():
    return width_above_form(10, "theta0 = 0.4677")


def linear_form():
    return width_above_form(11, "theta0 = 1.3318")


def smooth_pours():
    assert label("dr-pours", 0) == "friction = 0"
    return [Estimate.of(whole_bed(0))]


def rough_pours():
    assert label("dr-pours", ROUGH) == "friction = 0.1"
    return [Estimate.of(whole_bed(ROUGH))]


def rough_pours_middle():
    return [Estimate.of(series("dr-pours", ROUGH, "bulk_fraction", 0))]


def rough_pours_floor():
    return [Estimate.of(series("dr-pours", ROUGH, "floor_15", 0))]


def smooth_pours_middle():
    return [Estimate.of(series("dr-pours", 0, "bulk_fraction", 0))]


def smooth_pours_floor():
    return [Estimate.of(series("dr-pours", 0, "floor_15", 0))]


def neighbour_mean():
    """The mean of the normal law fitted to the neighbours of all spheres of a bed."""
    return [Estimate.of(numbers("dr-pours", ROUGH, "all/normal_mean", 0))]


def neighbour_width():
    return [Estimate.of(numbers("dr-pours", ROUGH, "all/normal_width", 0))]


def neighbour_average():
    return [Estimate.of(numbers("dr-pours", ROUGH, "all/neighbours", 0))]


def spread_of_free_volumes():
    """The 95 % interval of the deviation of beds' mean free volumes, as a share of their mean."""
    values = numbers("dr-pours", ROUGH, "voronoi/mean_free_volume", 0)
    dof = len(values) - 1
    share = values.std(ddof=1) / values.mean()
    return tuple(float(share * np.sqrt(dof / stats.chi2.ppf(p, dof))) for p in (0.975, 0.025))


VOIDS, WEAK, STRONG = "pb-voids", (0,), (1,)   # its sweep points: strengths 0.02 and 0.1
UNTAPPED = WEAK + STRONG


def fraction_before_voids():
    """Phi_c of all beds before the first tap: the strengths differ only after it."""
    return [Estimate.of(np.concatenate([series(VOIDS, point, "corrected_fraction", 0) for point in UNTAPPED]))]


def void_probability(points, tap, quantity="p0"):
    """P0 or Gotoh's at sigma = 1.2 and a kept tap, [bed]."""
    return np.concatenate([numbers(VOIDS, point, f"void_probability/{quantity}(1.2)", tap) for point in points])


def above_gotoh(points, tap):
    """P0 less Gotoh's at the packing's own fraction."""
    return [Estimate.of(void_probability(points, tap) - void_probability(points, tap, "p0_gotoh"))]


def above_gotoh_first():
    return above_gotoh(UNTAPPED, 0)


def above_gotoh_last():
    return above_gotoh(WEAK, 4000)


def strong_above_gotoh_last():
    return above_gotoh(STRONG, 4000)


def voids_change(points):
    """P0 after 4000 taps less that before."""
    return [Estimate.of(void_probability(points, 4000) - void_probability(points, 0))]


def weak_voids_change():
    return voids_change(WEAK)


def voids_change_as_printed():
    """P0's change for the rise of the fraction that the paper prints, 0.584 to 0.606, by each bed's own ratio."""
    rise = np.concatenate([numbers(VOIDS, point, "profile/phi_region", 4000) -
                           numbers(VOIDS, point, "profile/phi_region", 0) for point in WEAK])
    change = void_probability(WEAK, 4000) - void_probability(WEAK, 0)
    return [Estimate.of(change / rise * (0.606 - 0.584))]


def strong_voids_change():
    return voids_change(STRONG)


def pores_of_four(tap):
    return numbers("pb-pores", 0, "pores/four_centres", tap)


def pores_first():
    return [Estimate.of(pores_of_four(0))]


CRYSTAL = "dr-crystal"
MELTED, LATE = (75, 100, 133), (1778, 2371, 3162)   # kept taps, means of which are compared
ORDERED = (750, 800, 898, 1000, 1334)


def from_crystal(lift):
    """The sweep point of a lift."""
    return point_of(CRYSTAL, f"lift = {lift}")


def fall_from_crystal(lift):
    """The fraction from the floor to 15 d of the crystal less that after 56 taps, the last kept before 60."""
    return [Estimate.of(series(CRYSTAL, from_crystal(lift), "floor_15", 0) -
                        series(CRYSTAL, from_crystal(lift), "floor_15", 56))]


def fall_at_10():
    return fall_from_crystal(0.1)


def fall_at_20():
    return fall_from_crystal(0.2)


def fall_at_25():
    return fall_from_crystal(0.25)


def fall_at_30():
    return fall_from_crystal(0.3)


def fall_at_50():
    return fall_from_crystal(0.5)


LIFTS = (0.1, 0.2, 0.25, 0.3, 0.4, 0.5)


def melted_crystals():
    """[(lift, mean fraction of taps 4001 to 5000, standard error)], 0 to 15 d, and the least degrees of freedom."""
    found = [(lift, Estimate.of(steady(CRYSTAL, from_crystal(lift), "floor_15"))) for lift in LIFTS]
    return [(lift, e.value, e.error) for lift, e in found], min(e.dof for _, e in found)


def best_crystal():
    """0.25 and 0.3 less the weakest and less the strongest lift: variances differ as beds order."""
    points, dof = melted_crystals()
    return [contrast(points, w, dof, False) for w in ([-1, 0, .5, .5, 0, 0], [0, 0, .5, .5, 0, -1])]


def best_crystal_within():
    """0.2, 0.25 and 0.3 less 0.1, 0.4 and 0.5."""
    points, dof = melted_crystals()
    return most_within(points, [LIFTS.index(lift) for lift in (0.2, 0.25, 0.3)],
                       [LIFTS.index(lift) for lift in (0.1, 0.4, 0.5)], dof)


def rise_per_e_fold(point, first, last):
    """(last - first) / ln of their taps' ratio, [bed]: means over kept taps, whose tap is their geometric mean; None
    for the mean of taps 4001 to 5000."""
    def ends(taps):
        if taps is None:
            return steady(CRYSTAL, point, "floor_15"), np.log(4500)
        return np.mean([series(CRYSTAL, point, "floor_15", tap) for tap in taps], axis=0), np.mean(np.log(taps))
    (before, t0), (after, t1) = ends(first), ends(last)
    return (after - before) / (t1 - t0)


def strong_lifts_drift():
    """The mean of taps 4001 to 5000 less that of kept taps 75 to 133, lifts 0.4 and 0.5."""
    return [Estimate.of(steady(CRYSTAL, point, "floor_15") -
                        np.mean([series(CRYSTAL, point, "floor_15", tap) for tap in MELTED], axis=0))
            for point in map(from_crystal, (0.4, 0.5))]


def flattening():
    """Half the rise per e-fold of taps from about 100 to 940 less that from about 2370 to 4500, beds of lifts 0.2 and
    0.25."""
    return [Estimate.of(np.concatenate([rise_per_e_fold(point, MELTED, ORDERED) / 2 - rise_per_e_fold(point, LATE, None)
                                        for point in map(from_crystal, (0.2, 0.25))]))]
