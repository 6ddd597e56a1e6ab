#pragma once

#include <limits>

#include "engine/bed/container.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/vec3.hpp"

namespace jostle::inline engine {

/// Sides that are obstacles.
enum class Sides { none, walls, cylinder };

/// Where a container ends, as everything but the typed trial loops asks: made from it once, so that
/// nobody else looks which container it is. Lengths in diameters.
struct Boundary {
  bool periodic_x = false, periodic_y = false, periodic_z = false;
  bool floor = true;  // at z = 0, under an open top; then there is gravity. False: periodic_z
  Sides sides = Sides::none;
  double width_x = 0, width_y = 0;                          // of the box around the footprint
  double height = std::numeric_limits<double>::infinity();  // infinite under an open top

  explicit Boundary(const Container& container);

  bool has_walls() const { return sides != Sides::none; }
  bool periodic_sides() const { return periodic_x && periodic_y; }
  /// Periods in x, y and z; 0 where it is not periodic.
  Vec3 periods() const {
    return {periodic_x ? width_x : 0, periodic_y ? width_y : 0, periodic_z ? height : 0};
  }
  /// How far centres stay away from the box's sides: a radius, or 0 where it is periodic.
  double side_margin() const { return has_walls() ? sphere_radius : 0; }
  /// Of a cylinder: where its axis stands in x and in y, which is its radius.
  double axis() const { return 0.5 * width_x; }
};

/// Brings r, at most one period away, into the box (engine/bed/geometry.hpp).
inline Vec3 wrapped(const Boundary& boundary, Vec3 r) {
  if (boundary.periodic_x) r.x = wrap_coordinate(r.x, boundary.width_x);
  if (boundary.periodic_y) r.y = wrap_coordinate(r.y, boundary.width_y);
  if (boundary.periodic_z) r.z = wrap_coordinate(r.z, boundary.height);
  return r;
}

/// Brings r, any number of periods away, into the box.
Vec3 into_periods(const Boundary& boundary, Vec3 r);

/// The shortest vector from b to a, both wrapped.
inline Vec3 separation(const Boundary& boundary, Vec3 a, Vec3 b) {
  Vec3 d = a - b;
  if (boundary.periodic_x) d.x = nearest_image(d.x, boundary.width_x);
  if (boundary.periodic_y) d.y = nearest_image(d.y, boundary.width_y);
  if (boundary.periodic_z) d.z = nearest_image(d.z, boundary.height);
  return d;
}

/// Whether a sphere centred at r stays clear of floor and sides (touching is clear).
bool clear_of_boundaries(const Boundary& boundary, Vec3 r);

/// How deep a sphere centred at r reaches into the floor or a side; negative or 0 where it is clear
/// of them.
double boundary_depth(const Boundary& boundary, Vec3 r);

}  // namespace jostle::inline engine
