#!/usr/bin/env python3
"""Writes docs/validation.md, docs/validation/*.md and their figures from tests/physics/reduced.

validation.py [DOCS]: into DOCS, docs of this project by default."""
import json
import pathlib
import re
import sys
import textwrap

from drawings import draw_figure, draw_overview, draw_strongest
from page_text import table
from paper_runs import table_of
from published import FIGURES, NO_DATA
from reduce import REDUCED, read_table
from scores import (DECIDED, SILENT, STATUS, UNDERPOWERED, all_scores, counts, false_discoveries,
                    status_of_figure)
from verdicts import p_text

ROOT = pathlib.Path(__file__).resolve().parents[2]
LONG = 118
PAPER_RUNS = {run.name: run for run in table_of()}


def wrapped(text):
    return "\n".join(textwrap.wrap(text, LONG, break_long_words=False, break_on_hyphens=False))


def verdicts(scores):
    """The table of statements, tests and status words."""
    rows = []
    for s in scores:
        marks = " (post hoc)" * s.claim.post_hoc + (" (reduced)" if not s.claim.full else "")
        rows.append([s.claim.text + marks, shortened(s.found, 100).replace("|", "/"), s.test, p_text(s.p), f"**{s.status}**"])
    return table(["statement", "found", "test", "p", "status"], rows)


def shortened(text, longest):
    """A list of results, cut after a whole one."""
    if len(text) <= longest or ", " not in text:
        return text
    return text[:longest].rsplit(", ", 1)[0] + ", ..."


def notes_of(run):
    path = REDUCED / run / "notes.json"
    return json.loads(path.read_text()) if path.exists() else {}


def origin_of(run):
    path = REDUCED / run / "origin.csv"
    if not path.exists():
        return "only the printed numbers of this run survive; its scene's checksum and revision are not known"
    digest = dict(read_table(path)[1:])["sha256 of the settings"]
    beds = read_table(REDUCED / run / "beds.csv")[1:]
    hours = sum(float(row[2]) for row in beds) / 3600
    revisions = ", ".join(sorted({row[3] for row in beds}))
    return (f"{len(beds)} beds, {hours:.2g} core-hours, SHA-256 of the scene's settings {digest[:16]}..., "
            f"revision {revisions}")


def size_of(run):
    """A line on the size of a run of paper_runs.csv."""
    scene, beds = PAPER_RUNS[run].scene, read_table(REDUCED / run / "beds.csv")[1:]
    last = max(int(row[2]) for row in read_table(REDUCED / run / "series.csv")[1:])
    per_point = [sum(row[0] == str(point) for row in beds) for point in range(PAPER_RUNS[run].points)]
    least, most = min(per_point), max(per_point)
    width = scene["container"]["width"]
    x, y = width if isinstance(width, list) else (width, width)
    return (f"{scene['spheres']} spheres in {x:.4g} x {y:.4g} d, {scene['container']['sides']}, {last} taps, {least}{f' or {most}' * (most > least)} beds per sweep point.")


def command_of(run):
    """The command that makes the reduced data of a run."""
    return f"./dev physics --hours 24 --only {run}" if run in PAPER_RUNS else f"./dev physics {run}"


def page_of(name, figure, scores, printed):
    own = [s for s in scores if s.claim.own]
    papers = [s for s in scores if not s.claim.own]
    parts = [f"# {figure.title}", "[All figures](../validation.md)", f"![{figure.title}]({name}.svg)",
             wrapped("Black circles are the paper's printed numbers. " * printed +
                     f"Status: **{status_of_figure(scores)}**." if papers else "This comparison is outside the score.")]
    if papers:
        parts += ["## The paper's statements", verdicts(papers)]
    parts += ["## Readings", wrapped(figure.silence)]
    if own:
        parts += ["## Additional tests, not scored", verdicts(own)]
    parts += ["## Runs", f"Scene: [{figure.scene}](../../config/scenes/{figure.scene}.json)"]
    for run in figure.runs:
        notes = notes_of(run)
        lines = [f"- `{command_of(run)}`: {notes.get('here') or size_of(run)}"]
        lines.append(f"  Reduced data: [{run}](../../tests/physics/reduced/{run}); {origin_of(run)}.")
        parts.append("\n".join("\n".join(textwrap.wrap(line, LONG, subsequent_indent="  ", initial_indent=""))
                               for line in lines))
    remarks = [(run, notes_of(run)["remark"]) for run in figure.runs if notes_of(run).get("remark")]
    if remarks:
        parts.append("## Remarks on the runs")
        parts += [wrapped(f"**{run}**: " + without_links(remark)) for run, remark in remarks]
    return "\n\n".join(parts) + "\n"


def without_links(text):
    return re.sub(r"\[([^\]]*)\]\(#[^)]*\)", r"\1", text)


