#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "engine/bed/random.hpp"
#include "engine/starts/pour_bed.hpp"
#include "engine/starts/pour_descent.hpp"
#include "tests/engine/starts/starts_supports.hpp"

namespace jostle {
namespace {

// Pushes a centre out of whatever it overlaps, a few rounds.
template <class Box>
Vec3 pushed_out(const Box& box, const std::vector<Vec3>& bed, Vec3 p) {
  for (int round = 0; round < 8; ++round) {
    bool overlapped = false;
    for (const Vec3& centre : bed) {
      if (std::abs(centre.z - p.z) >= 1) continue;
      const Vec3 offset = separation(box, p, centre);
      if (norm_squared(offset) >= 1) continue;
      p = wrapped(box, p + (1 / std::sqrt(norm_squared(offset)) - 1) * offset);
      overlapped = true;
    }
    p.z = std::max(p.z, sphere_radius);
    if constexpr (std::is_same_v<Box, WalledBox>) {
      p.x = std::clamp(p.x, sphere_radius, box.width_x - sphere_radius);
      p.y = std::clamp(p.y, sphere_radius, box.width_y - sphere_radius);
    }
    if constexpr (std::is_same_v<Box, Cylinder>) {
      const double axis = 0.5 * box.diameter, dx = p.x - axis, dy = p.y - axis;
      const double shrink = std::min(1.0, (axis - 0.5) / std::sqrt(dx * dx + dy * dy));
      p.x = axis + shrink * dx;
      p.y = axis + shrink * dy;
    }
    if (!overlapped) break;
  }
  return p;
}

// The path by brute force: small steps down, each followed by pushing out.
template <class Box>
Vec3 creep_down(const Box& box, const std::vector<Vec3>& bed, Vec3 p) {
  constexpr double step = 1e-3;
  constexpr int window = 100;
  for (int i = 0; i < 1000; ++i) {
    const double height = p.z;
    for (int k = 0; k < window; ++k) p = pushed_out(box, bed, {p.x, p.y, p.z - step});
    if (height - p.z < 1e-2 * step * window && (height - p.z < 1e-7 || p.z == sphere_radius)) break;
  }
  return p;
}

// Share of drops for which the two agree on where the sphere rests.
template <class Box>
double agreement(const Box& box) {
  constexpr std::uint32_t n = 120;
  constexpr double near = 0.02;
  RandomStream random(stream_key(5, 0, 0, Purpose::start));
  PourBed bed(box, n);
  int agreed = 0, drops = 0;
  while (bed.centres().size() < n) {
    const double share_x = random.uniform(), share_y = random.uniform();
    const auto start = bed.drop_point_of_shares(share_x, share_y);
    if (!start) continue;
    const auto rest = descend(bed, *start);
    REQUIRE(rest);
    const Vec3 offset = separation(box, *rest, creep_down(box, bed.centres(), *start));
    agreed += norm_squared(offset) < near * near ? 1 : 0;
    ++drops;
    bed.add(*rest);
  }
  return agreed / static_cast<double>(drops);
}

}  // namespace

TEST_CASE("Descents end where creeping down in small steps ends") {
  // Small steps now and then take the other side of a ridge.
  CHECK(agreement(PeriodicBox{4.5, 5}) > 0.93);
  CHECK(agreement(WalledBox{4.5, 5}) > 0.93);
  CHECK(agreement(Cylinder{5}) > 0.93);
}

TEST_CASE("A centre on a ridge along its wall tips over into the container") {
  PourBed bed(WalledBox{4, 6}, 3);
  bed.add({0.5, 2, 0.5});
  bed.add({0.5, 3.2, 0.5});
  const auto rest = descend(bed, {0.5, 2.5, 4});
  REQUIRE(rest);
  CHECK(rest->z == sphere_radius);
  CHECK(rest->x > 1);
}

}  // namespace jostle
