#include "engine/monte_carlo/trial_loop.hpp"

#include <limits>
#include <stdexcept>
#include <type_traits>

#include "engine/monte_carlo/kernel/kernel_table.hpp"
#include "engine/monte_carlo/kernel/typed_trial_loop.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_loop.hpp"

namespace jostle {

namespace {

void refuse_skipping_rises(const Container& container, const Move& move) {
  if (!has_gravity(container)) {
    throw std::invalid_argument(
        "the skipping sampler needs gravity, which a fully periodic box has not: use the "
        "exhaustive sampler");
  }
  const auto* metropolis = std::get_if<MetropolisMove>(&move);
  if (metropolis == nullptr) return;
  if (metropolis->beta != std::numeric_limits<double>::infinity()) {
    throw std::invalid_argument(
        "the skipping sampler is for trials that never rise, and a finite beta lets them: use the "
        "exhaustive sampler");
  }
  if (metropolis->adaptation && metropolis->adaptation->base != AcceptanceBase::all_trials) {
    throw std::invalid_argument(
        "the skipping sampler does not count rising trials, of which the adaptation of the step "
        "asks: count all trials or use the exhaustive sampler");
  }
}

// Calls act(box, policy) with the container and the move as the loop is compiled for them.
template <class Act>
std::unique_ptr<TrialLoop> with_types(const Container& container, const Move& move, StreamKey key,
                                      const Act& act) {
  return std::visit(
      [&](const auto& box) -> std::unique_ptr<TrialLoop> {
        const auto* polar = std::get_if<PolarMove>(&move);
        if constexpr (std::is_same_v<std::decay_t<decltype(box)>, FullyPeriodicBox>) {
          if (polar == nullptr) return act(box, WithoutGravity(std::get<MetropolisMove>(move)));
          throw std::invalid_argument(
              "the polar move only goes down and a fully periodic box has no down: use the "
              "Metropolis move");
        } else {
          if (polar != nullptr) return act(box, Polar(*polar));
          const auto& metropolis = std::get<MetropolisMove>(move);
          if (metropolis.beta == std::numeric_limits<double>::infinity()) {
            return act(box, ZeroTemperature(metropolis));
          }
          return act(box, Metropolis(metropolis, key));
        }
      },
      container);
}

struct MakeExhaustive {
  StreamKey key;
  ProposalKernels kernels;

  template <class Box, class Policy>
  std::unique_ptr<TrialLoop> operator()(const Box& box, Policy move) const {
    return std::make_unique<TypedTrialLoop<Box, Policy>>(box, std::move(move), key, kernels);
  }
};

struct MakeRejectionFree {
  StreamKey key;
  Kernels kernels;

  template <class Box>
  std::unique_ptr<TrialLoop> operator()(const Box& box, const Polar& move) const {
    return std::make_unique<RejectionFreeLoop<Box, PolarDirections>>(
        box, move, key, kernels.proposals, kernels.rejection_free);
  }
  template <class Box>
  std::unique_ptr<TrialLoop> operator()(const Box& box, const ZeroTemperature& move) const {
    return std::make_unique<RejectionFreeLoop<Box, CubicDirections>>(
        box, move, key, kernels.proposals, kernels.rejection_free);
  }
  template <class Box, class Policy>
  std::unique_ptr<TrialLoop> operator()(const Box&, const Policy&) const {
    return nullptr;  // refused before
  }
};

}  // namespace

std::unique_ptr<TrialLoop> make_trial_loop(const Container& container, const Move& move,
                                           StreamKey key, InstructionSet set, Sampler sampler) {
  const Kernels kernels = kernels_for(set);
  if (sampler == Sampler::skipping) {
    refuse_skipping_rises(container, move);
    return with_types(container, move, key, MakeRejectionFree{key, kernels});
  }
  return with_types(container, move, key, MakeExhaustive{key, kernels.proposals});
}

}  // namespace jostle
