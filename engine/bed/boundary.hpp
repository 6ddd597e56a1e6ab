#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "engine/bed/container.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/vec3.hpp"

namespace jostle::inline engine {

/// Where a container ends, as everything but the typed trial loops asks: made from it once, so that
/// nobody else looks which container it is. Lengths in diameters.
struct Boundary : ContainerShape {
  double width_x = 0, width_y = 0;  // width x of the box around the footprint
  double height = std::numeric_limits<double>::infinity();  // infinite under an open top

  explicit Boundary(const Container& container);

  const ContainerShape& shape() const { return *this; }
  Vec3 extent() const { return {width_x, width_y, height}; }
  bool periodic_sides() const { return periodic_x && periodic_y; }
  /// Periods in x, y and z; 0 where it is not periodic.
  Vec3 periods() const {
    return {periodic_x ? width_x : 0, periodic_y ? width_y : 0, periodic_z ? height : 0};
  }
  /// How far centres stay away from the box's sides along x and along y: a radius, or 0 where it is
  /// periodic.
  double margin_x() const { return periodic_x ? 0 : sphere_radius; }
  double margin_y() const { return periodic_y ? 0 : sphere_radius; }
  /// The place of a tube's axis in x and in y, which is its radius.
  double axis() const { return 0.5 * width_x; }
};

/// The floor or a side: a plane, or the inside of a vertical tube.
struct Face {
  const char* name;  // "floor", "x_min", "x_max", "y_min", "y_max" or "tube"
  Vec3 inward;       // unit normal of a plane into the container; zero for a tube
  double place =
      0;  // distance of the origin from a plane; for a tube its radius, and the place of its axis
  bool is_tube = false;

  /// How far a point is from a face (negative outside), and the unit normal into the container
  /// where the face is nearest; the normal is zero on a tube's axis.
  struct Nearest {
    double distance;
    Vec3 normal;
  };

  Nearest nearest(Vec3 r) const {
    if (!is_tube) return {dot(inward, r) + place, inward};
    const double x = r.x - place, y = r.y - place;
    const double from_axis = std::sqrt(x * x + y * y);
    const double inverse = from_axis > 0 ? 1 / from_axis : 0;
    return {place - from_axis, {-x * inverse, -y * inverse, 0}};
  }
  double distance(Vec3 r) const { return nearest(r).distance; }
  Vec3 normal(Vec3 r) const { return nearest(r).normal; }
  /// How fast a point at r with velocity v goes away from the face.
  double recession(Vec3 r, Vec3 v) const;
};

/// The faces of a container, the floor first if there is one: a sphere's contacts name them by
/// their place here.
class Faces {
 public:
  explicit Faces(const Boundary& boundary);

  const Face* begin() const { return faces_.data(); }
  const Face* end() const { return faces_.data() + size_; }
  std::size_t size() const { return size_; }
  const Face& operator[](std::size_t k) const { return faces_[k]; }

 private:
  void add(const Face& face) { faces_.at(size_++) = face; }

  std::array<Face, most_faces> faces_{};
  std::size_t size_ = 0;
};

/// Area of the part of the footprint at least `from_sides` away from walls.
double footprint_area(const Boundary& boundary, double from_sides);

/// True if (x, y) is at least `from_sides` away from walls.
bool in_footprint(const Boundary& boundary, Vec3 r, double from_sides);

/// Brings r, any number of periods away, into the box.
Vec3 into_periods(const Boundary& boundary, Vec3 r);

/// How deep a sphere centred at r reaches into the floor or a side; negative or 0 where it is clear
/// of them.
double boundary_depth(const Boundary& boundary, Vec3 r);

/// The names of the faces that a sphere can lean on, by number. A fully periodic container has
/// none.
std::vector<std::string> wall_names(const Container& container);

}  // namespace jostle::inline engine
