"""A picture of each section: the numbers of one of its tables, the paper's points beside them."""
import dataclasses
import pathlib
import re
import subprocess
import tempfile

NUMBER = r"-?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?"
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#999999")


@dataclasses.dataclass
class Picture:
    """What is drawn of a section's tables. across: each row is a curve and the numbers in the
    header are x; else each column is one and the first column is x."""
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


ZERO = 0.5  # where a logarithmic axis of taps shows tap 0


def x_range(points, picture):
    """(least, greatest) of the axis, a little beyond all points."""
    places = [x for x, *_ in points] + [x for x, _ in picture.paper]
    if "x" in picture.log:
        places = [x if x > 0 else ZERO for x in places]
        return min(places) / 1.3, max(places) * 1.3
    margin = 0.03 * (max(places) - min(places))
    return min(places) - margin, max(places) + margin


def script(curves, picture, target):
    """Of gnuplot."""
    points = [point for _, drawn in curves for point in drawn]
    logarithmic = "x" in picture.log
    place = f"($1 > 0 ? $1 : {ZERO})" if logarithmic else "1"
    settings = [f"set logscale {axis}" for axis in picture.log]
    if logarithmic and min(x for x, *_ in points) == 0:
        settings.append(f'set xtics add ("0" {ZERO})')
    if "y" in picture.log:
        settings.append("set format y '10^{%L}'")
    low, high = x_range(points, picture)
    drawn, blocks = [], []
    for k, (name, curve) in enumerate(curves):
        blocks.append(f"$curve{k} << END\n" + "\n".join(
            " ".join(f"{number:.8g}" for number in point) for point in curve) + "\nEND")
        style = f"lc rgb '{COLOURS[k % len(COLOURS)]}' lw 1"
        title = re.sub(r"['\"{}\\]", "", name)
        drawn += [f"$curve{k} using {place}:2 with lines {style} notitle",
                  f"$curve{k} using {place}:2:3:4 with yerrorbars pt 7 ps 0.4 {style} "
                  f"title '{title}' noenhanced"]
    if picture.paper:
        blocks.append("$paper << END\n" + "\n".join(f"{x} {y}" for x, y in picture.paper) +
                      "\nEND")
        drawn.append(f"$paper using {place}:2 with points pt 6 ps 1 lc rgb '#000000' "
                     "title 'the paper'")
    return "\n".join(
        ["set terminal svg size 480,320 font 'sans,11' background '#ffffff'",
         f"set output '{target}'", "set key above left Left reverse samplen 1.5 width 1 maxcols 3",
         "set border 3", "set tics nomirror", "" if "y" in picture.log else "set offsets 0, 0, graph 0.05, graph 0.05",
         f"set xrange [{low:.6g}:{high:.6g}]", f"set xlabel '{picture.x}' noenhanced",
         f"set ylabel '{picture.y}' noenhanced", *settings, *blocks,
         "plot " + ", \\\n     ".join(drawn)]) + "\n"


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
    with tempfile.TemporaryDirectory() as folder:
        drawn = pathlib.Path(folder) / "picture.svg"
        subprocess.run(["gnuplot"], input=script(curves, picture, drawn), text=True, check=True)
        target.write_bytes(drawn.read_bytes())
    return True
