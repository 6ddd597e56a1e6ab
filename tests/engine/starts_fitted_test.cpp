#include <catch2/catch.hpp>

#include "engine/starts.hpp"

namespace jostle {
namespace {

Packing fitted(const FittedPour& start, const Container& container, std::uint32_t n) {
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  return make_start(start, container, n, random);
}

}  // namespace

TEST_CASE("A fitted pour lies between its walls and is the same from the same stream") {
  const Container box = WalledBox{6, 7};
  const Packing packing = fitted({}, box, 300);
  CHECK(packing.centres.size() == 300);
  CHECK(deepest_overlap_brute_force(packing).depth <= 1e-12);
  CHECK(packing.centres == fitted({}, box, 300).centres);
}

TEST_CASE("A pour of the paper's size is fitted between its walls", "[statistics]") {
  const Packing packing = fitted({}, WalledBox{16, 16}, 4096);
  CHECK(packing.centres.size() == 4096);
  CHECK(deepest_overlap(packing).depth <= 1e-12);
}

TEST_CASE("A fitted pour that cannot be is refused") {
  CHECK_THROWS_WITH(fitted({.max_sweeps = 2}, WalledBox{6, 6}, 200),
                    Catch::Contains("spheres still overlap the walls after 2 sweeps"));
  CHECK_THROWS_WITH(fitted({}, PeriodicBox{6, 6}, 200), Catch::Contains("four flat walls"));
  CHECK_THROWS_WITH(fitted({}, Cylinder{6}, 200), Catch::Contains("four flat walls"));
  CHECK_THROWS_WITH(fitted({}, WalledBox{2, 6}, 200), Catch::Contains("least is 2"));
  CHECK_THROWS_WITH(fitted({.max_step = 0}, WalledBox{6, 6}, 200), Catch::Contains("max_step"));
}

}  // namespace jostle
