#pragma once

#include <memory>
#include <stdexcept>

#include "engine/monte_carlo/kernel/loop_choice.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_loop.hpp"

// Chooses the typed loop of the rejection-free sampler for a container and a move.
namespace jostle::inline engine {

template <class Spheres>
struct MakeRejectionFree {
  StreamKey key;
  ProposalKernels proposals;
  RejectionFreeKernels kernels;

  template <class Box>
  std::unique_ptr<TrialLoop> operator()(const Box& box, const Polar& move) const {
    return make<PolarDirections>(box, move);
  }
  template <class Box>
  std::unique_ptr<TrialLoop> operator()(const Box& box, const ZeroTemperature& move) const {
    return make<CubicDirections>(box, move);
  }
  template <class Box, class Policy>
  std::unique_ptr<TrialLoop> operator()(const Box&, const Policy&) const {
    throw std::invalid_argument(
        "the rejection-free sampler has no bounds for this move: use the exhaustive sampler");
  }

 private:
  template <class Directions, class Box, class Policy>
  std::unique_ptr<TrialLoop> make(const Box& box, const Policy& move) const {
    return std::make_unique<RejectionFreeLoop<Box, Directions, Spheres>>(box, move, key, proposals,
                                                                         kernels);
  }
};

template <class Spheres>
std::unique_ptr<TrialLoop> make_rejection_free_loop_of(const Container& container, const Move& move,
                                                       StreamKey key, InstructionSet set) {
  return choose_loop(
      container, move, key,
      MakeRejectionFree<Spheres>{key, proposal_kernels_for(set), rejection_free_kernels_for(set)});
}

}  // namespace jostle::inline engine
