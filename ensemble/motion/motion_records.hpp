#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "ensemble/motion/motion.hpp"

namespace jostle::inline ensemble {

/// Motion at one sweep point over all realizations; NaN where there is
/// nothing.
struct MotionRecords {
  MotionRecords(const MotionSettings& followed, std::uint32_t spheres, std::uint32_t realizations);

  MotionSettings settings;
  std::uint32_t n_spheres, n_realizations;
  /// One a quantity of motion_quantities: [n_origins, n_lags, n_places, n_realizations].
  std::vector<std::vector<double>> values;
  std::vector<double> layer_height;  // [n_origins, n_layers, n_realizations], mean, diameters
  std::vector<double> largest_step;  // [n_realizations], MotionState

  void add(std::uint32_t realization, const MotionState& state, const Container& container);

  /// [n_realizations] of the quantity with that name.
  std::span<const double> row(std::string_view quantity, std::size_t origin, std::size_t lag,
                              std::size_t place = 0) const;
  std::span<const double> layer_heights(std::size_t origin, std::size_t layer) const;
};

}  // namespace jostle::inline ensemble
