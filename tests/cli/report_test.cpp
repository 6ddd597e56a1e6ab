#include "cli/report.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("Reported taps are about three a decade, with both ends") {
  CHECK(reported_taps(0) == std::vector<std::uint64_t>{0});
  CHECK(reported_taps(1) == std::vector<std::uint64_t>{0, 1});
  CHECK(reported_taps(50) == std::vector<std::uint64_t>{0, 1, 2, 5, 10, 20, 50});
  CHECK(reported_taps(400) == std::vector<std::uint64_t>{0, 1, 2, 5, 10, 20, 50, 100, 200, 400});
}
