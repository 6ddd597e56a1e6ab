#pragma once

#include <vector>

#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"
#include "engine/large_pages.hpp"

// Centres as the trial loop holds them, and the two kinds of spheres that it is compiled for: equal
// ones and several sizes.
namespace jostle::inline engine {

/// Two lateral coordinates, in one register.
using Pair = double __attribute__((vector_size(16), may_alias));

/// Four numbers in single precision, in one register.
using Lanes = float __attribute__((vector_size(16), may_alias));

/// A centre ready for the loop: aligned, half a cache line.
struct alignas(32) PackedCentre {
  Pair xy;
  double z;
  double radius;  // diameters; of several sizes only, else 0 and unread
};

using PackedCentres = std::vector<PackedCentre, LargePageAllocator<PackedCentre>>;

inline PackedCentre packed(Vec3 r) {
  return {Pair{r.x, r.y}, r.z, 0};
}
inline PackedCentre packed_sphere(Vec3 r, double radius) {
  return {Pair{r.x, r.y}, r.z, radius};
}
inline Vec3 unpacked(const PackedCentre& r) {
  return {r.xy[0], r.xy[1], r.z};
}

/// All spheres have diameter 1: nothing is read.
struct EqualSpheres {
  static constexpr bool several = false;
  /// The part of a radius that is known when a container is laid out: all of it.
  static constexpr double known_radius = sphere_radius;
  static Pair raised(Pair low, const PackedCentre&) { return low; }
  static Pair lowered(Pair high, const PackedCentre&) { return high; }
  static double radius(const PackedCentre&) { return sphere_radius; }
  static double touching_squared(const PackedCentre&, const PackedCentre&) { return 1.0; }
};

/// Every centre has its radius with it. (0.5 + 0.5)^2 is exactly 1: with radii of 0.5 the loop
/// makes the bits of equal spheres.
struct SeveralSizes {
  static constexpr bool several = true;
  static constexpr double known_radius = 0;
  static Pair raised(Pair low, const PackedCentre& r) { return low + r.radius; }
  static Pair lowered(Pair high, const PackedCentre& r) { return high - r.radius; }
  static double radius(const PackedCentre& r) { return r.radius; }
  static double touching_squared(const PackedCentre& a, const PackedCentre& b) {
    const double touching = a.radius + b.radius;
    return touching * touching;
  }
};

}  // namespace jostle::inline engine
