#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"

// Packings for tests, made without the code under test.
namespace jostle {

/// Non-overlapping random positions by plain rejection, all pairs; up to `height` where there is a
/// floor.
inline Packing random_packing(const Container& container, std::uint32_t n, double height,
                              std::uint64_t seed) {
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  Packing packing{container, {}};
  const auto* bulk = std::get_if<FullyPeriodicBox>(&container);
  for (int attempt = 0; packing.centres.size() < n; ++attempt) {
    if (attempt > 10'000'000) throw std::runtime_error("too dense for random insertion");
    const Vec3 r{width_x(container) * random.uniform(), width_y(container) * random.uniform(),
                 bulk ? bulk->height * random.uniform() : 0.5 + height * random.uniform()};
    const bool free = std::visit(
        [&](const auto& box) {
          if (!clear_of_boundaries(box, r)) return false;
          for (const Vec3& neighbour : packing.centres) {
            if (overlaps(box, r, neighbour)) return false;
          }
          return true;
        },
        container);
    if (free) packing.centres.push_back(r);
  }
  return packing;
}

/// Non-overlapping random positions of spheres of these diameters by plain rejection, all pairs,
/// the largest first; lowest points up to `height` above the floor where there is one.
inline Packing random_mixture(const Container& container, const std::vector<double>& diameters,
                              double height, std::uint64_t seed) {
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  Packing packing{container, std::vector<Vec3>(diameters.size()),
                  std::make_shared<const Sizes>(diameters)};
  const Boundary boundary(container);
  std::vector<std::size_t> order(diameters.size()), placed;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return diameters[i]; });
  for (const std::size_t i : order) {
    const double radius = packing.radius(i);
    for (int attempt = 0; placed.empty() || placed.back() != i; ++attempt) {
      if (attempt > 1'000'000) throw std::runtime_error("too dense for random insertion");
      const double z = random.uniform() * (boundary.periodic_z ? boundary.height : height);
      const Vec3 r{boundary.width_x * random.uniform(), boundary.width_y * random.uniform(),
                   boundary.periodic_z ? z : radius + z};
      const auto meets = [&](std::size_t j) {
        return overlaps(boundary, r, packing.centres[j], radius + packing.radius(j));
      };
      if (!clear_of_boundaries(boundary, r, radius) || std::ranges::any_of(placed, meets)) continue;
      packing.centres[i] = r;
      placed.push_back(i);
    }
  }
  return packing;
}

/// `n` diameters between `smallest` and `ratio` times that, the larger the rarer: both extremes are
/// among them.
inline std::vector<double> graded_diameters(std::uint32_t n, double smallest, double ratio) {
  std::vector<double> diameters;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double rank = (i * 7 % n) / (n - 1.0);  // n is no multiple of 7
    diameters.push_back(smallest * std::pow(ratio, rank * rank * rank));
  }
  return diameters;
}

/// A simple cubic lattice with the given spacing >= 1, n_side^3 spheres, from the corner.
inline Packing cubic_packing(const Container& container, std::uint32_t n_side, double spacing) {
  Packing packing{container, {}};
  for (std::uint32_t k = 0; k < n_side; ++k) {
    for (std::uint32_t j = 0; j < n_side; ++j) {
      for (std::uint32_t i = 0; i < n_side; ++i) {
        packing.centres.push_back({spacing * i, spacing * j, spacing * k + sphere_radius});
      }
    }
  }
  return packing;
}

}  // namespace jostle
