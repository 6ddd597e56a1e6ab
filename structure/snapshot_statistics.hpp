#pragma once

#include <vector>

#include "engine/packing.hpp"

// What is measured of a packing at snapshots only.
namespace jostle {

/// N_c: mean number of other centres within `cut` diameters (at the cut included) of a centre,
/// every periodic image being a centre of its own. Rosato et al. 2010: cut = 1.05. Requires a
/// sphere.
double coordination(const Packing& packing, double cut = 1.05);

/// The number of centres within `cut` of each centre, [n_spheres].
std::vector<unsigned> coordination_numbers(const Packing& packing, double cut = 1.05);

/// n(z): fraction of all centres per height bin, bins [k width, (k + 1) width), k = 0 .. up to the
/// highest centre. Sums to 1. Requires a sphere. Rosato et al. 2010, fig. 6.
std::vector<double> height_histogram(const Packing& packing, double bin_width = 0.1);

}  // namespace jostle
