#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"
#include "engine/monte_carlo/kernel/four_floats.hpp"
#include "engine/monte_carlo/kernel/packed_centre.hpp"

// The arithmetic of engine/bed/geometry.hpp for the trial loop: x and y side by side in one
// register and no branches. It gives the same numbers, bit for bit (a zero may differ in its sign);
// the trial loop is tested against the plain functions.
namespace jostle::inline engine {

namespace packed_geometry {

/// `values` where the mask is set, else zero.
template <class Mask>
inline Pair masked(Mask mask, Pair values) {
  using Bits = std::int64_t __attribute__((vector_size(16)));
  return (Pair)((Bits)mask & (Bits)values);
}

inline Pair wrap(Pair r, Pair width) {
  r += masked(r < 0, width);
  return r - masked(r >= width, width);
}

inline Pair nearest_image(Pair d, Pair width) {
  const Pair half = 0.5 * width;
  return d - (masked(d > half, width) - masked(d < -half, width));
}

inline bool are_ordered(Pair low, Pair high) {
  const auto inside = low <= high;
  return (inside[0] & inside[1]) != 0;
}

// Added to every room to floor and sides in single precision, so that it is never too small for
// steps below 10 diameters.
inline constexpr float room_margin = 2e-6f;

inline float room(double exact) {
  return static_cast<float>(std::max(exact, 0.0)) + room_margin;
}
inline float room_below(const PackedCentre& r) {
  return room(r.z - sphere_radius);
}

/// Room to the nearer of two walls, negative if that is the lower one.
inline float room_between(double low, double height, double high) {
  return height - low < high - height ? -room(height - low) : room(high - height);
}

}  // namespace packed_geometry

// The parts of a box, each chosen by its shape. The room of a sphere is what a step has to floor
// and sides, in a form that `leaves` understands: true if a step certainly ends outside.

/// Along x and y. A direction that is not periodic has the period 0, which leaves it as it is.
template <bool periodic>
struct PackedPeriods {
  Pair width;
  PackedPeriods(ContainerShape shape, Vec3 extent)
      : width{shape.periodic_x ? extent.x : 0, shape.periodic_y ? extent.y : 0} {}
  Pair wrapped_lateral(Pair r) const { return packed_geometry::wrap(r, width); }
  Pair lateral(Pair d) const { return packed_geometry::nearest_image(d, width); }
};
template <>
struct PackedPeriods<false> {
  PackedPeriods(ContainerShape, Vec3) {}
  static Pair wrapped_lateral(Pair r) { return r; }
  static Pair lateral(Pair d) { return d; }
};

/// Along z.
template <bool periodic>
struct PackedHeight {
  double height;
  explicit PackedHeight(Vec3 extent) : height(extent.z) {}
  double wrapped_vertical(double z) const {
    return packed_geometry::wrap(Pair{z, 0}, Pair{height, 1})[0];
  }
  double vertical(double d) const {
    return packed_geometry::nearest_image(Pair{d, 0}, Pair{height, 1})[0];
  }
};
template <>
struct PackedHeight<false> {
  explicit PackedHeight(Vec3) {}
  static double wrapped_vertical(double z) { return z; }
  static double vertical(double d) { return d; }
};

enum class PackedSides { none, floor, floor_and_planes, floor_and_tube };

constexpr PackedSides packed_sides(ContainerShape shape) {
  if (shape.tube) return PackedSides::floor_and_tube;
  if (shape.has_walls()) return PackedSides::floor_and_planes;
  return shape.has_floor() ? PackedSides::floor : PackedSides::none;
}

/// Room to the face that is nearest, and the unit normal towards it.
struct FaceAhead {
  double room = std::numeric_limits<double>::infinity();
  Vec3 normal{};

