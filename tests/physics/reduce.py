#!/usr/bin/env python3
"""Stores what runs found as small CSV files, from which docs/validation is made on any machine.

reduce.py sections PAGE FOLDER: the tables of a page of figures.py, one folder per run. beds.py reduces results files."""
import csv
import functools
import json
import pathlib
import re
import sys

from pictures import tables_of

HERE = pathlib.Path(__file__).resolve().parent
REDUCED = HERE / "reduced"
NOTES = {"about": r"`\./dev physics [^`]*`, (.*?)\n\n", "here": r"\*\*Here\*\*: (.*?) \*\*The paper",
         "paper": r"\*\*The paper\*\*: (.*?)(?: \*\*Full size|\n\n)", "remark": r"\*\*Remark\*\*: (.*)"}
VERDICTS = "statement of the paper"


def write_table(path, header, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])


@functools.lru_cache(maxsize=64)
def rows_of(path, modified, size):
    with path.open(newline="") as file:
        return list(csv.reader(file))


def read_table(path):
    """The rows of a CSV file, read again only where it has changed."""
    found = path.stat()
    return list(rows_of(path, found.st_mtime_ns, found.st_size))


def reduce_sections(page, folder):
    """Writes the tables of each section: statements.csv (found numbers and tests) and 1.csv, 2.csv, ..."""
    for part in re.split(r"^## ", page.read_text(), flags=re.M)[1:]:
        name, text = part.split("\n", 1)
        notes = {key: found[1].strip() if (found := re.search(pattern, text, re.S)) else ""
                 for key, pattern in NOTES.items()}
        (folder / name).mkdir(parents=True, exist_ok=True)
        kept = folder / name / "notes.json"
        if not notes["remark"] and kept.exists():  # a remark is written by hand
            notes["remark"] = json.loads(kept.read_text())["remark"]
        kept.write_text(json.dumps(notes, indent=1) + "\n")
        number = 0
        for header, *rows in tables_of(text):
            if header[0] == VERDICTS:
                write_table(folder / name / "statements.csv", ["statement", "found", "test"],
                            [row[:3] for row in rows])
            else:
                number += 1
                write_table(folder / name / f"{number}.csv", header, rows)


def text_of(dataset):
    value = dataset[()]
    value = value.flat[0] if hasattr(value, "flat") else value
    return value.decode() if isinstance(value, bytes) else str(value)


def taps_to_keep(last):
    """0 to 5 and then about eight taps per decade, the taps that the papers print, and the last; of short runs every
    25th, so that jumps of single beds are seen."""
    spaced = {round(10**(k / 8)) for k in range(60)} | {50, 100, 200, 250, 400, 800, 898, 1000}
    if last < 1000:
        spaced |= set(range(0, last, 25))
    return [tap for tap in sorted({0, 1, 2, 3, 4, 5, last} | spaced) if tap <= last]


if __name__ == "__main__":
    reduce_sections(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
