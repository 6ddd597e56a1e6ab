#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/window.hpp"

// g(r) of a packing in any container, corrected for floor, surface and sides. Lengths in diameters.
namespace jostle::inline structure {

struct PairCorrelationSettings {
  double r_max = 4;
  double bin_width = 0.02;
  std::optional<HeightWindow> heights = std::nullopt;  // heights of the central spheres; by default
                                                       // bulk_heights
};

/// The r_max that suits a container: 4, but at most half a period of its box. A multiple of 0.1.
double widest_pairs(const Container& container);

/// Heights of central spheres: r_max above the lowest centres that the floor allows and below 2<Z>,
/// but at least the middle half of the heights up to there, and all of these where that half has no
/// centre. All of a fully periodic box.
HeightWindow bulk_heights(const Packing& packing, double r_max);

/// Pairs of centres against their distance, in bins [k width, (k + 1) width). A bin begins 1e-9 of
/// its width early, so that touching spheres are in the bin that begins at 1, whatever rounding
/// did.
struct PairCorrelation {
  std::vector<double> r;              // middles of the bins, [n_bins]
  std::vector<std::uint64_t> counts;  // neighbours found around all central spheres, [n_bins]
  std::vector<double> neighbours;     // in whole shells (whole_shells.hpp), [n_bins]
  std::vector<double> found;          // these, as if centres crowded nowhere at the sides, [n_bins]
  std::vector<double> expected;       // pairs of an uncorrelated packing, [n_bins]
  std::vector<double> shells;  // central spheres whose shell at the end of a bin is whole, [n_bins]
  double bin_width = 0;
  double widest_shell = 0;  // radius up to which shells have room between the sides, or infinite
  double density = 0;       // centres a cubic diameter, of the heights that the shells sample
  std::uint64_t n_centres = 0;  // central spheres

  /// g of each bin, found / expected: 1 for an uncorrelated packing. NaN where nothing is expected.
  std::vector<double> g() const;

  /// Mean number of other centres up to the end of each bin: a sum over distances, at each of them
  /// the mean over the spheres whose shell there is whole. NaN from the first bin at whose end no
  /// central sphere has a whole shell.
  std::vector<double> running_neighbours() const;

  /// Pools the counts of another packing, measured in the same bins; density and n_centres become
  /// the mean, weighted by central spheres, and the sum.
  PairCorrelation& operator+=(const PairCorrelation& rhs);
};

/// Counts pairs of a central sphere, between `heights`, and another sphere in the accessible
/// region: the accessible footprint (accessible.hpp) between the lowest centres and the surface,
/// 2<Z> - 1/2 or the highest centre below it, and within r_max of `heights`.
///
/// Neighbours are counted around central spheres whose shell is in that region. Shells that
/// exceed half a period count all pairs with the edge correction below. No neighbours are given
/// where sides, floor or surface cut every shell: the correction would be too large where spheres
/// crowd at them.
///
/// Edges of g: n(d) of the n central spheres have the place at a displacement d inside that region,
/// and a pair at d counts n / n(d) times (translation correction: Ohser 1983, Math.
/// Operationsforsch. Statist. Ser. Statist. 14, 63). Lattices have neighbours in some directions
/// alone, and their numbers come out exactly. A displacement that fewer than a quarter of the
/// central spheres can make counts as if a quarter could, in pairs and in what is expected.
///
/// Expected: the pairs of an uncorrelated packing with the heights of this one. A sphere keeps its
/// height and is anywhere in the footprint (height_pairs.hpp). The number is unbiased for few
/// spheres and for any profile, as beds with a crowded floor have. For g the heights reach 1 beyond
/// floor and surface, as far as layers are spread. Where centres crowd at the sides, the partners
/// of a pair at d are denser than the mean by n(-d) / n over what evenly spread points have, the
/// pair itself not counted (adapted intensity: Stoyan & Stoyan 2000, Scand. J. Statist. 27, 641).
///
/// `density`: the area of the accessible footprint between the heights sampled, weighted by 1 at
/// heights of central spheres and falling linearly to 0 at the last height sampled. Volumes of
/// spheres are counted, not centres: the density does not jump where a height cuts a layer.
///
/// Along periodic directions a pair is taken to its nearest image, and shells end at half a period.
/// The sphere's own images are no neighbours. Throws std::invalid_argument where centres have no
/// room beside each other, or fewer than about two layers of it.
PairCorrelation pair_correlation(const Packing& packing,
                                 const PairCorrelationSettings& settings = {});

/// g(1+), by least squares of a cubic through the bins between 1 and 1 + reach, each weighing as
/// what is expected in it. For fluids, with bins of 0.01 or less, of which a whole number makes 1;
/// beds have contacts, whose g is a peak without width. NaN with fewer than 4 bins.
double contact_value(const PairCorrelation& pairs, double reach = 0.1);

}  // namespace jostle::inline structure
