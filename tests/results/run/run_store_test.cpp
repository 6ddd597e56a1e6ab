#include "results/run/run_store.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <thread>

#include "results/disk/error.hpp"
#include "tests/monte_carlo_plan.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;
using synthetic::Conduct;
using synthetic::provenance;
using synthetic::run_pending;
using synthetic::StudySize;

namespace {

std::string straight_digest(const TemporaryFolder& folder, const StudySize& sizes = {}) {
  return synthetic::run_to_end(folder / "straight.h5", sizes);
}

bool is_same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

/// Stops after `first` steps, `stride` more, and so on, by signal or by kill, and resumes.
void check_stops(std::uint64_t first, std::uint64_t stride) {
  const TemporaryFolder folder;
  const std::string expected = straight_digest(folder);
  const Study study = synthetic::study();
  const bool killed = GENERATE(false, true);
  const std::uint64_t checkpoint_every = GENERATE(1, 4);
  for (std::uint64_t steps = first; steps < 18; steps += stride) {
    const std::string path = folder / fmt::format("a{}.h5", steps);
    {
      const auto store = RunStore::create(path, study, {}, provenance());
      run_pending(
          *store, study,
          {.checkpoint_every = checkpoint_every, .steps = steps, .leave_without_end = killed});
      if (!killed) store->finish();
    }
    CHECK(ResultsFile(path).state() == (killed ? RunState::running : RunState::interrupted));
    {
      const auto store = RunStore::resume(path, study, {}, provenance());
      CHECK(store->pending().size() == 6);
      run_pending(*store, study, {.steps = 3});
      store->finish();
    }
    const auto store = RunStore::resume(path, study, {}, provenance());
    const bool idle = store->pending().empty();  // a process that adds nothing changes nothing
    run_pending(*store, study);
    store->finish();
    CHECK(digest_of(path) == expected);
    CHECK(ResultsFile(path).provenance().size() == (idle ? 2 : 3));
  }
}

}  // namespace

TEST_CASE("a folded file gives back every row, snapshot and state") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const Study study = synthetic::study();
  {
    const auto store = RunStore::create(path, study, {}, provenance());
    CHECK(ResultsFile(path).state() == RunState::running);
    run_pending(*store, study);
    CHECK(store->pending().empty());
    store->finish();
  }
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
  const ResultsFile file(path);
  CHECK(file.state() == RunState::complete);
  CHECK(file.study().scene == study.scene);
  CHECK(file.study().resolved_scene == study.resolved_scene);
  CHECK(file.study().points[1].id == study.points[1].id);
  CHECK(file.study().points[1].sweep_values == study.points[1].sweep_values);
  CHECK(file.study().points[1].snapshots == study.points[1].snapshots);
  CHECK(file.study().points[1].container == study.points[1].container);
  CHECK(file.provenance().at(0).host == provenance().host);
  for (std::uint32_t p = 0; p < 2; ++p) {
    const auto series = file.series(p);
    REQUIRE(series.size() == 6);
    CHECK(series[0].label.name == "mean_height");
    CHECK(series[0].label.source == "a paper");
    CHECK(series[3].label.name == "acceptance");
    for (std::uint32_t r = 0; r < 3; ++r)
      for (std::uint64_t tap = 0; tap <= 6; ++tap) {
        const TapRow row = synthetic::expected_row(study, {p, r}, tap);
        CHECK(series[0].value(tap, r) == row.observables[0]);
        CHECK(series[1].value(tap, r) == row.observables[1]);
        CHECK(series[2].value(tap, r) == diagnostic(row, "sweeps"));
        CHECK(is_same(series[3].value(tap, r), diagnostic(row, "acceptance")));
        CHECK(series[5].value(tap, r) == diagnostic(row, "dropped_offsets"));
      }
  }
  const RealizationRecord record = file.record({1, 2});
  CHECK(record.status == RealizationStatus::done);
  CHECK(record.work.seconds == 0.5);
  CHECK(record.work.start_seconds == 0.25);
  REQUIRE(record.state);
  CHECK(record.state->rows == 7);
  CHECK(record.state->engine.size() == 3 * sizeof(double));
  CHECK(record.state->observable_windows.size() == 2);
  REQUIRE(record.snapshots.size() == 3);
  CHECK(record.snapshots[2].tap == 6);
  CHECK(record.snapshots[2].centres == record.state->centres);
  CHECK(record.snapshots[2].coordination == record.state->centres[0].x);
  CHECK(record.snapshots[2].height_histogram ==
        std::vector<double>{0.25, 0, record.state->centres[1].x});
  const SnapshotRecord& last = record.snapshots[2];
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(last.velocities.at(i) ==
          Vec3{last.centres[i].x - 0.5, -last.centres[i].x, 1e-3 * last.centres[i].z});
    CHECK(last.spins.at(i) == Vec3{last.centres[i].z, 0, -last.centres[i].x});
  }
  CHECK(last.temperature_lateral.size() == 2);
  CHECK(std::isnan(last.temperature_vertical.at(0)));
  CHECK(last.temperature_vertical.at(1) == 2 * last.centres[0].x);
  CHECK(last.driven_fraction == std::vector<double>{0.5, 0, last.centres[0].x});
  CHECK(last.driven_lateral.at(1) == 3 * last.centres[0].x);
  CHECK(last.driven_vertical == std::vector<double>{4 * last.centres[0].x});
  REQUIRE(last.forces);
  CHECK(last.forces->moment[8] == 8 + last.centres[0].x);
  CHECK(last.forces->walls == std::vector<WallForce>{{5.5, {0.5, last.centres[0].x, 0}}});
  std::size_t n_contacts = 0;
  for (std::uint32_t r = 0; r < 3; ++r) {
    for (const SnapshotRecord& snapshot : file.snapshots({1, r})) {
      CHECK(snapshot.contacts.size() == static_cast<std::size_t>(5 * snapshot.centres[0].x));
      n_contacts += snapshot.contacts.size();
      if (snapshot.contacts.size() < 2) continue;
      CHECK(
          snapshot.contacts[1] ==
          Contact{
              1, 5, 1e-4 * snapshot.centres[1].x, 2, {0, 0, -1}, {snapshot.centres[1].x, 0.25, 0}});
    }
    CHECK(file.positions({1, r}).at(1).centres == file.snapshots({1, r}).at(1).centres);
  }
  CHECK(n_contacts > 5);
}

