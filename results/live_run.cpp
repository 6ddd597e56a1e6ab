#include "results/live_run.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <utility>

#include "results/error.hpp"
#include "results/run_parts.hpp"

namespace jostle {
namespace {

/// Replaces what a part knows better; a part may vanish while a live run folds.
void take_parts(const ResultsFile& file, std::vector<RealizationSummary>& realizations) {
  for (const RealizationId id : realizations_with_parts(file.path())) {
    const auto place = std::ranges::lower_bound(realizations, id, {}, &RealizationSummary::id);
    if (place == realizations.end() || place->id != id) continue;
    const std::string path = state_path(file.path(), id);
    try {
      *place = summary_of(id, read_state(path, {file.run_id(), id}));
    } catch (const ResultsError&) {
      struct stat status;
      if (::stat(path.c_str(), &status) == 0) throw;
    }
  }
}

/// Tells one published file from the next under the same name.
std::pair<std::uint64_t, long> version_of(const std::string& path) {
  struct stat status {};
  ::stat(path.c_str(), &status);
  return {status.st_ino, status.st_mtim.tv_nsec};
}

RunStatus look_once(const std::string& results_path) {
  const ResultsFile file(results_path);
  RunStatus status{.state = file.state(),
                   .owner = lock_owner(results_path),
                   .realizations = file.realizations()};
  take_parts(file, status.realizations);
  struct stat on_disk {};
  if (::stat(results_path.c_str(), &on_disk) == 0)
    status.file_bytes = static_cast<std::uint64_t>(on_disk.st_size);
  status.parts_bytes = parts_bytes(results_path);
  return status;
}

}  // namespace

RunStatus run_status(const std::string& results_path) {
  for (;;) {
    const auto before = version_of(results_path);
    const RunStatus status = look_once(results_path);
    // Parts that a fold meanwhile took away are in the new file.
    if (version_of(results_path) == before) return status;
  }
}

}  // namespace jostle
