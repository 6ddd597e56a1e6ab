#include "study/planning/replicates.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace jostle;

namespace {

RealizationSummary one(std::uint32_t point, std::uint32_t realization, double seconds,
                       RealizationStatus status = RealizationStatus::done) {
  return {.id = {point, realization},
          .status = status,
          .rows = 1,
          .reason = "",
          .work = {.seconds = seconds}};
}

}  // namespace

TEST_CASE("Whole realizations make whole replicates, whatever their settings cost") {
  const std::vector before = {one(0, 0, 0, RealizationStatus::missing),
                              one(1, 0, 0, RealizationStatus::missing)};
  const std::vector after = {one(0, 0, 1), one(0, 1, 3), one(1, 0, 100), one(1, 1, 100)};
  CHECK(replicates_done(before, after) == Approx(2));
  CHECK(replicates_done(before, before) == 0);
}

TEST_CASE("Realizations that gained a tap count as what they gained") {
  // A thousand replicates of ten taps, to each of which an eleventh was added.
  std::vector<RealizationSummary> before, after;
  for (std::uint32_t replicate = 0; replicate < 1000; ++replicate) {
    before.push_back(one(0, replicate, 10));
    after.push_back(one(0, replicate, 11));
  }
  CHECK(replicates_done(before, after) == Approx(1000.0 / 11));
  // 100 s for these: a whole replicate takes 1.1 s, so that 200 s have room for 90 more, not for
  // 1000.
  const double done = replicates_done(before, after);
  CHECK(affordable_replicates(1000, Seconds(200), Seconds(100), done) == 1090);
  CHECK(affordable_replicates(1000, Seconds(100), Seconds(100), done) == 1000);
  CHECK(affordable_replicates(1000, Seconds(50), Seconds(100), done) == 1000);
}

TEST_CASE("Where nothing was computed, one replicate finds the pace") {
  CHECK(affordable_replicates(5, Seconds(60), Seconds(0), 0) == 6);
  CHECK(affordable_replicates(5, Seconds(60), Seconds(60), 0) == 5);
}
