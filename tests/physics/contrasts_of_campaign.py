"""Contrasts of the campaign of [PB] 3 and 6 to 8: 4096 spheres, 4000 taps, four strengths."""
import numpy as np

from distributions import beds_of_point, differences, distribution, numbers, point_of, realizations, spectrum
from verdicts import Estimate

CAMPAIGN = "pb-campaign"
STRENGTHS = (0.000625, 0.0025, 0.01, 0.1)
LAST, DRAWN, WIDTH = 4000, 0.1, 16   # the last tap; eps of figs. 6 and 7; the box in diameters
LOW, HIGH, FITTED = (0.002, 0.01), (0.1, 0.5), (0.002, 0.5)   # frequencies in 1/taps; drift lies below 0.002


def point_at(strength):
    """The sweep point of an eps."""
    return point_of(CAMPAIGN, f"dilate = {strength}")


def by_realization(strength, values):
    """{realization: value}; values(strength): [bed]."""
    return dict(zip(realizations(CAMPAIGN, point_at(strength)), values(strength)))


def in_pairs(first, second, values):
    """Differences between two strengths, of the realizations that both have."""
    return differences(by_realization(first, values), by_realization(second, values))


def log_power(strength, band):
    """ln of frequency and of power in a band, [frequency] and [bed, frequency], at eps."""
    frequency, power = spectrum(CAMPAIGN, point_at(strength))
    chosen = (frequency >= band[0]) & (frequency <= band[1])
    return np.log(frequency[chosen]), np.log(power[:, chosen])


def effect_of_strength(band):
    """Mean ln of the power at eps = 0.1 over that at 0.0025, beds in pairs."""
    return in_pairs(0.1, 0.0025, lambda strength: log_power(strength, band)[1].mean(axis=1))


def high_frequencies_only():
    """Half the effect at high frequencies, less and plus that at low ones: the latter is less than half the former."""
    high, low = effect_of_strength(HIGH), effect_of_strength(LOW)
    return [Estimate.of(high / 2 - low), Estimate.of(high / 2 + low)]


def low_frequencies():
    return [Estimate.of(effect_of_strength(LOW))]


def high_frequencies():
    return [Estimate.of(effect_of_strength(HIGH))]


def slope_at_full_size(strength):
    """The slope of ln power against ln frequency, its bins alike, beds of one strength."""
    frequency, power = log_power(strength, FITTED)
    return [Estimate.of([np.polyfit(frequency, bed, 1)[0] for bed in power])]


def full_slope_05():
    return slope_at_full_size(0.0025)


def full_slope_32():
    return slope_at_full_size(0.1)


def numbers_at(strength, quantity, tap=LAST):
    return numbers(CAMPAIGN, point_at(strength), quantity, tap)


def over_strengths(values):
    """The mean over the strengths within each bed that all have: one bed starts the realization at every strength."""
    beds = [by_realization(strength, values) for strength in STRENGTHS]
    return Estimate.of([np.mean([of_strength[bed] for of_strength in beds])
                        for bed in set.intersection(*map(set, beds))])


def of_profile(quantity, peaks, trough):
    """The mean of a profile at peaks less that at a trough, eps = 0.1: places in diameters. Only means and deviations
    of single places are kept: their errors are added, which is at least the error of the difference."""
    point = point_at(DRAWN)
    x, mean, error = distribution(CAMPAIGN, point, quantity)[LAST]
    weights = np.zeros_like(x)
    for places, weight in ((peaks, 1 / len(peaks)), (trough, -1 / len(trough))):
        for place in places:
            weights[np.argmin(np.abs(x - place))] += weight
    return [Estimate(float(weights @ mean), float(np.abs(weights) @ error), beds_of_point(CAMPAIGN, point) - 1)]


def full_floor_peaks():
    """Heights 1.25 and 2.25 less 1.75."""
    return of_profile("profile/phi", (1.25, 2.25), (1.75,))


def layers_at_walls(peaks, trough):
    """From both walls."""
    return of_profile("sides/phi_xy", [*peaks, *(WIDTH - x for x in peaks)], [trough, WIDTH - trough])


