#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/monte_carlo/kernel/proposals.hpp"

namespace jostle::inline engine {

/// Decides whether blocker caches pay, by thresholds on the acceptance ratio, with hysteresis:
/// caching begins below 1/6 and ends above 1/4 (docs/developers/performance.md). It decides at most
/// once per sweep, and changes no trial.
class CachingRule {
 public:
  /// Counts trials of a bed of n_spheres towards the next decision.
  void count(std::uint64_t trials, std::uint64_t accepted, std::uint32_t n_spheres) {
    trials_ += trials;
    accepted_ += accepted;
    if (trials_ < std::max<std::uint64_t>(n_spheres, 4 * ProposalBatch::size)) return;
    caching_pays_ =
        accepted_ * (caching_pays_ ? ends_above_one_in : begins_below_one_in) <= trials_;
    hardly_any_accepted_ = accepted_ * rare_one_in < trials_;
    trials_ = accepted_ = 0;
  }

  bool caching_pays() const { return caching_pays_; }
  /// Fewer than one in a hundred.
  bool hardly_any_accepted() const { return hardly_any_accepted_; }

 private:
  static constexpr std::uint32_t begins_below_one_in = 6, ends_above_one_in = 4, rare_one_in = 100;

  bool caching_pays_ = false, hardly_any_accepted_ = false;
  std::uint64_t trials_ = 0, accepted_ = 0;
};

}  // namespace jostle::inline engine
