"""Verdicts of docs/validation.md have the error rates that they state, at the smallest ensembles."""
import os
import pathlib

import numpy as np

from ageing_figures import detectable_factor, falls_with_age, p_exchanged
from compaction_figures import exponential_in_strength, greater, laws_of_height
from figures import NOT_REACHED, arguments, not_reached, remark_of, summary
from lift_figures import densities
from page_text import are_steady
from runs import Table
from verdicts import (AGREES, DISAGREES, LEVEL, POWER, UNDECIDED, Estimate, are_positive,
                      are_within, detectable, holm, is_positive, is_within, judge, of_interval)

ENSEMBLES = 600 if os.environ.get("JOSTLE_EVERY") else 200


def check(holds, *said):
    if not holds:
        raise AssertionError(" ".join(map(str, said)))


def at_most(rate, bound, what):
    """A rate over ENSEMBLES, within three binomial errors."""
    check(rate <= bound + 3 * np.sqrt(bound * (1 - bound) / ENSEMBLES), what, rate, "above", bound)


def words(random, realizations, shift, make):
    """How often ensembles of normal values about `shift` give each word."""
    values = random.normal(shift, 1, (ENSEMBLES, realizations))
    found = [judge([make(Estimate.of(row))])[0][2] for row in values]
    return {word: found.count(word) / ENSEMBLES for word in (AGREES, DISAGREES, UNDECIDED)}


def signs(random):
    print("statement of a sign: share of each word\nM  truth  agrees  disagrees  cannot decide")
    for realizations in (2, 3, 4, 16):
        error = 1 / np.sqrt(realizations)
        found_at = detectable(Estimate(0, error, realizations - 1))
        for truth in (0, found_at, -found_at):
            rate = words(random, realizations, truth, lambda e: is_positive("", e, ""))
            print(f"{realizations:<2} {truth:6.2f} " +
                  "  ".join(f"{rate[word]:.3f}" for word in rate))
            if truth == 0:
                at_most(rate[AGREES] + rate[DISAGREES], LEVEL, "a word where there is nothing")
            else:
                right, wrong = (AGREES, DISAGREES) if truth > 0 else (DISAGREES, AGREES)
                at_most(rate[wrong], LEVEL / 2, "the wrong sign")
                # detectable() from the true error: the t-test finds it with the promised power.
                check(abs(rate[right] - POWER) <= 3 * np.sqrt(POWER * (1 - POWER) / ENSEMBLES),
                      "power", rate[right])


def margins(random):
    for realizations in (2, 3, 6):
        for truth, wrong in ((0.999, DISAGREES), (1.001, AGREES)):
            rate = words(random, realizations, truth, lambda e: is_within("", e, 1, ""))
            at_most(rate[wrong], LEVEL, f"M = {realizations}: {wrong} at the margin")


        # The effect beyond the margin that is_within reports as detectable.
        beyond = 1 + detectable(Estimate(0, 1 / np.sqrt(realizations), realizations - 1))
        rate = words(random, realizations, beyond, lambda e: is_within("", e, 1, ""))[DISAGREES]
        print(f"M = {realizations}: {beyond:.2f} is beyond a margin of 1: {rate:.3f} disagree")
        check(rate >= POWER - 3 * np.sqrt(POWER * (1 - POWER) / ENSEMBLES), "power", rate)


def all_positive(random):
    """Two numbers, one of them 0, for any value of the other."""
    for other in (0, 100, -100):
        found = [judge([are_positive("", [Estimate.of(row), Estimate.of(row[::-1] ** 3 + other)],
                                     "")])[0][2] for row in random.normal(0, 1, (ENSEMBLES, 4))]
        if other >= 0:
            at_most(found.count(AGREES) / ENSEMBLES, LEVEL, "both are called positive")
            at_most(found.count(DISAGREES) / ENSEMBLES, LEVEL, "one is called negative")
        else:
            check(found.count(DISAGREES) > 0.9 * ENSEMBLES, "a negative one is missed")


