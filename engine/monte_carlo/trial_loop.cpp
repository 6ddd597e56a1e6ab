#include "engine/monte_carlo/trial_loop.hpp"

#include <stdexcept>
#include <utility>

#include "engine/monte_carlo/kernel/kernel_table.hpp"
#include "engine/monte_carlo/kernel/loop_choice.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_loop.hpp"

namespace jostle::inline engine {

namespace {

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
                                           StreamKey key, InstructionSet set, Sampler sampler,
                                           SphereSizes sizes) {
  if (const auto fault = move_fault(move, container)) throw std::invalid_argument(*fault);
  if (const auto fault = sampler_fault(sampler, move, container, sizes)) {
    throw std::invalid_argument(*fault);
  }
  const Kernels kernels = kernels_for(set);
  if (sampler == Sampler::rejection_free) {
    const MakeRejectionFree make{key, kernels};
    return std::visit(WithTypes<MakeRejectionFree>{key, make}, container, move);
  }
  if (sizes == SphereSizes::several)
    return make_loop_for_sizes(container, move, key, kernels.proposals);
  return make_exhaustive<EqualSpheres>(container, move, key, kernels.proposals);
}

}  // namespace jostle::inline engine
