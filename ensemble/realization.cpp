#include "ensemble/realization.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "ensemble/processor_clock.hpp"
#include "structure/snapshot_statistics.hpp"

namespace jostle::inline ensemble {

namespace {

bool moves_in_time(const Snapshots& wanted) {
  return wanted.velocities || wanted.contacts || wanted.granular_temperature || wanted.forces ||
         wanted.driven_temperature;
}

}  // namespace

std::unique_ptr<Dynamics> dynamics_of(const Plan& plan, std::uint32_t index) {
  return make_dynamics(plan.engine, {.start = stream_key(plan, index, Purpose::start_trials),
                                     .taps = stream_key(plan, index, Purpose::trials)});
}

Realization::Realization(const Plan& plan, std::uint32_t index,
                         std::optional<RealizationState> resumed)
    : Realization(plan, index, dynamics_of(plan, index), std::move(resumed)) {}

Realization::Realization(const Plan& plan, std::uint32_t index, std::unique_ptr<Dynamics> dynamics,
                         std::optional<RealizationState> resumed)
    : plan_(plan),
      index_(index),
      state_(resumed ? std::move(*resumed) : RealizationState{}),
      dynamics_(std::move(dynamics)),
      sizes_(sizes_of(plan, index)),
      packing_{plan.container, std::exchange(state_.centres, {}), sizes_},
      tap_random_(stream_key(plan, index, Purpose::tap), state_.tap_stream_position) {
  if (!state_.diameters.empty() && (!sizes_ || state_.diameters != diameters_of(*sizes_)))
    throw StateError(
        "the stored state has spheres of other diameters than this version of the program draws: "
        "go on with the version that began the run");
  state_.diameters.clear();
  if (state_.rows > 0)
    observer_.emplace(with_kinds(plan.observables, plan.kinds), state_.observable_windows);
  if (packing_.centres.empty()) return;
  dynamics_->load(packing_);
  dynamics_->restore(std::exchange(state_.engine, {}));
}

bool Realization::finished() const {
  return state_.rows > total_taps(plan_);
}

Slice Realization::advance(std::uint64_t units, const StopAsked& stop) {
  assert(!finished());
  Slice slice;
  if (!state_.relaxing && state_.rows == 0 && !start(stop)) return slice;
  if (!state_.relaxing && state_.rows > 0) tap();
  const Effort effort_before = dynamics_->effort();
  const auto began = ProcessorClock::now();
  state_.relaxing = dynamics_->advance(units) == DynamicsStatus::running;
  slice.relaxing = ProcessorClock::now() - began;
  slice.effort = dynamics_->effort() - effort_before;
  if (!state_.relaxing) record(slice);
  return slice;
}

void Realization::tap() {
  dynamics_->tap(tap_number(plan_, state_.rows), tap_random_);
  const Snapshots& wanted = plan_.snapshots;
  if (wanted.driven_temperature && keeps_this_row()) dynamics_->watch_motion(wanted.bin_width);
}

bool Realization::keeps_this_row() const {
  return std::ranges::binary_search(plan_.snapshots.taps, state_.rows);
}

// Returns whether it was made, not stopped.
bool Realization::start(const StopAsked& stop) {
  RandomStream random(stream_key(plan_, index_, Purpose::start));
  Packing poured;
  try {
    packing_ = make_start(plan_.start, plan_.container, start_spheres(plan_, sizes_), random, stop,
                          &poured);
  } catch (const StartStopped&) {
    return false;
  }
  if (!poured.centres.empty()) state_.fitting = fitting_report(poured, packing_);
  dynamics_->load(packing_);
  dynamics_->settle(plan_.start);
  return true;
}

void Realization::record(Slice& slice) {
  dynamics_->store(packing_);
  if (state_.rows == 0) {  // windows by quantiles are those of the bed at tap 0
    observer_.emplace(with_kinds(plan_.observables, plan_.kinds), packing_);
    state_.observable_windows = observer_->windows();
  }
  if (plan_.motion) {
    if (!state_.motion) state_.motion.emplace();
    follow_motion(*plan_.motion, packing_, state_.rows, *state_.motion);
  }
  slice.row = TapRow{state_.rows, (*observer_)(packing_), dynamics_->diagnostics()};
  if (keeps_this_row()) slice.snapshot = snapshot_of_row();
  ++state_.rows;
}

SnapshotRecord Realization::snapshot_of_row() const {
  const Snapshots& wanted = plan_.snapshots;
  SnapshotRecord record;
  record.tap = state_.rows;
  if (wanted.positions) record.centres = packing_.centres;
  if (wanted.coordination) record.coordination = coordination(packing_, wanted.contact_cut);
  // A quantity that a bed does not have is stored as missing.
  if (wanted.height_histogram && has_height_bins(packing_, wanted.bin_width))
    record.height_histogram = height_histogram(packing_, wanted.bin_width);
  if (moves_in_time(wanted)) add_mechanics(record);
  return record;
}

void Realization::add_mechanics(SnapshotRecord& record) const {
  const Snapshots& wanted = plan_.snapshots;
  BedMechanics bed = dynamics_->mechanics();
  if (bed.velocities.empty()) return;
  if (wanted.granular_temperature && has_height_bins(packing_, wanted.bin_width)) {
    GranularTemperature temperature =
        granular_temperature(packing_, bed.velocities, wanted.bin_width);
    record.temperature_lateral = std::move(temperature.lateral);
    record.temperature_vertical = std::move(temperature.vertical);
  }
  if (wanted.forces) record.forces = bed_forces(packing_, bed.contacts);
  if (wanted.driven_temperature) {
    record.driven_fraction = std::move(bed.driven.fraction);
    record.driven_lateral = std::move(bed.driven.lateral);
    record.driven_vertical = std::move(bed.driven.vertical);
  }
  if (wanted.contacts) record.contacts = std::move(bed.contacts);
  if (!wanted.velocities) return;
  record.velocities = std::move(bed.velocities);
  record.spins = std::move(bed.spins);
}

RealizationState Realization::state() const {
  RealizationState state = state_;
  state.tap_stream_position = tap_random_.position();
  if (packing_.centres.empty()) return state;
  Packing bed;
  dynamics_->store(bed);
  state.centres = std::move(bed.centres);
  if (sizes_ && has_drawn_sizes(plan_)) state.diameters = diameters_of(*sizes_);
  state.engine = dynamics_->save();
  return state;
}

}  // namespace jostle::inline ensemble
