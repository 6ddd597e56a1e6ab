#pragma once

#include <cstdint>
#include <string_view>

#include "engine/bed/packing.hpp"

// Where the kinds of a mixture lie, and how well they are mixed. All require a packing with sizes.
namespace jostle::inline structure {

/// Returns the number of the kind of this name. Throws std::invalid_argument where there is none.
std::uint32_t kind_named(const Sizes& sizes, std::string_view name);

/// Return the numbers of the kinds of the largest and of the smallest mean diameter; of equal means
/// the first is called largest and the last smallest. Kinds without spheres are left out.
std::uint32_t largest_kind(const Sizes& sizes);
std::uint32_t smallest_kind(const Sizes& sizes);

/// Returns the mean height of the centres of a kind, diameters, each weighted by the volume of its
/// sphere: so weighted by the volumes of kinds the heights average to mean_height(). NaN where the
/// kind has no spheres.
double kind_height(const Packing& packing, std::uint32_t kind);

/// Returns S = 2 (z_L - z_S)/H of two kinds, H = 2 <z> being the height of the bed, all weighted by
/// volume. Two kinds of equal volume that fill the upper and the lower half give 1; 0 where both
/// are at the same height. NaN where a kind has no spheres.
double segregation(const Packing& packing, std::uint32_t large, std::uint32_t small);

/// Returns Lacey's mixing index M = (S_0^2 - S^2)/(S_0^2 - S_R^2) of a kind among all others, by
/// numbers of spheres. The footprint and the heights from the floor to the surface are divided into
/// whole numbers of cells of about `cell` diameters; a sphere belongs to the cell of its centre.
/// S^2 is the variance of the kind's share over cells, each weighted by its spheres; S_0^2 = p (1 -
/// p) where all cells are pure. S_R^2 = p (1 - p) (K - 1)/(N - 1), for K cells with spheres, is its
/// expectation where the N spheres are labelled at random: the number in a cell of n spheres is
/// then hypergeometric, its share has the variance p (1 - p) (N - n)/(n (N - 1)), and the mean over
/// cells weighted by n/N is S_R^2. NaN where the kind has all spheres or none, or no cell has two.
double lacey_index(const Packing& packing, std::uint32_t kind, double cell);

}  // namespace jostle::inline structure
