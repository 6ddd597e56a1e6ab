#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/starts/starts.hpp"
#include "tests/engine/starts/starts_supports.hpp"

namespace jostle {
namespace {

Packing fitted(const Container& container, std::uint32_t n, Packing* poured = nullptr) {
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  return make_start(FittedPour{}, container, n, random, {}, poured);
}

}  // namespace

TEST_CASE("A fitted pour lies between its walls and is the same from the same stream") {
  for (const Container& box :
       {Container{WalledBox{6, 7}}, Container{WalledBox{2.001, 2.6}}, Container{WalledBox{2.01, 9}},
        Container{WalledBox{3, 3}}, Container{Plates{6, 5}}}) {
    const Packing packing = fitted(box, 300);
    CHECK(packing.centres.size() == 300);
    CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
    CHECK(packing.centres == fitted(box, 300).centres);
  }
}

TEST_CASE("A fitted pour moves only the spheres that straddle a wall, and these come to rest") {
  constexpr std::uint32_t n = 600;
  const WalledBox box{8, 7};
  Packing poured;
  const Packing packing_after = fitted(box, n, &poured);
  // The first stage is a pour with periodic sides, from the same stream.
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  const Packing periodic = make_start(SteepestDescentPour{}, PeriodicBox{8, 7}, n, random);
  CHECK(poured.container == periodic.container);
  CHECK(poured.centres == periodic.centres);

  std::size_t moved = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 r = poured.centres[i];
    const bool straddles =
        r.x < 0.5 || r.y < 0.5 || r.x > box.width_x - 0.5 || r.y > box.width_y - 0.5;
    CAPTURE(i, r.x, r.y, r.z);
    CHECK((packing_after.centres[i] == r) == !straddles);
    if (!straddles) continue;
    ++moved;
    const bool on_floor = packing_after.centres[i].z == sphere_radius;
    CHECK((on_floor || carried(contacts(packing_after, i))));
  }
  // A quarter of the footprint is nearer than R to a side: 1 - (7 x 6)/(8 x 7).
  CHECK(moved > n / 8);
  CHECK(moved < n / 2);
}

TEST_CASE("A pour of the paper's size is fitted between its walls") {
  const Packing packing = fitted(WalledBox{16, 16}, 4096);
  CHECK(packing.centres.size() == 4096);
  CHECK(deepest_overlap(packing).depth <= 1e-12);
}

TEST_CASE("A fitted pour that cannot be is refused") {
  CHECK_THROWS_WITH(fitted(PeriodicBox{6, 6}, 200), Catch::Contains("fitted between walls"));
  CHECK_THROWS_WITH(fitted(Cylinder{6}, 200), Catch::Contains("fitted between walls"));
  CHECK_THROWS_WITH(fitted(WalledBox{2, 6}, 200), Catch::Contains("least is 2"));
}

}  // namespace jostle
