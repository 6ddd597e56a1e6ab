#include "study/planning/job_plan.hpp"

#include <catch2/catch.hpp>

#include "study/bad_input.hpp"
#include "study/planning/shards.hpp"

using namespace jostle;
using Catch::Matchers::Contains;

namespace {

constexpr double hour = 3600;

SceneCost cost(std::vector<double> hours, std::uint32_t realizations) {
  SceneCost cost{.realization = {}, .realizations = realizations};
  for (const double duration : hours) cost.realization.emplace_back(duration * hour);
  return cost;
}

JobRequest request(double hours, std::uint32_t cpus, std::uint32_t shards,
                   std::uint32_t most_tasks = 1000) {
  return {.time_limit = Seconds(hours * hour),
          .cpus = cpus,
          .shards = shards,
          .most_tasks = most_tasks};
}

double hours(Seconds time) {
  return time.count() / hour;
}

}  // namespace

TEST_CASE("a shard takes as long as its realizations, as many at once as it has CPUs") {
  // 10 realizations of an hour: 5 a shard, 2 at once, in 3 turns.
  const JobPlan plan = plan_jobs(cost({1}, 10), request(12, 2, 2));
  CHECK(hours(plan.longest_task) == Approx(3));
  CHECK(hours(plan.core_time) == Approx(10));
  CHECK(plan.most_realizations == 5);
  CHECK(plan.tasks == 2);
  CHECK(plan.shards_a_task == 1);
  CHECK(plan.starts == 1);
}

TEST_CASE(
    "Efficiency is the share of reserved time in which CPUs work, and a layout can waste less") {
  // Ten realizations of an hour, 5 a shard, 4 at once: two turns of 4 CPUs, in both shards.
  const SceneCost ten = cost({1}, 10);
  const JobPlan plan = plan_jobs(ten, request(12, 4, 2));
  CHECK(plan.efficiency == Approx(10.0 / 16));
  const auto better = better_layout(ten, request(12, 4, 2));
  REQUIRE(better);
  CHECK(better->cpus * better->shards <= 8);
  const JobPlan better_plan = plan_jobs(ten, *better);
  CHECK(better_plan.efficiency == Approx(1));
  CHECK(hours(better_plan.longest_task) == Approx(2));
  // One that wastes nothing has no better one.
  CHECK(!better_layout(ten, request(12, 5, 2)));
  CHECK(!better_layout(ten, request(12, 1, 10)));
}

TEST_CASE("CPUs beyond a shard's realizations take neither memory nor time") {
  const JobPlan all = plan_jobs(cost({1, 2}, 8), request(100, 4'000'000'000, 2));
  const JobPlan busy = plan_jobs(cost({1, 2}, 8), request(100, 8, 2));
  CHECK(all.longest_task == busy.longest_task);
  CHECK(hours(all.longest_task) == Approx(2));
}

TEST_CASE("the longest shard is that of the costliest sweep points") {
  // Equal numbers of shards and points: each shard has one point.
  const JobPlan plan = plan_jobs(cost({1, 2, 7}, 4), request(100, 1, 3));
  CHECK(hours(plan.longest_task) == Approx(28));
  // Two shards of three points mix them: 1, 7, 2, 1, 7, 2 and 2, 1, 7, 2, 1, 7.
  CHECK(hours(plan_jobs(cost({1, 2, 7}, 4), request(100, 1, 2)).longest_task) == Approx(20));
}

TEST_CASE("shards that an array has no room for come one after another in a task") {
  const JobPlan plan = plan_jobs(cost({1}, 50), request(100, 1, 25, 10));
  CHECK(plan.shards_a_task == 3);
  CHECK(plan.tasks == 9);  // the last has one shard
  CHECK(hours(plan.longest_task) == Approx(6));
}

TEST_CASE("what is not done in a job's time takes more starts, each without the notice") {
  const JobPlan plan = plan_jobs(cost({10}, 4), request(4, 1, 4));
  CHECK(plan.notice == Seconds(120));
  CHECK(plan.starts == 3);
  CHECK(plan_jobs(cost({3.9}, 4), request(4, 1, 4)).starts == 1);
  // A short limit keeps three quarters of it, and so does one with much to store.
  SceneCost large = cost({0.001}, 4);
  large.bytes_on_disk = 40'000'000'000;
  CHECK(plan_jobs(large, request(1.0 / 60, 1, 4)).notice == Seconds(15));
  CHECK(plan_jobs(large, request(4, 1, 4)).notice == Seconds(120));
}

TEST_CASE("jobs without work, and starts that no job can end, are refused") {
  CHECK_THROWS_WITH(plan_jobs(cost({1, 1}, 3), request(4, 1, 7)), Contains("take at most 6"));
  SceneCost slow = cost({10}, 4);
  slow.start = Seconds(5 * hour);
  CHECK_THROWS_WITH(plan_jobs(slow, request(4, 1, 4)), Contains("request more hours"));
  CHECK_NOTHROW(plan_jobs(slow, request(6, 1, 4)));
}

TEST_CASE("numbers are written as ranges") {
  const auto told = [](std::vector<std::uint32_t> numbers) { return ranges_text(numbers); };
  CHECK(told({}).empty());
  CHECK(told({4}) == "4");
  CHECK(told({1, 2, 4, 5, 6, 9}) == "1,2,4-6,9");
}