TEST_CASE("any part of a column can be read by itself") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  synthetic::run_to_end(path, {.realizations = 7, .taps = 300});
  const ResultsFile file(path);
  const std::vector<Series> all = file.series(1);
  const std::vector<Column> labels = file.columns(1);
  REQUIRE(labels.size() == all.size());
  for (std::size_t column = 0; column < all.size(); ++column) {
    CHECK(labels[column].name == all[column].label.name);
    const auto block = file.block(1, labels[column].name, {17, 290}, {2, 6});
    REQUIRE(block.size() == 273 * 4);
    for (std::uint64_t tap = 17; tap < 290; ++tap)
      for (std::uint32_t r = 2; r < 6; ++r)
        CHECK(is_same(block[(tap - 17) * 4 + r - 2], all[column].value(tap, r)));
  }
  CHECK(file.block(0, labels[0].name, {5, 5}, {0, 7}).empty());
  CHECK_THROWS_AS(file.block(0, "no_such_column", {0, 1}, {0, 1}), ResultsError);
}

TEST_CASE("what fitting did to a pour is given back by realization") {
  const TemporaryFolder folder;
  straight_digest(folder);
  const ResultsFile file(folder / "straight.h5");
  const std::vector<RealizationValues> columns = file.fittings(1);
  REQUIRE(columns.size() == std::size(fitting_columns));
  CHECK(columns[0].label.name == "spheres_moved");
  CHECK(columns[0].values == std::vector<double>{3, 4, 5});
  CHECK(columns[1].values == std::vector<double>{1.5, 1.5, 1.5});
  CHECK(std::isnan(columns[4].values.at(0)));
}

TEST_CASE("means, deviations and errors are over realizations") {
  const TemporaryFolder folder;
  straight_digest(folder);
  const ResultsFile file(folder / "straight.h5");
  const Series series = file.series(1)[0];
  const EnsembleSeries ensemble = file.ensemble(1)[0];
  CHECK(ensemble.label.name == "mean_height");
  for (std::uint64_t tap = 0; tap <= 6; ++tap) {
    const double a = series.value(tap, 0), b = series.value(tap, 1), c = series.value(tap, 2);
    const double mean = (a + b + c) / 3;
    const double squares =
        (a - mean) * (a - mean) + (b - mean) * (b - mean) + (c - mean) * (c - mean);
    CHECK(ensemble.mean[tap] == Approx(mean).epsilon(1e-14));
    CHECK(ensemble.sigma[tap] == Approx(std::sqrt(squares / 3)).epsilon(1e-12));
    CHECK(ensemble.error[tap] == Approx(std::sqrt(squares / 6)).epsilon(1e-12));
    CHECK(ensemble.count[tap] == 3);
  }
  CHECK(file.ensemble(1)[3].count[0] == 0);  // no acceptance before the first tap
}

TEST_CASE("stopped and resumed, by signal or by kill, the digest is that of a straight run") {
  check_stops(1, 6);
}

TEST_CASE("stopped at any step and resumed, the digest is that of a straight run", "[slow]") {
  check_stops(1, 2);
}

