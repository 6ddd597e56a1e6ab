#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "results/file/results_writer.hpp"
#include "results/file/tables.hpp"
#include "study/drawing/page/page.hpp"
#include "study/drawing/page/page_data.hpp"
#include "study/drawing/page/page_json.hpp"
#include "study/drawing/page/page_packings.hpp"
#include "tests/results/synthetic.hpp"
#include "tests/results/temporary_folder.hpp"

// Files too large for a page: the page stays small, keeps the ends, and names the omitted data.
using namespace jostle;

namespace {

constexpr std::size_t most_bytes = 10'000'000;

struct StudySize {
  std::uint32_t points = 1, realizations = 1, spheres = 0;  // spheres of each kept packing
  std::uint64_t taps = 10;
  std::size_t snapshots = 0;
};

/// Spheres on a square lattice of width 1.25, in layers.
std::vector<Vec3> lattice(std::uint32_t n) {
  constexpr std::uint32_t side = 16;
  std::vector<Vec3> centres;
  for (std::uint32_t i = 0; i < n; ++i) {
    centres.push_back({1.25 * (i % side) + 0.625, 1.25 * (i / side % side) + 0.625,
                       1.25 * (i / side / side) + 0.625});
  }
  return centres;
}

Study study_of(const StudySize& sizes) {
  Study study = synthetic::study({.points = sizes.points,
                                  .realizations = sizes.realizations,
                                  .spheres = std::max(1u, sizes.spheres),
                                  .taps = sizes.taps,
                                  .snapshot_taps = {}});
  study.resolved_scene = R"({"name": "synthetic", "protocol": [{"count": 1}]})";
  for (StudyPoint& point : study.points) {
    point.container = PeriodicBox{20, 20};
    for (std::size_t k = 0; k < sizes.snapshots; ++k) point.snapshots.taps.push_back(k);
    point.snapshots.velocities = point.snapshots.contacts = point.snapshots.forces = false;
    point.snapshots.granular_temperature = point.snapshots.coordination = false;
    point.snapshots.height_histogram = false;
  }
  return study;
}

/// The curve that is stored, [taps + 1, columns]: one tap of the first column is far above all.
std::vector<double> rows_of(const StudySize& sizes, std::size_t n_columns, std::uint64_t peak) {
  std::vector<double> rows;
  rows.reserve((sizes.taps + 1) * n_columns);
  for (std::uint64_t tap = 0; tap <= sizes.taps; ++tap) {
    for (std::size_t c = 0; c < n_columns; ++c) {
      rows.push_back(c == 0 && tap == peak ? 1e6
                                           : 0.123456789 * double(c + 1) + 1e-7 * double(tap));
    }
  }
  return rows;
}

ResultsFile file_of(const StudySize& sizes, const std::string& path, std::uint64_t peak = 7) {
  const Study study = study_of(sizes);
  const std::size_t n_columns = study.points.front().n_columns();
  const std::vector<double> rows = rows_of(sizes, n_columns, peak);
  const auto realization = [&](RealizationId) {
    RealizationRecord record;
    record.status = RealizationStatus::done;
    record.state.emplace();
    record.state->rows = sizes.taps + 1;
    record.rows = rows;
    for (std::size_t k = 0; k < sizes.snapshots; ++k) {
      SnapshotRecord snapshot;
      snapshot.tap = k;
      snapshot.centres = lattice(sizes.spheres);
      record.snapshots.push_back(std::move(snapshot));
    }
    return in_memory(std::move(record), n_columns);
  };
  write_results(path, {study, {}, {synthetic::provenance()}, "run", realization});
  return ResultsFile(path);
}

/// Profiles at a sweep point.
Table profiles_of(std::uint32_t point) {
  constexpr std::size_t n_taps = 4, n_places = 120, n_profiles = 5;
  std::vector<double> places(n_places), values(n_taps * n_places);
  for (std::size_t i = 0; i < n_places; ++i) places[i] = 0.1 * double(i);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.123456789 * double(i + point);
  Table table{
      .name = fmt::format("point_{:04}/profile", point),
      .axes = {
          {.name = "tap", .axes = {"tap"}, .values = std::vector<std::uint64_t>{0, 1, 10, 100}},
          {.name = "height", .axes = {"height"}, .values = places}}};
  for (std::size_t k = 0; k < n_profiles; ++k) {
    table.quantities.push_back({.name = k == 0 ? "phi" : fmt::format("phi_{}", k),
                                .axes = {"tap", "height"},
                                .values = values});
  }
  return table;
}

/// In the room of one file among `n_files`.
Json data_of(const ResultsFile& file, std::size_t n_files = 1) {
  return page_data(file, "", {.drawn = DrawnRoom::of_one_in(n_files), .packing_bytes = 4'000'000},
                   2);
}

std::string said(const Json& data) {
  std::string text;
  for (const Json& entry : data.at("left_out").elements()) text += entry.text() + "\n";
  return text;
}

std::size_t page_bytes(const ResultsFile& file) {
  const PageSource source{file, ""};
  return report_page({&source, 1}, synthetic::provenance(), 2).size();
}

/// The series of the first figure: one per sweep point.
const std::vector<Json>& first_series(const Json& data) {
  return data.at("figures").at(0).at("panels").at(0).at("series").elements();
}

void check_thinned_curves(const ResultsFile& file, std::size_t n_points, std::size_t n_files) {
  const Json data = data_of(file, n_files);
  CHECK_THAT(said(data), Catch::Contains("curves are drawn at 5 taps per decade"));
  CHECK_THAT(said(data),
             Catch::Contains(fmt::format("of {} sweep points, evenly spread", n_points)));
  const auto& curves = first_series(data);
  REQUIRE(curves.size() > n_points / 2);
  CHECK(curves.size() < n_points);
  CHECK(data.at("curve_points").size() == curves.size());
  CHECK(curves.front().at("point").whole_number() == 0);
  CHECK(curves.back().at("point").whole_number() == n_points - 1);
  for (const Json& curve : {curves.front(), curves.back()}) {
    const auto& taps = curve.at("x").elements();
    const auto& mean = curve.at("y").elements();
    REQUIRE(taps.size() == mean.size());
    CHECK(taps.front().whole_number() == 0);
    CHECK(taps.back().whole_number() == 300);
    const auto peak =
        std::ranges::find_if(taps, [](const Json& tap) { return tap.whole_number() == 187; });
    REQUIRE(peak != taps.end());
    CHECK(mean[static_cast<std::size_t>(peak - taps.begin())].number() == 1e6);
    CHECK(std::ranges::is_sorted(taps, {}, [](const Json& tap) { return tap.whole_number(); }));
  }
  CHECK(data.at("points").elements().size() == n_points);
}

/// A file in which so many sweep points have profiles.
ResultsFile file_of_profiles(const std::string& path, std::uint32_t n_points) {
  { const ResultsFile file = file_of({.points = n_points}, path); }
  std::vector<Table> tables;
  for (std::uint32_t point = 0; point < n_points; ++point) tables.push_back(profiles_of(point));
  store_tables(path, "structure", tables, synthetic::provenance());
  return ResultsFile(path);
}

void check_thinned_tables(const ResultsFile& file, std::size_t n_points, std::size_t n_files) {
  const Json data = data_of(file, n_files);
  CHECK_THAT(said(data), Catch::Contains("tables are drawn at some of their taps and places"));
  CHECK_THAT(said(data),
             Catch::Contains(fmt::format("of {} sweep points, evenly spread", n_points)));
  std::vector<std::uint64_t> kept;  // the sweep points of the profiles that are drawn
  for (const Json& figure : data.at("figures").elements()) {
    if (figure.at("section").text() != "profile" || figure.find("point") == nullptr) continue;
    const std::uint64_t point = figure.at("point").whole_number();
    if (kept.empty() || kept.back() != point) kept.push_back(point);
  }
  REQUIRE(!kept.empty());
  CHECK(kept.size() > n_points / 3);
  CHECK(kept.size() < n_points);
  CHECK(kept.front() == 0);
  CHECK(kept.back() == n_points - 1);
}

}  // namespace

