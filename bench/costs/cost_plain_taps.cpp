// "taps COUNT" makes taps written out, with nothing between tap and trials. The excess of
// `cost_of_effect` is the price of unused effects.
#include <algorithm>
#include <cstdlib>

#include "bench/costs/cost_state.hpp"
#include "engine/monte_carlo/trial_loop.hpp"

int main(int argc, char** argv) {
  using namespace jostle;
  if (argc != 3) return 2;
  const std::uint64_t count = std::strtoull(argv[2], nullptr, 10);
  const PeriodicBox box{8, 8};
  const auto loop = make_trial_loop(box, PolarMove{}, bench::cost_trials,
                                    std::min(InstructionSet::avx2, best_instruction_set()));
  RandomStream random(stream_key(bench::cost_seed, 0, 0, Purpose::tap));
  Packing bed = bench::poured_cost_bed(box);
  for (std::uint64_t tap = 0; tap < count; ++tap) {
    excite(bed, bench::cost_tap, random);
    loop->load(bed);
    loop->run(bench::cost_sweeps * bench::cost_spheres);
    loop->store(bed);
  }
  return loop->tally().accepted > 0 ? 0 : 1;
}
