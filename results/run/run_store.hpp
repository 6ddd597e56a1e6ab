#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/sink.hpp"
#include "results/content/stored_realization.hpp"
#include "results/content/study.hpp"
#include "results/file/results_file.hpp"

namespace jostle::inline results {

/// The results of one run on disk: a file NAME that always opens, parts under NAME.parts/ during
/// the run, and NAME.lock. Killed at any instant, it leaves its last checkpoints.
///
/// Begin/append/snapshot/checkpoint/end may be called from several threads, one realization at a
/// time from one; everything else from one thread. Every function throws ResultsError.
class RunStore : public Sink {
 public:
  /// True if a disk with less space than disk_estimate() is refused. A run that may be stopped
  /// before it has computed everything may need less.
  enum class Room { for_all, for_a_part };

  /// Starts a file. An existing one is refused unless `force`, which discards it and its parts and
  /// takes over the lock of another host; `takes_over` does the latter alone. Another process is
  /// waited for with `patience`.
  static std::unique_ptr<RunStore> create(const std::string& path, const Study& study,
                                          const Shard& shard, const Provenance& provenance,
                                          bool force = false, Room room = Room::for_all,
                                          const Patience& patience = {}, bool takes_over = false);
  /// Resumes a file. `study` is the stored one, or it has more taps at the end, more
  /// realizations or more sweep points, in any order: the caller compares the scenes
  /// (ResultsFile::study) and refuses other changes. Points are known by their ids. A share of a
  /// run keeps its points: their number decides which realizations are its own.
  /// The shard must be the stored one. `force` only takes over the lock of another host.
  static std::unique_ptr<RunStore> resume(const std::string& path, const Study& study,
                                          const Shard& shard, const Provenance& provenance,
                                          bool force = false, const Patience& patience = {});
  /// Like the constructor above, for a study that depends on the file's contents: `study_for`
  /// receives the locked, verified file, and may throw.
  static std::unique_ptr<RunStore> resume(const std::string& path,
                                          const std::function<Study(const ResultsFile&)>& study_for,
                                          const Shard& shard, const Provenance& provenance,
                                          bool force = false, Room room = Room::for_all,
                                          const Patience& patience = {});
  /// Gives the lock back; parts that were not folded stay for a resume.
  ~RunStore() override;
  /// Ends a store: gives the lock back, and its file as the last fold left it, open and verified.
  static ResultsFile close(std::unique_ptr<RunStore> store);

  /// Warning about the lock if flock does not work here; otherwise empty.
  std::string lock_warning() const;
  /// The file as the last fold left it, until the next one.
  const ResultsFile& results() const;
  /// Every (point, realization), points outermost, with the checkpoints that are newer than the
  /// file.
  std::vector<RealizationSummary> realizations() const;

  /// Realizations of the shard that have taps left to do; failed ones only if asked for, and those
  /// begin anew.
  std::vector<RealizationId> pending(bool retry_failed = false) const;

  /// Makes room for more realizations of every point: `realizations` in all. After finish().
  void extend(std::uint32_t realizations);

  std::optional<RealizationState> begin(RealizationId id) override;
  void append(RealizationId id, const TapRow& row) override;
  void snapshot(RealizationId id, const SnapshotRecord& record) override;
  void checkpoint(RealizationId id, const RealizationState& state, const Work& work) override;
  void end(RealizationId id, const RealizationState& state, const Outcome& outcome) override;

  /// Folds everything into a new file in the order of (point, realization), replaces the old one
  /// by it, then deletes the parts. At the end of a run and at a graceful stop alike: the
  /// restart states of unfinished realizations are in the file. `progress` receives the progress.
  void finish(const StoringProgress& progress = {});
  /// For the file and its parts: what finish() reads and writes about once.
  std::uint64_t bytes_to_fold() const;

 private:
  class Impl;
  explicit RunStore(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace jostle::inline results
