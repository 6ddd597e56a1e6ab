#include "engine/kernel_sets.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_choice.hpp"

namespace jostle::inline engine {

RejectionFreeKernels rejection_free_kernels_for(InstructionSet set) {
  return function_for<RejectionFreeKernels()>(set, JOSTLE_EVERY_SET(rejection_free_kernels))();
}

std::unique_ptr<TrialLoop> make_rejection_free_loop(const Container& container, const Move& move,
                                                    StreamKey key, InstructionSet set) {
  return make_rejection_free_loop_of<EqualSpheres>(container, move, key, set);
}

}  // namespace jostle::inline engine
