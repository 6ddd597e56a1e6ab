#include "cli/reports/batch_script.hpp"

#include <catch2/catch.hpp>

using namespace jostle;

TEST_CASE("Slurm's times are whole minutes, rounded up") {
  CHECK(slurm_time(Seconds(60)) == "00:01:00");
  CHECK(slurm_time(Seconds(60 * (1.0 / 60) * 60)) == "00:01:00");
  CHECK(slurm_time(Seconds(61)) == "00:02:00");
  CHECK(slurm_time(Seconds(12 * 3600)) == "12:00:00");
  CHECK(slurm_time(Seconds(90000)) == "1-01:00:00");
}
