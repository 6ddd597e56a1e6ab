#pragma once

#include <cstdint>
#include <string>

#include "study/planning/job_plan.hpp"

namespace jostle::inline cli {

/// Further data of a batch script.
struct BatchScript {
  std::string name;             // name of the scene: letters, digits, dots, hyphens, underscores
  std::string scene;            // its file
  std::string results;          // the folder of the shards' files
  std::string folder;           // where it runs, absolute
  std::string program;          // jostle, absolute
  std::string made_by;          // a command line
  std::uint32_t cpus = 1;       // cpus of a job
  Seconds time_limit{0};        // time limit of a job
  std::uint64_t megabytes = 0;  // megabytes of a job
  std::string estimate;         // a line for people
};

/// A complete script for Slurm's sbatch: an array of jobs that runs every shard, stops before its
/// time limit, requeues itself, and resumes.
std::string slurm_script(const BatchScript& script, const JobPlan& plan);

/// "2-00:30:00", "12:00:00": as Slurm takes them; whole minutes, rounded up.
std::string slurm_time(Seconds time);

}  // namespace jostle::inline cli