def all_within(random):
    """Two numbers with margins of 1, M = 3 and 6: one on its margin, the other at 0; both on
    their margins; one far away."""
    for realizations in (3, 6):
        for first, second, wrong in ((1, 0, {AGREES, DISAGREES}), (1, -1, {AGREES, DISAGREES}),
                                     (20, 0, {AGREES, UNDECIDED})):
            values = random.normal(0, 1, (ENSEMBLES, 2, realizations))
            found = [judge([are_within("", [Estimate.of(a + first), Estimate.of(b + second)], 1,
                                       "")])[0][2] for a, b in values]
            for word in wrong:
                at_most(found.count(word) / ENSEMBLES, LEVEL,
                        f"{word}: two of M = {realizations} at {first} and {second}")
    still, near, far = (Estimate.of(np.array(values)) for values in
                        ([-9.0, -9.0, -9.0], [-0.01, 0.0, 0.02], [6.9, 7.0, 7.2]))
    for pair, word in (([far, still], DISAGREES), ([near, still], UNDECIDED)):
        said = judge([are_within("", pair, 1, "")])[0][2]
        check(said == word, "one number without scatter:", said)


def families(random):
    check(np.allclose(holm([0.01, 0.04, np.nan, 0.03])[[0, 1, 3]], [0.03, 0.06, 0.06]), "Holm")
    any_word = 0
    for _ in range(ENSEMBLES):
        rows = random.normal(0, 1, (8, 3))
        any_word += any(word != UNDECIDED for _, _, word, _ in
                        judge([is_positive("", Estimate.of(row), "") for row in rows]))
    at_most(any_word / ENSEMBLES, LEVEL, "any word among eight statements")


def ages(random):
    """Means of squares of normal changes, as the ages of fig. 5 are compared."""
    squares = random.normal(0, 1, (2, ENSEMBLES, 10))**2
    for factor, least, most in ((1, 0, LEVEL), (20, 0.8, 1)):
        found = [judge([falls_with_age("", factor * a, b)])[0][2] for a, b in zip(*squares)]
        rate = found.count(AGREES) / ENSEMBLES
        print(f"A of one age {factor} times that of another, 10 realizations: {rate:.3f} agree")
        at_most(rate if factor > 1 else 1 - found.count(UNDECIDED) / ENSEMBLES, most, "ages")
        check(rate >= least, "power", rate)
    for pairs in (8, 10, 40):  # with more than 16, exchanges are drawn by chance
        squares = random.normal(0, 1, (2, ENSEMBLES, pairs))**2
        factor = detectable_factor(pairs, LEVEL)
        for truth, wanted in ((1, LEVEL), (factor, POWER)):
            rate = np.mean([p_exchanged(truth * a, b) <= LEVEL for a, b in zip(*squares)])
            print(f"{pairs} pairs, a factor of {truth:.1f}: {rate:.3f} are found")
            # The factor comes from a rate over 400 pairs of ages, which has an error too.
            check(abs(rate - wanted) <= 3 * np.sqrt(wanted * (1 - wanted) *
                                                    (1 / ENSEMBLES + (truth > 1) / 400)),
                  "exchanges", pairs, rate)
    check(detectable_factor(5, LEVEL) == np.inf, "of five pairs no exchange has p below 1/16")


def intervals():
    def word(low, high, **limits):
        return judge([of_interval("", low, high, "", **limits)])[0][2]
    check(word(0.65, np.nan, above=0.64) == AGREES, "above")
    check(word(0.57, 0.61, above=0.64) == DISAGREES, "below")
    check(word(0.57, np.nan, above=0.64) == UNDECIDED, "open")
    check(word(0.12, 0.18, between=(0.1, 0.2)) == AGREES, "inside")
    check(word(0.05, 0.09, between=(0.1, 0.2)) == DISAGREES, "outside")
    check(word(np.nan, np.nan, between=(0.1, 0.2)) == UNDECIDED, "no limits")
    one = is_positive("", Estimate.of([1.0]), "")
    check(judge([one])[0][2] == UNDECIDED, "one realization decides nothing")


