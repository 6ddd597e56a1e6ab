#pragma once

#include <cstdint>
#include <vector>

#include "engine/bed/vec3.hpp"

// Velocities, forces and contacts in a bed, in addition to positions.
namespace jostle::inline engine {

/// Two spheres, or a sphere and a wall, that act on each other. On `first` acts normal_force x
/// normal + tangential_force, on `second` the opposite.
struct Contact {
  std::uint32_t first = 0;
  std::uint32_t second = 0;  // a later sphere, or n_spheres + w: wall w of wall_names()
  double overlap = 0;        // diameters, positive
  double normal_force = 0;   // m g; positive where they press on each other
  Vec3 normal{};             // normal of length 1, from `second` to `first`
  Vec3 tangential_force{};   // m g, along the tangent plane
  bool operator==(const Contact&) const = default;
};

/// A bed while its floor moves, by height above the floor, over the whole of the motion.
struct DrivenBed {
  std::vector<double> fraction;  // [n_bins] of all centres, the mean over time
  /// Granular temperature, (diameters / s)^2: variance of the velocities about the mean of the bin
  /// at that time, unbiased; lateral is half of the variances along x and y together. NaN in bins
  /// that never held two spheres, and none above the highest that did.
  std::vector<double> lateral, vertical;
};

/// State of a bed at the time of its positions.
struct BedMechanics {
  std::vector<Vec3> velocities;   // [n_spheres], diameters / s; empty where nothing has any
  std::vector<Vec3> spins;        // [n_spheres], rad / s; empty where nothing turns
  std::vector<Contact> contacts;  // with force, by (first, second)
  DrivenBed driven;  // state of a tap whose motion was watched (Dynamics::watch_motion)
};

}  // namespace jostle::inline engine
