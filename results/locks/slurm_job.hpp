#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace jostle::inline results {

/// A Slurm job, one task of an array, as it was started so many times before.
struct SlurmJob {
  std::string cluster;
  std::uint64_t id = 0;        // SLURM_JOB_ID: of this task alone
  std::uint64_t restarts = 0;  // SLURM_RESTART_COUNT: how often it was requeued
  std::string name;            // the usual form: "1234_7", "1234"

  bool operator==(const SlurmJob&) const = default;
};

/// The job that this process is part of, from its environment; nothing outside of jobs.
std::optional<SlurmJob> this_slurm_job();

/// Slurm's MaxArraySize: indices of array tasks stay below it. Nothing where Slurm is not here.
std::optional<std::uint64_t> slurm_max_array_size();

/// The jobs of this user, as Slurm's own program `squeue` lists them. It is called once, at the
/// first use.
class SlurmQueue {
 public:
  /// True if processes of a job of this user may still run. Nothing where Slurm has no answer: it
  /// is missing, does not answer, or the job belongs to another cluster.
  std::optional<bool> runs(const SlurmJob& job);

 private:
  struct Listed {
    std::string state;
    std::uint64_t restarts = 0;
  };
  void ask();

  bool asked_ = false;
  std::optional<std::map<std::uint64_t, Listed>> jobs_;
  std::string cluster_;
};

}  // namespace jostle::inline results
