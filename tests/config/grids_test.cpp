#include "config/grids.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

namespace jostle {

namespace {

std::vector<std::uint64_t> log_taps(LogarithmicTaps grid) {
  SnapshotChoice snapshots;
  snapshots.taps = std::move(grid);
  return chosen_taps(snapshots.taps);
}

}  // namespace

TEST_CASE("A ramp gives the very numbers a person would list, both ends included") {
  CHECK(strengths({.start = 0.1, .end = 0.5, .step = 0.05}) ==
        std::vector<double>{0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5});
  CHECK(strengths({.start = 0.3, .end = 0, .step = 0.1}) == std::vector<double>{0.3, 0.2, 0.1, 0});
  CHECK(strengths({.start = 0.25, .end = 0.25, .step = 1}) == std::vector<double>{0.25});
}

TEST_CASE("A ramp of thousand steps does not drift") {
  const auto values = strengths({.start = 0, .end = 0.999, .step = 0.001});
  REQUIRE(values.size() == 1000);
  for (std::size_t k = 0; k < values.size(); ++k) {
    CHECK(values[k] == std::stod(std::to_string(k)) / 1000);
  }
}

TEST_CASE("A ramp in the square root squares its values") {
  const auto values =
      strengths({.start = 0.025, .end = 0.4, .step = 0.025, .scale = RampScale::square_root});
  REQUIRE(values.size() == 16);
  CHECK(values.front() == 0.025 * 0.025);
  CHECK(values[5] == 0.15 * 0.15);
  CHECK(values.back() == 0.4 * 0.4);
}

TEST_CASE("The way down meets the strengths of the way up") {
  auto upward =
      strengths({.start = 0.025, .end = 0.4, .step = 0.025, .scale = RampScale::square_root});
  const auto downward =
      strengths({.start = 0.4, .end = 0.025, .step = 0.025, .scale = RampScale::square_root});
  std::reverse(upward.begin(), upward.end());
  CHECK(upward == downward);
}

TEST_CASE("Steps that miss the end are noticed") {
  CHECK(whole_steps({.start = 0.1, .end = 0.5, .step = 0.1}) == 4u);
  CHECK(whole_steps({.start = 0.5, .end = 0.1, .step = 0.1}) == 4u);
  CHECK_FALSE(whole_steps({.start = 0.1, .end = 0.5, .step = 0.15}).has_value());
  CHECK_FALSE(whole_steps({.start = 0.1, .end = 0.5, .step = 0.3999}).has_value());
}

TEST_CASE("A protocol is written out stage by stage, without those of no taps") {
  const std::vector<ProtocolLine> protocol{
      {Dilate{0.02}, std::nullopt, 5},
      {Lift{0.3}, std::nullopt, 0},
      {Shake{0, 0.1, 2}, Ramp{.start = 0.2, .end = 0.1, .step = 0.1}, 7}};
  CHECK(stages(protocol) ==
        std::vector<Stage>{{Dilate{0.02}, 5}, {Shake{0.2, 0.1, 2}, 7}, {Shake{0.1, 0.1, 2}, 7}});
  CHECK(total_taps(protocol) == 19);
}

TEST_CASE("Logarithmic taps are rounded powers of the root of ten") {
  CHECK(log_taps({.first = 1, .last = 1000, .per_decade = 3}) ==
        std::vector<std::uint64_t>{1, 2, 5, 10, 22, 46, 100, 215, 464, 1000});
  CHECK(log_taps({.first = 1, .last = 4000, .per_decade = 1, .also = {0, 4000}}) ==
        std::vector<std::uint64_t>{0, 1, 10, 100, 1000, 4000});
  CHECK(log_taps({.first = 3, .last = 40, .per_decade = 2}) ==
        std::vector<std::uint64_t>{3, 9, 30});
  CHECK(log_taps({.first = 7, .last = 7, .per_decade = 100}) == std::vector<std::uint64_t>{7});
}

TEST_CASE("Fine logarithmic grids list no tap twice and reach every decade exactly") {
  const auto taps = log_taps({.first = 1, .last = 1'000'000'000, .per_decade = 100});
  CHECK(std::is_sorted(taps.begin(), taps.end()));
  CHECK(std::adjacent_find(taps.begin(), taps.end()) == taps.end());
  for (std::uint64_t decade = 1; decade <= 1'000'000'000; decade *= 10) {
    CHECK(std::binary_search(taps.begin(), taps.end(), decade));
  }
}

}  // namespace jostle
