#pragma once

#include <cstdint>

#include "engine/monte_carlo/trial_loop.hpp"

namespace jostle::bench {

/// Cost of some trials.
struct Rate {
  std::uint64_t trials = 0;
  double seconds = 0;  // seconds of processor time of the calling thread
  double acceptance = 0;
  double distance_tests_per_trial = 0;
  double list_renewals_per_sweep = 0;  // a rebuild of all lists counts as a renewal of each
  double bytes_per_sphere = 0;

  double trials_per_second() const { return static_cast<double>(trials) / seconds; }
};

/// Makes `trials` trials and looks at the clock before and after.
Rate measure_rate(TrialLoop& loop, std::uint64_t trials);

}  // namespace jostle::bench
