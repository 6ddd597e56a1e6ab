#include "structure/region.hpp"

#include "engine/bed/boundary.hpp"

namespace jostle::inline structure {

bool Region::contains(const Container& container, Vec3 r) const {
  if (r.z < low || r.z > high) return false;
  return in_footprint(Boundary(container), r, from_sides);
}

double Region::volume(const Container& container) const {
  return (high - low) * footprint_area(Boundary(container), from_sides);
}

}  // namespace jostle::inline structure