  void see(double other_room, Vec3 other_normal) {
    if (other_room < room) *this = {other_room, other_normal};
  }
};

template <PackedSides sides, class Spheres>
struct PackedFaces;

template <class Spheres>
struct PackedFaces<PackedSides::none, Spheres> {
  PackedFaces(ContainerShape, Vec3) {}
  static bool clear_of_boundaries(const PackedCentre&) { return true; }
  static FaceAhead nearest_face(const PackedCentre&) { return {}; }
  static Lanes room(const PackedCentre&) { return Lanes{}; }
  static bool leaves(const Lanes&, float, float, float) { return false; }
};

template <class Spheres>
struct PackedFaces<PackedSides::floor, Spheres> {
  PackedFaces(ContainerShape, Vec3) {}
  static bool clear_of_boundaries(const PackedCentre& r) { return r.z >= Spheres::radius(r); }
  static FaceAhead nearest_face(const PackedCentre& r) {
    return {r.z - Spheres::radius(r), {0, 0, -1}};
  }
  static Lanes room(const PackedCentre& r) {
    return Lanes{0, 0, packed_geometry::room_below(r), 0};
  }
  static bool leaves(const Lanes& room, float, float, float dz) { return dz < -room[2]; }
};

/// A direction without planes has room for ever.
template <class Spheres>
struct PackedFaces<PackedSides::floor_and_planes, Spheres> {
  Pair low, high;
  PackedFaces(ContainerShape shape, Vec3 extent)
      : low{shape.planes_x() ? Spheres::known_radius : -endless,
            shape.planes_y() ? Spheres::known_radius : -endless},
        high{shape.planes_x() ? extent.x - Spheres::known_radius : endless,
             shape.planes_y() ? extent.y - Spheres::known_radius : endless} {}
  bool clear_of_boundaries(const PackedCentre& r) const {
    return r.z >= Spheres::radius(r) &&
           packed_geometry::are_ordered(Spheres::raised(low, r), r.xy) &&
           packed_geometry::are_ordered(r.xy, Spheres::lowered(high, r));
  }
  FaceAhead nearest_face(const PackedCentre& r) const {
    const Pair room_low = r.xy - Spheres::raised(low, r),
               room_high = Spheres::lowered(high, r) - r.xy;
    FaceAhead nearest{r.z - Spheres::radius(r), {0, 0, -1}};
    nearest.see(room_low[0], {-1, 0, 0});
    nearest.see(room_high[0], {1, 0, 0});
    nearest.see(room_low[1], {0, -1, 0});
    nearest.see(room_high[1], {0, 1, 0});
    return nearest;
  }
  Lanes room(const PackedCentre& r) const {
    return Lanes{packed_geometry::room_between(low[0], r.xy[0], high[0]),
                 packed_geometry::room_between(low[1], r.xy[1], high[1]),
                 -packed_geometry::room_below(r), 1};
  }
  static bool leaves(const Lanes& room, float dx, float dy, float dz) {
    using Bits = std::int32_t __attribute__((vector_size(16)));
    const Bits side = (Bits)room & std::int32_t(0x80000000);
    const Lanes towards = (Lanes)((Bits)Lanes{dx, dy, dz, 0} ^ side);
    return any_of_four(towards > (Lanes)((Bits)room ^ side));
  }

 private:
  static constexpr double endless = std::numeric_limits<double>::infinity();
};

template <class Spheres>
struct PackedFaces<PackedSides::floor_and_tube, Spheres> {
  Pair axis;
  double reach;  // reach of centres from the axis, but for what is unknown of the radius
  PackedFaces(ContainerShape, Vec3 extent)
      : axis{0.5 * extent.x, 0.5 * extent.x}, reach(0.5 * extent.x - Spheres::known_radius) {}
  bool clear_of_boundaries(const PackedCentre& r) const {
    const Pair d = r.xy - axis;
    const double own = Spheres::lowered(Pair{reach, reach}, r)[0];
    return r.z >= Spheres::radius(r) && d[0] * d[0] + d[1] * d[1] <= own * own;
  }
  FaceAhead nearest_face(const PackedCentre& r) const {
    const Pair d = r.xy - axis;
    const double from_axis = std::sqrt(d[0] * d[0] + d[1] * d[1]);
    FaceAhead nearest{r.z - Spheres::radius(r), {0, 0, -1}};
    if (from_axis > 0) {
      nearest.see(Spheres::lowered(Pair{reach, reach}, r)[0] - from_axis,
                  {d[0] / from_axis, d[1] / from_axis, 0});
    }
    return nearest;
  }
  // The outward normal, the room below and the room along the normal.
  Lanes room(const PackedCentre& r) const {
    const Pair d = r.xy - axis;
    const double radius = std::sqrt(d[0] * d[0] + d[1] * d[1]);
    const Pair normal = radius > 0 ? d / radius : Pair{0, 0};
    return Lanes{static_cast<float>(normal[0]), static_cast<float>(normal[1]),
                 packed_geometry::room_below(r), packed_geometry::room(reach - radius)};
  }
  static bool leaves(const Lanes& room, float dx, float dy, float dz) {
    return (room[0] * dx + room[1] * dy > room[3]) | (dz < -room[2]);
  }
};

template <class Box>
using PeriodsOf = PackedPeriods<Box::shape().periodic_x || Box::shape().periodic_y>;
template <class Box>
using HeightOf = PackedHeight<Box::shape().periodic_z>;
template <class Box, class Spheres>
using FacesOf = PackedFaces<packed_sides(Box::shape()), Spheres>;

/// A container with its constants laid out for the loop.
template <class Box, class Spheres = EqualSpheres>
struct PackedBox : PeriodsOf<Box>, HeightOf<Box>, FacesOf<Box, Spheres> {
  explicit PackedBox(const Box& box)
      : PeriodsOf<Box>(box.shape(), box.extent()),
        HeightOf<Box>(box.extent()),
        FacesOf<Box, Spheres>(box.shape(), box.extent()) {}

  PackedCentre wrapped(PackedCentre r) const {
    return {this->wrapped_lateral(r.xy), this->wrapped_vertical(r.z), r.radius};
  }
};

/// Squared distance of two centres, to the nearest image.
template <class Box, class Spheres>
inline double distance_squared(const PackedBox<Box, Spheres>& box, const PackedCentre& a,
                               const PackedCentre& b) {
  const Pair d = box.lateral(a.xy - b.xy);
  const double dz = box.vertical(a.z - b.z);
  const Pair squares = d * d;
  return squares[0] + squares[1] + dz * dz;
}

}  // namespace jostle::inline engine
