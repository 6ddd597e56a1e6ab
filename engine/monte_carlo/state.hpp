#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/bed/window.hpp"
#include "engine/monte_carlo/relaxation.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

namespace jostle::inline engine {

/// State from which a realization by Monte Carlo resumes, besides the centres.
struct MonteCarloState {
  bool tapping = false;         // true if the start is at rest: what follows is after taps
  RelaxationProgress progress;  // settled at once in a bed at rest
  MoveState move;
  SamplerState sampler;
  std::uint64_t dropped_offsets = 0;  // dropped offsets of the tap that is being relaxed
  HeightWindow stop_window{0, 0};     // stop window of the relaxation that is on or comes next
  bool operator==(const MonteCarloState&) const = default;
};

/// Converts to bytes, which begin with their version, and back. Reading throws StateError for other
/// bytes.
std::vector<std::byte> bytes_of(const MonteCarloState& state);
MonteCarloState monte_carlo_state(std::span<const std::byte> bytes);

}  // namespace jostle::inline engine
