#include "engine/kernel_sets.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_choice.hpp"

namespace jostle::inline engine {

RejectionFreeKernels rejection_free_kernels_for(InstructionSet set) {
  constexpr CompiledFor<RejectionFreeKernels()> compiled[] = {
      {InstructionSet::baseline, baseline::rejection_free_kernels},
#ifdef JOSTLE_X86_KERNELS
      {InstructionSet::avx2, avx2::rejection_free_kernels},
      {InstructionSet::avx512, avx512::rejection_free_kernels},
#endif
  };
  return function_for(set, compiled)();
}

std::unique_ptr<TrialLoop> make_rejection_free_loop(const Container& container, const Move& move,
                                                    StreamKey key, InstructionSet set) {
  return make_rejection_free_loop_of<EqualSpheres>(container, move, key, set);
}

}  // namespace jostle::inline engine
