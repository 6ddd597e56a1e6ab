"""Pictures of packings."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle, Patch, Rectangle

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
    both. A mixture's kinds have colours of their own and a legend.
    """
    if normal not in tuple(DIRECTIONS):
        raise BadArgument(f"normal={normal!r}: one of x, y, z")
    ax = axes_or_current(ax)
    centres, box = results.positions(point, realization, tap), results.box(point, realization)
    across = DIRECTIONS.index(normal)
    right, up = (i for i in range(3) if i != across)
    plane = box.edges[across] / 2 if at is None else at
    spheres = results.points[point]
    radii = 0.5 * spheres.diameters(realization)
    images, of_sphere = _with_images(centres, radii, box.boundary, box.edges)
    squares = radii[of_sphere] ** 2 - (images[:, across] - plane) ** 2
    is_cut = squares > 0
    frame = Rectangle((0, 0), box.edges[right], box.edges[up], fill=False, edgecolor="0.5", linewidth=0.8)
    ax.add_patch(frame)
    for number, kind in enumerate(spheres.kinds or [None]):
        own = is_cut & (spheres.kind[of_sphere] == number)
        discs = [Circle((centre[right], centre[up]), radius)
                 for centre, radius in zip(images[own], np.sqrt(squares[own]))]
        drawn = PatchCollection(discs, facecolor=f"C{number % 10}", edgecolor="black", linewidth=0.4)
        ax.add_collection(drawn)
        drawn.set_clip_path(frame)
    if spheres.is_mixture:
        ax.legend(handles=[Patch(facecolor=f"C{number % 10}", label=kind) for number, kind in enumerate(spheres.kinds)])
    ax.set_xlim(0, box.edges[right])
    ax.set_ylim(0, box.edges[up])
    ax.set_aspect("equal")
    ax.set_xlabel(f"{DIRECTIONS[right]} (diameter)")
    ax.set_ylabel(f"{DIRECTIONS[up]} (diameter)")
    return ax


def _with_images(centres: np.ndarray, radii: np.ndarray, boundary: tuple[str, str, str],
                 edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The centres inside the box and their images within a radius of it, and the sphere of each."""
    of_sphere = np.arange(len(centres))
    for axis in range(3):
        if boundary[axis] != "periodic":
            continue
        centres = centres.copy()
        centres[:, axis] %= edges[axis]
        shift = np.zeros(3)
        shift[axis] = edges[axis]
        reach = radii[of_sphere]
        is_high, is_low = centres[:, axis] > edges[axis] - reach, centres[:, axis] < reach
        centres = np.concatenate([centres, centres[is_high] - shift, centres[is_low] + shift])
        of_sphere = np.concatenate([of_sphere, of_sphere[is_high], of_sphere[is_low]])
    return centres, of_sphere
