// "periodic COUNT" makes trials with the one loop that this program knows: periodic sides, polar
// move. The excess of `cost_of_effect` is the price of unused effects.
#include <cstdlib>
#include <memory>

#include "bench/costs/cost_state.hpp"
#include "engine/monte_carlo/kernel/typed_trial_loop.hpp"

int main(int argc, char** argv) {
  using namespace jostle;
  if (argc != 3) return 2;
  const PeriodicBox box{8, 8};
  const auto loop = std::make_unique<TypedTrialLoop<PeriodicBox, Polar>>(
      box, Polar{PolarMove{}}, bench::cost_trials, avx2::proposal_kernels());
  loop->load(bench::cost_bed(box));
  loop->run(std::strtoull(argv[2], nullptr, 10));
  return loop->tally().accepted > 0 ? 0 : 1;
}
