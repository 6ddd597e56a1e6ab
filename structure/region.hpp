#pragma once

#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"

namespace jostle::inline structure {

/// Part of a container: between two heights, at least `from_sides` away from the walls (counted
/// from the walls themselves; without effect where sides are periodic).
struct Region {
  double low = 0, high = 0, from_sides = 0;
  bool contains(const Container& container, Vec3 r) const;
  /// Diameters cubed.
  double volume(const Container& container) const;
  bool operator==(const Region&) const = default;
};

}  // namespace jostle::inline structure
