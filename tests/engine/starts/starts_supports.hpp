#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/packing.hpp"

// Supports of the spheres of a poured packing, found by all pairs and without the code under test.
namespace jostle {

inline constexpr double touch_tolerance = 1e-6;  // diameters

/// Unit vectors from what a sphere touches (spheres, walls; not the floor) to its centre.
inline std::vector<Vec3> contacts(const Packing& packing, std::size_t sphere) {
  std::vector<Vec3> found;
  const Vec3 r = packing.centres[sphere];
  const Boundary boundary(packing.container);
  for (std::size_t neighbour = 0; neighbour < packing.centres.size(); ++neighbour) {
    const double reach = packing.radius(sphere) + packing.radius(neighbour) + touch_tolerance;
    const bool is_far =
        !boundary.periodic_z && std::abs(r.z - packing.centres[neighbour].z) > reach;
    if (neighbour == sphere || is_far) continue;
    const Vec3 offset =
        std::visit([&](const auto& box) { return separation(box, r, packing.centres[neighbour]); },
                   packing.container);
    const double length = std::sqrt(norm_squared(offset));
    if (length < reach) found.push_back((1 / length) * offset);
  }
  const double reach = packing.radius(sphere) + touch_tolerance;
  if (boundary.planes_x() && r.x < reach) found.push_back({1, 0, 0});
  if (boundary.planes_y() && r.y < reach) found.push_back({0, 1, 0});
  if (boundary.planes_x() && r.x > boundary.width_x - reach) found.push_back({-1, 0, 0});
  if (boundary.planes_y() && r.y > boundary.width_y - reach) found.push_back({0, -1, 0});
  if (const auto* tube = std::get_if<Cylinder>(&packing.container)) {
    const double axis = 0.5 * tube->diameter, dx = r.x - axis, dy = r.y - axis;
    const double off_axis = std::sqrt(dx * dx + dy * dy);
    if (off_axis > axis - packing.radius(sphere) - touch_tolerance && off_axis > 0) {
      found.push_back({-dx / off_axis, -dy / off_axis, 0});
    }
  }
  return found;
}

/// True if forces along the contacts, none of them pulling, can carry the sphere's weight: some
/// three of them enclose the vertical, so that the centre's projection lies inside their triangle.
/// Beside a tube two contacts may do, in one plane with the vertical.
inline bool carried(const std::vector<Vec3>& contacts) {
  constexpr double rounding = -1e-5;  // a contact within the touch tolerance may be a near miss
  for (const Vec3& a : contacts) {
    for (const Vec3& b : contacts) {
      const double ab = dot(a, b), rest = 1 - ab * ab;
      if (rest < 1e-9) continue;
      const double on_a = (a.z - ab * b.z) / rest, on_b = (b.z - ab * a.z) / rest;
      const Vec3 left = on_a * a + on_b * b - Vec3{0, 0, 1};
      if (on_a > rounding && on_b > rounding && norm_squared(left) < rounding * rounding)
        return true;
    }
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = i + 1; j < contacts.size(); ++j) {
      for (std::size_t k = j + 1; k < contacts.size(); ++k) {
        const Vec3 bc = cross(contacts[j], contacts[k]), ca = cross(contacts[k], contacts[i]),
                   ab = cross(contacts[i], contacts[j]);
        const double volume = dot(contacts[i], bc);
        if (volume == 0) continue;
        if (bc.z / volume > rounding && ca.z / volume > rounding && ab.z / volume > rounding) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace jostle
