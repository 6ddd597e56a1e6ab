#include "engine/monte_carlo/kernel/kernel_table.hpp"

#include "engine/kernel_sets.hpp"

namespace jostle::inline engine {

Kernels kernels_for(InstructionSet set) {
  struct Entry {
    InstructionSet set;
    ProposalKernels (*proposals)();
    RejectionFreeKernels (*rejection_free)();
  };
  constexpr Entry entries[] = {
      {InstructionSet::baseline, baseline::proposal_kernels, baseline::rejection_free_kernels},
#ifdef JOSTLE_X86_KERNELS
      {InstructionSet::avx2, avx2::proposal_kernels, avx2::rejection_free_kernels},
      {InstructionSet::avx512, avx512::proposal_kernels, avx512::rejection_free_kernels},
#endif
  };
  for (const Entry& entry : entries) {
    if (entry.set == set) return {entry.proposals(), entry.rejection_free()};
  }
  throw_not_compiled_in(set);
}

}  // namespace jostle::inline engine
