#include "ensemble/motion/motion.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

#include "engine/bed/boundary.hpp"

namespace jostle::inline ensemble {

namespace {

constexpr std::size_t n_directions = 3;

std::array<double, n_directions> components(Vec3 d) {
  return {d.x, d.y, d.z};
}

/// Sums over the spheres of the bed, or of a layer.
struct Sums {
  explicit Sums(std::size_t n_lengths) : lateral_overlap(n_lengths), overlap(n_lengths) {}

  double n = 0, lateral_quartic = 0, vertical_quartic = 0;
  std::array<double, n_directions> steps{}, squares{};
  std::vector<double> lateral_overlap, overlap;

  void add(const std::array<double, n_directions>& d, std::span<const double> lengths) {
    n += 1;
    for (std::size_t k = 0; k < n_directions; ++k) {
      steps[k] += d[k];
      squares[k] += d[k] * d[k];
    }
    const double lateral = d[0] * d[0] + d[1] * d[1];
    lateral_quartic += lateral * lateral;
    for (std::size_t a = 0; a < lengths.size(); ++a) {
      const double square = lengths[a] * lengths[a];
      lateral_overlap[a] += lateral < square ? 1 : 0;
      overlap[a] += lateral + d[2] * d[2] < square ? 1 : 0;
    }
  }
  Sums& operator+=(const Sums& rhs) {
    n += rhs.n;
    lateral_quartic += rhs.lateral_quartic;
    for (std::size_t k = 0; k < n_directions; ++k) {
      steps[k] += rhs.steps[k];
      squares[k] += rhs.squares[k];
    }
    for (std::size_t a = 0; a < overlap.size(); ++a) {
      lateral_overlap[a] += rhs.lateral_overlap[a];
      overlap[a] += rhs.overlap[a];
    }
    return *this;
  }
  /// Once all spheres are added.
  void add_about_mean(double dz) {
    const double about_mean = dz - steps[2] / n;
    vertical_quartic += about_mean * about_mean * about_mean * about_mean;
  }
};

/// The image of a wrapped coordinate that is nearest to where the sphere was.
double unwrapped_coordinate(double wrapped, double was, double period, double& largest_step) {
  if (period == 0) return wrapped;
  const double now = wrapped + period * std::nearbyint((was - wrapped) / period);
  largest_step = std::max(largest_step, std::abs(now - was) / period);
  return now;
}

void unwrap(const Packing& bed, MotionState& state) {
  const Vec3 periods = Boundary(bed.container).periods();
  for (std::size_t i = 0; i < bed.centres.size(); ++i) {
    const Vec3 wrapped = bed.centres[i];
    Vec3& r = state.unwrapped[i];
    r = {unwrapped_coordinate(wrapped.x, r.x, periods.x, state.largest_step),
         unwrapped_coordinate(wrapped.y, r.y, periods.y, state.largest_step),
         unwrapped_coordinate(wrapped.z, r.z, periods.z, state.largest_step)};
  }
}

void append(std::vector<double>& values, std::span<const double> sums, double n) {
  for (const double sum : sums) values.push_back(sum / n);
}

/// Displacements and their squares, kind by kind.
void append_kinds(const MotionSettings& settings, std::span<const Vec3> reference,
                  std::span<const Vec3> now, std::span<const std::uint32_t> kinds,
                  std::vector<double>& values) {
  if (settings.kinds == 0) return;
  assert(kinds.size() == now.size());
  std::vector<Sums> of_kinds(settings.kinds, Sums(0));
  for (std::size_t i = 0; i < now.size(); ++i)
    of_kinds[kinds[i]].add(components(now[i] - reference[i]), {});
  for (const Sums& kind : of_kinds) append(values, kind.steps, kind.n);
  for (const Sums& kind : of_kinds) append(values, kind.squares, kind.n);
}

}  // namespace

std::size_t n_places(MotionPlaces places, const MotionSettings& settings) {
  switch (places) {
    case MotionPlaces::none:
      return 1;
    case MotionPlaces::directions:
      return n_directions;
    case MotionPlaces::overlap_lengths:
      return settings.overlap_lengths.size();
    case MotionPlaces::layers:
      return settings.layers;
    case MotionPlaces::layer_directions:
      return n_directions * settings.layers;
    case MotionPlaces::layer_overlap_lengths:
      return settings.overlap_lengths.size() * settings.layers;
    case MotionPlaces::kind_directions:
      return n_directions * settings.kinds;
  }
  return 0;
}

std::size_t n_motion_values(const MotionSettings& settings) {
  std::size_t n = 0;
  for (const MotionQuantity& quantity : motion_quantities) n += n_places(quantity.places, settings);
  return n;
}

std::size_t lags_reached(const MotionSettings& settings, std::uint64_t origin, std::uint64_t rows) {
  const auto beyond = std::ranges::find_if(
      settings.lags, [&](std::uint64_t lag) { return origin >= rows || lag >= rows - origin; });
  return static_cast<std::size_t>(beyond - settings.lags.begin());
}

std::uint64_t motion_bytes(const MotionSettings& settings, std::uint64_t n_spheres) {
  const std::uint64_t n_origins = settings.origins.size();
  return (n_origins + 1) * n_spheres * sizeof(Vec3) +
         n_origins * settings.lags.size() * n_motion_values(settings) * sizeof(double);
}

std::uint64_t motion_numbers(const MotionSettings& settings, std::uint64_t realizations) {
  return settings.origins.size() * settings.lags.size() * n_motion_values(settings) * realizations;
}

std::vector<double> heights_of(std::span<const Vec3> centres, const Container& container) {
  const double period = Boundary(container).periods().z;
  std::vector<double> heights;
  for (const Vec3& r : centres)
    heights.push_back(period > 0 ? r.z - period * std::floor(r.z / period) : r.z);
  return heights;
}

std::vector<std::uint32_t> layers_of(std::span<const double> heights, std::uint32_t n_layers) {
  const std::size_t n = heights.size();
  std::vector<std::size_t> by_height(n);
  std::iota(by_height.begin(), by_height.end(), std::size_t{0});
  std::ranges::stable_sort(by_height, {}, [&](std::size_t i) { return heights[i]; });
  std::vector<std::uint32_t> layers(n);
  for (std::size_t rank = 0; rank < n; ++rank)
    layers[by_height[rank]] = static_cast<std::uint32_t>(rank * n_layers / n);
  return layers;
}

std::vector<std::uint64_t> layer_sizes(std::uint64_t n_spheres, std::uint32_t n_layers) {
  std::vector<std::uint64_t> sizes(n_layers);
  // Layer k begins at the least rank r with r n_layers >= k n_spheres.
  const auto first = [&](std::uint64_t k) { return (k * n_spheres + n_layers - 1) / n_layers; };
  for (std::uint32_t k = 0; k < n_layers; ++k) sizes[k] = first(k + 1) - first(k);
  return sizes;
}

std::vector<double> motion_values(const MotionSettings& settings, std::span<const Vec3> reference,
                                  std::span<const Vec3> now, std::span<const std::uint32_t> layers,
                                  std::span<const std::uint32_t> kinds) {
  assert(reference.size() == now.size() && layers.size() == now.size());
  const std::vector<double>& lengths = settings.overlap_lengths;
  Sums bed(lengths.size());
  std::vector<Sums> of_layers(settings.layers, Sums(lengths.size()));
  for (std::size_t i = 0; i < now.size(); ++i) {
    of_layers[layers[i]].add(components(now[i] - reference[i]), lengths);
  }
  for (const Sums& layer : of_layers) bed += layer;
  for (std::size_t i = 0; i < now.size(); ++i) {
    bed.add_about_mean(now[i].z - reference[i].z);
    of_layers[layers[i]].add_about_mean(now[i].z - reference[i].z);
  }
  std::vector<double> values;  // in the order of motion_quantities
  append(values, bed.steps, bed.n);
  append(values, bed.squares, bed.n);
  append(values, {{bed.lateral_quartic, bed.vertical_quartic}}, bed.n);
  append(values, bed.lateral_overlap, bed.n);
  append(values, bed.overlap, bed.n);
  for (const Sums& layer : of_layers) values.push_back(layer.steps[2] / layer.n);
  for (const Sums& layer : of_layers) append(values, layer.squares, layer.n);
  for (const Sums& layer : of_layers) values.push_back(layer.lateral_quartic / layer.n);
  for (const Sums& layer : of_layers) values.push_back(layer.vertical_quartic / layer.n);
  for (const Sums& layer : of_layers) append(values, layer.lateral_overlap, layer.n);
  for (const Sums& layer : of_layers) append(values, layer.overlap, layer.n);
  append_kinds(settings, reference, now, kinds, values);
  return values;
}

void follow_motion(const MotionSettings& settings, const Packing& bed, std::uint64_t tap,
                   MotionState& state) {
  const auto begin_origin = [&](std::uint64_t waiting_time) {
    if (std::ranges::binary_search(settings.origins, waiting_time) &&
        (state.origins.empty() || state.origins.back().tap < waiting_time))
      state.origins.push_back({waiting_time, state.unwrapped, {}});
  };
  if (tap == 0) {
    state = {};
    state.unwrapped = bed.centres;
  } else {
    begin_origin(tap - 1);  // chosen after the run had stopped at it
  }
  unwrap(bed, state);
  std::span<const std::uint32_t> kinds;
  if (settings.kinds > 0) kinds = bed.sizes->kind_of();
  for (MotionOrigin& origin : state.origins) {
    if (!std::ranges::binary_search(settings.lags, tap - origin.tap)) continue;
    const std::vector<double> values =
        motion_values(settings, origin.centres, state.unwrapped,
                      layers_of(heights_of(origin.centres, bed.container), settings.layers), kinds);
    origin.values.insert(origin.values.end(), values.begin(), values.end());
  }
  begin_origin(tap);
}

}  // namespace jostle::inline ensemble
