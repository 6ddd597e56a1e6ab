#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/bed/elementary.hpp"
#include "engine/bed/philox.hpp"
#include "engine/monte_carlo/kernel/falling_trials.hpp"
#include "engine/monte_carlo/kernel/neighbourhood.hpp"
#include "engine/monte_carlo/kernel/proposals.hpp"
#include "engine/monte_carlo/step_adaptation.hpp"
#include "engine/monte_carlo/theta_table.hpp"

// The moves as the trial loop is compiled for them, one type each: what a trial proposes, which
// trials are looked at, and what decides beside geometry. A new move is one more type.
namespace jostle::inline engine {

/// Trials of a batch by the order in which they are looked at: first .. last - 1.
struct TrialRange {
  std::uint32_t first, last;
};

/// The functions of a move that the loop calls. `step` is MoveState::step.
template <class Policy>
concept MovePolicy = requires(Policy& move, const Policy& constant_move,
                              const ProposalKernels& kernels, const BatchOrigin& origin,
                              ProposalBatch& batch, MoveState& state, const TrialCounts& counts,
                              double step, std::uint32_t t) {
  /// True if floor, sides and neighbours alone decide: then blocker caches serve.
  { Policy::geometry_decides } -> std::convertible_to<bool>;
  { constant_move.max_step() } -> std::same_as<double>;
  move.propose(kernels, origin, batch);
  /// Diameters a unit of the batch's displacements.
  { constant_move.unit(step) } -> std::same_as<double>;
  { constant_move.reach(step) } -> std::same_as<Reach>;
  /// Marks the trials t .. of the batch that are tested; the others rise, and are rejected.
  { constant_move.looked_at(t, t) } -> std::same_as<TrialRange>;
  { constant_move.trial(t) } -> std::same_as<std::uint32_t>;
  /// True if a displacement that is looked at rises, and may pass or not; dz of the batch.
  { constant_move.rises(step) } -> std::same_as<bool>;
  /// True if it accepts the rise; trial number, m g dz in units of m g d.
  { constant_move.accepts_rise(std::uint64_t{}, step) } -> std::same_as<bool>;
  /// The step through a tap: what it begins with, and how it adapts (true: it changed).
  constant_move.begin_tap(state);
  { constant_move.until_adaptation(state) } -> std::same_as<std::uint64_t>;
  { constant_move.adapt(state, counts) } -> std::same_as<bool>;
};

/// Where every trial is looked at and geometry alone decides.
struct GeometryDecides {
  static constexpr bool geometry_decides = true;
  static TrialRange looked_at(std::uint32_t begin, std::uint32_t end) { return {begin, end}; }
  static std::uint32_t trial(std::uint32_t k) { return k; }
  static bool rises(double) { return false; }
  static bool accepts_rise(std::uint64_t, double) { return true; }
};

/// Steps down only (PolarMove). Philippe & Bideau 2001, sec. II.
class Polar : public GeometryDecides {
 public:
  explicit Polar(const PolarMove& move) : move_(move), theta_table_(make_theta_table(move)) {}

  double max_step() const { return move_.max_step; }
  void propose(const ProposalKernels& kernels, const BatchOrigin& origin,
               ProposalBatch& batch) const {
    kernels.polar(origin, theta_table_.data(), move_.max_step, batch);
  }
  static double unit(double) { return 1; }
  static Reach reach(double step) { return {step * rounding_up, mean_dz * step}; }
  static void begin_tap(MoveState&) {}
  static std::uint64_t until_adaptation(const MoveState&) { return never; }
  static bool adapt(MoveState&, const TrialCounts&) { return false; }

  const std::vector<double>& theta_table() const { return theta_table_; }
  std::size_t bytes() const { return sizeof(double) * theta_table_.capacity(); }

 private:
  static constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();
  static constexpr double rounding_up = 1.000001;
  static constexpr double mean_dz = -0.43;  // mean descent in units of max_step, at theta0 = pi/4

  PolarMove move_;
  std::vector<double> theta_table_;
};

/// Steps uniform in a cube (MetropolisMove), whose size may adapt. Rosato et al. 2010, sec. II.
class CubicStep {
 public:
  explicit CubicStep(const MetropolisMove& move) : move_(move) {}