TEST_CASE("curves of many sweep points are thinned to the room, ends and peaks kept") {
  const TemporaryFolder folder;
  check_thinned_curves(file_of({.points = 50, .taps = 300}, folder / "many.h5", 187), 50, 8);
}

TEST_CASE("curves of hundreds of sweep points are thinned, and their page keeps its bounds",
          "[slow]") {
  const TemporaryFolder folder;
  const ResultsFile file = file_of({.points = 400, .taps = 300}, folder / "many.h5", 187);
  check_thinned_curves(file, 400, 1);
  CHECK(page_bytes(file) < most_bytes);
}

TEST_CASE("a very long series is thinned, with a note") {
  const TemporaryFolder folder;
  const ResultsFile file = file_of({.taps = 300'000}, folder / "long.h5", 123'457);
  const Json data = data_of(file);
  CHECK_THAT(said(data), Catch::Contains("curves are drawn at 40 taps per decade"));
  const auto& taps = first_series(data).front().at("x").elements();
  CHECK(taps.size() < 300);
  CHECK(taps.back().whole_number() == 300'000);
  CHECK(std::ranges::any_of(taps, [](const Json& tap) { return tap.whole_number() == 123'457; }));
  CHECK(page_bytes(file) < 1'000'000);
}

TEST_CASE("packings of hundreds of realizations are chosen, the first and the last tap kept") {
  const TemporaryFolder folder;
  const ResultsFile file =
      file_of({.points = 2, .realizations = 200, .spheres = 250, .taps = 3, .snapshots = 3},
              folder / "packings.h5");
  constexpr std::size_t room = 250'000;  // a sixteenth of a page's: Voronoi cells take their time
  std::vector<std::string> left_out;
  const Json packings = page_packings(file, room, 2, left_out);
  REQUIRE(left_out.size() == 2);
  CHECK_THAT(left_out[0], Catch::Contains("of 120 kept packings are drawn: evenly spread"));
  CHECK_THAT(left_out[1], Catch::Contains("20 realizations of each"));
  const auto& chosen = packings.elements();
  CHECK(chosen.size() > 40);
  CHECK(chosen.size() < 2 * 20 * 3);
  CHECK(chosen.front().at("tap").whole_number() == 0);
  CHECK(chosen.back().at("tap").whole_number() == 2);
  CHECK(chosen.front().at("point").whole_number() == 0);
  CHECK(chosen.back().at("point").whole_number() == 1);
  const std::size_t bytes = script_text(packings).size();
  CHECK(bytes > room / 2);  // it does use its room
  CHECK(bytes < room);
}

TEST_CASE("tables of many sweep points are thinned, and then left out at some points") {
  const TemporaryFolder folder;
  check_thinned_tables(file_of_profiles(folder / "tables.h5", 50), 50, 4);
}

TEST_CASE("tables of hundreds of sweep points are thinned, and their page keeps its bounds",
          "[slow]") {
  const TemporaryFolder folder;
  const ResultsFile file = file_of_profiles(folder / "tables.h5", 200);
  check_thinned_tables(file, 200, 1);
  const std::size_t bytes = page_bytes(file);
  CHECK(bytes > 1'000'000);
  CHECK(bytes < most_bytes);
}
