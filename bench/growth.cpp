// Costs of results files of many points, realizations and taps, and of packings in wide boxes,
// beside those of a quarter of the size: in proportion, work takes 4 times as long, or as long as
// before for sides alone; with its square, 16 times. Sizes begin beyond about 300 realizations,
// from where on HDF5's metadata outgrow its cache (results/hdf5/handle.cpp) and cost twice as much.
// Processor times, both sizes in turn, the least of three. Ends with 1 if any grew beyond 6.25
// times.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "results/export/packing_file.hpp"
#include "results/file/results_writer.hpp"
#include "structure/measure.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

namespace jostle::bench {
namespace {

/// Processor time of this process and of those that it starts, as a digest does.
double processor_seconds(const std::function<void()>& work) {
  const auto now = [] {
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    double sum = 0;
    for (const auto processes : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
      rusage usage{};
      ::getrusage(processes, &usage);
      sum += seconds(usage.ru_utime) + seconds(usage.ru_stime);
    }
    return sum;
  };
  const double began = now();
  work();
  return now() - began;
}

constexpr std::uint32_t times = 4;
constexpr double most_growth = 2.5 * 2.5;  // most growth of two doublings

/// Work of a size, and what it is called.
template <class Size>
using Steps = std::vector<std::pair<const char*, std::function<void(const Size&)>>>;

/// Prints how much longer each step takes with `large` than with `small`; false if one grew too
/// much.
template <class Size>
bool within_growth(const char* title, const Steps<Size>& steps, const Size& small,
                   const Size& large) {
  bool passed = true;
  for (const auto& [step, work] : steps) {
    double small_time = std::numeric_limits<double>::infinity(), large_time = small_time;
    for (int repeat = 0; repeat < 3; ++repeat) {
      small_time = std::min(small_time, processor_seconds([&, &run = work] { run(small); }));
      large_time = std::min(large_time, processor_seconds([&, &run = work] { run(large); }));
    }
    const double growth = large_time / small_time;
    fmt::print("{} x {:14} {:12} {:9.1f} ms {:9.1f} ms {:6.2f} {}\n", times, title, step,
               1e3 * small_time, 1e3 * large_time, growth, growth < most_growth ? "" : "MISSED");
    passed = passed && growth < most_growth;
  }
  return passed;
}

bool files_grow_in_proportion(const char* title, const synthetic::StudySize& small,
                              const synthetic::StudySize& large) {
  const TemporaryFolder folder;
  const auto path = [&](const synthetic::StudySize& sizes) {
    return folder / fmt::format("{}_{}_{}.h5", sizes.points, sizes.realizations, sizes.taps);
  };
  const auto written = [&](const synthetic::StudySize& sizes) {
    const Study study = synthetic::study(sizes);
    std::filesystem::remove(path(sizes));
    const auto store = RunStore::create(path(sizes), study, {}, synthetic::provenance());
    // A checkpoint writes the last piece of a series anew, of which there are few in a real run.
    synthetic::run_pending(*store, study, {.checkpoint_every = 10'000});
    store->finish();
  };
  const auto opened = [&](const synthetic::StudySize& sizes) {
    ResultsFile(path(sizes)).realizations();
  };
  const auto digested = [&](const synthetic::StudySize& sizes) { digest_of(path(sizes)); };
  const Steps<synthetic::StudySize> steps = {
      {"run and fold", written}, {"open", opened}, {"digest", digested}};
  return within_growth(title, steps, small, large);
}

/// A bed of as many spheres in a wider box.
bool sides_cost_little(double side) {
  constexpr std::uint32_t n_spheres = 2000;
  const StreamKey key = stream_key(14, 0, 0, Purpose::start);
  const TemporaryFolder folder;
  const auto bed = [&](double width) {
    RandomStream random(key);
    return make_start(SteepestDescentPour{}, PeriodicBox{width, width}, n_spheres, random);
  };
  const auto path = [&](double width) { return folder / fmt::format("{}.xyz", width); };
  std::map<double, Packing> beds;
  for (const double width : {side, times * side}) {
    beds.emplace(width, bed(width));
    write_extended_xyz(path(width), beds.at(width));
  }
  const auto relaxed = [&](double width) {
    const Packing& packing = beds.at(width);
    const auto loop = make_trial_loop(packing.container, PolarMove{}, key);
    loop->load(packing);
    loop->run(100 * n_spheres);
  };
  const auto measured = [&](double width) {
    measure(read_packing(path(width)), all_structure(), key);
  };
  Steps<double> steps = {{"pour", bed}, {"relax", relaxed}};
  // Spheres that are all far apart are refused.
  if (side < 100) {
    steps.emplace_back("read", [&](double width) { read_packing(path(width)); });
    steps.emplace_back("structure", measured);
  }
  return within_growth(fmt::format("sides of {:g}", side).c_str(), steps, side, times * side);
}

bool all_within_growth() {
  const std::vector<bool> passed = {
      files_grow_in_proportion("realizations", {.points = 1, .realizations = 500},
                               {.points = 1, .realizations = times * 500}),
      files_grow_in_proportion("points", {.points = 150, .realizations = 1},
                               {.points = times * 150, .realizations = 1}),
      files_grow_in_proportion("taps", {.points = 1, .realizations = 1, .taps = 20'000},
                               {.points = 1, .realizations = 1, .taps = times * 20'000}),
      sides_cost_little(40), sides_cost_little(2500)};
  return std::ranges::all_of(passed, [](bool is_small) { return is_small; });
}

}  // namespace
}  // namespace jostle::bench

int main() {
  return jostle::bench::all_within_growth() ? 0 : 1;
}
