#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include "results/file/results_writer.hpp"
#include "runs.hpp"
#include "temporary_folder.hpp"

// Sizes of files of many points, and of long plans with few finished taps.
using namespace jostle;

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
