#include <catch2/catch.hpp>
#include <limits>
#include <memory>

#include "engine/starts/starts.hpp"

namespace jostle {
namespace {

Packing given(std::vector<Vec3> centres, const Container& container, std::uint32_t n) {
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  return make_start(GivenPacking{std::make_shared<const std::vector<Vec3>>(std::move(centres))},
                    container, n, random);
}

}  // namespace

TEST_CASE("A given packing may overlap up to the given depth, with spheres and with the floor") {
  const PeriodicBox box{5, 5};
  RandomStream random(StreamKey{});
  const auto overlapping = [&](double most) {
    const std::vector<Vec3> centres{{1, 1, 0.495}, {1, 1, 1.49}};  // 0.005 deep in both
    return make_start(GivenPacking{std::make_shared<const std::vector<Vec3>>(centres), most}, box,
                      2, random);
  };
  CHECK_THROWS_AS(overlapping(0), StartError);
  CHECK_THROWS_AS(overlapping(0.0049), StartError);
  CHECK(overlapping(0.0051).centres.size() == 2);
}

TEST_CASE("A given packing is taken as it is, brought into the box") {
  const Packing packing = given({{1, 1, 0.5}, {-0.5, 5, 0.5}, {17, 2.5, 3}}, PeriodicBox{8, 4}, 3);
  CHECK(packing.centres == std::vector<Vec3>{{1, 1, 0.5}, {7.5, 1, 0.5}, {1, 2.5, 3}});
  const Packing tiny = given({{-5e-17, 8, 0.5}}, PeriodicBox{8, 8}, 1);
  CHECK(tiny.centres == std::vector<Vec3>{{0, 0, 0.5}});
  const Packing bulk = given({{1, 1, -0.25}}, FullyPeriodicBox{3, 3, 3}, 1);
  CHECK(bulk.centres == std::vector<Vec3>{{1, 1, 2.75}});
}

TEST_CASE("A given packing that does not fit is refused, naming the sphere") {
  const Container box = PeriodicBox{8, 8};
  CHECK_THROWS_WITH(given({{1, 1, 1}}, box, 2), Catch::Contains("1 spheres where 2"));
  CHECK_THROWS_WITH(given({{1, 1, 1}, {1.5, 1, 1}}, box, 2),
                    Catch::Contains("sphere 0 overlaps sphere 1 by 0.5 diameters"));
  CHECK_THROWS_WITH(given({{0.1, 1, 1}, {7.9, 1, 1}}, box, 2),
                    Catch::Contains("sphere 0 overlaps sphere 1 by 0.8 diameters"));
  CHECK_NOTHROW(given({{1, 1, 1}, {2 - 1e-13, 1, 1}}, box, 2));
  CHECK_THROWS_AS(given({{1, 1, 1}, {2 - 1e-5, 1, 1}}, box, 2), StartError);
  CHECK_THROWS_WITH(given({{1, 1, 0.4}}, box, 1), Catch::Contains("floor"));
  CHECK_THROWS_WITH(given({{0.4, 1, 1}}, WalledBox{8, 8}, 1), Catch::Contains("side"));
  CHECK_THROWS_WITH(given({{1, 1, 1}}, Cylinder{8}, 1), Catch::Contains("side"));
  CHECK_THROWS_WITH(given({{1, 1, -1e300}}, box, 1), Catch::Contains("outside"));
  CHECK_THROWS_WITH(given({{1, 1, std::numeric_limits<double>::quiet_NaN()}}, box, 1),
                    Catch::Contains("finite"));
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  CHECK_THROWS_AS(make_start(GivenPacking{}, box, 1, random), StartError);
}

}  // namespace jostle
