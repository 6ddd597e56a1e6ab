#include "results/run/live_run.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "results/disk/error.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/publish.hpp"
#include "results/disk/system_calls.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/file/results_writer.hpp"
#include "results/locks/lock.hpp"
#include "results/run/run_parts.hpp"

namespace jostle::inline results {
namespace {

/// Replaces data that a part has more recently; a part may vanish while a live run folds.
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

/// Distinguishes one published file from the next with its name.
std::pair<std::uint64_t, std::int64_t> version_of(const std::string& path) {
  struct stat status {};
  ::stat(path.c_str(), &status);
  return {status.st_ino, change_time(status).nanoseconds};
}

RunStatus status_of(const ResultsFile& file, Realizations selection,
                    const std::string& results_path, SlurmQueue& queue) {
  RunStatus status{.state = file.state(),
                   .owner = lock_owner(results_path, queue),
                   .realizations = file.realizations(selection)};
  take_parts(file, status.realizations);
  struct stat on_disk {};
  if (::stat(results_path.c_str(), &on_disk) == 0)
    status.file_bytes = static_cast<std::uint64_t>(on_disk.st_size);
  status.parts_bytes = parts_bytes(results_path);
  return status;
}

/// Writes the file and these of its parts in one to `output`. Throws ResultsError also where a fold
/// takes parts away meanwhile.
void write_joined(const ResultsFile& file, const std::string& results_path,
                  const std::vector<RealizationId>& with_parts, const std::string& output,
                  Content content) {
  const auto realization = [&](RealizationId id) {
    auto base = file.realization(id, content);
    if (!std::ranges::binary_search(with_parts, id)) return base;
    const std::size_t n_columns = file.study().points[id.point].n_columns();
    return continued(std::move(base), results_path, {file.run_id(), id}, n_columns, content);
  };
  write_results(output,
                {file.study(), file.shard(), file.provenance(), file.run_id(), realization});
}

/// The file and its parts in one.
ResultsFile joined_once(const std::string& results_path, const std::string& known_as,
                        Content content) {
  ResultsFile file(results_path, known_as);
  const auto with_parts = realizations_with_parts(results_path);
  if (with_parts.empty()) return file;
  const ScratchFolder folder("live");
  const std::string joined = (folder.path() / "live.h5").string();
  write_joined(file, results_path, with_parts, joined, content);
  return {joined, known_as};  // open, it outlives its name
}

/// Calls read() until the run neither folded nor published while it read.
template <class Read>
auto read_undisturbed(const std::string& results_path, const Read& read) {
  constexpr int most_tries = 20;
  for (int tries = 1;; ++tries) {
    const auto version_before = version_of(results_path);
    const auto parts = realizations_with_parts(results_path);
    try {
      auto found = read();
      if (version_of(results_path) == version_before || tries == most_tries) return found;
    } catch (const ResultsError&) {
      const bool folded = version_of(results_path) != version_before ||
                          realizations_with_parts(results_path) != parts;
      if (!folded || tries == most_tries) throw;
    }
  }
}

}  // namespace

ResultsFile live_results(const std::string& named, Content content) {
  const std::string results_path = end_of_links(named);
  return read_undisturbed(results_path, [&] { return joined_once(results_path, named, content); });
}

void write_copy(const std::string& named, const std::string& output, bool live,
                ExistingFile existing, const Patience& patience) {
  const std::string results_path = end_of_links(named), replaced = output_path(output);
  const RunLock lock(replaced, false, LockUse::run, patience);
  struct stat status;  // once more: another command may have made the file during the wait
  if (existing == ExistingFile::kept && ::stat(replaced.c_str(), &status) == 0)
    refuse_existing(replaced);
  if (parts_exist(replaced)) {
    throw ResultsError(parts_folder(replaced),
                       "holds parts of another run, which the copy would cut off from theirs; "
                       "choose another name");
  }
  read_undisturbed(results_path, [&] {
    const auto parts = live ? realizations_with_parts(results_path) : std::vector<RealizationId>{};
    write_joined(ResultsFile(results_path, named), results_path, parts, replaced,
                 Content::everything);
    return true;
  });
}

RunStatus run_status(const std::string& named) {
  const std::string results_path = end_of_links(named);
  SlurmQueue queue;
  for (;;) {
    const auto version_before = version_of(results_path);
    const RunStatus status =
        status_of(ResultsFile(results_path), Realizations::all, results_path, queue);
    // Parts that a fold meanwhile took away are in the new file.
    if (version_of(results_path) == version_before) return status;
  }
}

LiveLook look_at_run(const std::string& named, SlurmQueue& queue, const ResultsFile* sibling) {
  const std::string results_path = end_of_links(named);
  for (;;) {
    const auto version_before = version_of(results_path);
    ResultsFile file = sibling == nullptr
                           ? ResultsFile(results_path, Verify::end_of_file)
                           : ResultsFile(results_path, Verify::end_of_file, *sibling);
    RunStatus status = status_of(file, Realizations::of_its_share, results_path, queue);
    if (version_of(results_path) == version_before) return {std::move(file), std::move(status)};
  }
}

}  // namespace jostle::inline results
