#!/usr/bin/env python3
"""Fits eq. 3 of Philippe and Bideau 2001 to Phi_b of the campaign by the program.

fits_of_growth.py JOSTLE: writes reduced/pb-campaign/fits.csv, the 95 % intervals by profile likelihood of the curves of
all beds at the kept taps, from 1 on. After more beds, run it again."""
import json
import pathlib
import subprocess
import sys
import tempfile

from contrasts_of_campaign import CAMPAIGN, STRENGTHS
from contrasts_of_growth import growth
from reduce import REDUCED, write_table

FITS = REDUCED / CAMPAIGN / "fits.csv"


def intervals(jostle, taps, beds):
    """{parameter: (low, high)} at 95 %, None for no limit, of beds [tap, bed]."""
    with tempfile.TemporaryDirectory() as folder:
        curve = pathlib.Path(folder) / "phi_b.txt"
        curve.write_text("".join(" ".join(map(str, [t, *phi])) + "\n" for t, phi in zip(taps, beds)))
        printed = subprocess.run([jostle, "fit", curve, "--realizations", "--model", "inverse_log", "--json"],
                                 check=True, stdout=subprocess.PIPE).stdout
    (fit,) = json.loads(printed)["curves"][0]["fits"]
    return {name: found["interval_95"] for name, found in fit["parameters"].items()}


def fitted(jostle):
    """[(strength, parameter, low, high)], the ends as text, empty where there is none."""
    return [(f"{strength:g}", name, *("" if end is None else f"{end:.4g}" for end in ends))
            for strength in STRENGTHS
            for name, ends in intervals(jostle, *growth(strength, "bottom_fraction")).items()]


if __name__ == "__main__":
    write_table(FITS, ["strength", "parameter", "low", "high"], fitted(sys.argv[1]))
