// Makes COUNT trials of a scene with one effect, COUNT taps of a realization, or COUNT
// measurements, to be counted by callgrind (which has no AVX-512: the loops take AVX2).
#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>

#include "bench/costs/cost_state.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "ensemble/realization.hpp"
#include "structure/observables.hpp"
#include "structure/snapshot_statistics.hpp"
#include "structure/voids/pores.hpp"
#include "structure/voids/voronoi.hpp"

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

double any_height(const Packing& bed) {
  return static_cast<double>(height_histogram(bed, 0.1).size());
}
double contacts(const Packing& bed) {
  return coordination(bed, 1.05);
}
double cells(const Packing& bed) {
  return voronoi_cells(bed).volumes[0];
}
double cells_and_pores(const Packing& bed) {
  return static_cast<double>(pores(bed, voronoi_cells(bed)).size());
}

using Measurement = double (*)(const Packing&);
const std::map<std::string, Measurement> measurements = {{"height_histogram", any_height},
                                                         {"coordination", contacts},
                                                         {"voronoi_cells", cells},
                                                         {"cells_and_pores", cells_and_pores}};

bool make_trials(const Scene& scene, std::uint64_t count) {
  const auto loop = make_trial_loop(scene.container, scene.move, cost_trials,
                                    std::min(InstructionSet::avx2, best_instruction_set()));
  loop->load(cost_bed(scene.container));
  loop->run(count);
  return loop->tally().accepted > 0;
}

template <class Measure>
bool measure(const Measure& measurement, const Packing& bed, std::uint64_t count) {
  double sum = 0;
  for (std::uint64_t k = 0; k < count; ++k) sum += measurement(bed);
  return sum > 0;
}

bool observe(const Observable& observable, std::uint64_t count) {
  const Packing bed = cost_bed(PeriodicBox{8, 8});
  const Observer observer({observable}, bed);
  return measure([&](const Packing& packing) { return observer(packing)[0]; }, bed, count);
}

// Taps of a realization that observes nothing and keeps no snapshot.
bool make_taps(std::uint64_t count) {
  Plan plan;
  plan.seed = cost_seed;
  plan.container = PeriodicBox{8, 8};
  plan.n_spheres = cost_spheres;
  plan.start = SteepestDescentPour{};
  plan.protocol = {{cost_tap, count}};
  plan.engine = MonteCarlo{.relax = {.move = PolarMove{}, .stop = {SweepsStop{cost_sweeps}}}};
  Realization realization(plan, 0);
  std::uint64_t rows = 0;
  while (!realization.finished()) rows += realization.advance(100'000'000).row.has_value();
  return rows == count + 1;
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
  if (const auto found = measurements.find(effect); found != measurements.end()) {
    return measure(found->second, cost_bed(jostle::PeriodicBox{8, 8}), count) ? 0 : 1;
  }
  if (effect == "taps") return make_taps(count) ? 0 : 1;
  return 2;
}
