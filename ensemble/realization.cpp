#include "ensemble/realization.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "engine/bed/slab.hpp"
#include "engine/monte_carlo/relaxation.hpp"
#include "engine/taps.hpp"
#include "ensemble/processor_clock.hpp"
#include "structure/snapshot_statistics.hpp"

namespace jostle {

namespace {

// Matched streams: the start, its relaxation and the taps draw at every sweep point what they draw
// at the point without one.
StreamKey key_of(const Plan& plan, std::uint32_t index, Purpose purpose) {
  const bool shared = plan.streams == Streams::matched && purpose != Purpose::trials;
  return stream_key(plan.seed, shared ? 0 : plan.point_id, index, purpose);
}

// The window of the stop rule; {0, 0} for a rule without one.
HeightWindow stop_window(const Stop& stop, const Packing& packing) {
  const auto* rule = std::get_if<BulkFractionStop>(&stop.rule);
  return rule != nullptr ? resolve(rule->window, packing) : HeightWindow{0, 0};
}

// The same for the relaxation of the start itself, when there is no bed yet to take quantiles of:
// those of a uniform bed (docs/decisions/stop-window-of-the-start.md).
HeightWindow start_stop_window(const Stop& stop, const Packing& packing) {
  const auto* rule = std::get_if<BulkFractionStop>(&stop.rule);
  if (rule == nullptr) return {0, 0};
  if (const auto* heights = std::get_if<HeightWindow>(&rule->window)) return *heights;
  constexpr double settled_fraction = 0.57;  // 0.56 to 0.58, Rosato et al. 2010, sec. II
  const double solid = sphere_volume * static_cast<double>(packing.centres.size());
  const double depth = solid / (settled_fraction * footprint_area(packing.container));
  const auto& quantiles = std::get<QuantileWindow>(rule->window);
  return {quantiles.low * depth, quantiles.high * depth};
}

}  // namespace

Realization::Realization(const Plan& plan, std::uint32_t index,
                         std::optional<RealizationState> resumed)
    : plan_(plan),
      index_(index),
      state_(resumed ? std::move(*resumed) : RealizationState{}),
      packing_{plan.container, std::exchange(state_.centres, {})},
      tap_random_(key_of(plan, index, Purpose::tap), state_.tap_stream_position) {
  if (state_.rows > 0) observer_.emplace(plan.observables, state_.observable_windows);
}

bool Realization::finished() const {
  return state_.rows > total_taps(plan_);
}

Slice Realization::advance(std::uint64_t trials, const StopAsked& stop) {
  assert(!finished());
  Slice slice;
  if (!state_.relaxing) {
    if (state_.rows > 0) {
      tap();
    } else if (!start(stop)) {
      return slice;
    }
  }
  if (state_.relaxing) relax_for(trials, slice);
  if (!state_.relaxing) record(slice);
  return slice;
}

// Returns whether it was finished, not stopped.
bool Realization::start(const StopAsked& stop) {
  RandomStream random(key_of(plan_, index_, Purpose::start));
  Packing poured;
  try {
    packing_ = make_start(plan_.start, plan_.container, plan_.n_spheres, random, stop, &poured);
  } catch (const StartStopped&) {
    return false;
  }
  if (!poured.centres.empty()) state_.fitting = fitting_report(poured, packing_);
  if (relaxation_of_start(engine(), plan_.start) == nullptr) return true;
  state_.stop_window = start_stop_window(relaxation().stop, packing_);
  begin_relaxation();
  return true;
}

void Realization::tap() {
  const TapReport report = excite(packing_, tap_number(plan_, state_.rows), tap_random_);
  state_.dropped_offsets = report.lateral_offsets_dropped;
  begin_relaxation();
}

void Realization::begin_relaxation() {
  loop().load(packing_);
  loop().begin_tap();
  state_.relaxation = {};
  state_.relaxing = true;
}

void Realization::relax_for(std::uint64_t trials, Slice& slice) {
  const TrialTally before = loop().tally();
  const auto began = ProcessorClock::now();
  relax(loop(), relaxation().stop, state_.stop_window, state_.relaxation, trials);
  slice.relaxing = ProcessorClock::now() - began;
  slice.trials = loop().tally().trials - before.trials;
  slice.distance_tests = loop().tally().distance_tests - before.distance_tests;
  if (state_.relaxation.status == RelaxationStatus::running) return;
  loop().store(packing_);
  state_.relaxing = false;
}

void Realization::record(Slice& slice) {
  if (state_.rows == 0) resolve_windows();
  slice.row = TapRow{state_.rows, (*observer_)(packing_), diagnostics()};
  if (std::ranges::binary_search(plan_.snapshots.taps, state_.rows)) {
    slice.snapshot = snapshot_of_row();
  }
  ++state_.rows;
  state_.dropped_offsets = 0;
  if (state_.rows == 1 && loop_) {  // the start was relaxed: from here on, the taps' trials
    const bool by_one_rule = !engine().relax_start || *engine().relax_start == engine().relax;
    state_.move = by_one_rule ? loop_->state() : MoveState{};
    state_.sampler = by_one_rule ? loop_->sampler_state() : SamplerState{};
    loop_.reset();
  }
}

// Windows by quantiles are those of the bed at tap 0, for the whole realization.
void Realization::resolve_windows() {
  observer_.emplace(plan_.observables, packing_);
  state_.observable_windows = observer_->windows();
  state_.stop_window = stop_window(engine().relax.stop, packing_);
}

std::vector<double> Realization::diagnostics() const {
  const RelaxationProgress& relaxation = state_.relaxation;
  const auto n = static_cast<double>(packing_.centres.size());
  const auto trials = static_cast<double>(relaxation.trials);
  return {trials / n,
          relaxation.trials > 0 ? static_cast<double>(relaxation.accepted) / trials
                                : std::numeric_limits<double>::quiet_NaN(),
          relaxation.status == RelaxationStatus::capped ? 1.0 : 0.0,
          static_cast<double>(state_.dropped_offsets) / n};
}

SnapshotRecord Realization::snapshot_of_row() const {
  const Snapshots& wanted = plan_.snapshots;
  SnapshotRecord record;
  record.tap = state_.rows;
  if (wanted.positions) record.centres = packing_.centres;
  if (wanted.coordination) record.coordination = coordination(packing_, wanted.contact_cut);
  if (wanted.height_histogram)
    record.height_histogram = height_histogram(packing_, wanted.bin_width);
  return record;
}

RealizationState Realization::state() const {
  RealizationState state = state_;
  state.tap_stream_position = tap_random_.position();
  if (loop_) {
    state.move = loop_->state();
    state.sampler = loop_->sampler_state();
  }
  Packing stored = packing_;
  if (state_.relaxing && loop_) loop_->store(stored);
  state.centres = std::move(stored.centres);
  return state;
}

const MonteCarlo& Realization::engine() const {
  return std::get<MonteCarlo>(plan_.engine);
}

const Relaxation& Realization::relaxation() const {
  const Relaxation* of_start = relaxation_of_start(engine(), plan_.start);
  return state_.rows == 0 && of_start != nullptr ? *of_start : engine().relax;
}

// A new loop is a resumed one: it takes over the centres and where the trials stand.
TrialLoop& Realization::loop() {
  if (loop_) return *loop_;
  const Purpose purpose = state_.rows == 0 ? Purpose::start_trials : Purpose::trials;
  loop_ = make_trial_loop(plan_.container, relaxation().move, key_of(plan_, index_, purpose),
                          best_instruction_set(), relaxation().sampler);
  loop_->load(packing_);
  if (state_.move.next_trial > 0) loop_->restore(state_.move, state_.sampler);
  return *loop_;
}

}  // namespace jostle
