#pragma once

#include <cstdint>

#include "engine/monte_carlo/moves.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

namespace jostle::inline engine {

/// Numbers of trials.
struct TrialCounts {
  std::uint64_t trials = 0, rising = 0, accepted = 0, accepted_rising = 0;
};

/// Counts trials towards the rule's window and adapts the step once it is full. Returns whether the
/// step changed. No call may go beyond the window's end.
inline bool adapt_step(const StepAdaptation& rule, MoveState& state, const TrialCounts& counts) {
  const bool all = rule.base == AcceptanceBase::all_trials;
  state.window_trials += counts.trials;
  state.window_base += all ? counts.trials : counts.trials - counts.rising;
  state.window_accepted += all ? counts.accepted : counts.accepted - counts.accepted_rising;
  if (state.window_trials < rule.every_trials) return false;
  const bool few = static_cast<double>(state.window_accepted) <
                   rule.threshold * static_cast<double>(state.window_base);
  if (few) state.step *= rule.factor;
  state.window_trials = state.window_base = state.window_accepted = 0;
  return few;
}

}  // namespace jostle::inline engine
