#pragma once

#include <concepts>

#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"

// The one arithmetic by which positions are wrapped and compared. Whatever decides or checks an
// overlap uses these functions, so that a stored packing is judged by the very numbers that made
// it. A container itself (its shape is then known to the compiler) and a Boundary are used alike.
namespace jostle::inline engine {

template <class Box>
concept Shaped = requires(const Box& box) {
  { box.shape() } -> std::convertible_to<ContainerShape>;
  { box.extent() } -> std::convertible_to<Vec3>;
};

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

/// Brings r, at most one period away, into the box.
template <Shaped Box>
Vec3 wrapped(const Box& box, Vec3 r) {
  const Vec3 extent = box.extent();
  if (box.shape().periodic_x) r.x = wrap_coordinate(r.x, extent.x);
  if (box.shape().periodic_y) r.y = wrap_coordinate(r.y, extent.y);
  if (box.shape().periodic_z) r.z = wrap_coordinate(r.z, extent.z);
  return r;
}

/// The shortest vector from b to a, both wrapped.
template <Shaped Box>
Vec3 separation(const Box& box, Vec3 a, Vec3 b) {
  const Vec3 extent = box.extent();
  Vec3 d = a - b;
  if (box.shape().periodic_x) d.x = nearest_image(d.x, extent.x);
  if (box.shape().periodic_y) d.y = nearest_image(d.y, extent.y);
  if (box.shape().periodic_z) d.z = nearest_image(d.z, extent.z);
  return d;
}

/// True if a sphere centred at r stays clear of the floor and the sides (touching is clear).
template <Shaped Box>
bool clear_of_boundaries(const Box& box, Vec3 r, double radius = sphere_radius) {
  const ContainerShape shape = box.shape();
  const Vec3 extent = box.extent();
  const auto is_between = [radius](double coordinate, double width) {
    return coordinate >= radius && coordinate <= width - radius;
  };
  if (shape.has_floor() && !(r.z >= radius)) return false;
  if (shape.planes_x() && !is_between(r.x, extent.x)) return false;
  if (shape.planes_y() && !is_between(r.y, extent.y)) return false;
  if (!shape.tube) return true;
  const double axis = 0.5 * extent.x;
  const double dx = r.x - axis, dy = r.y - axis, reach = axis - radius;
  return dx * dx + dy * dy <= reach * reach;
}

/// True if two spheres overlap (touching is no overlap). `touching` is the sum of their radii.
template <Shaped Box>
bool overlaps(const Box& box, Vec3 a, Vec3 b, double touching = 1) {
  return norm_squared(separation(box, a, b)) < touching * touching;
}

}  // namespace jostle::inline engine
