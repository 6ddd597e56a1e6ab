#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "study/seconds.hpp"

// How the realizations of a scene are divided among the jobs of a batch system.
namespace jostle::inline study {

/// Request to a batch system.
struct JobRequest {
  Seconds time_limit{0};   // time limit of a job
  std::uint32_t cpus = 1;  // cpus of a job
  std::uint32_t shards = 1;
  std::uint32_t most_tasks = 1000;  // most tasks of one array of jobs
};

/// Resources of the scene.
struct SceneCost {
  std::vector<Seconds> realization;  // [n_points], of one on one core
  std::uint32_t realizations = 1;    // realizations of every point
  Seconds start{0};                  // the longest; one that is stopped is made anew
  std::uint64_t bytes_on_disk = 0;   // bytes on disk for all realizations
};

struct JobPlan {
  std::uint32_t shards = 1;
  std::uint32_t shards_a_task = 1;      // one after another
  std::uint32_t tasks = 1;              // tasks of the array
  std::uint64_t most_realizations = 0;  // most realizations of a shard
  Seconds core_time{0};                 // core time of everything
  Seconds longest_task{0};              // with its CPUs
  double efficiency = 1;                // core_time over the time for which CPUs are reserved
  Seconds notice{0};         // the job receives the stop signal so long before its time limit
  std::uint64_t starts = 1;  // starts of the longest task until it is done, the first included
};

/// Every CPU takes the next realization of its shard when it has ended one. Throws BadInput where
/// there are more shards than realizations, and where a job ends before a start can be made.
JobPlan plan_jobs(const SceneCost& cost, const JobRequest& request);

/// The request with other numbers of CPUs and shards, no more CPUs in all, that wastes least of
/// what it reserves and takes at most a tenth longer; nothing where none wastes less by 5 % of it.
std::optional<JobRequest> better_layout(const SceneCost& cost, const JobRequest& request);

}  // namespace jostle::inline study
