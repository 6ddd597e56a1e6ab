#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <vector>

#include "engine/bed/geometry.hpp"
#include "engine/starts/starts.hpp"
#include "tests/engine/sample_packings.hpp"

namespace jostle {
namespace {

Packing packing_of(const Start& start, const FullyPeriodicBox& box, std::uint32_t n) {
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  return make_start(start, box, n, random);
}

FullyPeriodicBox cube(std::uint32_t n, double fraction) {
  const double side = std::cbrt(n * sphere_volume / fraction);
  return {side, side, side};
}

// The largest structure factor at a wave vector of the box with 2 <= k / 2 pi <= 3.1, divided by
// the number of spheres: 1 for a crystal at a reciprocal lattice vector, about ln(vectors) / n
// without order. fcc has (1, 1, 1) and (2, 0, 0) at sqrt(3) and 2 over its cell of sqrt(2) d.
double strongest_order(const Packing& packing) {
  const auto& box = std::get<FullyPeriodicBox>(packing.container);
  const double two_pi = 2 * std::acos(-1.0);
  const int reach = static_cast<int>(1.7 * box.width_x) + 1;
  double strongest = 0;
  for (int a = 0; a <= reach; ++a) {
    for (int b = -reach; b <= reach; ++b) {
      for (int c = -reach; c <= reach; ++c) {
        const Vec3 k = {a / box.width_x, b / box.width_y, c / box.height};
        if (norm_squared(k) < 0.9 * 0.9 || norm_squared(k) > 1.7 * 1.7) continue;
        std::complex<double> sum = 0;
        for (const Vec3& r : packing.centres) sum += std::polar(1.0, two_pi * dot(k, r));
        strongest = std::max(strongest, std::norm(sum));
      }
    }
  }
  const auto n = static_cast<double>(packing.centres.size());
  return strongest / (n * n);
}

}  // namespace

TEST_CASE("Grown spheres fill the box without overlap and without crystalline order") {
  constexpr std::uint32_t n = 500;
  // The measure distinguishes a crystal from a fluid: a perfect fcc cube of the same number of
  // spheres.
  const double side = 5 * std::sqrt(2.0);
  CHECK(strongest_order(packing_of(Crystal{Lattice::fcc, true}, {side, side, side}, 490)) > 0.3);
  for (const double fraction : {0.30, 0.49, 0.60}) {
    CAPTURE(fraction);
    const Packing packing = packing_of(Grow{}, cube(n, fraction), n);
    CHECK(packing.centres.size() == n);
    CHECK(deepest_overlap_brute_force(packing).depth == 0);
    CHECK(strongest_order(packing) < 0.1);
  }
}

TEST_CASE("Mixtures grow by one factor until every sphere has its diameter") {
  for (const double ratio : {1.4, 3.0, 10.0}) {
    for (const double fraction : {0.30, 0.55}) {
      CAPTURE(ratio, fraction);
      const std::uint32_t n = ratio > 5 ? 300 : 120;  // boxes are wider than two largest spheres
      StartSpheres spheres{n};
      spheres.sizes = std::make_shared<const Sizes>(graded_diameters(n, 0.5, ratio));
      const double solid = solid_volume({PeriodicBox{}, std::vector<Vec3>(n), spheres.sizes});
      const double side = std::cbrt(solid / fraction);
      RandomStream random(stream_key(1, 0, 0, Purpose::start));
      const Packing packing =
          make_start(Grow{}, FullyPeriodicBox{side, side, side}, spheres, random);
      CHECK(packing.sizes == spheres.sizes);
      CHECK(deepest_overlap_brute_force(packing).depth <= overlap_bound(packing));
    }
  }
}

TEST_CASE("Sizes of diameter 1 grow like equal spheres, bit for bit") {
  StartSpheres spheres{100};
  spheres.sizes = std::make_shared<const Sizes>(std::vector<double>(100, 1.0));
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  CHECK(make_start(Grow{}, cube(100, 0.5), spheres, random).centres ==
        packing_of(Grow{}, cube(100, 0.5), 100).centres);
}

TEST_CASE("A mixture too full to grow in is refused by its volume") {
  // 40 spheres of diameter 2 are as much as 320 of diameter 1.
  StartSpheres spheres{40};
  spheres.sizes = std::make_shared<const Sizes>(std::vector<double>(40, 2.0));
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  CHECK_THROWS_WITH(make_start(Grow{}, cube(320, 0.65), spheres, random),
                    Catch::Contains("the spheres fill 0.6500 of the box"));
  CHECK_THROWS_WITH(make_start(Grow{.max_sweeps = 10}, cube(320, 0.6), spheres, random),
                    Catch::Contains("did not reach their diameter in 10 sweeps"));
}

TEST_CASE("A box too full to grow in is refused, and growing never hangs") {
  CHECK_THROWS_WITH(packing_of(Grow{}, cube(200, 0.65), 200), Catch::Contains("0.64"));
  CHECK_THROWS_WITH(packing_of(Grow{.max_sweeps = 10}, cube(200, 0.6), 200),
                    Catch::Contains("did not reach diameter 1 in 10 sweeps"));
  RandomStream random(stream_key(1, 0, 0, Purpose::start));
  CHECK_THROWS_WITH(make_start(Grow{}, PeriodicBox{}, 10, random),
                    Catch::Contains("fully_periodic container only"));
  CHECK(packing_of(Grow{}, FullyPeriodicBox{2.01, 2.01, 2.01}, 4).centres.size() == 4);
}

}  // namespace jostle