HEAD = """# Validation: the published figures

Each row compares a figure of PB (Philippe and Bideau, Phys. Rev. E 63, 051304, 2001) or DR (Rosato et al.,
Phys. Rev. E 81, 061301, 2010) with runs of this program. In a(b), b is half the 68 % interval by Student's t, in the
last digits of a. `tests/physics/validation.py` makes these pages from [reduced data](../tests/physics/reduced) in
seconds.
"""
WORDS = """A statement is *reproduced* if its test at 5 % shows it, and *not reproduced* if the test rejects it.
*Compatible*: a test that can only reject, with 80 % power for the stated difference, did not. *Qualitatively*: the sign
of a change is found and the printed size is rejected, or single beds show the change. A figure is called qualitative if
some, at most half, of its decided statements fail or are qualitative, and not reproduced if more do. The table counts
the statements of a figure that are shown (reproduced, compatible, qualitatively), that failed (not reproduced) and that
are open. *Underpowered*: the data decide nothing, or there are none yet. *Not in the paper*: the paper prints too
little for a test; such a row is not counted. Each row states its margin and is marked where it is post hoc.
"""


def overview_page(scores):
    found = counts(scores)
    total = sum(found.values()) - found[SILENT]
    decided = sum(found[word] for word in DECIDED)
    kept, tested, expected = false_discoveries([s for s in scores if not s.claim.own])
    rows = []
    for name, figure in FIGURES.items():
        mine = [s for s in scores if s.claim.figure == name]
        papers = [s for s in mine if not s.claim.own]
        if not papers:
            continue
        key = next(s for s in papers if s.claim.text == figure.key)
        failed = sum(s.status == "not reproduced" for s in papers)
        shown = sum(s.status in DECIDED for s in papers) - failed
        standings = f"{shown} / {failed} / {sum(s.status == UNDERPOWERED for s in papers)}"
        value = shortened(key.found, 40)
        thumbnail = f'<img src="validation/{name}.svg" width="120" alt="{figure.title}">'
        rows.append([f"[{figure.title}](validation/{name}.md)", thumbnail, f"**{status_of_figure(mine)}**",
                     standings, f"{key.claim.text}: {value}", figure.size, figure.taps,
                     figure.realizations])
    scoreboard = ", ".join(f"{found[word]} {word}" for word in STATUS if word != SILENT)
    post_hoc = sum(s.claim.post_hoc for s in scores if not s.claim.own and s.status != SILENT)
    parts = [HEAD.strip(), wrapped(f"**{decided} of {total} statements are decided ({100 * decided / total:.0f} %)**: "
                                   f"{scoreboard}. {post_hoc} of the {total} were tested post hoc: their contrasts, "
                                   "margins or pooled variances were chosen after a look at the data."), "![Overview of all statements](validation/overview.svg)",
             table(["figure", "drawn", "status", "shown / failed / open", "statement: found", "spheres (paper)", "taps (paper)",
                    "M here / paper"], rows), WORDS.strip(),
             wrapped(f"{kept} of {tested} statements decided by a p-value remain with the false discovery rate "
                     "held at 5 % (Benjamini and Hochberg 1995); the expected share of false "
                     f"decisions is at most {100 * expected:.0f} %."),
             wrapped("The raw runs of about half of the figures were not kept: their reduced data are the numbers that an "
                     "earlier page printed (means and errors over realizations). DR 1 and 5 to 9, PB 6 to 9, the settings "
                     "of the move, the spectra of PB 3 and the number of pores of PB 10 have data of each bed. A revision "
                     "that git does not have was an uncommitted working copy. " + NO_DATA),
             wrapped("Not scored, because the papers do not state them: steadiness by a test of drift, one straight "
                     "line in DR 3, and KWW exponents of a few hundred taps beside laws fitted to many thousands."),
             wrapped("Ageing counts as one statement per lag: the steps from one age to the next are additional tests. The rise of sigma_Z with "
                     "eps^(1/2) is part of its proportionality and not counted beside it."),
             "Not scored: [snapshots of DR 1](validation/dr1.md), [both engines on the same "
             "beds](validation/both-engines.md)."]
    return "\n\n".join(parts) + "\n"


def main(docs):
    scores = all_scores()
    folder = docs / "validation"
    folder.mkdir(parents=True, exist_ok=True)
    names = [name for name in FIGURES if any(s.claim.figure == name and not s.claim.own for s in scores)]
    draw_overview(scores, names, folder / "overview.svg")
    (docs / "pictures").mkdir(exist_ok=True)
    draw_strongest(docs / "pictures" / "validation.svg")
    for name, figure in FIGURES.items():
        printed = draw_figure(name, folder / f"{name}.svg")
        mine = [s for s in scores if s.claim.figure == name]
        (folder / f"{name}.md").write_text(page_of(name, figure, mine, printed))
    (docs / "validation.md").write_text(overview_page(scores))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
