#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/dynamics.hpp"
#include "engine/starts/starts.hpp"
#include "ensemble/plan.hpp"
#include "ensemble/sink.hpp"
#include "structure/observables.hpp"

namespace jostle::inline ensemble {

/// Result of one call of Realization::advance.
struct Slice {
  std::optional<TapRow> row;               // where a tap ended
  std::optional<SnapshotRecord> snapshot;  // where one was due at that tap
  Effort effort;
  std::chrono::nanoseconds relaxing{0};  // processor time inside the engine, without the start
};

/// The engine of a realization of a plan, with its random numbers; nothing is loaded yet.
std::unique_ptr<Dynamics> dynamics_of(const Plan& plan, std::uint32_t index);

/// One realization of a plan: start, then tap, advance until at rest and record, tap after tap. It
/// is advanced a slice at a time and can be stopped, stored and resumed between any two slices; its
/// rows and snapshots do not depend on how it was sliced.
class Realization {
 public:
  /// Begins, or resumes from a state that `state()` gave for the same plan and index. Only taps at
  /// the end of the plan may have been added since. `plan` must outlive the realization. Throws
  /// StateError for a state of another engine or version.
  Realization(const Plan& plan, std::uint32_t index,
              std::optional<RealizationState> resumed = std::nullopt);
  /// By mechanics of the caller's own, which have loaded nothing yet; the plan's engine is unused.
  Realization(const Plan& plan, std::uint32_t index, std::unique_ptr<Dynamics> dynamics,
              std::optional<RealizationState> resumed = std::nullopt);

  /// Recorded taps, the start included.
  std::uint64_t rows() const { return state_.rows; }

  /// True if every tap of the plan is recorded.
  bool finished() const;

  /// Advances until a row is complete or by about so many units of the engine. Requires
  /// !finished(). Throws StartError where the start is impossible, std::invalid_argument where the
  /// engine's settings do not suit the container; the realization is then lost. A start is
  /// abandoned once `stop` returns true, and made again by the next call: the slice is empty.
  Slice advance(std::uint64_t units, const StopAsked& stop = {});

  RealizationState state() const;
  /// Null where all spheres have the diameter 1.
  const std::shared_ptr<const Sizes>& sizes() const { return sizes_; }
  const Dynamics& dynamics() const { return *dynamics_; }

 private:
  bool start(const StopAsked& stop);
  void tap();
  bool keeps_this_row() const;
  void record(Slice& slice);
  SnapshotRecord snapshot_of_row() const;
  void add_mechanics(SnapshotRecord& record) const;

  const Plan& plan_;
  std::uint32_t index_;
  RealizationState state_;  // but for the centres and the engine, which the members below hold
  std::unique_ptr<Dynamics> dynamics_;
  std::shared_ptr<const Sizes> sizes_;  // null: equal spheres
  Packing packing_;                     // last recorded state
  RandomStream tap_random_;
  std::optional<Observer> observer_;
};

}  // namespace jostle::inline ensemble
