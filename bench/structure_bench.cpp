// The structure of one packing, the standard tapped bed of 4096 spheres: each part of measure() by
// itself, and all together, on one core. Times are processor times.
#include <benchmark/benchmark.h>

#include <string>

#include "bench/run_registered.hpp"
#include "bench/standard_states.hpp"
#include "structure/measure.hpp"
#include "structure/voids/voronoi.hpp"

namespace jostle::bench {
namespace {

const Packing& bed() {
  static const Packing packing = standard_state(StandardState::tapped_bed).packing;
  return packing;
}

void part(benchmark::State& run, const StructureSettings& settings) {
  const Packing& packing = bed();
  for (auto _ : run) {
    for (const Measurement& measurement :
         measure(packing, settings, stream_key(20010222, 0, 0, Purpose::resampling)))
      if (!measurement.refused.empty()) run.SkipWithError(measurement.refused.c_str());
  }
}

void cells(benchmark::State& run) {
  const Packing& packing = bed();
  for (auto _ : run) benchmark::DoNotOptimize(voronoi_cells(packing));
  run.counters["cells/s"] = benchmark::Counter(static_cast<double>(packing.centres.size()),
                                               benchmark::Counter::kIsIterationInvariantRate);
}

void register_all() {
  const auto add = [](const std::string& name, const StructureSettings& settings) {
    benchmark::RegisterBenchmark(("structure/" + name).c_str(), part, settings)
        ->Unit(benchmark::kMillisecond);
  };
  add("profile", {.profile = ProfileSettings{}});
  add("sides", {.sides = SidesSettings{}});
  add("layers", {.layers = LayersSettings{}});
  add("coordination", {.coordination = CoordinationSettings{}});
  add("pair_correlation", {.pair_correlation = PairsSettings{}});
  add("order", {.order = OrderSettings{}});
  benchmark::RegisterBenchmark("structure/cells", cells)->Unit(benchmark::kMillisecond);
  // Each of these three makes the cells anew, all together make them once.
  add("voronoi", {.voronoi = VoronoiSettings{}});
  add("pores", {.pores = PoresSettings{}});
  add("holes", {.holes = HolesSettings{}});
  add("void_probability", {.void_probability = VoidSettings{}});
  add("all", all_structure());
}

}  // namespace
}  // namespace jostle::bench

int main(int argc, char** argv) {
  return jostle::bench::run_registered(argc, argv, jostle::bench::register_all);
}
