#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

#include "ensemble/analysis/analyses.hpp"
#include "ensemble/moments.hpp"
#include "fitting/intervals/distributions.hpp"
#include "tests/ensemble/synthetic_series.hpp"

// Calibration of the slope of a spectrum, for series that are AR(1) and series that are not.

using namespace jostle;

namespace {

double number(const Table& table, const std::string& name) {
  const auto found = std::ranges::find(table.quantities, name, &Quantity::name);
  REQUIRE(found != table.quantities.end());
  return std::get<std::vector<double>>(found->values).at(0);
}

Table analysed(const std::vector<std::vector<double>>& ensemble, const SpectrumSettings& settings) {
  const std::uint64_t n_taps = ensemble.front().size();
  SpectrumAnalysis analysis({.observable = "x", .units = "1", .first_tap = 1, .last_tap = n_taps},
                            settings);
  for (const auto& series : ensemble) analysis.add(series);
  return analysis.table();
}

void check(const std::vector<std::size_t>& all_realizations, std::size_t ensembles,
           std::size_t n_taps = 2000) {
  fmt::print("{:>3} {:>5} {:>5} | {:>7} {:>9} | {:>13} {:>11}\n", "M", "taps", "rho", "slope",
             "AR(1)'s", "called other", "1/f, other");
  for (const std::size_t realizations : all_realizations) {
    for (const double rho : {-0.9, -0.5, 0.5, 0.9, 0.99}) {
      Moments slopes, expected;
      double second = 0, found = 0;
      for (std::size_t e = 0; e < ensembles; ++e) {
        std::vector<std::vector<double>> ensemble, mixture;
        for (std::size_t r = 0; r < realizations; ++r) {
          ensemble.push_back(synthetic::autoregressive(rho, n_taps, 20261125 + e, r));
          // Memories from 1 to 100 taps in equal shares: about 1/f.
          mixture.emplace_back(n_taps, 0.0);
          for (int k = 0; k < 5; ++k) {
            const double time = std::pow(10.0, 0.5 * k), own = (2 * time - 1) / (2 * time + 1);
            const auto part = synthetic::autoregressive(own, n_taps, 20261126 + e, 100 * r + k);
            for (std::size_t t = 0; t < n_taps; ++t) {
              mixture.back()[t] += part[t] * std::sqrt(1 - own * own);
            }
          }
        }
        const Table table = analysed(ensemble, {});
        slopes.add(number(table, "slope"));
        expected.add(number(table, "ar1_slope"));
        second += number(table, "ar1_slope_p") < 0.05;
        found += number(analysed(mixture, {}), "ar1_slope_p") < 0.05;
      }
      const double share = second / static_cast<double>(ensembles);
      fmt::print("{:>3} {:>5} {:>5} | {:>7.3f} {:>9.3f} | {:>12.1f}% {:>10.1f}%\n", realizations,
                 n_taps, rho, slopes.mean(), expected.mean(), 100 * share,
                 100 * found / static_cast<double>(ensembles));
      CAPTURE(realizations, rho);
      CHECK(share <= 0.05 + 3 * std::sqrt(0.05 * 0.95 / static_cast<double>(ensembles)));
      CHECK(std::abs(slopes.mean() - expected.mean()) < 0.05);
    }
  }
  std::fflush(stdout);
}

}  // namespace

TEST_CASE("A slope that memory alone gives is called other at the level of the test",
          "[statistics]") {
  check({3}, 100);
}

TEST_CASE(
    "A slope that the memory of one realization gives is called other at the level of the test",
    "[slow]") {
  check({1}, 100);
}

TEST_CASE("Slopes of AR(1) ensembles differ from others at the stated rate", "[nightly]") {
  check({1, 2, 3, 4, 10, 20}, 400);
  // Short series, whose slopes are biased, in ensembles that would see it.
  check({3, 10, 20, 50}, 200, 1000);
}

