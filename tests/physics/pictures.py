"""A picture of each section: the numbers of one of its tables, the paper's points beside them."""
import dataclasses
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))

from jostle import plot  # noqa: E402

NUMBER = r"-?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?"
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#b0578d", "#b07800", "#3a93c4", "#555555", "#7a5195")


@dataclasses.dataclass
class Picture:
    """A picture of a section's tables. across: each row is a curve and the numbers in the
    header are x; else each column is a curve and the first column is x."""
    x: str
    y: str
    across: bool = False
    table: int = 0
    rows: str = ""                      # a pattern of the first cells that are drawn; all
    columns: str = ""                   # of the header's cells
    x_column: int = 0                   # where each column is a curve
    log: str = ""                       # "x", "y" or "xy"
    paper: tuple = ()                   # ((x, y), ...) that the paper prints


def tables_of(section):
    """[table][row][cell] of a section of the page, verdicts included."""
    blocks = re.findall(r"(?:^\|.*\n?)+", section, re.M)
    return [[[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
             for line in block.splitlines() if not re.fullmatch(r"[|\-]*", line)]
            for block in blocks]


def value_of(cell):
    """The number of a cell and the ends of its error: "a ± b", "a (b to c)", "a; ..."; or None."""
    found = re.match(rf"({NUMBER})(?: ± ({NUMBER})| \(({NUMBER}) to ({NUMBER})\))?(?:;|$)", cell)
    if not found:
        return None
    value = float(found[1])
    if found[3]:
        return value, float(found[3]), float(found[4])
    half = float(found[2] or 0)
    return value, value - half, value + half


def last_number(cell):
    found = re.findall(NUMBER, cell)
    return float(found[-1]) if found else None


def curves_of(table, picture):
    """[(name, [(x, y, low, high)])]: where a cell holds no number the curve has no point."""
    header, *body = table
    names = list(header[1:])
    body = [row for row in body if re.search(picture.rows, row[0])]
    chosen = [i for i, name in enumerate(names, 1) if re.search(picture.columns, name)]
    if picture.across:
        found = [(row[0], [(last_number(header[i]), value_of(row[i])) for i in chosen])
                 for row in body]
    else:
        found = [(header[i], sorted(((last_number(row[picture.x_column].split(" ± ")[0]),
                                      value_of(row[i])) for row in body),
                                    key=lambda point: (point[0] is None, point[0])))
                 for i in chosen]
    return [(name, [(x, *y) for x, y in points if x is not None and y is not None and
                    ("y" not in picture.log or y[1] > 0)]) for name, points in found]


def series(name, index, points, **look):
    """A series of the catalogue (docs/developers/catalogue.md)."""
    colour = {"light": COLOURS[index % len(COLOURS)], "dark": COLOURS[index % len(COLOURS)]}
    x, y, low, high = (list(column) for column in zip(*points))
    return {"name": name, "colour": colour, "mark": "joined", "dash": 0, "symbol": index, "x": x, "y": y,
            "low": low, "high": high, **look}


def figure(curves, picture):
    """The picture as a figure of the catalogue."""
    places = [x for _, points in curves for x, *_ in points]
    scale = "linear" if "x" not in picture.log else "taps" if min(places) <= 0 else "log"
    drawn = [series(name, k, points) for k, (name, points) in enumerate(curves)]
    if picture.paper:
        drawn.append({**series("the paper", 0, [(x, y, y, y) for x, y in picture.paper]),
                      "mark": "points", "hollow": True, "colour": {"light": "#000000", "dark": "#ffffff"}})
    return {"name": "picture", "panels": [{
        "title": "", "caption": "", "source": "", "x": {"label": picture.x, "scale": scale},
        "y": {"label": picture.y, "scale": "log" if "y" in picture.log else "linear"}, "rules": [], "series": drawn}]}


def draw(section, picture, target):
    """Draws a picture of a section's text into target (.svg). False: there is nothing to draw."""
    tables = tables_of(section)
    if picture.table >= len(tables):
        return False
    curves = [(name, points) for name, points in curves_of(tables[picture.table], picture)
              if points]
    if not curves:
        return False
    target.parent.mkdir(parents=True, exist_ok=True)
    plot.save(plot.draw(figure(curves, picture), columns=1.5), target.with_suffix(""), kinds=("svg",))
    return True
