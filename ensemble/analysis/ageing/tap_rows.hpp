#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace jostle::inline ensemble {

/// One observable over all realizations at chosen taps: as little of a long series as an analysis
/// of a few taps needs.
struct TapRows {
  std::vector<std::uint64_t> taps;  // [n_taps], ascending, no tap twice
  std::uint32_t realizations = 0;
  std::vector<double>
      values;  // [n_taps, n_realizations]; NaN where a realization did not get so far

  /// [n_realizations]; empty where the tap is not among those chosen.
  std::span<const double> row(std::uint64_t tap) const;
};

/// Those of the chosen taps (ascending) that a series [n_taps, n_realizations] has.
TapRows choose_taps(std::span<const double> series, std::uint32_t realizations,
                    std::span<const std::uint64_t> taps);

/// Whole numbers from first to last, both included, about equally spaced in their logarithm, none
/// twice. Requires 1 <= first <= last and per_decade > 0.
std::vector<std::uint64_t> logarithmic_taps(std::uint64_t first, std::uint64_t last,
                                            double per_decade);

}  // namespace jostle::inline ensemble
