#include "engine/monte_carlo/kernel/kernel_table.hpp"

namespace jostle::inline engine {

Kernels kernels_for(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return {avx512::proposal_kernels(), avx512::rejection_free_kernels()};
    case InstructionSet::avx2:
      return {avx2::proposal_kernels(), avx2::rejection_free_kernels()};
    case InstructionSet::baseline:
      break;
  }
  return {baseline::proposal_kernels(), baseline::rejection_free_kernels()};
}

}  // namespace jostle::inline engine
