#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>

#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/starts/starts.hpp"
#include "results/export/packing_file.hpp"
#include "results/file/results_writer.hpp"
#include "runs.hpp"
#include "structure/measure.hpp"
#include "temporary_folder.hpp"

// Costs of files of many points and realizations, of files of long plans with few finished taps,
// and of packings in wide boxes: in proportion to what is in them. Ratios of processor time, the
// least of three, with room for a machine that does other work: in proportion is 4, its square 16.
using namespace jostle;

namespace {

double processor_seconds(const std::function<void()>& work) {
  const auto now = [] {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
  };
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 3; ++repeat) {
    const double began = now();
    work();
    least = std::min(least, now() - began);
  }
  return least;
}

constexpr std::uint32_t times = 4;
constexpr double most_growth = 2.5 * 2.5;  // most growth of two doublings

/// Work of a size, and what it is called.
template <class Size>
using Steps = std::vector<std::pair<const char*, std::function<void(const Size&)>>>;

/// How much longer each step takes with `large` than with `small`.
template <class Size>
void check_steps(const char* title, const Steps<Size>& steps, const Size& small,
                 const Size& large) {
  for (const auto& [step, work] : steps) {
    const double small_time = processor_seconds([&, &run = work] { run(small); });
    const double large_time = processor_seconds([&, &run = work] { run(large); });
    fmt::print("{} times the {}: {:12} {:7.1f} ms, {:7.1f} ms, {:.2f} times\n", times, title, step,
               1e3 * small_time, 1e3 * large_time, large_time / small_time);
    CAPTURE(title, step, small_time, large_time);
    CHECK(large_time < most_growth * small_time);
  }
}

void check_growth(const char* title, const synthetic::StudySize& small,
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
    const ResultsFile file(path(sizes));
    REQUIRE(file.realizations().size() == std::size_t{sizes.points} * sizes.realizations);
  };
  const auto digested = [&](const synthetic::StudySize& sizes) { digest_of(path(sizes)); };
  const Steps<synthetic::StudySize> steps = {
      {"run and fold", written}, {"open", opened}, {"digest", digested}};
  check_steps(title, steps, small, large);
}

/// A bed of as many spheres in a wider box.
void check_growth_of_sides(double side) {
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
    REQUIRE(measure(read_packing(path(width)), all_structure(), key).size() >= 9);
  };
  Steps<double> steps = {{"pour", bed}, {"relax", relaxed}};
  // Spheres that are all far apart are refused.
  if (side < 100) {
    steps.emplace_back("read", [&](double width) { read_packing(path(width)); });
    steps.emplace_back("structure", measured);
  }
  check_steps("sides", steps, side, times * side);
}

}  // namespace

TEST_CASE("writing, opening and digesting take time in proportion to realizations", "[slow]") {
  check_growth("realizations", {.points = 1, .realizations = 60},
               {.points = 1, .realizations = times * 60});
}

