#include "engine/monte_carlo/trial_loop.hpp"

#include <stdexcept>

#include "engine/monte_carlo/kernel/loop_choice.hpp"

namespace jostle::inline engine {

std::unique_ptr<TrialLoop> make_trial_loop(const Container& container, const Move& move,
                                           StreamKey key, InstructionSet set, Sampler sampler,
                                           SphereSizes sizes) {
  if (const auto fault = move_fault(move, container)) throw std::invalid_argument(*fault);
  if (const auto fault = sampler_fault(sampler, move, container)) {
    throw std::invalid_argument(*fault);
  }
  const Kernels kernels = kernels_for(set);
  if (sizes == SphereSizes::several)
    return make_loop_for_sizes(container, move, key, kernels, sampler);
  return make_loop<EqualSpheres>(container, move, key, kernels, sampler);
}

}  // namespace jostle::inline engine
