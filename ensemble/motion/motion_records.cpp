#include "ensemble/motion/motion_records.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "engine/numbers.hpp"

namespace jostle::inline ensemble {

MotionRecords::MotionRecords(const MotionSettings& followed, std::uint32_t spheres,
                             std::uint32_t realizations)
    : settings(followed), n_spheres(spheres), n_realizations(realizations) {
  const std::size_t n_origins = settings.origins.size();
  for (const MotionQuantity& quantity : motion_quantities)
    values.emplace_back(
        n_origins * settings.lags.size() * n_places(quantity.places, settings) * n_realizations,
        not_a_number);
  layer_height.resize(n_origins * settings.layers * n_realizations, not_a_number);
  largest_step.resize(n_realizations, not_a_number);
}

void MotionRecords::add(std::uint32_t realization, const MotionState& state,
                        const Container& container) {
  largest_step.at(realization) = state.largest_step;
  const std::size_t n_values = n_motion_values(settings);
  const std::size_t n_origins = std::min(state.origins.size(), settings.origins.size());
  for (std::size_t o = 0; o < n_origins; ++o) {
    const MotionOrigin& origin = state.origins[o];
    const std::size_t n_lags = std::min(origin.values.size() / n_values, settings.lags.size());
    for (std::size_t l = 0; l < n_lags; ++l) {
      std::size_t index = l * n_values;
      for (std::size_t q = 0; q < values.size(); ++q) {
        const std::size_t n = n_places(motion_quantities[q].places, settings);
        for (std::size_t place = 0; place < n; ++place)
          values[q][((o * settings.lags.size() + l) * n + place) * n_realizations + realization] =
              origin.values[index++];
      }
    }
    std::vector<double> sums(settings.layers), counts(settings.layers);
    const std::vector<double> heights = heights_of(origin.centres, container);
    const std::vector<std::uint32_t> layers = layers_of(heights, settings.layers);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      sums[layers[i]] += heights[i];
      counts[layers[i]] += 1;
    }
    for (std::size_t k = 0; k < sums.size(); ++k)
      layer_height[(o * settings.layers + k) * n_realizations + realization] = sums[k] / counts[k];
  }
}

std::span<const double> MotionRecords::row(std::string_view quantity, std::size_t origin,
                                           std::size_t lag, std::size_t place) const {
  const auto* found = std::ranges::find(motion_quantities, quantity, &MotionQuantity::name);
  assert(found != std::end(motion_quantities));
  const std::size_t n = n_places(found->places, settings);
  const auto& all = values[static_cast<std::size_t>(found - std::begin(motion_quantities))];
  return std::span(all).subspan(
      ((origin * settings.lags.size() + lag) * n + place) * n_realizations, n_realizations);
}

std::span<const double> MotionRecords::layer_heights(std::size_t origin, std::size_t layer) const {
  return std::span(layer_height)
      .subspan((origin * settings.layers + layer) * n_realizations, n_realizations);
}

}  // namespace jostle::inline ensemble
