#pragma once

#include <cstdint>
#include <vector>

#include "engine/bed/slab.hpp"
#include "engine/dynamics.hpp"
#include "engine/monte_carlo/stops.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

namespace jostle::inline engine {

/// Everything a relaxation must remember to go on bit for bit after a checkpoint.
struct RelaxationProgress {
  DynamicsStatus status = DynamicsStatus::running;
  std::uint64_t trials = 0;    // since the tap
  std::uint64_t accepted = 0;  // accepted trials
  bool measured = false;       // true if last_value holds a measurement
  double last_value = 0;       // last value of <Z> or the bulk fraction
  std::uint32_t passes = 0;    // times in a row the rule was met
  std::vector<double> kind_heights =
      {};  // heights of a mixture's kinds, with last_value for a rule of <Z>
  bool operator==(const RelaxationProgress&) const = default;
};

/// Runs trials until the stop rule is met, the cap is reached or about `budget` trials are done;
/// returns at a sweep boundary. `window` is the resolved window of a BulkFractionStop, else unused.
void relax(TrialLoop& loop, const Stop& stop, HeightWindow window, RelaxationProgress& progress,
           std::uint64_t budget);

}  // namespace jostle::inline engine
