#pragma once

#include <cmath>
#include <variant>

#include "engine/fields.hpp"

// Horizontal slices of a bed, in which packing fractions are taken.
namespace jostle::inline engine {

/// Between two heights above the floor, diameters.
struct HeightWindow {
  double low = 0, high = 2;
  bool operator==(const HeightWindow&) const = default;

  static constexpr Description description{"heights",
                                           "From low to high, diameters above the floor"};
  static constexpr Bounds form = height_bounds;
};

/// True if both heights are numbers, the lower first.
inline bool is_window(HeightWindow window) {
  return std::isfinite(window.low) && std::isfinite(window.high) && window.low <= window.high;
}

/// Between two quantiles of the heights of the centres of the starting packing; fixed for the run.
struct QuantileWindow {
  double low = 0.2, high = 0.8;
  bool operator==(const QuantileWindow&) const = default;

  static constexpr Description description{
      "quantiles",
      "From low to high, quantiles of the heights of the centres of the starting packing"};
  static constexpr Bounds form = bounds(closed_range(0, 1));
};

using Window = std::variant<HeightWindow, QuantileWindow>;

}  // namespace jostle::inline engine
