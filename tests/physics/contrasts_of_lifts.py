"""Contrasts of [DR] 2 with the printed rules of step and stop: lifts of 0.25 and held dilations of 0.025, the same beds.

They were stated when one bed of each was known, and before a second; their claims follow once each has three. The
window is that from the floor to 15 d, which numbers of [DR] 6 chose and others of it tested."""
from distributions import differences, label, realizations, series
from verdicts import Estimate

RUN, LIFT, HELD = "dr-two-taps", 0, 2   # sweep points with the printed stop
COMPARED, LAST = (100, 1000, 3000), 3000
WINDOW = "floor_15"


def gains(point, tap, observable=WINDOW):
    """The change of Phi since tap 0, {realization: value}."""
    assert ("lift" in label(RUN, point)) == (point == LIFT), label(RUN, point)
    change = series(RUN, point, observable, tap) - series(RUN, point, observable, 0)
    return dict(zip(realizations(RUN, point), change))


def more_by_lifts(observable=WINDOW):
    """The gain by lifts less that by held dilations after 100, 1000 and 3000 taps, beds in pairs."""
    return [Estimate.of(differences(gains(LIFT, tap, observable), gains(HELD, tap, observable))) for tap in COMPARED]


def more_by_lifts_middle():
    return more_by_lifts("bulk_fraction")


def gain_by_held():
    """The gain by held dilations after 3000 taps."""
    return [Estimate.of(list(gains(HELD, LAST).values()))]
