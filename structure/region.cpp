#include "structure/region.hpp"

#include <algorithm>
#include <numbers>

#include "engine/bed/boundary.hpp"

namespace jostle::inline structure {

bool Region::contains(const Container& container, Vec3 r) const {
  if (r.z < low || r.z > high) return false;
  const Boundary boundary(container);
  switch (boundary.sides) {
    case Sides::none:
      return true;
    case Sides::walls:
      return r.x >= from_sides && r.x <= boundary.width_x - from_sides && r.y >= from_sides &&
             r.y <= boundary.width_y - from_sides;
    case Sides::cylinder:
      break;
  }
  const double reach = boundary.axis() - from_sides;
  const double x = r.x - boundary.axis(), y = r.y - boundary.axis();
  return reach >= 0 && x * x + y * y <= reach * reach;
}

double Region::volume(const Container& container) const {
  const double depth = high - low;
  const Boundary boundary(container);
  switch (boundary.sides) {
    case Sides::none:
      return depth * footprint_area(container);
    case Sides::walls:
      return depth * std::max(0.0, boundary.width_x - 2 * from_sides) *
             std::max(0.0, boundary.width_y - 2 * from_sides);
    case Sides::cylinder:
      break;
  }
  const double reach = std::max(0.0, boundary.axis() - from_sides);
  return depth * std::numbers::pi * reach * reach;
}

}  // namespace jostle::inline structure
