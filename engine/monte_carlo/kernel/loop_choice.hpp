#pragma once

#include <limits>
#include <memory>
#include <utility>
#include <variant>

#include "engine/monte_carlo/kernel/typed_trial_loop.hpp"

// Chooses the typed loop for a container and a move.
namespace jostle::inline engine {

// Calls act(box, policy) with the container and the move as the loop is compiled for them: a move
// without a policy does not compile.
template <class Act>
struct WithTypes {
  StreamKey key;
  const Act& act;

  template <class Box>
  std::unique_ptr<TrialLoop> operator()(const Box& box, const PolarMove& move) const {
    if constexpr (Box::shape().has_floor()) return act(box, Polar(move));
    return nullptr;  // move_fault
  }
  template <class Box>
  std::unique_ptr<TrialLoop> operator()(const Box& box, const MetropolisMove& move) const {
    if constexpr (!Box::shape().has_floor()) return act(box, WithoutGravity(move));
    if (move.beta != std::numeric_limits<double>::infinity())
      return act(box, Metropolis(move, key));
    return act(box, ZeroTemperature(move));
  }
};

template <class Spheres>
struct MakeExhaustive {
  StreamKey key;
  ProposalKernels kernels;

  template <class Box, class Policy>
  std::unique_ptr<TrialLoop> operator()(const Box& box, Policy move) const {
    return std::make_unique<TypedTrialLoop<Box, Policy, Spheres>>(box, std::move(move), key,
                                                                  kernels);
  }
};

template <class Spheres>
std::unique_ptr<TrialLoop> make_exhaustive(const Container& container, const Move& move,
                                           StreamKey key, const ProposalKernels& kernels) {
  const MakeExhaustive<Spheres> make{key, kernels};
  return std::visit(WithTypes<MakeExhaustive<Spheres>>{key, make}, container, move);
}

/// make_exhaustive<SeveralSizes>, compiled apart: it takes as long as the loops of equal spheres.
std::unique_ptr<TrialLoop> make_loop_for_sizes(const Container& container, const Move& move,
                                               StreamKey key, const ProposalKernels& kernels);

}  // namespace jostle::inline engine
