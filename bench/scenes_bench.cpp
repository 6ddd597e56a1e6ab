// Whole taps of the shipped scenes, and ensembles on one and more threads. Times are wall times.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bench/run_registered.hpp"
#include "bench/standard_states.hpp"
#include "config/scene.hpp"
#include "ensemble/realization.hpp"
#include "ensemble/run.hpp"

namespace jostle::bench {
namespace {

struct ForgetfulSink final : Sink {
  std::optional<RealizationState> begin(RealizationId) override { return std::nullopt; }
  void append(RealizationId, const TapRow&) override {}
  void snapshot(RealizationId, const SnapshotRecord&) override {}
  void checkpoint(RealizationId, const RealizationState&, const Work&) override {}
  void end(RealizationId, const RealizationState&, const Outcome&) override {}
};

// The first sweep point of a scene, or nothing where the file is no complete scene.
std::optional<Plan> first_point(const std::filesystem::path& file) {
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const ParsedScene parsed = parse_scene(text);
  if (!parsed.scene) return std::nullopt;
  try {
    return make_plans(*parsed.scene, [](const PackingFile&) { return Packing{}; }).at(0);
  } catch (const StartError&) {
    return std::nullopt;
  }
}

// One iteration is one tap, from excitation to the recorded row.
void taps_of_scene(benchmark::State& run, Plan plan) {
  using Seconds = std::chrono::duration<double>;
  Realization realization(plan, 0);
  const std::uint64_t at_once = 1u << 30;
  for (int rows = 0; rows < 2;) {  // the start, and a tap for which the loop is made
    rows += realization.advance(at_once).row.has_value();
  }
  Seconds relaxing{0}, whole{0};
  double trials = 0;
  for (auto _ : run) {
    for (bool ended = false; !ended;) {
      const auto began = std::chrono::steady_clock::now();
      const Slice slice = realization.advance(at_once);
      whole += std::chrono::steady_clock::now() - began;
      ended = slice.row.has_value();
      relaxing += slice.relaxing;
      trials += static_cast<double>(slice.effort.units);
    }
  }
  run.counters["taps/s"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  run.counters["sweeps/tap"] = trials / plan.n_spheres / static_cast<double>(run.iterations());
  run.counters["outside_loop_percent"] = 100 * (1 - relaxing / whole);
}

// Eight equal realizations of two taps; the rate counts the trials of all threads.
void ensemble(benchmark::State& run, int threads) {
  const Case bed = standard_state(StandardState::tapped_bed);
  Plan plan;
  plan.container = bed.packing.container;
  plan.n_spheres = static_cast<std::uint32_t>(bed.packing.centres.size());
  plan.start = GivenPacking{std::make_shared<const std::vector<Vec3>>(bed.packing.centres)};
  plan.protocol = {{Dilate{0.02}, 2}};
  plan.engine = MonteCarlo{.relax = {.move = bed.move, .stop = {SweepsStop{1000}}}};
  plan.observables = {MeanHeight{}, BottomFraction{}};
  std::vector<RealizationId> realizations;
  for (std::uint32_t k = 0; k < 8; ++k) realizations.push_back({0, k});
  double trials = 0;
  for (auto _ : run) {
    Progress progress;
    ForgetfulSink sink;
    run_ensemble(std::span(&plan, 1), realizations, {.threads = threads}, sink, progress);
    trials += static_cast<double>(progress.units_done);
  }
  run.counters["trials/s"] = benchmark::Counter(trials, benchmark::Counter::kIsRate);
}

void register_all() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SCENES)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  for (const auto& file : files) {
    const std::optional<Plan> plan = first_point(file);
    if (!plan || total_taps(*plan) < 8) continue;
    const std::string title = "taps/" + std::filesystem::relative(file, SCENES).string();
    benchmark::RegisterBenchmark(title.c_str(), taps_of_scene, *plan)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(3)
        ->UseRealTime();
  }
  const auto most = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  for (int threads = 1; threads <= most; threads = threads < 2 ? 2 : threads * 2) {
    const std::string title = "ensemble/" + std::to_string(threads) + "_threads";
    benchmark::RegisterBenchmark(title.c_str(), ensemble, threads)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(3)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
  }
}

}  // namespace
}  // namespace jostle::bench

int main(int argc, char** argv) {
  return jostle::bench::run_registered(argc, argv, jostle::bench::register_all);
}
