#include "engine/monte_carlo/kernel/loop_choice.hpp"

namespace jostle::inline engine {

std::unique_ptr<TrialLoop> make_loop_for_sizes(const Container& container, const Move& move,
                                               StreamKey key, const ProposalKernels& kernels) {
  return make_exhaustive<SeveralSizes>(container, move, key, kernels);
}

}  // namespace jostle::inline engine
