#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "engine/monte_carlo/kernel/proposals.hpp"

namespace jostle::inline engine {

/// The trials of a batch that do not rise, in order: at zero temperature the others are rejected.
class FallingTrials {
 public:
  void list(const ProposalBatch& batch) {
    std::uint32_t count = 0;
    for (std::uint32_t t = 0; t < ProposalBatch::size; ++t) {
      trials_[count] = t;
      count += !(batch.dz[t] > 0);
    }
    count_ = count;
    std::iota(trials_.begin() + count, trials_.begin() + count + ProposalBatch::margin,
              ProposalBatch::size);
  }

  /// How many come before trial t of the batch.
  std::uint32_t count_before(std::uint32_t t) const {
    const auto end = trials_.begin() + count_;
    return static_cast<std::uint32_t>(std::lower_bound(trials_.begin(), end, t) - trials_.begin());
  }

  /// The k-th; beyond the last, trials of the batch's margin.
  std::uint32_t operator[](std::uint32_t k) const { return trials_[k]; }

 private:
  std::array<std::uint32_t, ProposalBatch::size + ProposalBatch::margin> trials_;
  std::uint32_t count_ = 0;
};

}  // namespace jostle::inline engine
