"""Scores the papers' statements (claims_pb.py, claims_dr.py) from the reduced data: an estimate, a test, a status word.

Each statement is tested at 5 %; false_discoveries() gives what that means for the page as a whole."""
import dataclasses
import re

import numpy as np
from scipy import stats

import contrasts
import contrasts_of_beds
import contrasts_of_campaign
import contrasts_of_growth
import contrasts_of_lifts
import contrasts_of_taps
from reduce import REDUCED, read_table
from verdicts import LEVEL, Estimate, detectable, limits_text, p_beyond, p_two_sided, p_within, share_above

REPRODUCED, COMPATIBLE, QUALITATIVE = "reproduced", "compatible", "qualitatively"
NOT, UNDERPOWERED, SILENT = "not reproduced", "underpowered", "not in the paper"
STATUS = (REPRODUCED, COMPATIBLE, QUALITATIVE, NOT, UNDERPOWERED, SILENT)
DECIDED = STATUS[:4]
NUMBER = r"-?\d+\.?\d*"


@dataclasses.dataclass(frozen=True)
class Claim:
    """One statement and how it is tested.

    kind: positive (every estimate above 0; with `relevant`, refuted where it is
    shown to be less), within (every estimate within the margin of 0), printed (a number with its error; margin: its rounding; relevant: what a test with power must find), interval (low and high,
    compared with `wanted`), p (a p-value of the program, in favour or not), refute (a p-value of a test that can
    only refute and had power), shown (by the intervals in note), seen (in single beds), none (not tested),
    silent (the paper prints nothing to test)."""
    figure: str
    text: str
    kind: str
    run: str = ""
    source: str = ""          # the statement's row in statements.csv, or "=" and a function of contrasts.py
    pick: tuple = (0,)        # which "a ± b" of that row
    dof: float = 0.0          # 0: that of the row
    margin: float = 0.0
    printed: float = np.nan
    printed_error: float = 0.0
    relevant: float = np.inf  # printed: what a test with power must find; positive: the least effect that counts
    bounds: tuple = ()        # of an interval that the program printed
    wanted: tuple = ()
    p: float = np.nan
    favours: bool = True
    full: bool = False        # the paper's number of spheres
    post_hoc: bool = False    # the contrast was chosen after a look at these data
    gain: bool = False        # the printed number is a change: its sign is a statement too
    own: bool = False         # a question of this project, outside the score
    note: str = ""


@dataclasses.dataclass(frozen=True)
class Score:
    claim: Claim
    status: str
    found: str
    test: str
    p: float = np.nan
    distance: float = np.nan  # (found - printed) / combined error
    needed: float = np.nan    # the distance that 80 % power would have found


def from_half_width(value, half, dof):
    """The estimate behind a printed a ± b, b half of the 68 % interval by Student's t."""
    return Estimate(value, half / stats.t.ppf(0.5 + 0.3413447460685429, dof), dof)


def of_contrast(claim):
    """The estimates of the contrast that a claim names as its source."""
    name = claim.source[1:]
    module = next(module for module in (contrasts, contrasts_of_beds, contrasts_of_campaign, contrasts_of_growth,
                                        contrasts_of_lifts, contrasts_of_taps) if hasattr(module, name))
    return getattr(module, name)()


def row_of(claim):
    """The numbers found and the degrees of freedom of a statement of a run."""
    for statement, found, test in read_table(REDUCED / claim.run / "statements.csv")[1:]:
        if statement == claim.source:
            dof = re.search(r"([\d.e+]+) degrees? of freedom", test)
            return found, claim.dof or (float(dof[1]) if dof else 0.0)
    raise KeyError(f"{claim.run}: no statement {claim.source!r}")


def estimates_of(claim):
    if claim.source.startswith("="):
        return of_contrast(claim)
    found, dof = row_of(claim)
    pairs = re.findall(rf"({NUMBER}) ± ({NUMBER})", found)
    return [from_half_width(float(pairs[k][0]), float(pairs[k][1]), dof) for k in claim.pick]


def text_of(estimate):
    """value(half the 68 % interval in the last digits)."""
    if not estimate.testable:
        return f"{estimate.value:.4g}"
    half = estimate.half_width()
    digits = max(0, 1 - int(np.floor(np.log10(half))))
    return f"{estimate.value:.{digits}f}({round(half * 10**digits)})"


def positive(claim, estimates):
    """Every estimate is above 0: the largest p; refuted where one is below (Bonferroni), or below the least effect that
    the claim calls relevant."""
    favours = all(estimate.value > 0 for estimate in estimates)
    p = max(map(p_two_sided, estimates)) if favours else min(1.0, len(estimates) * min(
        p_two_sided(estimate) for estimate in estimates if estimate.value <= 0))
    name = "t-test" + "s of all" * (len(estimates) > 1)
    if not p < LEVEL and np.isfinite(claim.relevant):
        less = min(1.0, len(estimates) * min(share_above((claim.relevant - e.value) / e.error, e.dof)
                                             for e in estimates))
        return NOT if less < LEVEL else UNDERPOWERED, less, f"above 0, or below {claim.relevant:g}"
    return UNDERPOWERED if not p < LEVEL else REPRODUCED if favours else NOT, p, name


