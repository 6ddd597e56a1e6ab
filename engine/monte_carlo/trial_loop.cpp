#include "engine/monte_carlo/trial_loop.hpp"

#include <stdexcept>

#include "engine/kernel_sets.hpp"
#include "engine/monte_carlo/kernel/loop_choice.hpp"

namespace jostle::inline engine {

ProposalKernels proposal_kernels_for(InstructionSet set) {
  return function_for<ProposalKernels()>(set, JOSTLE_EVERY_SET(proposal_kernels))();
}

std::unique_ptr<TrialLoop> make_trial_loop(const Container& container, const Move& move,
                                           StreamKey key, InstructionSet set, Sampler sampler,
                                           SphereSizes sizes) {
  if (const auto fault = move_fault(move, container)) throw std::invalid_argument(*fault);
  if (const auto fault = sampler_fault(sampler, move, container)) {
    throw std::invalid_argument(*fault);
  }
  if (sizes == SphereSizes::several) return make_loop_for_sizes(container, move, key, set, sampler);
  if (sampler == Sampler::rejection_free)
    return make_rejection_free_loop(container, move, key, set);
  return make_exhaustive_loop<EqualSpheres>(container, move, key, set);
}

}  // namespace jostle::inline engine
