#include "cli/reports/tap_table.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace jostle;

namespace {

EnsembleSeries series(const std::string& name, Shown shown, double mean, double error) {
  return {.label = {name, "1", "", "", shown, 1},
          .mean = {mean, mean},
          .sigma = {3 * error, 3 * error},
          .error = {error, error},
          .count = {9, 9}};
}

PointSeries two_taps() {
  return {.columns = {series("mean_height", Shown::spread, 3.7524, 0.0082),
                      series("fraction", Shown::spread, 0.5413, 0.002),
                      series("sweeps", Shown::mean, 6125, 0), series("capped", Shown::count, 0, 0)},
          .reached = {9, 9},
          .planned = 9};
}

}  // namespace

TEST_CASE("Few columns are the observables, and what has room of the engine's") {
  CHECK(tap_table(two_taps(), {.width = 80}).find("capped") == std::string::npos);
  const std::string shown = tap_table(two_taps(), {.width = 80});
  CHECK(shown ==
        "tap  mean_height    fraction  sweeps\n"
        "  0   3.7524(87)  0.5413(21)  6125.0\n"
        "  1   3.7524(87)  0.5413(21)  6125.0\n");
  CHECK(tap_table(two_taps(), {.width = 36}) == shown);
  CHECK(tap_table(two_taps(), {.width = 35}) ==
        "tap  mean_height    fraction\n"
        "  0   3.7524(87)  0.5413(21)\n"
        "  1   3.7524(87)  0.5413(21)\n");
}

TEST_CASE("Observables are never left out: they follow below") {
  CHECK(tap_table(two_taps(), {.width = 20}) ==
        "tap  mean_height\n"
        "  0   3.7524(87)\n"
        "  1   3.7524(87)\n"
        "\n"
        "tap    fraction\n"
        "  0  0.5413(21)\n"
        "  1  0.5413(21)\n");
}

TEST_CASE("All columns have sigma beside every observable, however wide") {
  CHECK(tap_table(two_taps(), {.width = 20, .columns = Columns::all}) ==
        "tap  mean_height   sigma    fraction  sigma  sweeps\n"
        "  0   3.7524(87)  0.0246  0.5413(21)  0.006  6125.0\n"
        "  1   3.7524(87)  0.0246  0.5413(21)  0.006  6125.0\n");
}

TEST_CASE("A column without a value, or without an error, is marked") {
  PointSeries series = two_taps();
  series.columns[0].mean[1] = std::nan("");
  series.columns[1].error[1] = std::nan("");
  series.reached = {2, 1};
  CHECK(tap_table(series, {.width = 80}) ==
        "tap  M  mean_height    fraction  sweeps\n"
        "  0  2   3.7524(87)  0.5413(21)  6125.0\n"
        "  1  1            -      0.5413  6125.0\n");
}

TEST_CASE("One realization of many is marked at every tap, and has no deviation") {
  PointSeries series = two_taps();
  series.columns.resize(1);
  series.columns[0].count = series.reached = {1, 1};
  series.columns[0].sigma = {0, 0};
  CHECK(tap_table(series, {.width = 80, .columns = Columns::all}) ==
        "tap  M  mean_height  sigma\n"
        "  0  1       3.7524      -\n"
        "  1  1       3.7524      -\n");
}

TEST_CASE("Reported taps are about three per decade, with both ends") {
  CHECK(reported_taps(0) == std::vector<std::uint64_t>{0});
  CHECK(reported_taps(1) == std::vector<std::uint64_t>{0, 1});
  CHECK(reported_taps(50) == std::vector<std::uint64_t>{0, 1, 2, 5, 10, 20, 50});
  CHECK(reported_taps(400) == std::vector<std::uint64_t>{0, 1, 2, 5, 10, 20, 50, 100, 200, 400});
}
