#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/bed/packing.hpp"
#include "structure/region.hpp"

// Measurements of a packing at snapshots only.
namespace jostle::inline structure {

/// N_c: mean number of other centres within `cut` diameters (at the cut included) of a centre,
/// every periodic image being a centre of its own. In a mixture the cut is in sums of the two
/// radii. Rosato et al. 2010: cut = 1.05. Requires a sphere.
double coordination(const Packing& packing, double cut = 1.05);

/// The number of centres within `cut` of each centre, [n_spheres]; in a mixture, as above.
std::vector<unsigned> coordination_numbers(const Packing& packing, double cut = 1.05);

/// N_c against the cut.
struct CoordinationCurve {
  std::vector<double> cuts;          // [n_cuts], diameters
  std::vector<double> coordination;  // [n_cuts]; NaN where no sphere is in the region
  std::uint64_t n_spheres = 0;       // the spheres averaged over
};

/// At ascending cuts (at least one), in one pass, averaged over the spheres of the region or over
/// all. Their neighbours count wherever they are.
CoordinationCurve coordination_curve(const Packing& packing, std::span<const double> cuts,
                                     const std::optional<Region>& region = std::nullopt);

/// How many spheres have k neighbours, k = 0 .. up to the greatest number.
std::vector<std::uint64_t> neighbour_histogram(std::span<const unsigned> numbers);

/// True if bins of height up to the highest centre are at most 100,000, or 100 for each sphere:
/// nearly all of more would be empty. Requires a sphere.
bool has_height_bins(const Packing& packing, double bin_width);

/// Throws std::invalid_argument without has_height_bins(), with the reason.
void require_height_bins(const Packing& packing, double bin_width);

/// Bins [k width, (k + 1) width), k = 0 .. up to the highest centre. Requires a sphere. Throws as
/// require_height_bins() does.
std::size_t n_height_bins(const Packing& packing, double bin_width);

/// n(z): fraction of all centres per height bin, bins [k width, (k + 1) width), k = 0 .. up to the
/// highest centre. Sums to 1. Requires a sphere. Throws as n_height_bins() does. Rosato et al.
/// 2010, fig. 6.
std::vector<double> height_histogram(const Packing& packing, double bin_width = 0.1);

}  // namespace jostle::inline structure
