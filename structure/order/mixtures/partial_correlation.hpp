#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/bed/packing.hpp"
#include "structure/order/pair_correlation.hpp"

// g_ij of the kinds of a mixture against x = r / s_ij, s_ij = R_i + R_j of each pair.
namespace jostle::inline structure {

/// Most kinds whose pairs are counted.
inline constexpr std::size_t most_kinds_of_pairs = 8;

/// Pairs of spheres of two kinds against their distance in sums of their radii, in bins
/// [k width, (k + 1) width). A bin begins 1e-9 of its width early, as those of PairCorrelation.
struct PartialCorrelation {
  std::uint32_t first = 0, second = 0;  // kinds, first <= second
  std::vector<double> x{};              // middles of the bins, [n_bins]
  std::vector<std::uint64_t> counts{};  // pairs found, each from its central spheres, [n_bins]
  std::vector<double> expected{};       // pairs of an uncorrelated packing, [n_bins]

  /// counts / expected of each bin; NaN where nothing is expected.
  std::vector<double> g() const;
};

/// Heights of the central spheres: `settings.heights`, or bulk_heights() for the largest distance.
HeightWindow central_heights(const Packing& packing, const PairCorrelationSettings& settings);

/// Returns why partial_correlations() does not take such packings, or nothing. `largest`: the
/// largest diameter; `r_max` in sums of radii, absent for the widest that suits.
std::optional<std::string> partial_pairs_fault(const Container& container, double largest,
                                               std::size_t n_kinds, std::optional<double> r_max);

/// The x_max that suits a mixture: widest_pairs() over the largest diameter where that is less.
double widest_partial_pairs(const Packing& packing);

/// Returns the pairs of each two kinds, in the order 0-0, 0-1, ..., 1-1, ...: one sphere is
/// central, between central_heights(), the other is anywhere. r_max and bin_width are in sums of
/// radii. A pair of kinds is counted from the spheres of both, so that g_ij = g_ji.
///
/// Expected: every sphere keeps its height and its radius. Between periodic sides it is anywhere in
/// the footprint. The part of a shell of pair (i, j), whose centres are h apart in height, is then
/// an annulus of the footprint: its area is pi (max(0, r_2^2 - h^2) - max(0, r_1^2 - h^2)), r_1 and
/// r_2 being the ends of the bin times s_ij. Between walls and in a tube it is anywhere in the
/// region that its own radius leaves, where its kind is: ExpectedAtWalls. Both numbers are exact
/// for an ideal gas of any heights and sizes, floor and surface included. A box that is periodic
/// upwards has whole shells. Layers are divided out as far as single spheres make them: g of a bed
/// compares equal heights alone.
///
/// Throws std::invalid_argument with the text of partial_pairs_fault(): where a distance exceeds
/// half a period, and with more than 8 kinds. Requires sizes.
std::vector<PartialCorrelation> partial_correlations(const Packing& packing,
                                                     const PairCorrelationSettings& settings = {});

/// Like contact_value() of PairCorrelation: g(1+) by a cubic, for fluids.
double contact_value(const PartialCorrelation& pairs, double bin_width, double reach = 0.1);

}  // namespace jostle::inline structure