namespace {

/// White noise of deviation 1 and AR(1) of deviation `slow` and a time of 20 taps, which together
/// are no AR(1).
std::vector<double> two_memories(double slow, std::size_t n_taps, std::uint64_t seed,
                                 std::uint64_t realization) {
  constexpr double rho = 39.0 / 41;
  std::vector<double> series = synthetic::autoregressive(0, n_taps, seed, 2 * realization);
  const std::vector<double> slower =
      synthetic::autoregressive(rho, n_taps, seed, 2 * realization + 1);
  for (std::size_t t = 0; t < n_taps; ++t) series[t] += slow * slower[t] * std::sqrt(1 - rho * rho);
  return series;
}

/// How many ensembles find the true difference of their slopes, of those whose detectable
/// difference is at most that.
void check_detectable(const std::vector<std::size_t>& all_realizations, std::size_t n_taps,
                      std::size_t ensembles) {
  for (const std::size_t realizations : all_realizations) {
    for (const double slow : {0.3, 0.4, 0.6, 1.0}) {
      Moments difference;
      std::vector<std::pair<double, bool>> tests;  // detectable difference, is one found
      for (std::size_t e = 0; e < ensembles; ++e) {
        std::vector<std::vector<double>> ensemble;
        for (std::size_t r = 0; r < realizations; ++r)
          ensemble.push_back(two_memories(slow, n_taps, 20261130 + e, r));
        const Table table = analysed(ensemble, {});
        difference.add(number(table, "slope") - number(table, "ar1_slope"));
        tests.emplace_back(number(table, "ar1_slope_detectable"),
                           number(table, "ar1_slope_p") < 0.05);
      }
      double able = 0, found = 0;
      for (const auto& [detectable, is_found] : tests) {
        if (!(detectable <= std::abs(difference.mean()))) continue;
        ++able;
        found += is_found;
      }
      if (able < 20) continue;
      fmt::print(
          "M {:>2}, {:>4} taps, slow part {}: difference {:.2f}, able {:>3}, found {:.1f} %\n",
          realizations, n_taps, slow, difference.mean(), able, 100 * found / able);
      CAPTURE(realizations, n_taps, slow);
      // The nominal power is 0.8; for three realizations of 200 taps 0.65 are found.
      CHECK(found / able >= 0.6 - 3 * std::sqrt(0.6 * 0.4 / able));
    }
  }
  std::fflush(stdout);
}

}  // namespace

TEST_CASE("Differences of slopes that are detectable are found", "[statistics]") {
  check_detectable({2, 3, 10}, 200, 100);
}

TEST_CASE("Differences of slopes are found at the stated rate, for every ensemble and length",
          "[nightly]") {
  for (const std::size_t n_taps : {100, 200, 1000})
    check_detectable({2, 3, 4, 5, 10, 20}, n_taps, 400);
}

TEST_CASE("The expected slope of AR(1) is the mean of measured ones, as steep as a paper's",
          "[statistics]") {
  // The pipeline of the reduced fig. 3: 1500 taps, two realizations, linear detrending.
  const SpectrumSettings settings{.detrending = Detrending::linear};
  for (const double time : {100.0, 200.0}) {
    const double rho = (2 * time - 1) / (2 * time + 1);
    SpectrumAverage average(1500, spectrum_options(settings, 1500));
    for (std::uint64_t r = 0; r < 100; ++r) {
      average.add(synthetic::autoregressive(rho, 1500, 20261127, r));
    }
    const LogLogSlope slope = average.slope({});
    const double expected = average.autoregressive_slope(time, {});
    fmt::print("AR(1) of {} taps in the band of fig. 3: slope {:.3f} +- {:.3f}, expected {:.3f}\n",
               time, slope.slope, slope.error, expected);
    CHECK(std::abs(slope.slope - expected) < 3 * slope.error + 0.01);
    CHECK(expected < -1.5);
  }
}

