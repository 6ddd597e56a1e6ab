#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/bed/packing.hpp"
#include "structure/region.hpp"

// g(r) of the bulk of a packing, corrected for floor and surface. Lengths in diameters.
namespace jostle::inline structure {

struct PairCorrelationSettings {
  double r_max = 4;
  double bin_width = 0.02;
  std::optional<Region> region = std::nullopt;  // of the central spheres; by default bulk_region
};

/// The r_max that suits a container: 4, but at most half a period of its box, and between walls or
/// in a tube so that central spheres have a column of 1 diameter; at least 1, which is too wide for
/// the narrowest of them. A multiple of 0.1.
double widest_pairs(const Container& container);

/// Where shells of r_max around a centre are whole, as far as the packing goes: r_max above the
/// lowest centres that the floor allows and below 2<Z>, but at least the middle half of the heights
/// up to there; r_max + 1/2 away from walls. All of a fully periodic box.
Region bulk_region(const Packing& packing, double r_max);

/// Pairs of centres against their distance, in bins [k width, (k + 1) width). A bin begins 1e-9 of
/// its width early, so that touching spheres are in the bin that begins at 1, whatever rounding
/// did.
struct PairCorrelation {
  std::vector<double> r;              // middles of the bins, [n_bins]
  std::vector<std::uint64_t> counts;  // neighbours found around all central spheres, [n_bins]
  std::vector<double> expected;       // what an ideal gas would have, [n_bins]
  double bin_width = 0;
  double density = 0;           // centres a cubic diameter
  std::uint64_t n_centres = 0;  // central spheres

  /// g of each bin, counts / expected: 1 for an ideal gas, but for 1 / n_spheres where the box is
  /// fully periodic (the sphere itself is none of its neighbours). NaN where nothing is expected.
  std::vector<double> g() const;

  /// Pools the counts of another packing, measured in the same bins; density and n_centres become
  /// the mean, weighted by central spheres, and the sum.
  PairCorrelation& operator+=(const PairCorrelation& other);
};

/// Central spheres in the region; their neighbours anywhere. The ideal gas has the density of the
/// region and fills the heights where centres may be: from 1/2 to the highest centre, so a shell
/// cut by the floor or the top counts only with the part between them, in closed form. (A bed's
/// surface is uneven: keep r_max below it if you can.) The density is the volume of the spheres in
/// the region over a sphere's: it does not jump where the region cuts through a layer of centres.
/// It is taken at least 1/2 inside the heights where centres may be.
/// Throws std::invalid_argument if shells reach a wall or beyond half a period, or if the region is
/// empty.
PairCorrelation pair_correlation(const Packing& packing,
                                 const PairCorrelationSettings& settings = {});

/// g(1+), by least squares of a cubic through the bins between 1 and 1 + reach, each weighing as
/// what is expected in it. For fluids, with bins of 0.01 or less, of which a whole number makes 1;
/// beds have contacts, whose g is a peak without width. NaN with fewer than 4 bins.
double contact_value(const PairCorrelation& pairs, double reach = 0.1);

}  // namespace jostle::inline structure
