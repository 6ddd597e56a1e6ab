#pragma once

#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include "engine/monte_carlo/kernel/kernel_table.hpp"
#include "engine/monte_carlo/kernel/typed_trial_loop.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_loop.hpp"

// Chooses the typed loop for a container, a move and a sampler.
namespace jostle::inline engine {

template <class Spheres>
struct MakeExhaustive {
  StreamKey key;
  Kernels kernels;

  template <class Box, class Policy>
  std::unique_ptr<TrialLoop> operator()(const Box& box, Policy move) const {
    return std::make_unique<TypedTrialLoop<Box, Policy, Spheres>>(box, std::move(move), key,
                                                                  kernels.proposals);
  }
};

template <class Spheres>
struct MakeRejectionFree {
  StreamKey key;
  Kernels kernels;

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
    return std::make_unique<RejectionFreeLoop<Box, Directions, Spheres>>(
        box, move, key, kernels.proposals, kernels.rejection_free);
  }
};

template <class Spheres>
std::unique_ptr<TrialLoop> make_loop(const Container& container, const Move& move, StreamKey key,
                                     const Kernels& kernels, Sampler sampler) {
  using Loop = std::unique_ptr<TrialLoop>;
  const auto choose = [&](const auto& make) {
    return std::visit(
        [&](const auto& box, const auto& chosen) {
          using Box = std::decay_t<decltype(box)>;
          return with_policy<Loop, Box>(
              chosen, key, [&](auto policy) -> Loop { return make(box, std::move(policy)); });
        },
        container, move);
  };
  return sampler == Sampler::exhaustive ? choose(MakeExhaustive<Spheres>{key, kernels})
                                        : choose(MakeRejectionFree<Spheres>{key, kernels});
}

/// make_loop<SeveralSizes>, compiled apart: it takes as long as the loops of equal spheres.
std::unique_ptr<TrialLoop> make_loop_for_sizes(const Container& container, const Move& move,
                                               StreamKey key, const Kernels& kernels,
                                               Sampler sampler);

}  // namespace jostle::inline engine