def within(claim, estimates):
    """Equivalence within the margin: two one-sided tests; beyond it where one is shown to be (Bonferroni)."""
    near = max(p_within(estimate, claim.margin) for estimate in estimates)
    far = min(1.0, len(estimates) * min(p_beyond(estimate, claim.margin) for estimate in estimates))
    status = REPRODUCED if near < LEVEL else NOT if far < LEVEL else UNDERPOWERED
    return status, min(near, far), f"equivalence test, margin {claim.margin:g}"


def of_printed(claim, estimate):
    """A printed number: refuted beyond its errors; compatible where the test would have found `relevant`."""
    from_paper = estimate.from_printed(claim.printed, claim.printed_error)
    p = p_beyond(from_paper, claim.margin)
    if p < LEVEL:  # a printed gain whose sign alone is found
        status = QUALITATIVE if claim.gain and positive(claim, [estimate])[0] == REPRODUCED else NOT
    elif claim.margin + detectable(from_paper) <= claim.relevant:
        status = COMPATIBLE
    else:
        status = UNDERPOWERED
    return status, p, f"within {claim.margin:g}, the paper's error {claim.printed_error:g} counted", from_paper


def of_interval(claim, low, high):
    least, most = claim.wanted
    inside, outside = least <= low and high <= most, high < least or low > most
    return REPRODUCED if inside else NOT if outside else UNDERPOWERED


def score(claim):
    if claim.kind in ("none", "silent"):
        return Score(claim, SILENT if claim.kind == "silent" else UNDERPOWERED, claim.note, "no test")
    if claim.kind in ("p", "refute"):
        status = (COMPATIBLE if claim.kind == "refute" else UNDERPOWERED) if claim.p >= LEVEL else (
            NOT if claim.kind == "refute" or not claim.favours else REPRODUCED)
        found = claim.note or row_of(claim)[0]
        return Score(claim, status, found, "test of the program" if claim.run else claim.source, claim.p)
    if claim.kind == "interval":
        low, high = claim.bounds or of_contrast(claim)
        return Score(claim, of_interval(claim, low, high), limits_text(low, high) if high > low else f"{low:.4g}",
                     "95 % interval" if high > low else "value")
    if claim.kind in ("shown", "seen"):
        return Score(claim, REPRODUCED if claim.kind == "shown" else QUALITATIVE, claim.note,
                     "95 % intervals" if claim.kind == "shown" else "seen in single beds")
    estimates = estimates_of(claim)
    found = ", ".join(map(text_of, estimates))
    if claim.kind == "printed":
        status, p, test, difference = of_printed(claim, estimates[0])
        return Score(claim, status, found, test, p, difference.value / difference.error,
                     (claim.margin + detectable(difference)) / difference.error)
    if claim.kind == "within" and np.isfinite(claim.printed):
        # A margin that is the printed error itself counts it already.
        error = claim.printed_error if claim.printed_error < claim.margin else 0.0
        estimates = [e.from_printed(claim.printed, error) for e in estimates]
    status, p, test = (positive if claim.kind == "positive" else within)(claim, estimates)
    distance = np.nan
    if np.isfinite(claim.printed) and claim.printed_error > 0:
        difference = estimates[0].from_printed(0.0, claim.printed_error)
        distance = difference.value / difference.error
    worst = min(estimates, key=lambda estimate: abs(estimate.value) / estimate.error)
    return Score(claim, status, found, f"{test}, {worst.dof:.3g} degrees of freedom", p,
                 distance=distance, needed=detectable(worst) / worst.error)


def false_discoveries(scores, rate=0.05):
    """How many decisions remain with the false discovery rate held at `rate` (Benjamini, Hochberg 1995)."""
    p_values = np.sort([s.p for s in scores if s.status in (REPRODUCED, NOT, QUALITATIVE) and np.isfinite(s.p)])
    tests = sum(np.isfinite(s.p) for s in scores)
    kept = [k + 1 for k, p in enumerate(p_values) if p <= rate * (k + 1) / tests]
    return (max(kept) if kept else 0), len(p_values), LEVEL * tests / max(len(p_values), 1)


def all_scores():
    from claims_dr import CLAIMS as grains_and_lifts
    from claims_pb import CLAIMS as compaction
    return [score(claim) for claim in (*compaction, *grains_and_lifts)]


def counts(scores):
    found = [s for s in scores if not s.claim.own]
    return {status: sum(s.status == status for s in found) for status in STATUS}


def status_of_figure(scores):
    """The status of a figure: that of the paper's statements together."""
    found = [s.status for s in scores if not s.claim.own]
    decided = [status for status in found if status in DECIDED]
    if len(decided) < len(found) / 2 or not decided:
        return UNDERPOWERED
    wrong = sum(status in (NOT, QUALITATIVE) for status in decided)
    if wrong == 0:
        return COMPATIBLE if decided.count(COMPATIBLE) > len(decided) / 2 else REPRODUCED
    return QUALITATIVE if wrong <= len(decided) / 2 else NOT
