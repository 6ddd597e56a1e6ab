"""Contrasts of [DR] 10 to 14: discrete elements tapped at Gamma = 2 and 0.5, the same pours at both.

They were stated before a bed was finished; the claims of claims_dr.py follow once each strength has four. The window
is that from the floor to 15 d, which numbers of [DR] 6 chose and others of it tested."""
import numpy as np

from contrasts_of_beds import SPHERE
from distributions import differences, label, numbers, realizations, series
from packings import SPACING
from verdicts import Estimate

RUN, STRONG, WEAK = "dr-taps", 0, 1   # the sweep points of Gamma = 2 and 0.5
AMPLITUDES = {STRONG: 0.4413, WEAK: 0.1103}
LAST, LATE, FIRST = 898, 400, 100     # taps: of Gamma = 2, of Gamma = 0.5, and of the first profile
WINDOW = "floor_15"
LOW, HIGH = range(2, 6), range(12, 16)  # layers from the floor
JUMP = 0.02                           # the least rise of Phi within 50 taps that is called a jump


def at_tap(point, tap, observable=WINDOW):
    """An observable of the beds of a point, [bed]."""
    assert str(AMPLITUDES[point]) in label(RUN, point), label(RUN, point)
    return series(RUN, point, observable, tap)


def gain(point, tap, observable=WINDOW):
    """Its change since tap 0, [bed]."""
    return at_tap(point, tap, observable) - at_tap(point, 0, observable)


def whole_beds(point, tap):
    """N spheres over the floor times twice the mean height, [bed]."""
    return SPHERE * 3456 / (144 * 2 * at_tap(point, tap, "mean_height"))


def poured_beds():
    return [Estimate.of(at_tap(STRONG, 0))]


def poured_whole_beds():
    return [Estimate.of(whole_beds(STRONG, 0))]


def strong_taps_gain():
    return [Estimate.of(gain(STRONG, LAST))]


def strong_taps_end():
    return [Estimate.of(at_tap(STRONG, LAST))]


def strong_taps_end_whole():
    return [Estimate.of(whole_beds(STRONG, LAST))]


def strong_taps_end_middle():
    return [Estimate.of(at_tap(STRONG, LAST, "bulk_fraction"))]


def weak_taps_gain():
    return [Estimate.of(gain(WEAK, LATE))]


def strong_above_weak():
    """The gain by tap 400 at Gamma = 2 less that at 0.5, beds in pairs."""
    beds, others = (dict(zip(realizations(RUN, point), gain(point, LATE))) for point in (STRONG, WEAK))
    return [Estimate.of(differences(beds, others))]


def filled(point, tap, layers):
    """The change since tap 0 of the shares of layers, summed, [bed]."""
    return sum(numbers(RUN, point, f"layers/share({k})", tap) - numbers(RUN, point, f"layers/share({k})", 0)
               for k in layers)


def weak_taps_order():
    """The lowest six layers, tap 400 less tap 0."""
    return [Estimate.of(filled(WEAK, LATE, range(1, 7)))]


def layers_rise_from_floor():
    """The gain of layers 2 to 5 by tap 100 less that of layers 12 to 15: means of four layers."""
    return [Estimate.of((filled(STRONG, FIRST, LOW) - filled(STRONG, FIRST, HIGH)) / len(LOW))]


def strong_taps_layers():
    """Grown layers, tap 800 less tap 0."""
    return [Estimate.of(numbers(RUN, STRONG, "layers/grown_layers", 800) -
                        numbers(RUN, STRONG, "layers/grown_layers", 0))]


def strong_taps_peaks():
    """Peaks 2 and 3 of n(y/d) at tap 800 less the heights of hcp layers."""
    return [Estimate.of(numbers(RUN, STRONG, f"layers/peak_{k}", 800) - (0.5 + (k - 1) * SPACING)) for k in (2, 3)]


def bed_is_lower():
    """Twice the mean height of the centres, tap 0 less tap 800."""
    return [Estimate.of(-2 * gain(STRONG, 800, "mean_height"))]


def greatest_jumps():
    """The greatest rise of Phi within 50 taps, from tap 50 on, of each bed at Gamma = 2, [bed]."""
    path = np.array([at_tap(STRONG, tap) for tap in range(50, LAST, 25)])
    return (path[2:] - path[:-2]).max(axis=0)