def fit(**intervals):
    return {"parameters": {name: {"interval_95": ends, "statement": f"{name} is {ends}"}
                           for name, ends in intervals.items()}}


def intervals_of_fits():
    """Verdicts on fits of three strengths; a line through ln B passes (0, ln 1) and (0.2, ln 4)."""
    def word(statement):
        return judge([statement])[0][2]
    for middle, wanted in (([1.8, 2.1], UNDECIDED), ([1.9, 1.95], DISAGREES), ([2.1, 9], DISAGREES),
                           ([None, 9], UNDECIDED)):
        fits = [fit(B=[0.99, 1.01]), fit(B=middle), fit(B=[3.99, 4.01])]
        check(word(exponential_in_strength([0, 0.01, 0.04], fits)) == wanted, "B", middle)
    for first, second, wanted in (([50, None], [1, 40], AGREES), ([30, None], [1, 40], UNDECIDED),
                                  ([1, 2], [3, 4], DISAGREES)):
        said = word(greater("", [0, 1], [fit(tau=first), fit(tau=second)], "tau"))
        check(said == wanted, "tau", first, second, said)
    said = word(greater("", [0, 1], [fit(X=[0.6, 0.7]), fit(X=[0.6, 0.62])], "X", [0.5, 0.59]))
    check(said == AGREES, "distance from what is reached", said)


def steady_points():
    def word(*states, taps=4000):
        tables = {f"point_{point:04}/steady/phi": Table({
            "notes": {"verdict": f"{verdict} with 4 realizations: ..."}, "axes": {},
            "quantities": {"drift_p": {"axes": [], "values": p}}})
            for point, (verdict, p) in enumerate(states)}
        return judge([are_steady("", tables, "phi", "ab", (1, taps), 4000)])[0][2]
    check(word(("reached", 0.5), ("reached", 0.3)) == AGREES, "both are steady")
    check(word(("reached", 0.5), ("cannot decide", 0.3)) == UNDECIDED, "one may drift")
    check(word(("cannot decide", 0.5), ("not reached", 0.004)) == DISAGREES, "one drifts")
    check(word(("reached", 0.5), ("not reached", 0.004), taps=400) == UNDECIDED, "too few taps")
    check(word(("reached", 0.5), ("not reached", None)) == UNDECIDED, "a single realization")


def remarks_are_those_of_their_section():
    page = "## a\n\none\n\n## b\n\ntwo\n\n**Remark**: of b.\n\n## c\n\nthree\n"
    for figure, numbers, wanted in (("a", "one", ""), ("b", "two", "**Remark**: of b."),
                                    ("b", "2", "**Remark**: (Of earlier numbers.) of b."),
                                    ("c", "three", "")):
        found = remark_of(page, figure, numbers)
        check(found == wanted, "remark of", figure, repr(found))


def what_is_not_reached_keeps_what_stood_there():
    class Run:
        scene = {"description": ["A bed."]}
        seconds = 0  # nothing of it was read

        def full_size(self):
            return pathlib.Path("scene.json")

        def core_hours(self, scene):
            return "about 84 core-hours" if scene.name == "scene.json" else None
    new = not_reached("a", Run(), None)
    check("A bed." in new and NOT_REACHED in new and "about 84 core-hours" in new, new)
    check(not_reached("a", Run(), new) == new, "twice")
    former = "## a\n\none\n\n| p | f | t | - | **agrees** |\n"
    kept = not_reached("a", Run(), former)
    check(kept.startswith("## a\n\n**Not reached**") and kept.endswith("**agrees** |\n"), kept)
    check("- [pb2](#pb2): not reached\n" in summary({"pb2": new}), "summary")
    verdicts = "| p | f | t | - | **agrees** |\n| q | f | t | 1 | **cannot decide** |\n"
    check("- [pb2](#pb2): 1 of 2 agree. **cannot decide**: q\n" in summary({"pb2": verdicts}),
          "summary")