namespace {

struct FalseAlarms {
  double share = 0;  // ensembles whose slope is called other
  Moments slopes;    // measured
};

/// Ensembles of AR(1) of `taps` taps, analysed with segments of so many taps.
FalseAlarms false_alarms(std::size_t segment, std::size_t taps, double time,
                         std::size_t realizations, std::size_t ensembles,
                         Taper window = Taper::hann) {
  const double rho = (2 * time - 1) / (2 * time + 1);
  FalseAlarms found;
  double second = 0;
  for (std::size_t e = 0; e < ensembles; ++e) {
    std::vector<std::vector<double>> ensemble;
    for (std::size_t r = 0; r < realizations; ++r)
      ensemble.push_back(synthetic::autoregressive(rho, taps, 20261129 + e, r));
    const Table table = analysed(ensemble, {.segment = segment, .window = window});
    found.slopes.add(number(table, "slope"));
    second += number(table, "ar1_slope_p") < 0.05;
  }
  found.share = second / static_cast<double>(ensembles);
  fmt::print(
      "segment {:>3}, {:>4} taps, tau {:>4}, M {:>2}: slope {:>7.3f} +- {:.3f}, called other "
      "{:.1f} %\n",
      segment, taps, time, realizations, found.slopes.mean(), found.slopes.standard_error(),
      100 * found.share);
  std::fflush(stdout);
  return found;
}

void check_segments(std::size_t ensembles, const std::vector<double>& times) {
  for (const std::size_t segment : {16, 36, 64}) {
    for (const std::size_t realizations : {3, 6}) {
      for (const double time : times) {
        const FalseAlarms found = false_alarms(segment, 4 * segment, time, realizations, ensembles);
        CAPTURE(segment, realizations, time);
        CHECK(found.share <= 0.05 + 3 * std::sqrt(0.05 * 0.95 / static_cast<double>(ensembles)));
        if (time == 0.5) CHECK(std::abs(found.slopes.mean()) < 3 * found.slopes.standard_error());
      }
    }
  }
}

}  // namespace

TEST_CASE("White noise has slope 0 in segments of any length, and is not called other",
          "[statistics]") {
  check_segments(400, {0.5});
}

TEST_CASE("AR(1) in one segment is called other at the level of the test", "[statistics]") {
  // The segment is as long as the taps. With so many realizations a small bias of the memory would
  // show.
  constexpr std::size_t ensembles = 60, realizations = 20;
  for (const Taper window : {Taper::hann, Taper::boxcar}) {
    for (const auto& [taps, time] : {std::pair{100, 9.5}, std::pair{600, 60.0}}) {
      const auto n = static_cast<std::size_t>(taps);
      const FalseAlarms found = false_alarms(n, n, time, realizations, ensembles, window);
      CAPTURE(window, taps, time);
      CHECK(found.share <= 0.05 + 3 * std::sqrt(0.05 * 0.95 / ensembles));
    }
  }
}

namespace {

/// Shares of slopes of AR(1) within their 68 and 95 % intervals about the mean slope.
void check_coverage_of_slopes(std::size_t realizations, const SpectrumSettings& settings,
                              double rho, std::size_t ensembles) {
  std::vector<double> slopes;
  std::vector<ErrorOf> errors;
  Moments all;
  for (std::size_t e = 0; e < ensembles; ++e) {
    std::vector<std::vector<double>> ensemble;
    for (std::size_t r = 0; r < realizations; ++r)
      ensemble.push_back(synthetic::autoregressive(rho, 500, 20261130 + e, r));
    const Table table = analysed(ensemble, settings);
    slopes.push_back(number(table, "slope"));
    errors.push_back({number(table, "slope_error"), number(table, "slope_dof")});
    all.add(slopes.back());
  }
  const auto share_within = [&](double level) {
    double held = 0;
    for (std::size_t e = 0; e < ensembles; ++e) {
      held += std::abs(slopes[e] - all.mean()) <= errors[e].error * two_sided(level, errors[e].dof);
    }
    return held / static_cast<double>(ensembles);
  };
  const double at_68 = share_within(interval_levels[0]), at_95 = share_within(interval_levels[1]);
  fmt::print("M {}, rho {:>4}, {}, segment {:>3}: slope within 68 %: {:.1f} %, 95 %: {:.1f} %\n",
             realizations, rho, settings.window == Taper::hann ? "hann" : "boxcar",
             settings.segment.value_or(0), 100 * at_68, 100 * at_95);
  std::fflush(stdout);
  const auto n = static_cast<double>(ensembles);
  CAPTURE(realizations, rho);
  CHECK(at_68 >= 0.6 - 3 * std::sqrt(0.6 * 0.4 / n));
  CHECK(at_68 <= 0.8 + 3 * std::sqrt(0.8 * 0.2 / n));
  CHECK(at_95 >= 0.9 - 3 * std::sqrt(0.9 * 0.1 / n));
}

}  // namespace

TEST_CASE("Slopes of one and two realizations have intervals that hold them", "[statistics]") {
  for (const std::size_t realizations : {1, 2}) {
    for (const double rho : {0.0, 0.9}) {
      check_coverage_of_slopes(realizations, {}, rho, 300);
      check_coverage_of_slopes(realizations, {.segment = 500}, rho, 300);
    }
  }
  check_coverage_of_slopes(2, {.window = Taper::boxcar}, 0.9, 300);
}
