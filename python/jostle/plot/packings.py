"""Pictures of packings."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle, Rectangle

from ..errors import BadArgument
from ..guards import takes_arguments
from ..results import Results
from .axes import axes_or_current

DIRECTIONS = "xyz"


@takes_arguments
def packing_slice(results: Results, point: int = 0, realization: int = 0, tap: int | None = None, *,
                  normal: str = "y", at: float | None = None, ax: Axes | None = None) -> Axes:
    """The discs that a plane cuts out of a packing's spheres.

    tap: None the last that is kept. normal: "x", "y" or "z", the normal of the plane;
    at: where on it, diameters (default: the middle of the box). Across periodic sides spheres appear on
    both.
    """
    if normal not in tuple(DIRECTIONS):
        raise BadArgument(f"normal={normal!r}: one of x, y, z")
    ax = axes_or_current(ax)
    centres, box = results.positions(point, realization, tap), results.box(point, realization)
    across = DIRECTIONS.index(normal)
    right, up = (i for i in range(3) if i != across)
    plane = box.edges[across] / 2 if at is None else at
    images = _with_images(centres, box.boundary, box.edges)
    distance = np.abs(images[:, across] - plane)
    cut = images[distance < 0.5]
    radii = np.sqrt(0.25 - distance[distance < 0.5] ** 2)
    discs = [Circle((centre[right], centre[up]), radius) for centre, radius in zip(cut, radii)]
    drawn = PatchCollection(discs, facecolor="C0", edgecolor="black", linewidth=0.4)
    ax.add_collection(drawn)
    frame = Rectangle((0, 0), box.edges[right], box.edges[up], fill=False, edgecolor="0.5", linewidth=0.8)
    ax.add_patch(frame)
    drawn.set_clip_path(frame)
    ax.set_xlim(0, box.edges[right])
    ax.set_ylim(0, box.edges[up])
    ax.set_aspect("equal")
    ax.set_xlabel(f"{DIRECTIONS[right]} (diameter)")
    ax.set_ylabel(f"{DIRECTIONS[up]} (diameter)")
    return ax


def _with_images(centres: np.ndarray, boundary: tuple[str, str, str], edges: np.ndarray) -> np.ndarray:
    """The centres inside the box, and their images within a radius of it."""
    for axis in range(3):
        if boundary[axis] != "periodic":
            continue
        centres = centres.copy()
        centres[:, axis] %= edges[axis]
        shift = np.zeros(3)
        shift[axis] = edges[axis]
        below = centres[centres[:, axis] > edges[axis] - 0.5] - shift
        above = centres[centres[:, axis] < 0.5] + shift
        centres = np.concatenate([centres, below, above])
    return centres
