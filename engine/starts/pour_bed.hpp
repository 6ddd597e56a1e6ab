#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/cells/sphere_cells.hpp"
#include "engine/bed/sizes.hpp"

// The obstacles of a poured sphere. Its centre is a point; it must stay outside the balls around
// the other centres, whose radii are the sums of both radii, inside the sides and above the floor.
// Lengths in diameters.
namespace jostle::inline engine {

/// One thing a centre can touch: the gap to it and the direction away from it.
struct Obstacle {
  enum class Kind { sphere, wall, floor, tube };
  Kind kind = Kind::sphere;
  Vec3 anchor;  // sphere: its centre. wall, floor: unit normal into the container. tube: its axis
  // sphere: the distance of centres that touch. wall, floor: at . centre >= reach. tube: distance
  // from the axis <= reach
  double reach = 0;

  bool operator==(const Obstacle&) const = default;
};

/// Free distance from a centre p to touching; negative where it overlaps.
double gap(const Obstacle& obstacle, Vec3 p);
/// Unit vector at p out of the obstacle.
Vec3 outward(const Obstacle& obstacle, Vec3 p);

/// The spheres poured so far and the sides around them, seen by the sphere that is poured next.
class PourBed {
 public:
  /// For equal spheres. Requires a container with gravity and legal widths.
  PourBed(const Container& container, std::uint32_t n_spheres);
  /// For spheres of these sizes; call next() before anything else. Requires widths that are legal
  /// for the largest sphere.
  PourBed(const Container& container, std::shared_ptr<const Sizes> sizes);

  /// Makes `sphere` the one that is poured next.
  void next(std::uint32_t sphere);
  /// Radius of the sphere that is poured next: the height of its centre on the floor.
  double radius() const { return radius_; }
  /// The length that tolerances are multiples of: the smallest diameter.
  double unit() const { return unit_; }

  /// Brings p, at most one period away, into the box.
  Vec3 wrapped(Vec3 p) const;
  /// All spheres (periodic images, too) to which the gap from p may be at most `distance`, and all
  /// sides; the floor, too, where spheres are poured whose centres may lie lower on it.
  void gather(Vec3 p, double distance, std::vector<Obstacle>& found) const;
  /// Height at which a centre falling straight down from p first touches a sphere that it does not
  /// touch yet; nothing if it reaches the floor.
  std::optional<double> fall(Vec3 p) const;
  /// The curved side, if there is one.
  const std::optional<Obstacle>& tube() const { return tube_; }

  /// Moves p, which touches its supports up to rounding, away from whatever the engine's own
  /// arithmetic finds it to overlap; false if an overlap deeper than `tolerance` remains.
  bool clear(Vec3& p, double tolerance) const;
  /// A place for a centre to fall from: the given shares of the footprint's widths, above every
  /// sphere; nothing if that is outside the sides.
  std::optional<Vec3> drop_point_of_shares(double share_x, double share_y) const;
  /// The place over (x, y) above every sphere; nothing if that is outside the sides.
  std::optional<Vec3> drop_point(double x, double y) const;

  /// Adds the sphere that is poured next at rest.
  void add(Vec3 centre);
  /// In the order in which they were added.
  const std::vector<Vec3>& centres() const { return centres_; }

 private:
  /// Spheres whose radii differ by less than a factor of two, in cells of their own.
  struct Level {
    SphereCells cells;
    double largest_radius = sphere_radius;
    std::vector<double> radii;  // along cells.centres(); empty for equal spheres
  };
  /// Distances at which centres touch: of two equal spheres, known to the compiler.
  struct EqualReach {
    constexpr double operator()(std::uint32_t) const { return 1; }
    constexpr double most() const { return 1; }
  };
  /// Those of the sphere that is poured next from the spheres of a level.
  struct SeveralReach {
    double radius;
    const Level& level;
    double operator()(std::uint32_t index) const { return radius + level.radii[index]; }
    double most() const { return radius + level.largest_radius; }
  };
  template <class Act>
  void for_each_level(const Act& act) const;

  void set_radius(double radius);
  bool push_out(Vec3& p) const;
  void keep_between_walls(Vec3& p) const;
  double height_above_all() const;

  Boundary boundary_;
  std::shared_ptr<const Sizes> sizes_;  // null: equal spheres
  std::vector<Level> levels_;
  std::vector<std::uint32_t> level_of_;  // [n_spheres]; empty for equal spheres
  std::vector<Vec3> centres_;
  std::uint32_t next_ = 0;
  double radius_ = sphere_radius, unit_ = 1;
  std::vector<Obstacle> walls_;
  std::optional<Obstacle> tube_;
  double top_ = 0;
};

}  // namespace jostle::inline engine
