"""Figure 5 of Philippe & Bideau: squared changes of <Z> from different ages on."""
import functools

import numpy as np

from page_text import table
from verdicts import POWER, Estimate, Statement, of_program


def squared_change(curve, age, lag):
    return (curve[age + lag] - curve[age])**2


def log_ratio(first, second):
    """ln of the ratio of two means over the same realizations, by the jackknife."""
    n = first.size
    without = np.log((first.sum() - first) / (second.sum() - second))
    whole = np.log(first.mean() / second.mean())
    return Estimate(float(n * whole - (n - 1) * without.mean()),
                    float(np.sqrt((n - 1) * np.mean((without - without.mean())**2))), n - 1)


@functools.lru_cache(maxsize=None)
def exchanges(pairs):
    """Exchanges of the pairs: all of them; for more than 16 pairs the identity and 49 999 random ones
    (Phipson & Smyth 2010)."""
    if pairs <= 16:
        return (np.arange(2**pairs)[:, np.newaxis] >> np.arange(pairs)) & 1
    random = np.random.default_rng(pairs).integers(0, 2, (50000, pairs))
    random[-1] = 1
    return random


def p_exchanged(first, second):
    """p-value for equal distributions of two means, by exchanges within pairs. Exact for every
    distribution; squares are skewed, and Student's t-test would reject too often."""
    means = second.sum() + exchanges(first.size) @ (first - second)
    distance = np.abs(np.log(means / (first.sum() + second.sum() - means)))
    return float(np.mean(distance >= distance[-1] * (1 - 1e-12)))


@functools.lru_cache(maxsize=None)
def detectable_factor(pairs, level):
    """The smallest factor between two ages that exchanges find with probability POWER, squares of
    normal changes being exchanged; means of them scatter less. Infinite where none is found."""
    random = np.random.default_rng(pairs)
    young, old = random.normal(0, 1, (2, 400, pairs))**2
    chosen = exchanges(pairs)
    if len(chosen) > 2000:
        chosen = np.vstack([chosen[random.integers(0, len(chosen), 1999)], chosen[-1:]])
    kept_young, kept_old = young @ chosen.T, old @ chosen.T

    def power(factor):
        means = factor * kept_young + old.sum(axis=1, keepdims=True) - kept_old
        whole = factor * young.sum(axis=1, keepdims=True) + old.sum(axis=1, keepdims=True)
        distance = np.abs(np.log(means / (whole - means)))
        p = np.mean(distance >= distance[:, -1:] * (1 - 1e-12), axis=1)
        return np.mean(p < level)
    low, high = 0.0, np.log(1e6)
    if power(np.exp(high)) < POWER:
        return np.inf
    while high - low > 0.01:
        middle = (low + high) / 2
        low, high = (low, middle) if power(np.exp(middle)) >= POWER else (middle, high)
    return float(np.exp(high))


def falls_with_age(paper, young, old):
    """Squared changes of the same realizations from two ages on."""
    return Statement(
        paper, f"ln of their ratio: {log_ratio(young, old).text(2)}",
        f"exchanges within {young.size} pairs", p_exchanged(young, old), young.mean() > old.mean(),
        lambda level: would_be_found("a factor of", detectable_factor(young.size, level)))


def with_interval(found, name, place, unit=1.0):
    """A value with its 95 % interval, where there is one."""
    value, low, high = (unit * found[name + end][place] for end in ("", "_low_95", "_high_95"))
    return rounded(value, 3) + (f" ({rounded(low, 2)} to {rounded(high, 2)})"
                                if np.isfinite(low) else "")


def rounded(value, digits):
    """To so many digits, without an exponent where it has none by hand."""
    return f"{float(f'{value:.{digits}g}'):g}"


def would_be_found(what, size):
    return f"{what} {size:.3g} would have been found with 80 %" if np.isfinite(size) else \
        "none would have been found with 80 %"


def ageing(run):
    ages = [int(age) for age in run.scene["analyse"]["ageing"][0]["waiting_times"]]
    found = next(iter(run.analyse("ageing", "--observable", "mean_height", "--waiting-times",
                                  ",".join(map(str, ages))).values()))
    curve, lags = run.curves("mean_height")[0], found["lag"]
    shown = [int(np.argmin(np.abs(lags - lag))) for lag in (1, 10, 32, 100, 316)]
    rows = [[str(age)] + [with_interval(found, "a", (i, j), 1e4) for j in shown] +
            [f"{found['misfit'][i]:.2f}"] for i, age in enumerate(ages)]
    statements = []
    for lag in (10, 100):
        for young, old in zip(ages, ages[1:]):
            statements.append(falls_with_age(
                f"A falls with age: from t_W = {young} to {old} at lag {lag}",
                squared_change(curve, young, lag), squared_change(curve, old, lag)))
    statements += [
        of_program("A falls with age, all ages and lags", found.notes["ageing_verdict"],
                   "`jostle analyse ageing`", found["ageing_p"], found["ageing_factor"] < 1,
                   would_be_found("a factor of", found["ageing_detectable"])),
        of_program("the ages collapse on eq. 6", found.notes["collapse_verdict"],
                   "`jostle analyse ageing`, which can only refute", found["collapse_p"], False,
                   would_be_found("a change of B by a factor of", found["collapse_detectable"]))]
    head = "Not in the paper (V: the variance of the change over realizations):"
    beyond = "\n".join([head, ""] + [
        f"- {what}: {found.notes[note]}" for what, note in (
            ("V and age", "fluctuation_verdict"),
            ("A = F(t/t_W^mu)", "mu_verdict"),
            ("A = F(ln(t_W + t)/ln t_W)", "logarithmic_collapse_verdict"),
            ("V = F(t/t_W^mu)", "v_mu_verdict"),
            ("V = F(ln(t_W + t)/ln t_W)", "v_logarithmic_collapse_verdict"))])
    measured = table(["t_W"] + [f"10^4 A, lag {int(lags[j])}" for j in shown] +
                     ["misfit of eq. 6"], rows)
    return f"{measured}\n\n{beyond}", statements
