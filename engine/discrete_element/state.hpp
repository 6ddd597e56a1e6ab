#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/discrete_element/driven_sums.hpp"
#include "engine/discrete_element/grain_loop.hpp"

namespace jostle::inline engine {

/// State from which a realization by discrete elements resumes, besides the centres in the box.
struct GrainDynamicsState {
  DynamicsStatus status = DynamicsStatus::settled;
  double quiet_since = -1;  // time of the tap since which the bed is quiet; negative: it is not
  double input = 0;         // by a displacement at the tap's begin, m g d
  std::uint64_t dropped_offsets = 0;  // dropped offsets of a shake at the tap's begin
  Energies start_energies;            // at the beginning of the tap, after the displacement
  DrivenSums driven;                  // state of a tap whose motion is watched
  GrainLoop::State loop;
};

/// Converts to bytes, which begin with their version, and back. Reading throws StateError for other
/// bytes.
std::vector<std::byte> bytes_of(const GrainDynamicsState& state);
GrainDynamicsState grain_state(std::span<const std::byte> bytes);

}  // namespace jostle::inline engine
