// Rates of the exhaustive trial loop in the standard states, and their growth with the number of
// spheres. Times are processor times.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "bench/rates.hpp"
#include "bench/run_registered.hpp"
#include "bench/standard_states.hpp"

namespace jostle::bench {
namespace {

// States take seconds to make: each is made once, when a benchmark first asks for it.
const Case& case_of(StandardState state, std::uint32_t n_spheres) {
  static std::map<std::pair<StandardState, std::uint32_t>, Case> cases;
  const auto found = cases.find({state, n_spheres});
  if (found != cases.end()) return found->second;
  return cases[{state, n_spheres}] = standard_state(state, n_spheres);
}

void trials(benchmark::State& run, StandardState state, std::uint32_t n_spheres) {
  const Case& start = case_of(state, n_spheres);
  const auto loop = make_trial_loop(start.packing.container, start.move,
                                    stream_key(20010222, 0, 1, Purpose::trials));
  loop->load(start.packing);
  loop->run(10 * n_spheres);  // lists made, caches warm
  constexpr std::uint64_t chunk = 1'000'000;
  Rate sum;
  double tests = 0, accepted = 0, renewals = 0;
  for (auto _ : run) {
    const Rate rate = measure_rate(*loop, chunk);
    sum.trials += rate.trials;
    accepted += rate.acceptance;
    tests += rate.distance_tests_per_trial;
    renewals += rate.list_renewals_per_sweep;
    sum.bytes_per_sphere = rate.bytes_per_sphere;
  }
  const auto n = static_cast<double>(run.iterations());
  run.counters["trials/s"] =
      benchmark::Counter(static_cast<double>(sum.trials), benchmark::Counter::kIsRate);
  run.counters["acceptance"] = accepted / n;
  run.counters["tests/trial"] = tests / n;
  run.counters["renewals/sweep"] = renewals / n;
  run.counters["bytes/sphere"] = sum.bytes_per_sphere;
}

void register_all() {
  const auto add = [](StandardState state, std::uint32_t n_spheres) {
    const std::string title =
        "trials/" + std::string(name(state)) + "/" + std::to_string(n_spheres);
    benchmark::RegisterBenchmark(title.c_str(), trials, state, n_spheres)
        ->Unit(benchmark::kMillisecond);
  };
  for (const StandardState state : all_standard_states) add(state, 4096);
  for (const std::uint32_t n_spheres : {1024u, 16384u, 65536u, 262144u, 1048576u}) {
    add(StandardState::tapped_bed, n_spheres);
  }
  for (const std::uint32_t n_spheres : {1000u, 32768u, 262144u, 884736u}) {
    add(StandardState::fluid_55, n_spheres);
  }
}

}  // namespace
}  // namespace jostle::bench

int main(int argc, char** argv) {
  return jostle::bench::run_registered(argc, argv, jostle::bench::register_all);
}