  double max_step() const { return move_.max_step; }
  static void propose(const ProposalKernels& kernels, const BatchOrigin& origin,
                      ProposalBatch& batch) {
    kernels.metropolis(origin, batch);
  }
  static double unit(double step) { return step; }
  static Reach reach(double step) { return {half_diagonal * step * rounding_up, 0}; }
  void begin_tap(MoveState& state) const {
    if (!move_.adaptation || !move_.adaptation->reset_each_tap) return;
    state.step = move_.max_step;
    state.window_trials = state.window_base = state.window_accepted = 0;
  }
  std::uint64_t until_adaptation(const MoveState& state) const {
    return move_.adaptation ? move_.adaptation->every_trials - state.window_trials
                            : std::numeric_limits<std::uint64_t>::max();
  }
  bool adapt(MoveState& state, const TrialCounts& counts) const {
    return move_.adaptation && adapt_step(*move_.adaptation, state, counts);
  }
  static std::size_t bytes() { return 0; }

 protected:
  static constexpr double half_diagonal = 1.7320508075688773, rounding_up = 1.000001;

  MetropolisMove move_;
};

/// The Metropolis move where height does not matter.
class WithoutGravity : public CubicStep, public GeometryDecides {
 public:
  using CubicStep::CubicStep;
};

/// The Metropolis move at beta = infinity: upward moves are rejected, unseen.
class ZeroTemperature : public CubicStep {
 public:
  static constexpr bool geometry_decides = true;
  using CubicStep::CubicStep;

  void propose(const ProposalKernels& kernels, const BatchOrigin& origin, ProposalBatch& batch) {
    CubicStep::propose(kernels, origin, batch);
    falling_.list(batch);
  }
  static Reach reach(double step) { return {CubicStep::reach(step).longest, -0.5 * step}; }
  TrialRange looked_at(std::uint32_t begin, std::uint32_t end) const {
    return {falling_.count_before(begin), falling_.count_before(end)};
  }
  std::uint32_t trial(std::uint32_t k) const { return falling_[k]; }
  static bool rises(double) { return false; }
  static bool accepts_rise(std::uint64_t, double) { return false; }

 private:
  FallingTrials falling_;
};

/// The Metropolis move at a finite beta: an upward move passes with probability exp(-beta m g dz).
class Metropolis : public CubicStep {
 public:
  static constexpr bool geometry_decides = false;
  /// `key` is the stream of the trials: what decides a rise is lane 1 of the trial's block.
  Metropolis(const MetropolisMove& move, StreamKey key) : CubicStep(move), key_(key) {}

  static TrialRange looked_at(std::uint32_t begin, std::uint32_t end) { return {begin, end}; }
  static std::uint32_t trial(std::uint32_t k) { return k; }
  static bool rises(double dz) { return dz > 0; }
  [[gnu::noinline]] bool accepts_rise(std::uint64_t trial, double cost) const {
    const double u = (philox_block(key_, trial, 1)[0] + 0.5) * 0x1p-32;
    return u < exponential(-(move_.beta * cost));
  }

 private:
  StreamKey key_;
};

/// Calls act(policy) with the policy of a move in a box of that type, and returns its result; null
/// where the move does not suit the box (container_fault).
template <class Result, class Box, class Act>
Result with_policy(const PolarMove& move, StreamKey, const Act& act) {
  if constexpr (Box::shape().has_floor()) return act(Polar(move));
  return nullptr;
}
template <class Result, class Box, class Act>
Result with_policy(const MetropolisMove& move, StreamKey key, const Act& act) {
  if constexpr (!Box::shape().has_floor()) {
    return act(WithoutGravity(move));
  } else if (move.beta != std::numeric_limits<double>::infinity()) {
    return act(Metropolis(move, key));
  } else {
    return act(ZeroTemperature(move));
  }
}

static_assert(MovePolicy<Polar> && MovePolicy<WithoutGravity> && MovePolicy<ZeroTemperature> &&
              MovePolicy<Metropolis>);

}  // namespace jostle::inline engine
