#include "structure/density/sphere_cuts.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace jostle::inline structure {

namespace {

constexpr double radius = sphere_radius;
constexpr double radius_squared = radius * radius;
constexpr double radius_cubed = radius * radius_squared;

// Integral of R^2 - x^2 from 0 to x.
double primitive(double x) {
  return x * (radius_squared - x * x / 3);
}

double root(double x) {
  return std::sqrt(std::max(0.0, x));
}

double clamped(double x) {
  return std::clamp(x, -radius, radius);
}

// One face of the corner (a; b, c): the arc on the plane x = a from the plane y = b, where it is at
// height z_ab, to the plane z = c, where it is at y_ac. Its part of six times the volume.
double face_term(double a, double b, double c, double z_ab, double y_ac) {
  const double arc = std::atan2(z_ab, b) - std::atan2(c, y_ac);
  return a * (c * (y_ac - b) + b * (z_ab - c)) - 3 * primitive(a) * arc;
}

// A corner a, b, c >= 0 within the sphere. By the divergence theorem three times the volume is R
// times the area on the sphere less a, b, c times the areas of the plane faces; the area on the
// sphere follows from its angles and arcs by Gauss and Bonnet.
double volume_beyond_inner_corner(double a, double b, double c) {
  const double z_ab = root(radius_squared - a * a - b * b);
  const double x_bc = root(radius_squared - b * b - c * c);
  const double y_ac = root(radius_squared - a * a - c * c);
  const double angles = std::atan2(radius * z_ab, a * b) + std::atan2(radius * x_bc, b * c) +
                        std::atan2(radius * y_ac, a * c);
  const double faces = face_term(a, b, c, z_ab, y_ac) + face_term(b, c, a, x_bc, z_ab) +
                       face_term(c, a, b, y_ac, x_bc);
  return radius_cubed * (angles - std::numbers::pi) / 3 + faces / 6;
}

}  // namespace

double sphere_volume_beyond(double a, double b) {
  a = clamped(a);
  b = clamped(b);
  // Where the edge of the planes misses the sphere, q = 0 and the angles, 0 or pi, leave what one
  // plane cuts off, all but what both cut off, or nothing.
  const double q = root(radius_squared - a * a - b * b);
  return 2 * radius_cubed / 3 * std::atan2(radius * q, a * b) - primitive(a) * std::atan2(q, b) -
         primitive(b) * std::atan2(q, a) + 2.0 / 3 * a * b * q;
}

double sphere_volume_beyond(Vec3 corner) {
  const double a = clamped(corner.x), b = clamped(corner.y), c = clamped(corner.z);
  if (a == radius || b == radius || c == radius) return 0;
  // Each side of a plane has the rest of the other two; by symmetry the far side is the near
  // side of the mirrored plane.
  if (a < 0) return sphere_volume_beyond(b, c) - sphere_volume_beyond({-a, b, c});
  if (b < 0) return sphere_volume_beyond(a, c) - sphere_volume_beyond({a, -b, c});
  if (c < 0) return sphere_volume_beyond(a, b) - sphere_volume_beyond({a, b, -c});
  if (a * a + b * b + c * c >= radius_squared) return 0;
  return volume_beyond_inner_corner(a, b, c);
}

double sphere_volume_in_box(Vec3 low, Vec3 high) {
  assert(low.x <= high.x && low.y <= high.y && low.z <= high.z);
  const auto between_heights = [&](double x, double y) {
    return sphere_volume_beyond({x, y, low.z}) - sphere_volume_beyond({x, y, high.z});
  };
  return between_heights(low.x, low.y) - between_heights(high.x, low.y) -
         between_heights(low.x, high.y) + between_heights(high.x, high.y);
}

double disc_area_in_strip(double disc_radius, double low, double high) {
  const auto volume_below = [&](double t) {
    const double line = std::clamp(t, -disc_radius, disc_radius);
    const double half_chord = root(disc_radius * disc_radius - line * line);
    return disc_radius * disc_radius * std::atan2(line, half_chord) + line * half_chord;
  };
  return volume_below(high) - volume_below(low);
}

}  // namespace jostle::inline structure
