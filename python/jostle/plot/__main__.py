"""python3 -m jostle.plot CATALOGUE.json [--columns 1|2]: draws NAME.pdf and NAME.svg of every figure of a
catalogue (jostle report --catalogue) into the current folder."""

import argparse
import json
import pathlib
import sys

from .drawing import draw, save

def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m jostle.plot", description=__doc__)
    parser.add_argument("catalogue", type=pathlib.Path, help="the file that jostle report --catalogue writes")
    parser.add_argument("--columns", type=int, choices=(1, 2), default=1, help="width: of one or two columns of a journal")
    given = parser.parse_args()
    for figure in json.loads(given.catalogue.read_text(encoding="utf-8"))["figures"]:
        save(draw(figure, columns=given.columns), pathlib.Path(figure["name"]).name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
