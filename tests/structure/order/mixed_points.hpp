#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"

// Points with sizes, for partial pair correlations.
namespace jostle {

/// Diameters of two kinds: all of one diameter, or drawn about 1 from a lognormal law whose
/// logarithm deviates by 0.3, between 0.5 and 2.
struct MixedSizes {
  std::vector<double> diameters{};
  std::vector<std::uint32_t> kinds{};

  void add(std::uint32_t kind, int n, double diameter) {
    diameters.insert(diameters.end(), static_cast<std::size_t>(n), diameter);
    kinds.insert(kinds.end(), static_cast<std::size_t>(n), kind);
  }
  void add_drawn(std::uint32_t kind, int n, RandomStream& random) {
    for (int i = 0; i < n;) {
      const double normal = std::sqrt(-2 * std::log(1 - random.uniform())) *
                            std::cos(2 * std::numbers::pi * random.uniform());
      const double diameter = std::exp(0.3 * normal);
      if (diameter < 0.5 || diameter > 2) continue;
      add(kind, 1, diameter);
      ++i;
    }
  }
  std::shared_ptr<const Sizes> sizes() const {
    return std::make_shared<const Sizes>(diameters, kinds,
                                         std::vector<SphereKind>{{"first", 1}, {"second", 1}});
  }
};

/// Spheres that overlap or not, each anywhere between the sides up to a height of its lowest point.
/// With `is_hard` none overlaps another.
inline Packing mixed_points(const Container& container, const MixedSizes& sizes, double height,
                            RandomStream& random, bool is_hard = false) {
  const Boundary boundary(container);
  Packing packing{container, {}, sizes.sizes()};
  while (packing.centres.size() < sizes.diameters.size()) {
    const std::size_t i = packing.centres.size();
    const double radius = 0.5 * sizes.diameters[i];
    const Vec3 r{boundary.width_x * random.uniform(), boundary.width_y * random.uniform(),
                 radius + height * random.uniform()};
    bool is_free = clear_of_boundaries(boundary, r, radius);
    for (std::size_t j = 0; is_hard && is_free && j < i; ++j) {
      const double contact = radius + packing.radius(j);
      is_free = norm_squared(separation(boundary, r, packing.centres[j])) >= contact * contact;
    }
    if (is_free) packing.centres.push_back(r);
  }
  return packing;
}

}  // namespace jostle
