#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ensemble/analysis/ageing/ageing.hpp"
#include "fitting/models/models.hpp"
#include "tests/ensemble/noise.hpp"

namespace jostle::ageing_paths {

/// Three ages, each with paths of its own over five decades of lags.
inline const AgeingGrid grid = {.waiting_times = {0, 1000000, 2000000},
                                .lags = logarithmic_taps(1, 100000, 8)};

enum class Memory {
  long_,  // Brownian motion in the law's own time: neighbouring lags are correlated
  short_  // half of the mean square is that of X(t_W), the other half new at every lag
};

/// Changes whose mean squares are eq. 6, by waiting time. The lags determine these laws: they begin
/// well below tau and end close to A_inf.
struct Paths {
  double common_part =
      0;  // common part of the mean square: the same in all realizations, as they compact
  Memory memory = Memory::long_;
  std::array<double, 3> a_inf = {1, 3, 2}, b = {2, 2, 2}, tau = {20, 100, 500};
  std::array<double, 3> drift = {1, 1, 1};  // by which the common part is multiplied
};

inline TapRows rows(std::uint64_t seed, std::uint32_t realizations, const Paths& paths) {
  RandomStream random = test_stream(seed);
  TapRows rows{.taps = taps_of(grid), .realizations = realizations, .values = {}};
  std::vector<double> own(realizations), at_start(realizations);
  double previous = 0;
  for (const std::uint64_t tap : rows.taps) {
    const std::uint64_t k = tap / 1000000, lag = tap % 1000000;
    if (lag == 0) {
      for (std::uint32_t r = 0; r < realizations; ++r) {
        own[r] = 0;
        at_start[r] = noise(random);
        rows.values.push_back(10);
      }
      previous = 0;
      continue;
    }
    const double p[] = {paths.a_inf[k], paths.b[k], paths.tau[k]};
    const double current = Ageing().value(static_cast<double>(lag), p);
    for (std::uint32_t r = 0; r < realizations; ++r) {
      if (paths.memory == Memory::long_) {
        own[r] += std::sqrt(current - previous) * noise(random);
      } else {
        own[r] = std::sqrt(current / 2) * (at_start[r] + noise(random));
      }
      rows.values.push_back(10 + paths.drift[k] * std::sqrt(paths.common_part * current) +
                            std::sqrt(1 - paths.common_part) * own[r]);
    }
    previous = current;
  }
  return rows;
}

}  // namespace jostle::ageing_paths
