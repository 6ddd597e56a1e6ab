#pragma once

#include <cstdint>
#include <span>

#include "cli/durations.hpp"
#include "ensemble/plan.hpp"

namespace jostle {

/// What a short trial of a sweep point's first tap measured, and what it makes of a realization.
struct PilotEstimate {
  std::uint32_t n_spheres = 0;   // of the pilot's packing: a large one is cut down
  std::uint64_t trials = 0;      // made by the pilot
  double trials_per_second = 0;  // on one core
  double sweeps_per_tap = 0;     // a lower bound where `settled` is false
  bool settled = false;          // whether start and tap met their stop rules within the budget
  Seconds realization{0};        // a whole one on one core; a lower bound likewise
  std::size_t bytes = 0;         // held by one running realization
};

/// Makes the start, applies the first tap and relaxes it, all within about `budget` trials besides
/// the start. At most `max_spheres` spheres are poured; costs are scaled up in proportion.
/// Throws StartError where the start does not suit the container.
PilotEstimate pilot(const Plan& plan, std::uint64_t budget, std::uint32_t max_spheres = 20'000);

}  // namespace jostle
