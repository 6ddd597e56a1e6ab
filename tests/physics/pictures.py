"""A picture of each section: a figure of `jostle report --figures`, the paper's points beside it."""
import re
import subprocess
import tempfile
from pathlib import Path


def widened(script, axis, values):
    """The script with an axis that reaches all of the values too."""
    def wider(found):
        low, high = (float(end) for end in found.groups())
        margin = 0.05 * (max([high, *values]) - min([low, *values]))
        return (f"set {axis}range [{min([low, *(value - margin for value in values)]):.6g}:"
                f"{max([high, *(value + margin for value in values)]):.6g}]")
    return re.sub(rf"set {axis}range \[([^:]*):([^\]]*)\]", wider, script)


def draw(run, name, points, target):
    """Draws the figure of a finished run into target (.svg). points: [(x, y)] that the paper prints,
    as circles."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([run.jostle, "report", run.path, "--figures", folder, "--force"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        script = Path(folder) / f"{name}.gp"
        text = script.read_text()
        if points:
            text = widened(text, "y", [y for _, y in points])
            text = re.sub(r"set ytics [0-9.e-]+", "set ytics autofreq", text)
            (Path(folder) / "paper.dat").write_text(
                "".join(f"{x}\t{y}\n" for x, y in points))
            drawn = ", \\\n       'paper.dat' using (place($1)):2 with points pt 6 ps 0.8 " \
                    "lc rgb '#222222' notitle\n  unset output"
            text = text.replace("\n  unset output", drawn)
        script.write_text(text)
        subprocess.run(["gnuplot", script.name], cwd=folder, check=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(script.with_suffix(".svg").read_bytes())
