#pragma once

#include <string>

#include "results/disk/system_calls.hpp"
#include "results/locks/lock_owner.hpp"
#include "results/locks/patience.hpp"

namespace jostle::inline results {

/// The purpose of a lock; it is written in the lock.
enum class LockUse { run, storing };

/// NAME.lock: one process at a time works on NAME. Held by flock, so that two processes never both
/// take over from a dead one, and by what is written in it (host, pid, start time of the process,
/// and its Slurm job), for file systems and hosts that flock does not reach.
class RunLock {
 public:
  /// Waits with `patience`. Throws LockHeld naming the owner where a living process holds it still,
  /// or where a process of another host does that Slurm does not know to have ended, and `force` is
  /// not set.
  RunLock(const std::string& results_path, bool force, LockUse use = LockUse::run,
          const Patience& patience = {});
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  /// Removes the lock file.
  ~RunLock();

  /// Warning about the lock if flock does not work here; otherwise empty.
  std::string warning() const;

 private:
  void acquire(bool force, LockUse use);

  std::string path_;
  Descriptor file_;
  int flock_error_ = 0;
};

}  // namespace jostle::inline results
