#include "engine/dynamics.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "engine/monte_carlo/monte_carlo.hpp"
#include "engine/monte_carlo/relaxation.hpp"
#include "engine/monte_carlo/state.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

namespace jostle::inline engine {

namespace {

// The window of the stop rule; {0, 0} for a rule without one. By quantiles it is that of the bed at
// tap 0, for the whole realization.
HeightWindow stop_window(const Stop& stop, const Packing& bed) {
  const auto* rule = std::get_if<BulkFractionStop>(&stop.rule);
  return rule != nullptr ? resolve(rule->window, bed) : HeightWindow{0, 0};
}

// The window for the relaxation of the start itself, when there is no bed yet to take quantiles of:
// those of a uniform bed (docs/developers/decisions/stop-window-of-the-start.md).
HeightWindow start_stop_window(const Stop& stop, const Packing& packing) {
  const auto* rule = std::get_if<BulkFractionStop>(&stop.rule);
  if (rule == nullptr) return {0, 0};
  if (const auto* heights = std::get_if<HeightWindow>(&rule->window)) return *heights;
  constexpr double settled_fraction = 0.57;  // 0.56 to 0.58, Rosato et al. 2010, sec. II
  const double solid = solid_volume(packing);
  const double depth = solid / (settled_fraction * footprint_area(packing.container));
  const auto& quantiles = std::get<QuantileWindow>(rule->window);
  return {quantiles.low * depth, quantiles.high * depth};
}

class MonteCarloDynamics final : public Dynamics {
 public:
  MonteCarloDynamics(const MonteCarlo& settings, const DynamicsStreams& streams)
      : settings_(settings), streams_(streams) {}

  void load(const Packing& bed) override {
    packing_ = bed;
    loop_.reset();
  }

  void settle(const Start& start) override {
    if (relaxation_of_start(settings_, start) == nullptr) {
      state_.progress.status = DynamicsStatus::settled;
      return;
    }
    state_.stop_window = start_stop_window(relaxation().stop, packing_);
    begin();
  }

  void tap(const Tap& tap, RandomStream& random) override {
    if (moving()) cut_short();
    state_.dropped_offsets = excite(packing_, tap, random).lateral_offsets_dropped;
    check_height();
    begin();
  }

  DynamicsStatus advance(std::uint64_t trials) override {
    const DynamicsStatus& status = state_.progress.status;
    if (status == DynamicsStatus::running) relax_for(trials);
    if (status != DynamicsStatus::running && !state_.tapping) begin_taps();
    return status;
  }

  void store(Packing& bed) const override {
    bed = packing_;
    if (loop_ && moving()) loop_->store(bed);
  }

  std::vector<double> diagnostics() const override {
    const RelaxationProgress& progress = state_.progress;
    const auto n = static_cast<double>(packing_.centres.size());
    const auto trials = static_cast<double>(progress.trials);
    return {trials / n,
            progress.trials > 0 ? static_cast<double>(progress.accepted) / trials
                                : std::numeric_limits<double>::quiet_NaN(),
            progress.status == DynamicsStatus::capped ? 1.0 : 0.0,
            static_cast<double>(state_.dropped_offsets) / n};
  }

  Effort effort() const override { return effort_; }
  std::uint64_t units_per_slice() const override { return 4'000'000; }
  std::size_t bytes() const override {
    return packing_.centres.size() * sizeof(Vec3) + (loop_ ? loop_->bytes() : 0);
  }

  std::vector<std::byte> save() const override {
    MonteCarloState state = state_;
    if (loop_) keep_place(state);
    if (!moving()) {  // state of the next trial: independent of the last relaxation
      state.progress = {.status = DynamicsStatus::settled};
      state.dropped_offsets = 0;
    }
    return bytes_of(state);
  }

  void restore(std::span<const std::byte> state) override {
    state_ = monte_carlo_state(state);
    loop_.reset();
  }

 private:
  bool moving() const { return state_.progress.status == DynamicsStatus::running; }

  // The one that is on, or comes next.
  const Relaxation& relaxation() const {
    return !state_.tapping && settings_.relax_start ? *settings_.relax_start : settings_.relax;
  }

  // A new loop is a resumed one: it takes over the centres and the number of the next trial.
  TrialLoop& loop() {
    if (loop_) return *loop_;
    loop_ = make_trial_loop(packing_.container, relaxation().move,
                            state_.tapping ? streams_.taps : streams_.start, best_instruction_set(),
                            relaxation().sampler,
                            packing_.sizes ? SphereSizes::several : SphereSizes::equal);
    loop_->load(packing_);
    if (state_.move.next_trial > 0) loop_->restore(state_.move, state_.sampler);
    return *loop_;
  }

  void keep_place(MonteCarloState& state) const {
    state.move = loop_->state();
    state.sampler = loop_->sampler_state();
  }

  void begin() {
    loop().load(packing_);
    loop().begin_tap();
    state_.progress = {};
  }

  // Not far beyond it heights would be infinite.
  void check_height() const {
    constexpr double highest = 1e300;
    if (std::ranges::max(packing_.centres, {}, &Vec3::z).z <= highest) return;
    throw std::runtime_error(
        "the bed has risen beyond a height of 1e300 d: these taps lift it further than it comes "
        "down "
        "before the relaxation ends; relax more completely (smaller eta, more sweeps) or tap more "
        "gently");
  }

  void cut_short() {
    loop().store(packing_);
    state_.progress = {.status = DynamicsStatus::settled};
    if (!state_.tapping) begin_taps();
  }

  void relax_for(std::uint64_t trials) {
    const TrialTally tally_before = loop().tally();
    relax(loop(), relaxation().stop, state_.stop_window, state_.progress, trials);
    const TrialTally& tally_after = loop().tally();
    effort_ += {tally_after.trials - tally_before.trials,
                tally_after.distance_tests - tally_before.distance_tests};
    if (!moving()) loop().store(packing_);
  }

  // The start is at rest: from here on, trials after taps, with numbers of their own. Only a start
  // that was relaxed by the rule of the taps passes on the number of its next trial.
  void begin_taps() {
    state_.move = {};
    state_.sampler = {};
    const bool by_one_rule = !settings_.relax_start || *settings_.relax_start == settings_.relax;
    if (loop_ && by_one_rule) keep_place(state_);
    loop_.reset();
    state_.stop_window = stop_window(settings_.relax.stop, packing_);
    state_.tapping = true;
  }

  MonteCarlo settings_;
  DynamicsStreams streams_;
  Packing packing_;        // out of date while trials are made: the loop then has the centres
  MonteCarloState state_;  // but for the place of the trials where there is a loop
  std::unique_ptr<TrialLoop> loop_;  // made when first needed
  Effort effort_;
};

}  // namespace

std::unique_ptr<Dynamics> make_dynamics(const MonteCarlo& settings,
                                        const DynamicsStreams& streams) {
  return std::make_unique<MonteCarloDynamics>(settings, streams);
}

}  // namespace jostle::inline engine
