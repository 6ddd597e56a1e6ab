#include "study/tables/points/over_points.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("Points are compared over the taps that they share, those far behind left out") {
  const std::vector<ReachedTaps> points = {{1000, 1001}, {1000, 998}, {1000, 501},
                                           {1000, 500},  {1000, 0},   {200, 51}};
  const SharedTaps shared = shared_taps(points);
  // Half of the farthest's taps is enough; other lengths of protocols are not compared.
  CHECK(shared.rows == std::vector<std::uint64_t>{501, 501, 501, 0, 0, 51});
  CHECK(shared.reasons[0].empty());
  CHECK(shared.reasons[2].empty());
  CHECK(shared.reasons[3] ==
        "its realizations have all reached tap 499, fewer than half of the 1000 taps that those of "
        "another point reached");
  CHECK(shared.reasons[4] == "no realization has taps");
  CHECK(shared.reasons[5].empty());
  CHECK(shared_taps(std::vector<ReachedTaps>{{10, 1}, {10, 1}}).rows ==
        std::vector<std::uint64_t>{1, 1});
  CHECK(shared_taps({}).rows.empty());
}
