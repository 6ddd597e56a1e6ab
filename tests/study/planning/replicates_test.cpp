#include "study/planning/replicates.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace jostle;

namespace {

RealizationSummary realization_summary(std::uint32_t point, std::uint32_t realization,
                                       double seconds,
                                       RealizationStatus status = RealizationStatus::done) {
  return {.id = {point, realization},
          .status = status,
          .rows = 1,
          .reason = "",
          .work = {.seconds = seconds}};
}

}  // namespace

TEST_CASE("Whole realizations make whole replicates, whatever their settings cost") {
  const std::vector summaries_before = {realization_summary(0, 0, 0, RealizationStatus::missing),
                                        realization_summary(1, 0, 0, RealizationStatus::missing)};
  const std::vector summaries_after = {realization_summary(0, 0, 1), realization_summary(0, 1, 3),
                                       realization_summary(1, 0, 100),
                                       realization_summary(1, 1, 100)};
  CHECK(replicates_done(summaries_before, summaries_after) == Approx(2));
  CHECK(replicates_done(summaries_before, summaries_before) == 0);
}

TEST_CASE("Realizations that gained a tap count as what they gained") {
  // A thousand replicates of ten taps, to each of which an eleventh was added.
  std::vector<RealizationSummary> summaries_before, summaries_after;
  for (std::uint32_t replicate = 0; replicate < 1000; ++replicate) {
    summaries_before.push_back(realization_summary(0, replicate, 10));
    summaries_after.push_back(realization_summary(0, replicate, 11));
  }
  CHECK(replicates_done(summaries_before, summaries_after) == Approx(1000.0 / 11));
  // 100 s for these: a whole replicate takes 1.1 s, so that 200 s have room for 90 more, not for
  // 1000.
  const double done = replicates_done(summaries_before, summaries_after);
  CHECK(affordable_replicates(1000, Seconds(200), Seconds(100), done) == 1090);
  CHECK(affordable_replicates(1000, Seconds(100), Seconds(100), done) == 1000);
  CHECK(affordable_replicates(1000, Seconds(50), Seconds(100), done) == 1000);
}

TEST_CASE("Where nothing was computed, one replicate finds the pace") {
  CHECK(affordable_replicates(5, Seconds(60), Seconds(0), 0) == 6);
  CHECK(affordable_replicates(5, Seconds(60), Seconds(60), 0) == 5);
}
