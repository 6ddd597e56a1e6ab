#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "results/run/live_run.hpp"
#include "results/run/run_parts.hpp"
#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

// Checkpoints of a run are read during the run.
using namespace jostle;
using synthetic::provenance;

namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator entries(folder);
  return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
}

}  // namespace

TEST_CASE("a live run shows the taps of its last checkpoints, and nothing is touched") {
  const TemporaryFolder folder, temporary;
  ::setenv("TMPDIR", temporary.path().c_str(), 1);
  const std::string path = folder / "live.h5";
  const Study study = synthetic::study();
  const auto store = RunStore::create(path, study, {}, provenance());
  // Seven steps of three a tap, a checkpoint every two: tap 0, and two more.
  synthetic::run(*store, study, {0, 0}, {.steps = 7, .leave_without_end = true});
  synthetic::run(*store, study, {1, 2});
  const std::string bytes_before = bytes_of(path);
  const std::size_t n_parts = files_in(parts_folder(path));
  const Content content = GENERATE(Content::everything, Content::without_snapshots);
  {
    const ResultsFile live = live_results(path, content);
    CHECK(live.path() == path);
    CHECK(live.state() == RunState::interrupted);
    CHECK(files_in(temporary.path()) == 0);
    const auto realizations = live.realizations();
    CHECK(realizations[0].rows == 3);
    CHECK(realizations[0].status == RealizationStatus::running);
    CHECK(realizations[1].rows == 0);
    CHECK(realizations[5].status == RealizationStatus::done);
    for (const RealizationId id : {RealizationId{0, 0}, RealizationId{1, 2}}) {
      const auto series = live.series(id.point);
      for (std::uint64_t tap = 0; tap < 3; ++tap) {
        const TapRow expected = synthetic::expected_row(study, id, tap);
        CHECK(series[0].value(tap, id.realization) == expected.observables[0]);
        CHECK(series[1].value(tap, id.realization) == expected.observables[1]);
      }
    }
    CHECK(live.ensemble(0)[0].count == std::vector<std::uint32_t>{1, 1, 1});
    CHECK(live.snapshots({1, 2}).size() == (content == Content::everything ? 3 : 0));
  }
  CHECK(bytes_of(path) == bytes_before);
  CHECK(files_in(parts_folder(path)) == n_parts);
  ::unsetenv("TMPDIR");
}

TEST_CASE("a checkpoint stores the work of its process beside that of earlier ones") {
  const TemporaryFolder folder;
  const std::string path = folder / "live.h5";
  const Study study = synthetic::study();
  const auto reported = [&](std::size_t i) { return run_status(path).realizations.at(i).work; };
  {
    const auto store = RunStore::create(path, study, {}, provenance());
    synthetic::run(*store, study, {0, 0}, {.steps = 5, .leave_without_end = true});
    CHECK(reported(0).seconds == 4 * 0.0625);
    CHECK(reported(0).start_seconds == 0.03125);
    CHECK(reported(0).effort.units == 4);
    CHECK(reported(1).seconds == 0);
    CHECK(live_results(path).realizations()[0].work.seconds == 4 * 0.0625);
  }
  const auto store = RunStore::resume(path, study, {}, provenance());
  synthetic::run(*store, study, {0, 0}, {.steps = 5, .leave_without_end = true});
  CHECK(reported(0).seconds == 8 * 0.0625);
  CHECK(reported(0).effort.units == 8);
  synthetic::run(*store, study, {0, 0});
  CHECK(reported(0).seconds == 8 * 0.0625 + 0.5);
}

TEST_CASE("a live run that was resumed shows its old taps and its new ones") {
  const TemporaryFolder folder;
  const std::string path = folder / "live.h5";
  synthetic::run_to_end(path);
  const Study longer = synthetic::study({.taps = 9});
  const auto store = RunStore::resume(path, longer, {}, provenance());
  synthetic::run(*store, longer, {1, 1}, {.steps = 8, .leave_without_end = true});
  const ResultsFile live = live_results(path);
  CHECK(live.realizations()[4].rows == 9);
  CHECK(live.realizations()[3].rows == 7);
  for (std::uint64_t tap = 0; tap < 9; ++tap) {
    CHECK(live.series(1)[0].value(tap, 1) ==
          synthetic::expected_row(longer, {1, 1}, tap).observables[0]);
  }
}

TEST_CASE("without parts, a live run is its file") {
  const TemporaryFolder folder;
  const std::string path = folder / "whole.h5";
  synthetic::run_to_end(path);
  const ResultsFile live = live_results(path);
  CHECK(live.state() == RunState::complete);
  CHECK(live.realizations()[5].rows == 7);
}
