#pragma once

#include <cstdint>
#include <vector>

#include "engine/container.hpp"
#include "engine/large_pages.hpp"
#include "engine/vec3.hpp"

// The arithmetic of engine/geometry.hpp for the trial loop: x and y side by side in one register
// and no branches. It gives the same numbers, bit for bit (a zero may differ in its sign); the
// trial loop is tested against the plain functions.
namespace jostle {

/// Two lateral coordinates, in one SSE2 register.
using Pair = double __attribute__((vector_size(16), may_alias));

/// A centre ready for the loop: aligned, half a cache line.
struct alignas(32) PackedCentre {
  Pair xy;
  double z, unused;
};

using PackedCentres = std::vector<PackedCentre, LargePageAllocator<PackedCentre>>;

inline PackedCentre packed(Vec3 r) {
  return {Pair{r.x, r.y}, r.z, 0};
}
inline Vec3 unpacked(const PackedCentre& r) {
  return {r.xy[0], r.xy[1], r.z};
}

namespace packed_geometry {

/// `values` where the mask is set, else zero.
template <class Mask>
inline Pair where(Mask mask, Pair values) {
  using Bits = std::int64_t __attribute__((vector_size(16)));
  return (Pair)((Bits)mask & (Bits)values);
}

inline Pair wrap(Pair r, Pair width) {
  r += where(r < 0, width);
  return r - where(r >= width, width);
}

inline Pair nearest_image(Pair d, Pair width) {
  const Pair half = 0.5 * width;
  return d - (where(d > half, width) - where(d < -half, width));
}

inline bool both(Pair low, Pair high) {
  const auto inside = low <= high;
  return (inside[0] & inside[1]) != 0;
}

}  // namespace packed_geometry

/// A container with its constants laid out for the loop.
template <class Box>
struct PackedBox;

/// Free lateral space: what walled boxes and cylinders share.
struct PackedOpenBox {
  static PackedCentre wrapped(PackedCentre r) { return r; }
  static Pair lateral(Pair d) { return d; }
  static double vertical(double d) { return d; }
};

template <>
struct PackedBox<PeriodicBox> {
  Pair width;
  explicit PackedBox(const PeriodicBox& box) : width{box.width_x, box.width_y} {}
  PackedCentre wrapped(PackedCentre r) const {
    return {packed_geometry::wrap(r.xy, width), r.z, 0};
  }
  Pair lateral(Pair d) const { return packed_geometry::nearest_image(d, width); }
  static double vertical(double d) { return d; }
  static bool clear_of_boundaries(const PackedCentre& r) { return r.z >= sphere_radius; }
};

template <>
struct PackedBox<WalledBox> : PackedOpenBox {
  Pair low = {sphere_radius, sphere_radius}, high;
  explicit PackedBox(const WalledBox& box)
      : high{box.width_x - sphere_radius, box.width_y - sphere_radius} {}
  bool clear_of_boundaries(const PackedCentre& r) const {
    return r.z >= sphere_radius && packed_geometry::both(low, r.xy) &&
           packed_geometry::both(r.xy, high);
  }
};

template <>
struct PackedBox<Cylinder> : PackedOpenBox {
  Pair axis;
  double reach;
  explicit PackedBox(const Cylinder& tube)
      : axis{0.5 * tube.diameter, 0.5 * tube.diameter},
        reach(0.5 * tube.diameter - sphere_radius) {}
  bool clear_of_boundaries(const PackedCentre& r) const {
    const Pair d = r.xy - axis;
    return r.z >= sphere_radius && d[0] * d[0] + d[1] * d[1] <= reach * reach;
  }
};

template <>
struct PackedBox<FullyPeriodicBox> {
  Pair width;
  double height;
  explicit PackedBox(const FullyPeriodicBox& box)
      : width{box.width_x, box.width_y}, height(box.height) {}
  PackedCentre wrapped(PackedCentre r) const {
    return {packed_geometry::wrap(r.xy, width),
            packed_geometry::wrap(Pair{r.z, 0}, Pair{height, 1})[0], 0};
  }
  Pair lateral(Pair d) const { return packed_geometry::nearest_image(d, width); }
  double vertical(double d) const {
    return packed_geometry::nearest_image(Pair{d, 0}, Pair{height, 1})[0];
  }
  static bool clear_of_boundaries(const PackedCentre&) { return true; }
};

/// Squared distance of two centres, to the nearest image.
template <class Box>
inline double distance_squared(const PackedBox<Box>& box, const PackedCentre& a,
                               const PackedCentre& b) {
  const Pair d = box.lateral(a.xy - b.xy);
  const double dz = box.vertical(a.z - b.z);
  const Pair squares = d * d;
  return squares[0] + squares[1] + dz * dz;
}

}  // namespace jostle
