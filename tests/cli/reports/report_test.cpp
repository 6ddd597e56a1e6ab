#include "cli/reports/report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/results/runs.hpp"
#include "tests/results/temporary_folder.hpp"

using namespace jostle;
using Catch::Matchers::Contains;

namespace {

/// The report of a study of one point whose second realization ends after so many steps, three a
/// tap.
std::string report_of(std::uint64_t steps) {
  const TemporaryFolder folder;
  const Study study = synthetic::study({.points = 1, .realizations = 2});
  const auto store = RunStore::create(folder / "a.h5", study, {}, synthetic::provenance());
  synthetic::run(*store, study, {0, 0});
  synthetic::run(*store, study, {0, 1}, {.steps = steps});
  store->finish();
  return report(ResultsFile(folder / "a.h5"));
}

/// The report of a run whose <Z> is so high at its last tap.
std::string report_of_height(double last) {
  const TemporaryFolder folder;
  const Study study =
      synthetic::study({.points = 1, .realizations = 1, .taps = 1, .snapshot_taps = {}});
  const auto store = RunStore::create(folder / "a.h5", study, {}, synthetic::provenance());
  store->begin({0, 0});
  for (std::uint64_t tap = 0; tap < 2; ++tap) {
    TapRow row = synthetic::expected_row(study, {0, 0}, tap);
    row.observables[0] = tap == 0 ? 5 : last;
    store->append({0, 0}, row);
  }
  RealizationState state;
  state.rows = 2;
  store->end({0, 0}, state, {.status = RealizationStatus::done, .reason = {}});
  store->finish();
  return report(ResultsFile(folder / "a.h5"));
}

/// The line about fitting, of realizations with these fractions away from the walls.
std::string fitting_line_of(const std::vector<double>& earlier) {
  const TemporaryFolder folder;
  const auto n = static_cast<std::uint32_t>(earlier.size());
  const Study study =
      synthetic::study({.points = 1, .realizations = n, .taps = 0, .snapshot_taps = {}});
  const auto store = RunStore::create(folder / "a.h5", study, {}, synthetic::provenance());
  for (std::uint32_t r = 0; r < n; ++r) {
    store->begin({0, r});
    store->append({0, r}, synthetic::expected_row(study, {0, r}, 0));
    RealizationState state;
    state.rows = 1;
    state.fitting = {.spheres_moved = 3,
                     .mean_rise = 1.5,
                     .corrected_fraction_before = 0.58,
                     .corrected_fraction_after = 0.51,
                     .central_fraction_before = earlier[r],
                     .central_fraction_after = earlier[r] - 0.01};
    store->end({0, r}, state, {.status = RealizationStatus::done, .reason = {}});
  }
  store->finish();
  const std::string text = report(ResultsFile(folder / "a.h5"));
  const std::size_t index = text.find("fitting between the walls");
  return index == std::string::npos ? text : text.substr(index, text.find("\n\n", index) - index);
}

}  // namespace

TEST_CASE("A report shows the effect of fitting, and never a number that does not exist") {
  const double nan = std::nan("");
  CHECK(fitting_line_of({0.6, 0.62}).find("away from the walls 0.6100 -> 0.6000") !=
        std::string::npos);
  CHECK(fitting_line_of({nan, 0.62}).find("away from the walls 0.6200 -> 0.6100") !=
        std::string::npos);
  const std::string shallow = fitting_line_of({nan, nan});
  CAPTURE(shallow);
  CHECK(shallow.find("away from the walls not known") != std::string::npos);
  CHECK(shallow.find("nan") == std::string::npos);
}

TEST_CASE("A report warns where taps make a bed grow without end") {
  CHECK(report_of_height(49).find("<Z> has grown") == std::string::npos);
  CHECK(report_of_height(51).find("<Z> has grown from 5 d to 51 d") != std::string::npos);
}

