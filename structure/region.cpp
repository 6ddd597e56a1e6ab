#include "structure/region.hpp"

#include <algorithm>
#include <numbers>

namespace jostle {

bool Region::contains(const Container& container, Vec3 r) const {
  if (r.z < low || r.z > high) return false;
  if (std::holds_alternative<WalledBox>(container)) {
    return r.x >= from_sides && r.x <= width_x(container) - from_sides && r.y >= from_sides &&
           r.y <= width_y(container) - from_sides;
  }
  if (const auto* tube = std::get_if<Cylinder>(&container)) {
    const double axis = 0.5 * tube->diameter, reach = axis - from_sides;
    const double x = r.x - axis, y = r.y - axis;
    return reach >= 0 && x * x + y * y <= reach * reach;
  }
  return true;
}

double Region::volume(const Container& container) const {
  const double depth = high - low;
  if (std::holds_alternative<WalledBox>(container)) {
    return depth * std::max(0.0, width_x(container) - 2 * from_sides) *
           std::max(0.0, width_y(container) - 2 * from_sides);
  }
  if (const auto* tube = std::get_if<Cylinder>(&container)) {
    const double reach = std::max(0.0, 0.5 * tube->diameter - from_sides);
    return depth * std::numbers::pi * reach * reach;
  }
  return depth * footprint_area(container);
}

}  // namespace jostle
