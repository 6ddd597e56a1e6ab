"""Numbers and tables as docs/physics-results.md has them."""
import numpy as np

from verdicts import Estimate, judge, p_text


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
    """What a law says of its parameters, in words: the program's statements."""
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


def steadiness(tables, observable, names):
    """Of every sweep point in a word and the p-value of the tests of drift."""
    said = []
    for point, name in enumerate(names):
        state = tables[f"point_{point:04}/steady/{observable}"]
        word = state.notes["verdict"].split(":")[0].split(" with")[0]
        said.append(f"{name}: {word} (drift p = {state['drift_p']:.2g})")
    return "; ".join(said)
