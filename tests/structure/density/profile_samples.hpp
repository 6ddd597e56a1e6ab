#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "engine/bed/geometry.hpp"
#include "engine/bed/random.hpp"
#include "engine/starts/starts.hpp"
#include "structure/density/profiles.hpp"

// Profiles by random points, without what is under test.
namespace jostle {

/// A steepest-descent pour.
inline Packing poured(const Container& container, std::uint32_t n, std::uint64_t seed) {
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  return make_start(SteepestDescentPour{}, container, n, random);
}

/// True if a point lies within a sphere.
inline bool is_solid(const Packing& packing, Vec3 point) {
  return std::visit(
      [&](const auto& box) {
        return std::ranges::any_of(packing.centres, [&](Vec3 centre) {
          return norm_squared(separation(box, point, centre)) < 0.25;
        });
      },
      packing.container);
}

/// The sum over bins of the squared differences between a profile and the part of random points
/// that is solid, over the variance of this part. Expected: equal to the number of bins, with the
/// standard deviation sqrt(2 n_bins). `bin_place` gives the place of a point along the profile, NaN
/// outside the container.
inline double misfit_by_sampling(const Packing& packing, const Profile& profile,
                                 HeightWindow window, const std::function<double(Vec3)>& bin_place,
                                 int points) {
  RandomStream random(stream_key(51, 0, 0, Purpose::resampling));
  std::vector<double> hits(profile.size(), 0), numbers(profile.size(), 0);
  for (int i = 0; i < points; ++i) {
    const Vec3 point{width_x(packing.container) * random.uniform(),
                     width_y(packing.container) * random.uniform(),
                     window.low + (window.high - window.low) * random.uniform()};
    const double place = bin_place(point);
    if (!(place >= profile.edges.front() && place < profile.edges.back())) continue;
    const auto next = std::ranges::upper_bound(profile.edges, place);
    const auto k = static_cast<std::size_t>(next - profile.edges.begin()) - 1;
    numbers[k] += 1;
    hits[k] += is_solid(packing, point);
  }
  double misfit = 0;
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const double phi = profile.values[k];
    const double deviation = hits[k] / numbers[k] - phi;
    misfit += deviation * deviation / (phi * (1 - phi) / numbers[k]);
  }
  return misfit;
}

}  // namespace jostle