TEST_CASE("writing, opening and digesting take time in proportion to points and taps", "[slow]") {
  SECTION("points") {
    check_growth("points", {.points = 40, .realizations = 1},
                 {.points = times * 40, .realizations = 1});
  }
  SECTION("taps") {
    check_growth("taps", {.points = 1, .realizations = 1, .taps = 20'000},
                 {.points = 1, .realizations = 1, .taps = times * 20'000});
  }
}

// With equal numbers of spheres area costs nothing, up to the widest box of all.
TEST_CASE("a wider box takes no longer than its spheres and its bins") {
  check_growth_of_sides(GENERATE(40.0, 2500.0));
}

TEST_CASE("thousands of points and realizations take time in proportion too", "[nightly]") {
  SECTION("points") {
    check_growth("points", {.points = 1000, .realizations = 1},
                 {.points = times * 1000, .realizations = 1});
  }
  SECTION("realizations") {
    check_growth("realizations", {.points = 1, .realizations = 5000},
                 {.points = 1, .realizations = times * 5000});
  }
}

TEST_CASE("a sweep point that has not begun takes two kilobytes, and reads as missing") {
  const auto bytes_of = [](const std::string& path, std::uint32_t points) {
    Study study = synthetic::study({.points = points, .realizations = 2, .taps = 10});
    study.points.back().snapshots.bin_width = 0.2;  // keeps something else than those before it
    const std::size_t n_columns = study.points[0].n_columns();
    const auto record = [&](RealizationId id) {
      RealizationRecord realization_record;
      if (id.point == 1) realization_record.status = RealizationStatus::running;
      if (id.point == 1) realization_record.rows.assign(3 * n_columns, 0.5);
      return in_memory(realization_record, n_columns);
    };
    write_results(path, {study, {}, {synthetic::provenance()}, "run", record});
    return std::filesystem::file_size(path);
  };
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const auto few = bytes_of(folder / "few.h5", 100);
  CHECK(bytes_of(path, 1100) - few < 1000 * 2000);
  const ResultsFile file(path);
  const Study expected = synthetic::study({.points = 1100, .realizations = 2, .taps = 10});
  for (const std::uint32_t p : {0u, 1u, 2u, 1099u}) {
    CAPTURE(p);
    const StudyPoint& point = file.study().points[p];
    CHECK(point.label == expected.points[p].label);
    CHECK(point.id == expected.points[p].id);
    CHECK(point.sweep_values == expected.points[p].sweep_values);
    CHECK(point.columns() == expected.points[p].columns());
    CHECK(point.snapshots.bin_width == (p == 1099 ? 0.2 : expected.points[p].snapshots.bin_width));
    const bool begun = p == 1;
    CHECK(file.realizations()[2 * p].status ==
          (begun ? RealizationStatus::running : RealizationStatus::missing));
    CHECK(file.n_stored_rows(p) == (begun ? 3u : 0u));
    CHECK(file.ensemble(p).empty() == !begun);
    CHECK(std::isnan(file.block(p, "mean_height", {0, 1}, {0, 1}).at(0)) == !begun);
    CHECK(file.record({p, 0}).rows.size() == (begun ? 3 * point.n_columns() : 0));
    CHECK_FALSE(file.restart_state({p, 0}));
  }
  CHECK(digest_of(path).size() == 64);
}

TEST_CASE("a run that is stopped early stores what is there, however much was planned") {
  std::uintmax_t bytes = 0;
  for (const std::uint64_t taps : {1'000ULL, 1'000'000ULL, 100'000'000'000ULL}) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.h5";
    const Study study = synthetic::study({.points = 2, .realizations = 2, .taps = taps});
    const std::size_t n_columns = study.points[0].n_columns();
    const auto record = [&](RealizationId id) {
      RealizationRecord realization_record;
      realization_record.status = RealizationStatus::running;
      realization_record.rows.assign((id.realization == 0 ? 7 : 3) * n_columns, 0.5);
      return in_memory(realization_record, n_columns);
    };
    write_results(path, {study, {}, {synthetic::provenance()}, "run", record});
    const ResultsFile file(path);
    CHECK(file.state() == RunState::interrupted);
    CHECK(file.series(0).at(0).n_taps == 7);
    CHECK(file.ensemble(0).at(0).mean.size() == 7);
    const auto values = file.block(0, file.columns(0).at(0).name, {2, 9}, {0, 2});
    REQUIRE(values.size() == 14);
    CHECK(values[0] == 0.5);
    CHECK(values[1] == 0.5);
    CHECK(std::isnan(values[3]));   // the second realization has come to tap 2
    CHECK(values[8] == 0.5);        // the first to tap 6
    CHECK(std::isnan(values[10]));  // no column has a tap 7
    CHECK(file.record({0, 0}).rows.size() == 7 * n_columns);
    CHECK(digest_of(path).size() == 64);
    if (bytes == 0) bytes = std::filesystem::file_size(path);
    CHECK(std::filesystem::file_size(path) <= bytes + 100);  // more digits in the scene
  }
}
