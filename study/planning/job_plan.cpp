#include "study/planning/job_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "ensemble/statistics/finite_text.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline study {
namespace {

// Seconds. Slurm's signal comes up to 60 s early or late, and a stop folds no more than takes some
// 20 (RunSettings::most_bytes_folded_at_stop).
constexpr double most_notice = 120;
constexpr double most_of_the_limit = 0.25;

/// Realizations of share `index` of `count` (Shard), each on the CPU that is free first.
Seconds shard_time(const SceneCost& cost, const JobRequest& request, std::uint64_t index) {
  const std::uint64_t points = cost.realization.size(), all = points * cost.realizations;
  std::priority_queue<double, std::vector<double>, std::greater<>>
      ends;  // times at which CPUs become free, seconds
  const std::uint64_t most_busy = (all + request.shards - 1) / request.shards;
  for (std::uint64_t cpu = 0; cpu < std::min<std::uint64_t>(request.cpus, most_busy); ++cpu)
    ends.push(0);
  double last = 0;
  for (std::uint64_t n = index - 1; n < all; n += request.shards) {
    const double end = ends.top() + cost.realization[n % points].count();
    ends.pop();
    ends.push(end);
    last = std::max(last, end);
  }
  return Seconds(last);
}

Seconds notice_before_end(const JobRequest& request) {
  return Seconds(std::ceil(std::min(most_notice, most_of_the_limit * request.time_limit.count())));
}

}  // namespace

JobPlan plan_jobs(const SceneCost& cost, const JobRequest& request) {
  const std::uint64_t all = cost.realization.size() * std::uint64_t{cost.realizations};
  if (request.shards > all) {
    throw BadInput(fmt::format("{} jobs are more than the scene has realizations: take at most {}",
                               request.shards, all));
  }
  JobPlan plan;
  plan.shards = request.shards;
  plan.shards_a_task = (request.shards + request.most_tasks - 1) / request.most_tasks;
  plan.tasks = (request.shards + plan.shards_a_task - 1) / plan.shards_a_task;
  plan.most_realizations = (all + request.shards - 1) / request.shards;
  for (const Seconds duration : cost.realization)
    plan.core_time += duration * static_cast<double>(cost.realizations);
  Seconds reserved{0};
  for (std::uint32_t task = 0; task < plan.tasks; ++task) {
    Seconds time{0};
    const std::uint32_t first = task * plan.shards_a_task;
    for (std::uint32_t shard = first; shard < std::min(first + plan.shards_a_task, plan.shards);
         ++shard) {
      time += shard_time(cost, request, shard + 1);
    }
    plan.longest_task = std::max(plan.longest_task, time);
    reserved += time * static_cast<double>(request.cpus);
  }
  if (reserved > Seconds{0}) plan.efficiency = plan.core_time / reserved;
  plan.notice = notice_before_end(request);
  const Seconds usable = request.time_limit - plan.notice;
  if (cost.start > usable) {
    throw BadInput(
        finite_text("a start takes about {:.2g} h, and a job has {:.2g} h until its signal to "
                    "stop. A stopped start begins anew, so that none would ever finish: request "
                    "more hours",
                    cost.start.count() / 3600, usable.count() / 3600));
  }
  plan.starts =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(plan.longest_task / usable)));
  return plan;
}

std::optional<JobRequest> better_layout(const SceneCost& cost, const JobRequest& request) {
  constexpr double least_gain = 0.05, most_longer = 1.1;
  constexpr std::uint64_t most_tried = 64, most_realizations = 100'000;
  const std::uint64_t all = cost.realization.size() * std::uint64_t{cost.realizations};
  if (all > most_realizations) return std::nullopt;
  const std::uint64_t in_all = std::uint64_t{request.cpus} * request.shards;
  const JobPlan asked = plan_jobs(cost, request);
  double best = asked.efficiency + least_gain;
  std::optional<JobRequest> found;
  for (std::uint32_t cpus = 1; cpus <= std::min<std::uint64_t>(request.cpus, most_tried); ++cpus) {
    const std::uint64_t most_shards = std::min(all, in_all / cpus);
    // The fewest shards that need no more turns than the most shards do.
    const std::uint64_t turns = (all + most_shards * cpus - 1) / (most_shards * cpus);
    JobRequest alternative = request;
    alternative.cpus = cpus;
    alternative.shards = static_cast<std::uint32_t>((all + turns * cpus - 1) / (turns * cpus));
    const JobPlan plan = plan_jobs(cost, alternative);
    if (plan.longest_task > most_longer * asked.longest_task || plan.efficiency <= best) continue;
    best = plan.efficiency;
    found = alternative;
  }
  return found;
}

}  // namespace jostle::inline study
