"""Measures of the papers that `jostle structure` does not make: pores by their four centres, neighbours of all
spheres, heights of the peaks of n(z)."""
import numpy as np
from scipy import optimize, spatial, stats

CUT = 1.05             # diameters, Rosato et al. 2010, fig. 3
SPACING = (2 / 3)**0.5  # diameters, of hexagonal close-packed layers


def pores_of_four_centres(centres, width):
    """How many sets of four neighbours (Delaunay) have their centres in the box of Philippe and Bideau 2001, sec. IV B:
    18 R high, 2 R away from floor and walls."""
    inside = np.all((centres[:, :2] >= 1) & (centres[:, :2] <= width - 1), axis=1)
    inside &= (centres[:, 2] >= 1) & (centres[:, 2] <= 10)
    return int(inside[spatial.Delaunay(centres).simplices].all(axis=1).sum())


def neighbours_of_all(centres, sides):
    """Centres within 1.05 d of each centre, all spheres of a bed with periodic sides, [sphere]."""
    box = np.array([*sides, 0.0])  # 0: not periodic
    inside = centres.copy()
    inside[:, :2] %= box[:2]
    tree = spatial.cKDTree(inside, boxsize=box)
    return np.array([len(found) - 1 for found in tree.query_ball_point(inside, CUT)])


def normal_through(counts):
    """(mean a, width b, R2) of a normal law fitted to the shares of counts, as Rosato et al. 2010, fig. 8."""
    numbers = np.arange(counts.min() - 1, counts.max() + 2)
    shares = np.array([np.mean(counts == n) for n in numbers])
    (a, b), _ = optimize.curve_fit(stats.norm.pdf, numbers, shares, p0=(counts.mean(), counts.std()))
    misfit = np.sum((shares - stats.norm.pdf(numbers, a, b))**2)
    return float(a), float(abs(b)), float(1 - misfit / np.sum((shares - shares.mean())**2))


def peaks_of_layers(heights, layers=4):
    """Where the density of centres is highest within half a spacing of each of the lowest hcp layers, diameters.

    Kernel: a normal law of 0.05 d. Without layers the peak may be anywhere within half a spacing."""
    places = np.arange(-SPACING / 2, SPACING / 2, 0.005)
    found = []
    for layer in range(layers):
        grid = 0.5 + layer * SPACING + places
        density = np.exp(-0.5 * ((grid[:, None] - heights[None, :]) / 0.05)**2).sum(axis=1)
        found.append(float(grid[np.argmax(density)]))
    return found


def measured(scene, centres):
    """[(name, value)] and [(name, x, value)] of a packing, by what the scene measures and keeps."""
    parts, width = scene.get("structure", {}), scene["container"]["width"]
    sides, periodic = (width if isinstance(width, list) else [width] * 2), scene["container"]["sides"] == "periodic"
    numbers, curves = [], []
    if "pores" in parts and not periodic:
        numbers.append(("pores/four_centres", pores_of_four_centres(centres, sides[0])))
    if "coordination" in parts and periodic and min(sides) > 2 * CUT:
        counts = neighbours_of_all(centres, sides)
        numbers += zip(("all/neighbours", "all/normal_mean", "all/normal_width", "all/normal_R2"),
                       (float(counts.mean()), *normal_through(counts)))
        curves += [("all/neighbour_share", int(n), float(np.mean(counts == n))) for n in np.unique(counts)]
    if "height_histogram" in scene["snapshots"].get("keep", ()) and periodic:
        numbers += [(f"layers/peak_{k + 1}", z) for k, z in enumerate(peaks_of_layers(centres[:, 2]))]
    return numbers, curves
