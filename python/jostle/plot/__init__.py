"""The main figures, with matplotlib. Every function draws into `ax` (default: the current axes) and
returns it; error bars and bands are 68 % intervals by Student's t, as `jostle` prints them.
"""

try:
    import matplotlib.pyplot  # noqa: F401
except ImportError as error:
    raise ImportError("jostle.plot needs matplotlib, which is not installed (Debian: python3-matplotlib; "
                      "pip: matplotlib)") from error

from .curves import compaction, height_histogram, profile
from .packings import packing_slice
from .tables import ageing, fit, hysteresis, spectrum, sweep

__all__ = ["ageing", "compaction", "fit", "height_histogram", "hysteresis", "packing_slice", "profile",
           "spectrum", "sweep"]
