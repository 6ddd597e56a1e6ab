#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "ensemble/plan.hpp"
#include "ensemble/sink.hpp"
#include "structure/observables.hpp"

namespace jostle {

/// What one call of Realization::advance did.
struct Slice {
  std::optional<TapRow> row;               // where a tap ended
  std::optional<SnapshotRecord> snapshot;  // where one was due at that tap
  std::uint64_t trials = 0;
  std::uint64_t distance_tests = 0;
  std::chrono::nanoseconds relaxing{0};  // processor time inside the relaxation
};

/// One realization of a plan: start, then excite, relax and observe, tap after tap. It is advanced
/// a slice at a time and can be stopped, stored and resumed between any two slices; its rows and
/// snapshots do not depend on how it was sliced.
class Realization {
 public:
  /// Begins anew, or goes on from a state that `state()` gave for the same plan and index. Of the
  /// plan, only taps at the end may have been added since. `plan` must outlive the realization.
  Realization(const Plan& plan, std::uint32_t index,
              std::optional<RealizationState> resumed = std::nullopt);

  /// Recorded taps, the start included.
  std::uint64_t rows() const { return state_.rows; }

  /// Whether every tap of the plan is recorded.
  bool finished() const;

  /// Goes on until a row is complete or about `trials` trials are made, to the next end of a sweep.
  /// Requires !finished(). Throws StartError where the start is impossible, std::invalid_argument
  /// where the move does not suit the container; the realization is then lost. A start is given up
  /// once `stop` says so, to be made anew by the next call: the slice is empty.
  Slice advance(std::uint64_t trials, const StopAsked& stop = {});

  RealizationState state() const;

 private:
  bool start(const StopAsked& stop);
  void tap();
  void begin_relaxation();
  void relax_for(std::uint64_t trials, Slice& slice);
  void record(Slice& slice);
  void resolve_windows();
  std::vector<double> diagnostics() const;
  SnapshotRecord snapshot_of_row() const;
  const MonteCarlo& engine() const;
  const Relaxation& relaxation() const;  // the one that is on, or comes next
  TrialLoop& loop();

  const Plan& plan_;
  std::uint32_t index_;
  RealizationState state_;  // but for the centres and the move, which the members below hold
  Packing packing_;         // out of date while relaxing: the loop then has the centres
  RandomStream tap_random_;
  std::unique_ptr<TrialLoop> loop_;  // made when first needed
  std::optional<Observer> observer_;
};

}  // namespace jostle
