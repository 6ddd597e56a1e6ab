#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "results/locks/slurm_job.hpp"

namespace jostle::inline results {

/// Who holds NAME.lock.
struct LockOwner {
  std::string host;
  long pid = 0;
  std::uint64_t start_time = 0;  // field 22 of /proc/PID/stat
  std::optional<SlurmJob> job;   // where it is part of one
  bool storing = false;          // it holds the lock for moments, to store tables
  bool alive = false;  // known on its own host, and where Slurm knows its job; else taken to be
};
/// Nothing where there is no lock. Throws ResultsError where it cannot be read.
std::optional<LockOwner> lock_owner(const std::string& results_path);
/// For many files: Slurm is asked once for all.
std::optional<LockOwner> lock_owner(const std::string& results_path, SlurmQueue& queue);

}  // namespace jostle::inline results