def options_stand_before_or_after_figures():
    for order in (["--hours", "2", "pb9", "pb10"], ["pb9", "pb10", "--hours", "2"]):
        found = arguments(["jostle", "folder", "page", *order])
        check(found.hours == 2 and found.figures == ["pb9", "pb10"], order, found)


def exponentials(random):
    """B = exp(8 eps^(1/2)) with errors of ln B of 0.1 to 1, and one that bends by ten of them."""
    strengths = [0.005, 0.05, 0.15]
    for error in (0.1, 1.0):
        for bend, least, most in ((0, 0, 0.01), (10, 0.99, 1)):
            found = 0
            for noise in random.normal(0, 1, (ENSEMBLES, 3)):
                ln_b = 8 * np.sqrt(strengths) + error * (noise + np.array([0, bend, 0]))
                fits = [fit(B=[float(np.exp(one - 1.96 * error)), float(np.exp(one + 1.96 * error))])
                        for one in ln_b]
                found += judge([exponential_in_strength(strengths, fits)])[0][2] == DISAGREES
            print(f"B with an error of ln B of {error}, bent by {bend}: {found / ENSEMBLES:.3f} refuted")
            at_most(found / ENSEMBLES, most, "an exponential B")
            check(found >= least * ENSEMBLES, "a B that bends", found)


def laws_are_compared_in_words():
    class Heights:
        realizations = 3
        squares = {"inverse_log_height": [1e-5, 1.1e-5, 1.2e-5],
                   "two_exponentials": [1.3e-5, 1.2e-5, 1.4e-5]}

        def values(self):
            return [0.05]

        def curves(self, observable):
            return [np.array([[0.0, 1.0, 2.0]])]

        def residual(self, curve, law):
            return self.squares[law][int(curve[0])]
    text, (statement,) = laws_of_height(Heights())
    check("| 0.05 | 0.110 ± " in text, text)
    check(statement.found.startswith("1.5 times that of eq. 4 less theirs, 10^-4: 0.035 ± "),
          statement.found)


def numbers_of_the_paper_err_too(random):
    """A printed mean with an error of 0.001, rounded, against beds with the same true mean."""
    for realizations, scatter in ((6, 0.0005), (6, 0.004), (20, 0.004)):
        printed = np.round(random.normal(0.578, 0.001, ENSEMBLES), 3)
        ours = random.normal(0.578, scatter, (ENSEMBLES, realizations))
        found = [judge([densities(np.array([row]), {0: number})[0]])[0][2]
                 for row, number in zip(ours, printed)]
        rate = found.count(DISAGREES) / ENSEMBLES
        print(f"{realizations} beds that scatter by {scatter}, a printed mean: {rate:.3f} disagree")
        at_most(rate, LEVEL, "a printed mean")
    far = [judge([densities(np.array([row + 0.006]), {0: 0.578})[0]])[0][2] for row in ours]
    check(far.count(DISAGREES) > 0.9 * ENSEMBLES, "0.006 from a printed mean")


if __name__ == "__main__":
    generator = np.random.default_rng(20010222)
    signs(generator)
    margins(generator)
    all_positive(generator)
    all_within(generator)
    families(generator)
    ages(generator)
    intervals()
    numbers_of_the_paper_err_too(generator)
    exponentials(generator)
    laws_are_compared_in_words()
    intervals_of_fits()
    steady_points()
    remarks_are_those_of_their_section()
    what_is_not_reached_keeps_what_stood_there()
    options_stand_before_or_after_figures()
    print("verdicts: error rates are those stated")
