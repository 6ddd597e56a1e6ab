#pragma once

#include <stdexcept>

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
          for (const Vec3& other : packing.centres) {
            if (overlaps(box, r, other)) return false;
          }
          return true;
        },
        container);
    if (free) packing.centres.push_back(r);
  }
  return packing;
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
