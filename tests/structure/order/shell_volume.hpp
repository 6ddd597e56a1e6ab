#pragma once

#include <cstddef>
#include <numbers>

#include "structure/order/pair_correlation.hpp"

namespace jostle {

/// Volume of the whole shell of bin k, cubic diameters.
inline double shell_volume(const PairCorrelation& pairs, std::size_t k) {
  const double low = pairs.r[k] - 0.5 * pairs.bin_width, high = low + pairs.bin_width;
  return 4 * std::numbers::pi / 3 * (high * high * high - low * low * low);
}

}  // namespace jostle
