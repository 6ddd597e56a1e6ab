"""Numbers and tables as docs/validation.md has them."""
import numpy as np

from verdicts import AGREES, Estimate, Statement, judge, p_text


def window(curve, first, last):
    """Mean over the taps first to last of each realization, curve: [tap, realization]."""
    return curve[first:last + 1].mean(axis=0)


def at(curve, tap, digits=4):
    return Estimate.of(curve[tap]).text(digits)


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


VERDICT_HEADER = ["statement of the paper", "found here", "test", "p", "verdict"]


def verdict_table(statements):
    """One row a statement; p is corrected for all of them together."""
    rows = []
    for statement, p, word, power in judge(statements):
        test = statement.test + (f"; {power}" if power else "")
        rows.append([statement.paper, statement.found, test, p_text(p), f"**{word}**"])
    return table(VERDICT_HEADER, rows)


def parameters(fit, names):
    """The program's statements on the parameters of a law."""
    if "refused" in fit:
        return ["no fit"] * len(names)
    said = []
    for name in names:
        statement = fit["parameters"][name]["statement"]
        said.append(statement.split(" is ", 1)[-1].split(" was ", 1)[-1])
    return said


def interval(fit, name):
    """The 95 % interval of a parameter; infinite where it has no end."""
    if "refused" in fit:
        return -np.inf, np.inf
    low, high = fit["parameters"][name]["interval_95"]
    return (-np.inf if low is None else low), (np.inf if high is None else high)


def steady_words(tables, observable, points):
    """The verdict of `jostle analyse steady` on each sweep point, and its p-value for no drift."""
    states = [tables[f"point_{point:04}/steady/{observable}"] for point in range(points)]
    return [(state.notes["verdict"].split(":")[0].split(" with")[0], float(state["drift_p"]))
            for state in states]


def steadiness(tables, observable, names):
    """The verdict on each sweep point in a word, with the p-value of the test of drift."""
    return "; ".join(f"{name}: {word} (drift p = {p:.2g})" for name, (word, p) in
                     zip(names, steady_words(tables, observable, len(names))))


def are_steady(paper, tables, observable, names, taps, long):
    """All sweep points are in their steady states over taps (first, last): shown where the analysis
    shows it of each, refuted where one drifts (p times their number) after `long` taps and more."""
    states = steady_words(tables, observable, len(names))
    found = f"steady over taps {taps[0]} to {taps[1]}? {steadiness(tables, observable, names)}"
    test = "`jostle analyse steady`, each strength"
    if all(word == "reached" for word, _ in states):
        return Statement(paper, found, test, word=AGREES)
    if taps[1] < long:
        return Statement(paper, found, f"{test}; {taps[1]} taps are too few to refute it")
    drifts = any(word == "not reached" for word, _ in states)
    tested = [p for _, p in states if np.isfinite(p)]
    p = min(1.0, len(states) * min(tested)) if drifts and tested else 1.0
    return Statement(paper, found, test, p)
