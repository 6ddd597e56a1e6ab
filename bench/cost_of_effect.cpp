// Makes COUNT trials of a scene with one effect, or COUNT calls of an observable, to be counted by
// callgrind (which has no AVX-512: the loops take AVX2).
#include <cstdlib>
#include <map>
#include <string>

#include "bench/cost_state.hpp"
#include "engine/trial_loop.hpp"
#include "structure/observables.hpp"

namespace jostle::bench {
namespace {

struct Scene {
  Container container;
  Move move;
};

const std::map<std::string, Scene> scenes = {
    {"periodic", {PeriodicBox{8, 8}, PolarMove{}}},
    {"walls", {WalledBox{8, 8}, PolarMove{}}},
    {"cylinder", {Cylinder{9}, PolarMove{}}},
    {"periodic_metropolis", {PeriodicBox{8, 8}, MetropolisMove{}}},
    {"periodic_metropolis_beta_1e6", {PeriodicBox{8, 8}, MetropolisMove{0.1, 1e6}}},
};

const std::map<std::string, Observable> observables = {
    {"mean_height", MeanHeight{}},
    {"bottom_fraction", BottomFraction{}},
    {"corrected_fraction", CorrectedFraction{}},
    {"bulk_fraction", BulkFraction{}},
};

bool make_trials(const Scene& scene, std::uint64_t count) {
  const auto loop = make_trial_loop(scene.container, scene.move, cost_trials, InstructionSet::avx2);
  loop->load(cost_bed(scene.container));
  loop->run(count);
  return loop->tally().accepted > 0;
}

bool observe(const Observable& observable, std::uint64_t count) {
  const Packing bed = cost_bed(PeriodicBox{8, 8});
  const Observer observer({observable}, bed);
  double sum = 0;
  for (std::uint64_t k = 0; k < count; ++k) sum += observer(bed)[0];
  return sum > 0;
}

}  // namespace
}  // namespace jostle::bench

int main(int argc, char** argv) {
  using namespace jostle::bench;
  if (argc != 3) return 2;
  const std::string effect = argv[1];
  const std::uint64_t count = std::strtoull(argv[2], nullptr, 10);
  if (const auto scene = scenes.find(effect); scene != scenes.end()) {
    return make_trials(scene->second, count) ? 0 : 1;
  }
  if (const auto found = observables.find(effect); found != observables.end()) {
    return observe(found->second, count) ? 0 : 1;
  }
  return 2;
}
