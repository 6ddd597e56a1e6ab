#include "engine/monte_carlo/rejection_free/rejection_free_choice.hpp"

namespace jostle::inline engine {

std::unique_ptr<TrialLoop> make_loop_for_sizes(const Container& container, const Move& move,
                                               StreamKey key, InstructionSet set, Sampler sampler) {
  return sampler == Sampler::exhaustive
             ? make_exhaustive_loop<SeveralSizes>(container, move, key, set)
             : make_rejection_free_loop_of<SeveralSizes>(container, move, key, set);
}

}  // namespace jostle::inline engine
