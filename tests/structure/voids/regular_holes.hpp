#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"

// Bernal's holes alone between walls.
namespace jostle {

inline constexpr double half_root_2 = 0.5 * std::numbers::sqrt2;

// Corners of the regular holes, edges 1, somewhere about the origin.

inline std::vector<Vec3> tetrahedron() {
  return {{0, 0, 0},
          {half_root_2, half_root_2, 0},
          {half_root_2, 0, half_root_2},
          {0, half_root_2, half_root_2}};
}

inline std::vector<Vec3> half_octahedron() {
  return {{half_root_2, 0, 0},
          {0, half_root_2, 0},
          {-half_root_2, 0, 0},
          {0, -half_root_2, 0},
          {0, 0, half_root_2}};
}

inline std::vector<Vec3> octahedron() {
  auto corners = half_octahedron();
  corners.push_back({0, 0, -half_root_2});
  return corners;
}

inline std::vector<Vec3> prism() {
  const double height = 0.5 * std::numbers::sqrt3;
  return {{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, height, 1}};
}

inline std::vector<Vec3> antiprism() {
  const double height = std::pow(2.0, -0.25);
  return {{0.5, 0.5, 0},
          {-0.5, 0.5, 0},
          {-0.5, -0.5, 0},
          {0.5, -0.5, 0},
          {half_root_2, 0, height},
          {0, half_root_2, height},
          {-half_root_2, 0, height},
          {0, -half_root_2, height}};
}

// Snub disphenoid: q is the root of 2 q^3 + 11 q^2 + 4 q = 1.
inline std::vector<Vec3> dodecahedron() {
  const double q = 0.16902222942417583;
  const double r = 0.5 * std::sqrt(q), s = 0.5 * std::sqrt((1 - q) / (2 * q)), t = 4 * r * s;
  return {{t, r, 0},    {-t, r, 0},    {0, -r, t},  {0, -r, -t},
          {0.5, -s, 0}, {-0.5, -s, 0}, {0, s, 0.5}, {0, s, -0.5}};
}

inline Packing within_walls(const std::vector<Vec3>& corners) {
  Packing packing{WalledBox{10, 10}, {}};
  for (const Vec3 r : corners) packing.centres.push_back(r + Vec3{5, 5, 5});
  return packing;
}

// Every coordinate displaced by up to `amplitude`, turned by nothing: another stream a trial.
inline Packing shaken(Packing packing, double amplitude, std::uint64_t trial) {
  RandomStream random(stream_key(71, 0, trial, Purpose::start));
  for (Vec3& r : packing.centres) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    r = r + amplitude * Vec3{2 * x - 1, 2 * y - 1, 2 * z - 1};
  }
  return packing;
}

}  // namespace jostle
