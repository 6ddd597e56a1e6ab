#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "results/locks/slurm_job.hpp"
#include "results/run/live_run.hpp"
#include "study/seconds.hpp"

// The files of a run that many jobs share.
namespace jostle::inline study {

/// Results files where folders are named: all that end in .h5, in the order of the numbers in their
/// names. A file stays as it is. Throws BadInput for a folder without any.
std::vector<std::string> results_files(std::span<const std::string> named);

/// State of a shard. `stopped`: in good order, by a signal or a time limit; `dead`: its process
/// was killed; `missing`: no file holds it. All three go on with a resume. `unreadable`: by its
/// name a file holds it that cannot be read, and its contents may be finished.
enum class ShardState { done, running, stopped, dead, missing, unreadable };
const char* name_of(ShardState state);

struct ShardStatus {
  std::uint32_t index = 1;
  ShardState state = ShardState::missing;
  std::string path{};                // empty where it is missing
  std::optional<LockOwner> owner{};  // owner of a lock
  std::uint64_t done = 0, failed = 0, realizations = 0;
  std::uint64_t taps = 0, all_taps = 0;  // recorded and to record; a start is none
  std::string command{};                 // last process that worked on it
};

/// All shares of one study.
struct ShardsStatus {
  std::string scene;                // its name
  std::vector<ShardStatus> shards;  // [count], by their indices
  std::optional<Seconds> used;      // used processors; nothing before the first checkpoint
  std::optional<Seconds> left;      // estimated from recorded taps and their cost; nothing before
  std::vector<std::string> twice;   // files that hold a share another file holds
  std::vector<std::string> unread;  // files that cannot be read: each may hold any missing share

  std::vector<std::uint32_t> indices(ShardState state) const;
};

/// A file that cannot be read, and why.
struct BadFile {
  std::string path, reason;
};

struct Overview {
  std::vector<ShardsStatus> studies;  // one for each scene and number of shares
  std::vector<BadFile> bad_files;
};

/// Looks at the files and their checkpoints without disturbing their runs. Checksums of results
/// files are not verified: it reads little of each.
Overview overview_of(std::span<const std::string> files);

/// 1, 3, 4, 5 as "1,3-5".
std::string ranges_text(std::span<const std::uint32_t> ascending);

}  // namespace jostle::inline study
