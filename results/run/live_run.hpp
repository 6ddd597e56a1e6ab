#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "results/disk/publish.hpp"
#include "results/file/results_file.hpp"
#include "results/locks/lock_owner.hpp"
#include "results/locks/patience.hpp"

namespace jostle::inline results {

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
/// checkpoints. Throws ResultsError, also for a file that exists and is to be kept.
void write_copy(const std::string& results_path, const std::string& output, bool live,
                ExistingFile existing = ExistingFile::kept, const Patience& patience = {});

}  // namespace jostle::inline results
