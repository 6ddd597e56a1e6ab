// The program of a first run does not have these loops (cli/CMakeLists.txt): their functions throw.
// `run` refuses scenes that need them before it calls these; a pilot of `check` ends here.
#include <stdexcept>
#include <string>

#include "engine/engines.hpp"
#include "engine/monte_carlo/kernel/loop_choice.hpp"

namespace jostle::inline engine {

namespace {

[[noreturn]] void refuse(const std::string& needed) {
  throw std::invalid_argument("this program has no loop for " + needed + ": use jostle");
}

}  // namespace

std::unique_ptr<TrialLoop> make_rejection_free_loop(const Container&, const Move&, StreamKey,
                                                    InstructionSet) {
  refuse("the sampler skipping");
}

std::unique_ptr<TrialLoop> make_loop_for_sizes(const Container&, const Move&, StreamKey,
                                               InstructionSet, Sampler) {
  refuse("spheres of several sizes");
}

std::unique_ptr<Dynamics> make_dynamics(const DiscreteElement&, const DynamicsStreams&) {
  refuse("discrete elements");
}

}  // namespace jostle::inline engine
