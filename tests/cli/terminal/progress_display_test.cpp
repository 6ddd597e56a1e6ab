#include "cli/terminal/progress_display.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("A progress line counts, and estimates the time left from the taps done") {
  Progress progress;
  progress.realizations_done = 3;
  progress.realizations_running = 2;
  progress.taps_done = 100;
  const WorkAhead ahead{.realizations = 8, .taps = 400};
  CHECK(progress_line(progress, ahead, 4.1e7, std::chrono::seconds(20)) ==
        "3/8 done, 2 running, 0 failed; taps 100/400; 41.0 M trials/s; 1 min 0 s left");
}

TEST_CASE("The work of several engines is not added up") {
  Progress progress;
  progress.realizations_done = 3;
  progress.taps_done = 100;
  const WorkAhead ahead{.realizations = 8, .taps = 400, .unit = ""};
  CHECK(progress_line(progress, ahead, 4.1e7, std::chrono::seconds(20)) ==
        "3/8 done, 0 running, 0 failed; taps 100/400; 1 min 0 s left");
}

TEST_CASE("No remaining time is shown before the first tap") {
  Progress progress;
  const WorkAhead ahead{.realizations = 1, .taps = 10};
  CHECK(progress_line(progress, ahead, 0, std::chrono::seconds(20)) ==
        "0/1 done, 0 running, 0 failed; taps 0/10; 0 trials/s");
}

TEST_CASE("Pilots show the time used of their budget, and no time left") {
  Progress progress;
  progress.realizations_done = 3;
  progress.realizations_running = 2;
  progress.taps_done = 1;
  const WorkAhead ahead{.realizations = 8, .taps = 400};
  CHECK(pilot_line(progress, ahead, 4.1e7, std::chrono::seconds(65), std::chrono::minutes(10)) ==
        "pilots: 3/8 done, 2 running, 0 failed; taps 1/400; 41.0 M trials/s; 1 min 5 s of the "
        "budget of 10 min 0 s used");
}
