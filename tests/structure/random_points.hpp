#pragma once

#include "engine/bed/geometry.hpp"
#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"

namespace jostle {

/// Points, overlapping or not, at possible centres of spheres, up to the given height.
inline Packing random_points(const Container& container, double height, unsigned n,
                             std::uint64_t seed = 20) {
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  Packing packing{container, {}};
  while (packing.centres.size() < n) {
    const Vec3 point{width_x(container) * random.uniform(), width_y(container) * random.uniform(),
                     height * random.uniform()};
    const bool inside =
        std::visit([&](const auto& box) { return clear_of_boundaries(box, point); }, container);
    if (inside) packing.centres.push_back(point);
  }
  return packing;
}

}  // namespace jostle
