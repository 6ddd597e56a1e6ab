#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "results/patience.hpp"
#include "results/results_file.hpp"
#include "results/slurm_job.hpp"

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

/// A file and, if a run is in progress or was killed, its parts.
struct RunStatus {
  RunState state = RunState::running;            // state of the file
  std::optional<LockOwner> owner;                // owner of a lock
  std::vector<RealizationSummary> realizations;  // with the parts' newer checkpoints
  std::uint64_t file_bytes = 0, parts_bytes = 0;
};

/// Looks without disturbing: a live run may go on while this reads. Throws ResultsError.
RunStatus run_status(const std::string& results_path);

/// A file and the status of the realizations of its share. Only the presence of the checksum is
/// tested: a list of many files does not read all of them.
struct LiveLook {
  ResultsFile file;
  RunStatus status;
};
/// `sibling`: a file of the same study, if there is one; it makes this quicker. Throws
/// ResultsError.
LiveLook look_at_run(const std::string& results_path, SlurmQueue& queue,
                     const ResultsFile* sibling = nullptr);

/// The file as it would be if the run stopped at its last checkpoints; where it has no parts, the
/// file itself. Nothing beside it is touched: what is joined is a temporary file, in the folder
/// that TMPDIR names, which is gone when this returns. Throws ResultsError.
ResultsFile live_results(const std::string& results_path, Content content = Content::everything);

/// Writes it as a results file `output`, without derived tables. `live`: with the
/// checkpoints. Throws ResultsError.
void write_copy(const std::string& results_path, const std::string& output, bool live,
                const Patience& patience = {});

}  // namespace jostle::inline results
