"""From tests to words. A statement of a paper "agrees", "disagrees" or is one that the run "cannot
decide": never more. Realizations are independent and few, so errors have few degrees of freedom:
Student's t throughout, and Holm's correction for all statements of a figure together."""
import functools
from dataclasses import dataclass
from typing import Callable

import numpy as np
from scipy import optimize, special, stats

LEVEL, POWER = 0.05, 0.8
AGREES, DISAGREES, UNDECIDED = "agrees", "disagrees", "cannot decide"


@dataclass
class Estimate:
    """A number with its standard error, of so many degrees of freedom."""
    value: float
    error: float
    dof: float

    @staticmethod
    def of(values):
        """The mean of independent values."""
        values = np.asarray(values, float)
        if values.size < 2:
            return Estimate(float(values.mean()), np.nan, 0)
        return Estimate(float(values.mean()), float(values.std(ddof=1) / np.sqrt(values.size)),
                        values.size - 1)

    @staticmethod
    def difference(first, second):
        """The difference of two independent means (Welch 1947)."""
        first, second = Estimate.of(first), Estimate.of(second)
        squares = first.error**2, second.error**2
        of_squares = sum(square**2 / max(mean.dof, 1)
                         for square, mean in zip(squares, (first, second)))
        dof = sum(squares)**2 / of_squares if of_squares > 0 else 0
        return Estimate(first.value - second.value, float(np.sqrt(sum(squares))), dof)

    def from_printed(self, printed, error):
        """Less a number that is known to a standard error (Welch 1947)."""
        both = self.error**2 + error**2
        dof = self.dof * both**2 / self.error**4 if self.dof > 0 and self.error > 0 else self.dof
        return Estimate(self.value - printed, float(np.sqrt(both)), dof)

    @property
    def testable(self):
        return bool(self.dof > 0 and np.isfinite(self.value) and self.error > 0)

    def half_width(self):
        """Half the 68 % interval, printed after +-."""
        if not self.testable:
            return np.nan
        return self.error * (special.stdtrit(self.dof, 0.5 + 0.3413447460685429)
                             if np.isfinite(self.dof) else 1.0)

    def text(self, digits=4, scale=1.0):
        if not np.isfinite(self.value):
            return "-"
        if not self.testable:
            return f"{scale * self.value:.{digits}f}"
        return f"{scale * self.value:.{digits}f} ± {scale * self.half_width():.{digits}f}"


def share_above(t, dof):
    """The share of Student's t distribution above t: scipy.stats takes a hundred times as long for one number."""
    return float(special.stdtr(dof, -t) if np.isfinite(dof) else special.ndtr(-t))


def p_two_sided(estimate, reference=0.0):
    """p-value for the true value `reference`."""
    if not estimate.testable:
        return np.nan
    return 2 * share_above(abs(estimate.value - reference) / estimate.error, estimate.dof)


def p_beyond(estimate, margin):
    """p-value for a true value within the margin, given an estimate this far from 0."""
    distance = abs(estimate.value)
    return (share_above((distance - margin) / estimate.error, estimate.dof) +
            share_above((distance + margin) / estimate.error, estimate.dof))


def p_within(estimate, margin):
    """p-value for a true value outside the margin, given an estimate this near to 0: two one-sided tests
    (Schuirmann 1987)."""
    return share_above((margin - abs(estimate.value)) / estimate.error, estimate.dof)


@functools.lru_cache(maxsize=None)
def detectable_shift(dof, level):
    """In errors, those being the true ones. The power of Student's t-test is the mean of a normal
    one's over the chi distribution of the estimated error."""
    shares = (np.arange(4000) + 0.5) / 4000
    ratio = np.sqrt(stats.chi2.ppf(shares, dof) / dof) if np.isfinite(dof) else np.ones(1)
    t = stats.t.ppf(1 - level / 2, dof) if np.isfinite(dof) else stats.norm.ppf(1 - level / 2)

    def missing(shift):
        found = special.ndtr(shift - t * ratio) + special.ndtr(-t * ratio - shift)
        return POWER - found.mean()
    return float(optimize.brentq(missing, 0, 10 * t, xtol=1e-4))


def detectable(estimate, level=LEVEL):
    """The smallest true value that a two-sided test finds with probability POWER."""
    return estimate.error * detectable_shift(estimate.dof, level) if estimate.testable else np.nan


@dataclass
class Statement:
    """One statement of a paper, what was found, and the test. `p` is nan where there is none."""
    paper: str
    found: str
    test: str
    p: float = np.nan
    favours: bool = False  # the verdict if the test decides: agrees
    power: Callable[[float], str] = lambda level: ""  # at a level: what would have been found
    word: str = ""  # decided by an interval, not by p


def degrees_of_freedom(dof):
    return f"{dof:.3g} degree{'' if dof == 1 else 's'} of freedom"


def of_test(estimate, name):
    """The test of an estimate, or why there is none."""
    if estimate.testable:
        return f"{name}, {degrees_of_freedom(estimate.dof)}"
    return "no test: no scatter" if estimate.dof > 0 else "no test: one realization"


def is_positive(paper, estimate, found, what="", digits=4, scale=1.0, name="t-test"):
    """The paper's number is positive. `found` begins the printed text; `what` names the
    estimate."""
    return Statement(paper, f"{found}{what}{estimate.text(digits, scale)}",
                     of_test(estimate, name), p_two_sided(estimate), estimate.value > 0,
                     lambda level: found_with(estimate, level, digits, scale))


