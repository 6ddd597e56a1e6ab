#include "study/tables/observable_series.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "results/run/live_run.hpp"
#include "results/run/run_store.hpp"
#include "study/drawing/drawn/drawn_results.hpp"
#include "tests/results/synthetic.hpp"
#include "tests/results/temporary_folder.hpp"

// Runs that were stopped: realizations that have not come as far as others.
using namespace jostle;

TEST_CASE("In a stopped run every realization gives the taps that it has") {
  const TemporaryFolder folder;
  const std::string path = folder / "stopped.h5";
  const Study study = synthetic::study({.points = 3, .realizations = 3});
  const auto store = RunStore::create(path, study, {}, synthetic::provenance());
  synthetic::run(*store, study, {0, 0});
  synthetic::run(*store, study, {0, 2}, {.steps = 7, .leave_without_end = true});
  for (const std::uint32_t r : {0u, 1u, 2u}) synthetic::run(*store, study, {1, r});
  synthetic::run(*store, study, {2, 1}, {.fail_at_tap = 2});
  const ResultsFile file = live_results(path, Content::everything);

  const std::string observable = study.points[0].observables[0].name;
  const ObservableSeries series(file, 0, observable);
  CHECK(series.realizations() == std::vector<std::uint32_t>{0, 2});
  REQUIRE(series.n_rows() == 3);
  const auto expected = [&](std::uint32_t r, std::uint64_t tap) {
    return synthetic::expected_row(study, {0, r}, tap).observables[0];
  };
  const std::vector<double> early = series.means({1, 3}), late = series.means({2, 5});
  CHECK(early[0] == Approx((expected(0, 1) + expected(0, 2)) / 2));
  CHECK(early[1] == Approx((expected(2, 1) + expected(2, 2)) / 2));
  CHECK(late[0] == Approx((expected(0, 2) + expected(0, 3) + expected(0, 4)) / 3));
  CHECK(std::isnan(late[1]));
  CHECK(series.held_back() == "; realization 2 has reached only tap 2, the farthest tap 6");
  CHECK(ObservableSeries(file, 1, observable).held_back().empty());
  CHECK(realizations_with_taps(file, 0) == std::vector<std::uint32_t>{0, 2});
  CHECK(realizations_with_taps(file, 2).empty());
}
