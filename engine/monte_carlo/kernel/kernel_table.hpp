#pragma once

#include "engine/monte_carlo/kernel/proposals.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

namespace jostle::inline engine {

/// Functions that are compiled once for every instruction set.
struct Kernels {
  ProposalKernels proposals;
  RejectionFreeKernels rejection_free;
};

Kernels kernels_for(InstructionSet set);

}  // namespace jostle::inline engine