def full_first_gap():
    return layers_at_walls((0.55, 1.45), 0.95)


def full_second_gap():
    return layers_at_walls((1.45, 2.35), 1.85)


def full_third_gap():
    return layers_at_walls((2.35, 3.25), 2.75)


def full_fourth_gap():
    return layers_at_walls((3.25, 4.15), 3.65)


def full_fifth_gap():
    return layers_at_walls((4.15, 5.05), 4.55)


def full_pores_last():
    """Sets of four neighbours with their centres in the box, eps = 0.01, the densest of four strengths."""
    return [Estimate.of(numbers_at(0.01, "pores/four_centres"))]


NU_TAPS = (1, 10, 100, 1000, 4000)


def full_nu_falls():
    """nu at each of taps 1, 10, 100 and 1000 less that at the next of them or 4000, at each strength."""
    return [Estimate.of(numbers_at(strength, "pores/nu", first) - numbers_at(strength, "pores/nu", last))
            for strength in STRENGTHS for first, last in zip(NU_TAPS, NU_TAPS[1:])]


def full_nu_rises_first():
    """nu at tap 1 less that at tap 0."""
    return [Estimate.of(numbers_at(strength, "pores/nu", 1) - numbers_at(strength, "pores/nu", 0))
            for strength in STRENGTHS]


def full_tail_misfits():
    """ln of rho_v less a line in v, eps = 0.01, taps 0, 99 and 4000: means over 0.1 of v from 0.1 to where it is known to
    15 %, lines weighted by the errors, which are added within a mean."""
    point, found = point_at(0.01), []
    for tap in (0, 99, LAST):
        xi, mean, error = distribution(CAMPAIGN, point, "pores/rho_v")[tap]
        known = (xi**3 >= 0.1) & (error < 0.15 * mean)
        v, weight = xi[known]**3, mean[known] / error[known]
        basis = np.column_stack([np.ones_like(v), v])
        fitted = basis @ np.linalg.lstsq(basis * weight[:, None], np.log(mean[known]) * weight, rcond=None)[0]
        misfit = np.log(mean[known]) - fitted
        for low in np.arange(0.1, v[-1], 0.1):
            inside = (v >= low) & (v < low + 0.1)
            if inside.any():
                found.append(Estimate(float(misfit[inside].mean()), float((1 / weight[inside]).mean()),
                                      beds_of_point(CAMPAIGN, point) - 1))
    return found


def alpha_at(strength):
    """10^3 alpha R, [bed]."""
    return 1e3 * numbers_at(strength, "profile/alpha")


def full_alpha():
    return [Estimate.of(alpha_at(DRAWN))]


def full_alpha_rises():
    """eps^(1/2) = 0.1 less 0.025, beds in pairs."""
    return [Estimate.of(in_pairs(0.01, 0.000625, alpha_at))]


def full_alpha_falls():
    """eps^(1/2) = 0.1 less 0.32, beds in pairs."""
    return [Estimate.of(in_pairs(0.01, 0.1, alpha_at))]


def lateral_above_central(tap):
    return [over_strengths(lambda strength: numbers_at(strength, "sides/lateral_change", tap) -
                           numbers_at(strength, "sides/central_change", tap))]


def full_first_tap():
    return lateral_above_central(1)


def full_increases():
    return lateral_above_central(LAST)


def bell_of(quantity):
    """eps^(1/2) = 0.1 less either end, 0.025 and 0.32, beds in pairs."""
    return [Estimate.of(in_pairs(0.01, end, lambda strength: numbers_at(strength, quantity)))
            for end in (0.000625, 0.1)]


def full_lateral_bell():
    return bell_of("sides/lateral_change")


def full_central_bell():
    return bell_of("sides/central_change")


def full_weak_is_frozen():
    """A fifth of the central increase from tap 1 to 4000 at eps^(1/2) = 0.1, less that at 0.025, beds in pairs."""
    def gain(strength):
        change = numbers_at(strength, "sides/central_change") - numbers_at(strength, "sides/central_change", 1)
        return change / 5 if strength == 0.01 else change
    return [Estimate.of(in_pairs(0.01, 0.000625, gain))]
