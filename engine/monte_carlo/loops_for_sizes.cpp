#include "engine/monte_carlo/kernel/loop_choice.hpp"

namespace jostle::inline engine {

std::unique_ptr<TrialLoop> make_loop_for_sizes(const Container& container, const Move& move,
                                               StreamKey key, const Kernels& kernels,
                                               Sampler sampler) {
  return make_loop<SeveralSizes>(container, move, key, kernels, sampler);
}

}  // namespace jostle::inline engine
