"""Figures with matplotlib. `figures(results)` is the catalogue of all figures that the page of `jostle report`
shows; `draw` makes one of matplotlib's figures of each, and `save` writes it as PDF and SVG.

The other functions draw numbers of your choice. Every function draws into `ax` (default: the current axes) and
returns it; error bars and bands are 68 % intervals by Student's t, as `jostle` prints them.
"""

try:
    import matplotlib.pyplot  # noqa: F401
except ImportError as error:
    raise ImportError("jostle.plot needs matplotlib, which is not installed (Debian: python3-matplotlib; "
                      "pip: matplotlib)") from error

from .catalogue import figures
from .curves import compaction, height_histogram, profile
from .drawing import draw, save
from .packings import packing_slice
from .tables import ageing, fit, hysteresis, spectrum, sweep

__all__ = ["ageing", "compaction", "draw", "figures", "fit", "height_histogram", "hysteresis", "packing_slice", "profile",
           "save", "spectrum", "sweep"]
