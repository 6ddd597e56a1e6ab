#include "engine/monte_carlo/trial_loop.hpp"

#include <limits>
#include <stdexcept>
#include <utility>

#include "engine/monte_carlo/kernel/kernel_table.hpp"
#include "engine/monte_carlo/kernel/typed_trial_loop.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_loop.hpp"

namespace jostle::inline engine {

namespace {

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
    throw std::invalid_argument(
        "the rejection-free sampler has no bounds for this move: use the exhaustive sampler");
  }
};

}  // namespace

std::unique_ptr<TrialLoop> make_trial_loop(const Container& container, const Move& move,
                                           StreamKey key, InstructionSet set, Sampler sampler) {
  if (const auto fault = move_fault(move, container)) throw std::invalid_argument(*fault);
  if (const auto fault = sampler_fault(sampler, move, container)) {
    throw std::invalid_argument(*fault);
  }
  const Kernels kernels = kernels_for(set);
  if (sampler == Sampler::rejection_free) {
    const MakeRejectionFree make{key, kernels};
    return std::visit(WithTypes<MakeRejectionFree>{key, make}, container, move);
  }
  const MakeExhaustive make{key, kernels.proposals};
  return std::visit(WithTypes<MakeExhaustive>{key, make}, container, move);
}

}  // namespace jostle::inline engine
