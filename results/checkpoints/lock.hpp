#pragma once

#include <string>

#include "results/hdf5/descriptor.hpp"
#include "results/live_run.hpp"

namespace jostle::inline results {

/// NAME.lock: one process at a time works on NAME. Held by flock, so that two processes never both
/// take over from a dead one, and by what is written in it (host, pid, start time of the process,
/// and its Slurm job), for file systems and hosts that flock does not reach.
class RunLock {
 public:
  /// Throws ResultsError naming the owner where a living process holds it, or where a process of
  /// another host does that Slurm does not know to have ended, and `force` is not set.
  RunLock(const std::string& results_path, bool force);
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  /// Removes the lock file.
  ~RunLock();

  /// What is to be told of it: that flock does not work here. Empty where it does.
  std::string warning() const;

 private:
  std::string path_;
  Descriptor file_;
  int flock_error_ = 0;
};

}  // namespace jostle::inline results
