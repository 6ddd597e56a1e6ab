#pragma once

#include <optional>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/sphere_cells.hpp"

// What a poured sphere can touch. Its centre is a point; it must stay outside the unit balls around
// the other centres, inside the sides and above the floor. Lengths in diameters.
namespace jostle::inline engine {

/// One thing a centre can touch: the gap to it and the direction away from it.
struct Obstacle {
  enum class Kind { sphere, wall, tube };
  Kind kind = Kind::sphere;
  Vec3 at;           // sphere: its centre. wall: unit normal into the container. tube: its axis
  double reach = 0;  // wall: at . centre >= reach. tube: distance from the axis <= reach

  bool operator==(const Obstacle&) const = default;
};

/// Free distance from a centre p to touching; negative where it overlaps.
double gap(const Obstacle& obstacle, Vec3 p);
/// Unit vector at p out of the obstacle.
Vec3 outward(const Obstacle& obstacle, Vec3 p);

/// The spheres poured so far and the sides around them.
class PourBed {
 public:
  /// Requires a container with gravity and legal widths.
  PourBed(const Container& container, std::uint32_t n_spheres);

  /// Brings p, at most one period away, into the box.
  Vec3 wrapped(Vec3 p) const;
  /// All spheres (periodic images, too) whose centre may be within `distance` of p, and all sides.
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
  std::optional<Vec3> above(double share_x, double share_y) const;

  void add(Vec3 centre);
  const std::vector<Vec3>& centres() const { return cells_.centres(); }

 private:
  bool push_out(Vec3& p) const;
  void keep_between_walls(Vec3& p) const;

  Boundary boundary_;
  SphereCells cells_;
  std::vector<Obstacle> walls_;
  std::optional<Obstacle> tube_;
  double top_ = 0;
};

}  // namespace jostle::inline engine