TEST_CASE("A report has the number of realizations per row where not all reached every tap") {
  const std::string partial = report_of(7), whole = report_of(100);
  CAPTURE(partial, whole);
  CHECK(partial.starts_with("1 of 2 realizations done, 1 unfinished; "));
  CHECK(partial.find("\n\nepsilon = 0\ntap  M  mean_height") != std::string::npos);
  CHECK(partial.find("\n  2  2  ") != std::string::npos);
  CHECK(partial.find("\n  5  1  ") != std::string::npos);
  CHECK(partial.find("\n  6  1  ") != std::string::npos);
  CHECK(whole.find("\n\nepsilon = 0\ntap   mean_height") != std::string::npos);
}

TEST_CASE("A report shows the first of many failed realizations and counts the others") {
  const auto failures = [](std::uint32_t n) {
    const TemporaryFolder folder;
    const Study study = synthetic::study({.points = 1, .realizations = n, .snapshot_taps = {}});
    const auto store = RunStore::create(folder / "a.h5", study, {}, synthetic::provenance());
    synthetic::run_pending(*store, study, {.fail_at_tap = 1});
    store->finish();
    const ResultsFile file(folder / "a.h5");
    CHECK(report(file).find(failure_lines(file)) != std::string::npos);
    return failure_lines(file);
  };
  const std::string few = failures(20), large = failures(33);
  CAPTURE(few, large);
  CHECK(std::ranges::count(few, '\n') == 20);
  CHECK(few.find("more failed") == std::string::npos);
  CHECK(std::ranges::count(large, '\n') == 21);
  CHECK(large.ends_with("\nand 13 more failed: jostle info --json lists them\n"));
}

TEST_CASE("A report shows the columns of an engine as they ask for") {
  const TemporaryFolder folder;
  Study study = synthetic::study({.points = 1, .realizations = 2});
  study.points[0].diagnostics = {
      {"steps", "1", "", "", Shown::mean, 1},
      {"step", "diameter", "", "", Shown::spread},
      {"late", "1", "", "", Shown::count, 0, "{} taps were late", "no tap was late"},
      {"lost", "1", "", "", Shown::share, 0, "taps lost {} of it", "no tap lost any"}};
  const auto store = RunStore::create(folder / "a.h5", study, {}, synthetic::provenance());
  synthetic::run_pending(*store, study);
  store->finish();
  const std::string text = report(ResultsFile(folder / "a.h5"), {.columns = Columns::all});
  CAPTURE(text);
  CHECK(text.find("  sigma  steps  ") != std::string::npos);
  CHECK(text.find("  step  sigma\n") != std::string::npos);
  CHECK(text.find("  3.0  ") != std::string::npos);
  CHECK(text.find("\nno tap was late\n") != std::string::npos);
  CHECK(text.find("\ntaps lost 43.8 % of it\n") != std::string::npos);
}

TEST_CASE("Some points of a long sweep are shown, and all failed ones") {
  const TemporaryFolder folder;
  const Study study = synthetic::study({.points = 101, .realizations = 1, .snapshot_taps = {}});
  const auto store = RunStore::create(folder / "a.h5", study, {}, synthetic::provenance());
  for (std::uint32_t point = 0; point < 101; ++point) {
    synthetic::Conduct conduct;
    if (point == 50) conduct.fail_at_tap = 4;
    synthetic::run(*store, study, {point, 0}, conduct);
  }
  store->finish();
  const ResultsFile file(folder / "a.h5");
  const auto points_in = [](const std::string& text) {
    std::size_t n = 0;
    for (std::size_t index = 0; (index = text.find("\nepsilon = ", index)) != std::string::npos;
         ++index)
      ++n;
    return n;
  };
  const std::string text = report(file, {.width = 100});
  CHECK_THAT(text, Contains("40 of 101 sweep points, evenly spread, and 1 more with failures; "
                            "--wide shows all\n"));
  CHECK(points_in(text) == 41);
  CHECK_THAT(text, Contains("realization 0 failed (seed"));
  const std::string all = report(file, {.columns = Columns::all});
  CHECK_THAT(all, !Contains("shows all"));
  CHECK(points_in(all) == 101);
}
