#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include "engine/monte_carlo/kernel/typed_trial_loop.hpp"

// Chooses the typed loop for a container and a move. Loops of equal spheres that look at every
// trial are compiled with make_trial_loop(), others apart: they take as long to compile, and a
// first run needs none of them.
namespace jostle::inline engine {

/// Calls make(container, policy), both with their types.
template <class Make>
std::unique_ptr<TrialLoop> choose_loop(const Container& container, const Move& move, StreamKey key,
                                       const Make& make) {
  using Loop = std::unique_ptr<TrialLoop>;
  return std::visit(
      [&](const auto& box, const auto& chosen) {
        using Box = std::decay_t<decltype(box)>;
        return with_policy<Loop, Box>(
            chosen, key, [&](auto policy) -> Loop { return make(box, std::move(policy)); });
      },
      container, move);
}

template <class Spheres>
std::unique_ptr<TrialLoop> make_exhaustive_loop(const Container& container, const Move& move,
                                                StreamKey key, InstructionSet set) {
  const ProposalKernels kernels = proposal_kernels_for(set);
  return choose_loop(
      container, move, key,
      [&]<class Box, class Policy>(const Box& box, Policy policy) -> std::unique_ptr<TrialLoop> {
        return std::make_unique<TypedTrialLoop<Box, Policy, Spheres>>(box, std::move(policy), key,
                                                                      kernels);
      });
}

/// Makes a loop for equal spheres, with the rejection-free sampler.
std::unique_ptr<TrialLoop> make_rejection_free_loop(const Container& container, const Move& move,
                                                    StreamKey key, InstructionSet set);

/// Makes a loop for several sizes, with either sampler.
std::unique_ptr<TrialLoop> make_loop_for_sizes(const Container& container, const Move& move,
                                               StreamKey key, InstructionSet set, Sampler sampler);

}  // namespace jostle::inline engine
