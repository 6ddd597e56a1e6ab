#pragma once

#include <vector>

#include "engine/bed/window.hpp"

namespace jostle::inline structure {

/// Differences in height between central spheres and their partners in an uncorrelated packing
/// that has the heights of the packing measured. Lengths in diameters.
///
/// Every partner's height is spread over a kernel, so that the layers of a crystal count as the
/// density that they have on average. The kernel is a triangle of half-width 1, twiced (2 K - K *
/// K: Stuetzle & Mittal 1979, Smoothing Techniques for Curve Estimation, 176): it keeps the second
/// moment, so that a density which ends at floor and surface has the pairs that it had before.
/// The part that is spread farther than 1 beyond the accessible heights is reflected. No sphere is
/// its own partner: the pairs are unbiased for packings of few spheres too.
class HeightPairs {
 public:
  static constexpr double reach_beyond = 1;

  HeightPairs() = default;
  /// `centres`: heights of central spheres, which are among `partners`, which lie in `accessible`.
  /// Differences are looked up at most `reach` up and down.
  HeightPairs(const std::vector<double>& centres, const std::vector<double>& partners,
              HeightWindow accessible, double reach);

  /// Pairs per unit of the difference; their integral over all differences is n_centres times
  /// (n_partners - 1).
  double density(double difference) const { return interpolated(density_, difference); }
  /// Share of the central spheres that the difference takes to a height where a partner is spread.
  double share(double difference) const { return interpolated(share_, difference); }

 private:
  double interpolated(const std::vector<double>& values, double difference) const;

  double reach_ = 0;
  std::vector<double> density_, share_;
};

}  // namespace jostle::inline structure
