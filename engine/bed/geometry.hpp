#pragma once

#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"

// The one arithmetic by which positions are wrapped and compared. Whatever decides or checks an
// overlap uses these functions, so that a stored packing is judged by the very numbers that made
// it.
namespace jostle::inline engine {

/// A coordinate within one period of [0, width) brought into it. -5e-17 becomes 0, not width.
inline double wrap_coordinate(double x, double width) {
  if (x < 0) x += width;
  if (x >= width) x -= width;
  return x;
}

/// The difference of two wrapped coordinates, to the nearest image.
inline double nearest_image(double dx, double width) {
  if (dx > 0.5 * width) return dx - width;
  if (dx < -0.5 * width) return dx + width;
  return dx;
}

inline Vec3 wrapped(const PeriodicBox& box, Vec3 r) {
  return {wrap_coordinate(r.x, box.width_x), wrap_coordinate(r.y, box.width_y), r.z};
}
inline Vec3 wrapped(const FullyPeriodicBox& box, Vec3 r) {
  return {wrap_coordinate(r.x, box.width_x), wrap_coordinate(r.y, box.width_y),
          wrap_coordinate(r.z, box.height)};
}
inline Vec3 wrapped(const WalledBox&, Vec3 r) {
  return r;
}
inline Vec3 wrapped(const Cylinder&, Vec3 r) {
  return r;
}

/// The shortest vector from b to a.
inline Vec3 separation(const PeriodicBox& box, Vec3 a, Vec3 b) {
  return {nearest_image(a.x - b.x, box.width_x), nearest_image(a.y - b.y, box.width_y), a.z - b.z};
}
inline Vec3 separation(const FullyPeriodicBox& box, Vec3 a, Vec3 b) {
  return {nearest_image(a.x - b.x, box.width_x), nearest_image(a.y - b.y, box.width_y),
          nearest_image(a.z - b.z, box.height)};
}
inline Vec3 separation(const WalledBox&, Vec3 a, Vec3 b) {
  return a - b;
}
inline Vec3 separation(const Cylinder&, Vec3 a, Vec3 b) {
  return a - b;
}

/// Whether a sphere centred at r stays clear of the floor and the sides (touching is clear).
inline bool clear_of_boundaries(const PeriodicBox&, Vec3 r) {
  return r.z >= sphere_radius;
}
inline bool clear_of_boundaries(const FullyPeriodicBox&, Vec3) {
  return true;
}
inline bool clear_of_boundaries(const WalledBox& box, Vec3 r) {
  return r.z >= sphere_radius && r.x >= sphere_radius && r.x <= box.width_x - sphere_radius &&
         r.y >= sphere_radius && r.y <= box.width_y - sphere_radius;
}
inline bool clear_of_boundaries(const Cylinder& tube, Vec3 r) {
  const double axis = 0.5 * tube.diameter;
  const double dx = r.x - axis, dy = r.y - axis, reach = axis - sphere_radius;
  return r.z >= sphere_radius && dx * dx + dy * dy <= reach * reach;
}

/// Whether two spheres overlap (touching is no overlap).
template <class Box>
bool overlaps(const Box& box, Vec3 a, Vec3 b) {
  return norm_squared(separation(box, a, b)) < 1.0;
}

}  // namespace jostle::inline engine
