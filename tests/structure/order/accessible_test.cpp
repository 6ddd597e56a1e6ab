#include "structure/order/accessible.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "tests/structure/random_points.hpp"

using namespace jostle;

TEST_CASE("The overlap of a footprint is that of random points", "[statistics]") {
  const auto container = GENERATE(values<Container>(
      {WalledBox{5, 7}, WalledBox{1.6, 3}, Cylinder{6}, Cylinder{2}, Plates{7, 3}}));
  constexpr unsigned n = 40'000;
  const AccessibleFootprint footprint({container, {}});
  const Packing points = random_points(container, 2, n);
  const Boundary boundary(container);
  for (const auto& [dx, dy] : {std::pair{0.3, 0.0}, {1.1, -0.4}, {0.5, 0.9}, {-2.0, 1.5}}) {
    double inside = 0;
    for (Vec3 r : points.centres) {
      r.x += dx;
      r.y += dy;
      r = into_periods(boundary, r);
      const bool is_inside = r.x >= 0 && r.y >= 0 && r.x <= boundary.width_x &&
                             r.y <= boundary.width_y && clear_of_boundaries(boundary, r);
      inside += is_inside ? 1 : 0;
    }
    const double share = footprint.overlap(dx, dy);
    CAPTURE(dx, dy);
    CHECK(std::abs(inside / n - share) <= 4 * std::sqrt(share * (1 - share) / n));
  }
}
