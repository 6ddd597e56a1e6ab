#include "results/file/intact_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "results/disk/error.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/seal.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/file/contents.hpp"
#include "results/hdf5/child_process.hpp"
#include "results/hdf5/read.hpp"
#include "results/locks/lock.hpp"

namespace jostle::inline results {
namespace {

/// The first of the changes, in one line; empty where there are none.
std::string summary_of(const std::vector<std::string>& changes) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(changes.size(), most); ++i)
    text += (i > 0 ? ", " : "") + changes[i];
  if (changes.size() > most) text += fmt::format(", and {} more", changes.size() - most);
  return text;
}

void require_old_contents(const std::string& path, const std::string& known_as) {
  naming_file(known_as, [&] {
    silence_hdf5();
    const std::string changes =
        in_child_process([&] { return summary_of(changed_contents(open_to_read(path))); });
    if (changes.empty()) return;
    throw Hdf5Error(
        fmt::format("another program changed it: {}; undo the change, or restore the "
                    "file from a copy",
                    changes));
  });
}

}  // namespace

void require_intact(const std::string& path, const std::string& known_as, Verify verify) {
  const SealState state = verify == Verify::whole_file ? verify_seal(path) : seal_state(path);
  if (state == SealState::lost) require_old_contents(path, known_as);
}

void copy_intact(const std::string& path, TemporaryFile& copy) {
  const auto write = [&](std::span<const std::byte> piece) { copy.write(piece); };
  if (verify_seal(path, write) == SealState::lost) require_old_contents(copy.name(), path);
}

std::string seal_warning(const std::string& path) {
  try {
    if (seal_state(path) == SealState::whole) return "";
  } catch (const ResultsError&) {  // no file of results: somebody else's to refuse
    return "";
  }
  return "another program opened it for writing and cut off its last line, the checksum; its "
         "contents are the old ones";
}

bool reseal(const std::string& named, const Patience& patience) {
  const std::string path = output_path(named);
  const RunLock lock(path, false, LockUse::storing, patience);
  remove_stale_temporaries(path);
  if (verify_seal(path) == SealState::whole) return false;
  TemporaryFile copy(path);
  copy_intact(path, copy);
  seal(copy.name());
  copy.publish();
  return true;
}

}  // namespace jostle::inline results