TEST_CASE("a gracefully stopped file shows what is there") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const Study study = synthetic::study();
  const auto store = RunStore::create(path, study, {}, provenance());
  run_pending(*store, study, {.steps = 7});
  store->finish();
  const ResultsFile file(path);
  const RealizationSummary summary = file.realizations().at(4);
  CHECK(summary.id == RealizationId{1, 1});
  CHECK(summary.status == RealizationStatus::running);
  CHECK(summary.rows == 3);
  CHECK(file.series(1)[0].value(2, 1) == synthetic::expected_row(study, {1, 1}, 2).observables[0]);
  CHECK(file.series(1)[0].n_taps == 3);
  CHECK(file.snapshots({1, 1}).size() == 2);
  CHECK(file.record({1, 1}).state->relaxing);
}

TEST_CASE("more taps and more realizations give the file of the longer scene") {
  const TemporaryFolder folder;
  const StudySize longer{.realizations = 5, .taps = 9, .snapshot_taps = {0, 2, 6, 8}};
  const std::string expected = straight_digest(folder, longer);
  const std::string path = folder / "a.h5";
  const std::uint64_t steps = GENERATE(10, 1000);  // interrupted, complete
  {
    const auto store = RunStore::create(path, synthetic::study(), {}, provenance());
    run_pending(*store, synthetic::study(), {.steps = steps});
    if (steps == 1000) store->finish();
  }
  const Study study = synthetic::study(longer);
  {
    const auto store = RunStore::resume(path, study, {}, provenance());
    CHECK(ResultsFile(path).study().resolved_scene == study.resolved_scene);
    CHECK(ResultsFile(path).study().points[0].taps == 9);
    CHECK(store->pending().size() == 10);
    run_pending(*store, study, {.steps = 2, .leave_without_end = true});
  }
  const auto store = RunStore::resume(path, study, {}, provenance());
  run_pending(*store, study);
  store->finish();
  CHECK(digest_of(path) == expected);
}

TEST_CASE("a failed realization is NaN with its reason, and can be run again") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const Study study = synthetic::study();
  const auto store = RunStore::create(path, study, {}, provenance());
  for (const RealizationId id : store->pending())
    synthetic::run(*store, study, id, {.fail_at_tap = id == RealizationId{0, 1} ? 3u : 1000u});
  CHECK(store->pending().empty());
  store->finish();
  {
    const ResultsFile file(path);
    CHECK(file.state() == RunState::complete);
    const RealizationSummary failed = file.realizations().at(1);
    CHECK(failed.status == RealizationStatus::failed);
    CHECK(failed.reason == "requested by the test");
    CHECK(std::isnan(file.series(0)[0].value(0, 1)));
    CHECK(file.ensemble(0)[0].count[0] == 2);
    CHECK(file.snapshots({0, 1}).empty());
  }
  REQUIRE(store->pending(true) == std::vector<RealizationId>{{0, 1}});
  synthetic::run(*store, study, {0, 1});
  store->finish();
  CHECK(digest_of(path) == straight_digest(folder));
}

TEST_CASE("realizations on several threads give the bytes of one after another", "[threaded]") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  const Study study = synthetic::study();
  const auto store = RunStore::create(path, study, {}, provenance());
  std::vector<std::thread> threads;
  for (const RealizationId id : store->pending())
    threads.emplace_back([&, id] { synthetic::run(*store, study, id, {.checkpoint_every = 1}); });
  for (std::thread& thread : threads) thread.join();
  store->finish();
  CHECK(digest_of(path) == straight_digest(folder));
}

TEST_CASE("series longer than a segment are published piece by piece") {
  const TemporaryFolder folder;
  const StudySize sizes{.points = 1,
                        .realizations = 1,
                        .spheres = 20000,
                        .taps = 12,
                        .snapshot_taps = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
  const Study study = synthetic::study(sizes);
  const std::string path = folder / "a.h5";
  {
    const auto store = RunStore::create(path, study, {}, provenance());
    run_pending(*store, study, {.steps = 20, .leave_without_end = true});
  }
  CHECK(std::filesystem::exists(path + ".parts/p0000_r00000.segment00001"));
  CHECK(std::filesystem::file_size(path + ".parts/p0000_r00000.state") < 3 << 20);
  const auto store = RunStore::resume(path, study, {}, provenance());
  run_pending(*store, study);
  store->finish();
  CHECK(digest_of(path) == straight_digest(folder, sizes));
}

TEST_CASE("a run whose start file has changed since is refused") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  Study study = synthetic::study();
  study.points[1].start_sum = "as it was";
  {
    const auto store = RunStore::create(path, study, {}, provenance());
    run_pending(*store, study, {.steps = 4});
    store->finish();
  }
  CHECK(ResultsFile(path).study().points[0].start_sum.empty());
  CHECK(ResultsFile(path).study().points[1].start_sum == "as it was");
  Study changed = study;
  changed.points[1].start_sum = "as it is";
  CHECK_THROWS_WITH(RunStore::resume(path, changed, {}, provenance()),
                    Catch::Matchers::Contains("sweep point 1 starts from has changed"));
  CHECK_NOTHROW(RunStore::resume(path, study, {}, provenance()));
}
