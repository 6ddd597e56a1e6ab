"""Contrasts of [PB] 2 and of the laws of eqs. 3, 4 and 7 at full size: the campaign of 4096 spheres, 4000 taps."""
import numpy as np

from contrasts import misfit_of_inverse_log, misfit_of_means
from contrasts_of_campaign import CAMPAIGN, DRAWN, LAST, STRENGTHS, in_pairs, point_at
from distributions import distribution, kept_taps, numbers, series, steady
from reduce import REDUCED, read_table
from verdicts import Estimate

FIRST = 2.5  # diameters: eq. 7 describes the bed from 5 R


def full_growth(strength):
    """Phi_b, the mean of taps 3001 to 4000 less tap 1."""
    point = point_at(strength)
    return Estimate.of(steady(CAMPAIGN, point, "bottom_fraction") - series(CAMPAIGN, point, "bottom_fraction", 1))


def full_growths():
    return [full_growth(strength) for strength in (0.0025, 0.01, 0.1)]


def full_early_growth():
    """Phi_b, tap 100 less tap 1: eps^(1/2) = 0.1 less 0.05, and 0.05 less 0.025, beds in pairs."""
    def early(strength):
        first, last = (series(CAMPAIGN, point_at(strength), "bottom_fraction", tap) for tap in (1, 100))
        return last - first
    return [Estimate.of(in_pairs(0.01, 0.0025, early)), Estimate.of(in_pairs(0.0025, 0.000625, early))]


def growth(strength, observable):
    """(taps from 1 on, an observable [tap, bed])."""
    point = point_at(strength)
    taps = [tap for tap in kept_taps(CAMPAIGN, point) if tap >= 1]
    return np.array(taps, float), np.array([series(CAMPAIGN, point, observable, tap) for tap in taps])


def limits(strength, parameter):
    """The 95 % interval of a parameter of eq. 3 that the program fits to Phi_b (fits_of_growth.py)."""
    ends = next(row[2:] for row in read_table(REDUCED / CAMPAIGN / "fits.csv")[1:]
                if row[:2] == [f"{strength:g}", parameter])
    return tuple(float(end) if end else none for end, none in zip(ends, (-np.inf, np.inf)))


def asymptote_at_weak_taps():
    return limits(0.000625, "X_inf")


def rise_of_tau():
    """tau at eps^(1/2) = 0.025 over that at 0.1: the ends of both intervals."""
    (low, high), (least, most) = limits(0.000625, "tau"), limits(0.01, "tau")
    return low / most, high / least


def distance_to_asymptote_grows():
    """X_inf less Phi_b of taps 3001 to 4000, at eps^(1/2) = 0.025 at least, less that at 0.32 at most: 95 % limits."""
    def steady_value(strength):
        return steady(CAMPAIGN, point_at(strength), "bottom_fraction").mean()
    (low, _), (_, most) = limits(0.000625, "X_inf"), limits(0.1, "X_inf")
    return low - steady_value(0.000625) - (most - steady_value(0.1)), np.inf


def eq3_fits():
    """Phi_b less eq. 3 at every kept tap and strength."""
    return sum((misfit_of_eq3(*growth(strength, "bottom_fraction")) for strength in STRENGTHS), [])


def misfit_of_eq3(taps, beds):
    return misfit_of_means(beds, misfit_of_inverse_log(taps, beds.mean(axis=1)))


def eq4_fits():
    """<Z> less eq. 4, which is eq. 3 of 1/<Z>, over <Z>, at every kept tap and strength."""
    found = []
    for strength in STRENGTHS:
        taps, heights = growth(strength, "mean_height")
        found += misfit_of_eq3(taps, heights.mean() / heights)
    return found


def eq7_fits():
    """The profile at eps = 0.1, tap 4000, less eq. 7 of mean parameters: means over 1 d from 5 R to z*; errors of its
    places are added."""
    point = point_at(DRAWN)
    x, mean, error = distribution(CAMPAIGN, point, "profile/phi")[LAST]
    phi_0, alpha, beta, z_star = (numbers(CAMPAIGN, point, f"profile/eq7_{name}", LAST).mean()
                                  for name in ("phi_0", "alpha", "beta", "z_star"))
    misfit = mean - (phi_0 - alpha * 2 * x) / (1 + np.exp(beta * (2 * x - z_star)))
    beds = len(numbers(CAMPAIGN, point, "profile/eq7_alpha", LAST))
    found = []
    for low in np.arange(FIRST, z_star / 2 - 1, 1):
        inside = (x >= low) & (x < low + 1)
        found.append(Estimate(float(misfit[inside].mean()), float(error[inside].mean()), beds - 1))
    return found
