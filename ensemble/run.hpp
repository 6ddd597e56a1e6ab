#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ensemble/plan.hpp"
#include "ensemble/sink.hpp"

namespace jostle::inline ensemble {

/// Live counts for a progress display, read during the run.
struct Progress {
  std::atomic<std::uint64_t> realizations_done{0}, realizations_running{0}, realizations_failed{0};
  std::atomic<std::uint64_t> taps_done{0};
  std::atomic<std::uint64_t> units_done{0}, pair_tests{0};  // Effort of the engine
  std::atomic<std::uint64_t> relaxing_nanoseconds{
      0};  // relaxing nanoseconds of all threads, inside relaxations
};

struct RunOptions {
  int threads = 1;
  /// Least time between checkpoints of a realization. 0: after every slice.
  std::chrono::duration<double> checkpoint_every{60.0};
  /// Units of its engine between two checks of `stop` and of the clock. Default: the work of about
  /// 0.1 s.
  std::optional<std::uint64_t> units_per_slice = std::nullopt;
  /// Set from a signal handler or a time limit: every realization stops at the end of its slice,
  /// checkpoints and ends.
  const std::atomic<bool>* stop = nullptr;
};

/// How the realizations ended; those that a stop kept from beginning are in none of the counts.
struct RunSummary {
  std::uint64_t done = 0, failed = 0, interrupted = 0;
};

/// Runs the given realizations of the plans on `options.threads` threads, each thread taking the
/// next of the list, and hands their records to the sink. The data of a realization that reach the
/// sink depend only on its plan and index, never on threads or timing; but for when it checkpoints.
/// At a stop each realization ends with status `running` and its state. One that throws ends as
/// failed with the reason and an empty state, and the rest go on. An exception of the sink, or a
/// std::bad_alloc of a realization, which resumes from its last checkpoint, stops the run like a
/// stop and is rethrown. StateError of a realization with a state of another engine or version is
/// rethrown, too: its stored data stay.
RunSummary run_ensemble(std::span<const Plan> plans, const std::vector<RealizationId>& realizations,
                        const RunOptions& options, Sink& sink, Progress& progress);

}  // namespace jostle::inline ensemble
