#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/monte_carlo/kernel/proposals.hpp"
#include "engine/monte_carlo/moves.hpp"

namespace jostle::inline engine {

/// The reference with which the trial loop must agree bit for bit: one trial after another, each
/// tested against all spheres, without lists, cells or caches. It shares with the trial loop the
/// proposals alone, and those of the baseline instruction set. For checks: O(n) a trial, and the
/// step never adapts.
class PlainLoop {
 public:
  PlainLoop(Packing packing, const Move& move, StreamKey key);

  /// Makes the trials from its current state.
  void run(std::uint64_t n_trials);

  const Packing& packing() const { return packing_; }
  std::uint64_t accepted() const { return accepted_; }

 private:
  bool passes(std::uint32_t sphere, Vec3 step);
  bool rise_passes(const MetropolisMove& move, double mass, double dz) const;

  Packing packing_;
  Move move_;
  StreamKey key_;
  double step_;
  std::vector<double> theta_table_;
  std::uint64_t next_trial_ = 0, accepted_ = 0;
  std::unique_ptr<ProposalBatch> batch_ = std::make_unique<ProposalBatch>();
};

}  // namespace jostle::inline engine
