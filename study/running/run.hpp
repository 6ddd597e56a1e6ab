#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/run.hpp"
#include "results/locks/patience.hpp"
#include "results/run/run_store.hpp"
#include "study/bad_input.hpp"
#include "study/running/scene_file.hpp"
#include "study/seconds.hpp"
#include "study/tables/target_precision.hpp"

namespace jostle::inline study {

/// Permitted actions for an existing results file.
enum class Existing { keep, resume, replace };

struct RunSettings {
  std::string output = {};  // the results file
  Existing existing = Existing::keep;
  bool take_over = false;     // the lock of another host
  Patience patience = {};     // with another process that works on the file
  bool retry_failed = false;  // repeats failed realizations of a resumed file, once
  Shard shard = {};
  int threads = 1;
  Seconds checkpoint_every{60};
  /// A run that stops at a time limit is not refused where the disk has too little space for all.
  RunStore::Room room = RunStore::Room::for_all;
  const std::atomic<bool>* stop = nullptr;  // stops all realizations at the end of a slice
  /// A stop is soon over: where the results are larger, it leaves the parts beside the file, for
  /// the resume to go on from and the end of the run to fold. Some 20 s at the slowest rate of a
  /// fold.
  std::uint64_t most_bytes_folded_at_stop = 600'000'000;
};

/// The results file is there already, and may neither be resumed nor replaced.
class OutputExists : public BadInput {
 public:
  explicit OutputExists(const std::string& path);
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The results file that is to be resumed was begun with another scene.
class OtherScene : public BadInput {
 public:
  /// `differences`: one per line, as fault_lines() writes them.
  OtherScene(const std::string& path, const std::string& differences);
  const std::string& path() const { return path_; }
  const std::string& differences() const { return differences_; }

 private:
  std::string path_, differences_;
};

/// The results file that is to be resumed holds another shard.
class OtherShard : public BadInput {
 public:
  OtherShard(const std::string& path, const Shard& stored, const Shard& asked);
  const std::string& path() const { return path_; }
  const Shard& stored() const { return stored_; }
  const Shard& asked() const { return asked_; }

 private:
  std::string path_;
  Shard stored_, asked_;
};

/// Remaining work when realizations begin to be computed.
struct WorkAhead {
  std::uint64_t realizations = 0;
  std::uint64_t taps = 0;       // taps of all realizations, without the starts
  std::string unit = "trials";  // unit of the engine's work; empty for several engines
};

/// Receives the progress of a run. Every call comes from the thread that runs.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// Realizations are computed from here to computed(); `progress` counts them meanwhile.
  /// `pending` of `all` are to do.
  virtual void computing(const Progress& /*progress*/, const WorkAhead& /*ahead*/,
                         std::uint64_t /*pending*/, std::uint64_t /*all*/) {}
  virtual void computed() {}
  /// Reports the number of realizations in the new file.
  virtual void storing(std::uint64_t /*done*/, std::uint64_t /*total*/) {}
  virtual void stored() {}
  /// How far the scene's targets are met, after every comparison with the targets.
  virtual void compared(const PrecisionStatus&) {}
};

/// A run of a scene into a results file, which it opens once and holds, with its lock, to the end.
class SceneRun {
 public:
  /// Begins a file, or resumes one. `loaded` and `observer` must outlive this. Throws
  /// OutputExists, OtherScene, OtherShard; BadArgument for a shard of a scene that has a
  /// target precision; ResultsError.
  SceneRun(const LoadedScene& loaded, const RunSettings& settings, RunObserver& observer);

  /// Computes what is pending and folds it into the file, realizations of sweep point `first`
  /// before the others. Returns whether all of it was computed, not stopped; after a stop the file
  /// may have been left as it was, see left_in_parts(). Throws ResultsError.
  bool compute(std::optional<std::uint32_t> first = std::nullopt);
  /// Like run(), with more realizations until the scene's targets are met, if it has any.
  bool compute_until_precise();
  /// Makes room for more realizations of every point: so many in all.
  void extend(std::uint32_t realizations);

  const Study& study() const { return study_; }
  /// The state after the last fold.
  const ResultsFile& results() const { return store_->results(); }
  /// Every (point, realization), with checkpoints that are newer than the file.
  std::vector<RealizationSummary> realizations() const { return store_->realizations(); }
  const Progress& progress() const { return progress_; }
  /// True if a stop left results in the parts, because folding would take long.
  bool left_in_parts() const { return left_in_parts_; }
  /// Realizations of this run so far.
  const RunSummary& summary() const { return summary_; }
  /// Warning about the file's lock; otherwise empty.
  std::string lock_warning() const { return store_->lock_warning(); }
  /// Derived tables that the file had before: they do not outlive the data they were made of.
  const std::vector<std::string>& tables_before() const { return tables_before_; }

  /// Gives the lock back, and the file. Nothing but the destructor may be called after.
  ResultsFile close();

 private:
  Study study_for(const ResultsFile& file);
  RunSummary run(const std::vector<RealizationId>& pending);
  void fold();
  WorkAhead work_ahead(const std::vector<RealizationId>& pending) const;

  const LoadedScene& loaded_;
  RunSettings settings_;
  RunObserver& observer_;
  Study study_;
  std::unique_ptr<RunStore> store_;
  std::vector<std::string> tables_before_;
  std::uint64_t taps_recorded_ = 0;  // taps recorded of pending realizations, by earlier processes
  bool left_in_parts_ = false;
  bool retry_failed_ = false;  // those that failed are tried once, before others are added
  Progress progress_;
  RunSummary summary_;
};

}  // namespace jostle::inline study