def is_within(paper, estimate, margin, found, digits=4, scale=1.0):
    """The paper's number is 0, as far as it can be read: within the margin."""
    text = f"{found}{estimate.text(digits, scale)}"
    if not estimate.testable:
        return Statement(paper, text, of_test(estimate, ""))
    near, far = p_within(estimate, margin), p_beyond(estimate, margin)
    return Statement(paper, text,
                     of_test(estimate, f"within {scale * margin:.{digits}f} or beyond: t-tests"),
                     min(near, far), near < far,
                     lambda level: found_beyond(estimate, margin, level, digits, scale))


def is_zero(paper, estimate, found, digits=4, scale=1.0):
    """The paper states exactly 0, which a test can refute but not show."""
    return Statement(paper, f"{found}{estimate.text(digits, scale)}",
                     of_test(estimate, "t-test of 0, which can only refute"),
                     p_two_sided(estimate), False,
                     lambda level: found_with(estimate, level, digits, scale))


def are_positive(paper, estimates, found, digits=4, scale=1.0, name="t-tests"):
    """All of the paper's numbers are positive: shown where the test of each shows it (the largest
    p, intersection-union), refuted where one is negative (p times their number, Bonferroni)."""
    text = found + ", ".join(estimate.text(digits, scale) for estimate in estimates)
    if not all(estimate.testable for estimate in estimates):
        return Statement(paper, text, "no test")
    favours = all(estimate.value > 0 for estimate in estimates)
    p = max(map(p_two_sided, estimates)) if favours else min(1.0, len(estimates) * min(
        p_two_sided(estimate) for estimate in estimates if estimate.value <= 0))
    worst = max(estimates, key=lambda estimate: estimate.error)
    return Statement(paper, text, f"{name}, {degrees_of_freedom(worst.dof)} each", p, favours,
                     lambda level: found_with(worst, level, digits, scale))


def are_within(paper, estimates, margin, found, digits=4):
    """All of the paper's numbers are 0, within the margin: shown where the test of each shows it,
    refuted where one lies beyond (p times their number)."""
    tested = [estimate for estimate in estimates if estimate.testable]
    if not tested:
        return Statement(paper, found, "no test")
    all_tested = len(tested) == len(estimates)  # else it can be refuted only
    near = max(p_within(estimate, margin) for estimate in tested) if all_tested else 1.0
    far = min(1.0, len(estimates) * min(p_beyond(estimate, margin) for estimate in tested))
    worst = max(tested, key=lambda estimate: estimate.error)
    return Statement(paper, found, f"all within {margin:.{digits}f} or one beyond: t-tests, "
                     f"{degrees_of_freedom(worst.dof)} each", min(near, far), near < far,
                     lambda level: found_beyond(worst, margin, level / len(estimates), digits, 1.0))


def of_program(paper, found, test, p, favours, power=""):
    """A test that `jostle analyse` made."""
    return Statement(paper, found, test, float(p), bool(favours), lambda level: power)


def undecided(paper, found, why):
    return Statement(paper, found, why)


def found_with(estimate, level, digits, scale):
    least = detectable(estimate, level)
    return (f"{scale * least:.{digits}f} would have been found with {100 * POWER:.0f} %"
            if np.isfinite(least) else "")


def found_beyond(estimate, margin, level, digits, scale):
    """The power of a test against a margin: the least effect beyond it that would have been found.
    Within the margin nothing is found if even an estimate of 0 would be undecided."""
    if not estimate.testable:
        return ""
    least = margin + detectable(estimate, level)
    text = f"{scale * least:.{digits}f} would have been found beyond with {100 * POWER:.0f} %"
    if p_within(Estimate(0.0, estimate.error, estimate.dof), margin) >= level:
        text += "; that it lies within could not have been shown"
    return text


def holm(p_values):
    """Corrected for their number (Holm 1979); nan stays nan and counts for nothing."""
    p_values = np.asarray(p_values, float)
    corrected = np.full(p_values.shape, np.nan)
    order = [i for i in np.argsort(p_values) if np.isfinite(p_values[i])]
    largest = 0.0
    for rank, i in enumerate(order):
        largest = max(largest, (len(order) - rank) * p_values[i])
        corrected[i] = min(largest, 1.0)
    return corrected


def p_text(p):
    if not np.isfinite(p):
        return "-"
    return "< 0.0001" if p < 1e-4 else f"{p:.2g}"


def judge(statements):
    """[(statement, corrected p, word, what could have been found)]: all statements together."""
    corrected = holm([statement.p for statement in statements])
    tests = max(int(np.isfinite(corrected).sum()), 1)
    judged = []
    for statement, p in zip(statements, corrected):
        decided = np.isfinite(p) and p < LEVEL
        word = statement.word or ((AGREES if statement.favours else DISAGREES) if decided
                                  else UNDECIDED)
        judged.append((statement, p, word, "" if decided else statement.power(LEVEL / tests)))
    return judged


def limits_text(low, high):
    return (f"{low:.4g} to {high:.4g}" if np.isfinite(low) and np.isfinite(high) else
            f"above {low:.4g}" if np.isfinite(low) else
            f"below {high:.4g}" if np.isfinite(high) else "no limits")


def of_interval(paper, low, high, found, above=None, between=None):
    """The paper's number is above a value or between two: by a 95 % interval, which stands for
    itself and takes no part in Holm's correction."""
    low, high = (-np.inf if not np.isfinite(low) else low), (np.inf if not np.isfinite(high)
                                                            else high)
    least, most = (above, np.inf) if between is None else between
    word = AGREES if low >= least and high <= most else (
        DISAGREES if high < least or low > most else UNDECIDED)
    return Statement(paper, f"{found}: {limits_text(low, high)}", "95 % interval", word=word)
