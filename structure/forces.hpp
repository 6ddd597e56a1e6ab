#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bed/bed_mechanics.hpp"
#include "engine/bed/packing.hpp"

// Forces and temperatures from the contacts and the velocities of a bed.
namespace jostle::inline structure {

/// Sum over contacts of arm (x) force, m g d: element 3 a + b is arm a times force b, a and b being
/// x, y, z. The arm reaches from the contact to the centre on which the force acts, so that the
/// diagonal is positive under pressure; divided by a volume it is the stress. Symmetric where no
/// sphere is turned faster or slower.
using ForceMoment = std::array<double, 9>;

/// Normal and tangential force of a wall on the bed.
struct WallForce {
  double normal = 0;  // sum of the normal forces, m g
  Vec3 friction;      // sum of the tangential forces, m g
  bool operator==(const WallForce&) const = default;
};

struct BedForces {
  ForceMoment moment{};          // sum over all contacts
  std::vector<WallForce> walls;  // forces of wall_names()
  bool operator==(const BedForces&) const = default;
};

/// Forces of a packing and its contacts.
BedForces bed_forces(const Packing& packing, std::span<const Contact> contacts);

/// Force moments of each sphere, [n_spheres]: that of the bed is their sum. The contact of two
/// spheres divides the line of their centres in the ratio of their radii. `sizes`: null for equal
/// spheres.
std::vector<ForceMoment> force_moments(std::span<const Contact> contacts, std::uint32_t n_spheres,
                                       const Sizes* sizes = nullptr);

/// Variance of the velocities about their mean, in bins of height as those of height_histogram:
/// lateral is half of the variances along x and y together. (diameters / s)^2, up to the highest
/// bin with two spheres; NaN in bins with fewer. Unbiased: divided by one less than the spheres.
struct GranularTemperature {
  std::vector<double> lateral, vertical;  // [n_bins]
};
GranularTemperature granular_temperature(const Packing& packing, std::span<const Vec3> velocities,
                                         double bin_width = 0.1);

}  // namespace jostle::inline structure
