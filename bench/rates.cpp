#include "bench/rates.hpp"

#include "bench/stopwatch.hpp"

namespace jostle::bench {

Rate measure_rate(TrialLoop& loop, std::uint64_t trials) {
  const TrialTally tally_before = loop.tally();
  const double began = thread_seconds();
  loop.run(trials);
  Rate rate{.trials = trials, .seconds = thread_seconds() - began};
  const TrialTally& tally_after = loop.tally();
  const auto n = static_cast<double>(trials);
  const double n_spheres = loop.n_spheres();
  const auto renewals =
      static_cast<double>(tally_after.list_renewals - tally_before.list_renewals) +
      n_spheres * static_cast<double>(tally_after.list_builds - tally_before.list_builds);
  rate.acceptance = static_cast<double>(tally_after.accepted - tally_before.accepted) / n;
  rate.distance_tests_per_trial =
      static_cast<double>(tally_after.distance_tests - tally_before.distance_tests) / n;
  rate.list_renewals_per_sweep = renewals * n_spheres / n;
  rate.bytes_per_sphere = static_cast<double>(loop.bytes()) / n_spheres;
  return rate;
}

}  // namespace jostle::bench
