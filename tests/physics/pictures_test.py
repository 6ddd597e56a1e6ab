"""Pictures show the numbers of the tables of a section."""
import pathlib
import tempfile

from pictures import Picture, curves_of, draw, tables_of, value_of

SECTION = """## figure

**Here**: a bed.

| point | Phi, tap 0 | 10 | 100 | law |
|---|---|---|---|---|
| lift = 0.1 | 0.5756 ± 0.0017 | 0.58 | 0.5838 ± 0.0036 | tau > 3 |
| lift = 0.2 | 0.5756 ± 0.0017 |  | 0.6 ± 0.1 | no fit |

| t_W | A, lag 1 | share |
|---|---|---|
| 3 | 29.7 (23 to 39) | -80 ± 2; 1124 |
| 10 | 4.11 (2.7 to 6.2) | 0.00 |
"""


def check(found, wanted):
    if found != wanted:
        raise AssertionError(f"{found} is not {wanted}")


def main():
    check(value_of("0.5756 ± 0.0017"), (0.5756, 0.5756 - 0.0017, 0.5756 + 0.0017))
    check(value_of("29.7 (23 to 39)"), (29.7, 23.0, 39.0))
    check(value_of("-80 ± 2; 1124"), (-80.0, -82.0, -78.0))
    check([value_of(cell) for cell in ("", "tau > 3", "0.1 to 0.3")], [None] * 3)

    tables = tables_of(SECTION)
    check([len(table) for table in tables], [3, 3])
    curves = curves_of(tables[0], Picture("taps", "Phi", across=True, log="x"))
    check([name for name, _ in curves], ["lift = 0.1", "lift = 0.2"])
    check([[x for x, *_ in points] for _, points in curves], [[0, 10, 100], [0, 100]])
    columns = Picture("t_W", "A", table=1, columns="lag")
    check(curves_of(tables[1], columns), [("A, lag 1", [(3, 29.7, 23, 39), (10, 4.11, 2.7, 6.2)])])

    # A logarithmic axis has no place for 0 and what is below.
    logarithmic = Picture("t_W", "share", table=1, columns="share", log="y")
    check(curves_of(tables[1], logarithmic), [("share", [])])

    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder) / "figures" / "figure.svg"
        check(draw(SECTION, logarithmic, target), False)
        check(draw(SECTION, Picture("taps", "Phi", across=True, paper=((50, 0.578),)), target), True)
        drawn = target.read_text()
        check(["lift = 0.1" in drawn, "the paper" in drawn, drawn.rstrip().endswith("</svg>")],
              [True] * 3)


if __name__ == "__main__":
    main()
