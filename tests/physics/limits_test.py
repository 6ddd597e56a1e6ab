"""Limits of eq. 3 of Philippe and Bideau 2001 that the program finds hold the truth, on beds like those of the campaign
at its weakest strength: an eq. 3 with X_inf = 0.64, near their means, and their scatter."""
import os

import numpy as np
from scipy import optimize

from contrasts_of_growth import growth
from fits_of_growth import intervals

JOSTLE, ENSEMBLES, X_INF = os.environ["JOSTLE"], 200, 0.64


def at_most(misses, level, what):
    """Within three binomial errors."""
    most = level + 3 * np.sqrt(level * (1 - level) / ENSEMBLES)
    if misses / ENSEMBLES > most:
        raise AssertionError(f"{what}: {misses} of {ENSEMBLES}, more than {most:.3f} of them")


def main():
    taps, beds = growth(0.000625, "bottom_fraction")
    means = beds.mean(axis=1)

    def law(parameters):
        first, log_b, log_tau = parameters
        return X_INF - (X_INF - first) / (1 + np.exp(log_b) * np.log1p(taps / np.exp(log_tau)))
    parameters = optimize.least_squares(lambda p: law(p) - means, [means[0], -2, 5]).x
    random = np.random.default_rng(314)
    above, tau_missed = 0, 0
    for _ in range(ENSEMBLES):
        drawn = random.multivariate_normal(law(parameters), np.cov(beds), size=beds.shape[1]).T
        found = intervals(JOSTLE, taps, drawn)
        low, high = (end if end is not None else none for end, none in zip(found["tau"], (-np.inf, np.inf)))
        tau_missed += not low <= np.exp(parameters[2]) <= high
        above += found["X_inf"][0] is not None and found["X_inf"][0] > X_INF
    at_most(above, 0.025, "the lower limit of X_inf is above it")
    at_most(tau_missed, 0.05, "the limits of tau miss it")
    print(f"X_inf: {above / ENSEMBLES:.1%} above; tau: {tau_missed / ENSEMBLES:.1%} missed")


if __name__ == "__main__":
    main()
