#include "ensemble/statistics/trend.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "ensemble/moments.hpp"
#include "tests/ensemble/synthetic_series.hpp"

using namespace jostle;

namespace {

Trend trend_of(const std::vector<std::vector<double>>& ensemble) {
  TrendTest test;
  for (const auto& series : ensemble) test.add(series);
  return test.result();
}

}  // namespace

TEST_CASE("A line is fitted by least squares") {
  const Line line = fit_line(std::vector<double>{1, 3, 2, 6});
  CHECK(line.center == 1.5);
  CHECK(line.middle == 3);
  CHECK(line.slope == Approx(1.4).epsilon(1e-14));
  CHECK(fit_line(std::vector<double>{2}).slope == 0);
}

TEST_CASE("A linear ramp is flagged as drift, whatever rides on it") {
  const std::vector<double> ramp = synthetic::with_ramp(std::vector<double>(1000, 0.6), 0.01);
  const Trend pure = trend_of({ramp});
  CHECK(pure.drifts());
  CHECK(pure.line.value == Approx(0.01).epsilon(1e-9));
  CHECK(pure.halves.value == Approx(0.005).epsilon(1e-9));
  CHECK(pure.share == Approx(1).epsilon(1e-9));

  // 4 standard deviations over the range, on noise with a memory of 9.5 taps.
  const double change = 4 / std::sqrt(1 - 0.81);
  CHECK(
      trend_of({synthetic::with_ramp(synthetic::autoregressive(0.9, 4000, 11), change)}).drifts());
  std::vector<std::vector<double>> ensemble;
  for (std::uint64_t r = 0; r < 10; ++r) {
    ensemble.push_back(synthetic::with_ramp(synthetic::autoregressive(0.9, 1000, 12, r), change));
  }
  const Trend trend = trend_of(ensemble);
  CHECK(trend.drifts());
  CHECK(std::abs(trend.line.value - change) < 3 * trend.line.scatter_error.error);
  CHECK(std::abs(trend.line.value - change) < 3 * trend.line.series_error.error);
  CHECK(trend.line.scatter_error.dof == 9);
  CHECK(trend.line.series_error.dof == 30);
  CHECK(trend.tests == 4);
}

TEST_CASE("A series that changes without scatter is not constant, and every change is detectable") {
  std::vector<double> ramp(64);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<double>(i);
  const Trend trend = trend_of({ramp, ramp});
  CHECK_FALSE(trend.is_constant());
  CHECK(trend.drifts());
  CHECK(trend.detectable_in_sigma() == 0);
  CHECK(trend.power().starts_with(
      "the test finds drifts of 0 or more over the taps (80 % power), 0 times the scatter"));
}

TEST_CASE("Realizations that change alike prove no drift by their scatter") {
  std::vector<double> step(64, 1);  // an integer observable, which changes at one tap
  std::fill(step.begin() + 40, step.end(), 2);
  const Trend trend = trend_of({step, step});
  CHECK(trend.line.scatter_error.error == 0);
  CHECK_FALSE(trend.line.series_error.known());
  CHECK(trend.tests == 0);
  CHECK_FALSE(trend.drifts());
  CHECK(trend.statement() == "no test of a drift is possible");
}

TEST_CASE("A constant series does not drift") {
  const Trend trend = trend_of({std::vector<double>(64, 0.1), std::vector<double>(64, 0.3)});
  CHECK(trend.line.value == 0);
  CHECK(trend.detectable == 0);
  CHECK_FALSE(trend.drifts());
  CHECK(trend.is_constant());
  CHECK(trend.statement() == "no drift: the series is constant");
  CHECK(trend_of({std::vector<double>(32, 0.1)}).statement() == trend.statement());
}

TEST_CASE("The errors within series are the scatter of slopes and halves", "[statistics]") {
  // Blocks of 8 taps leave 7 of 103 over.
  const auto [rho, n_taps, ensembles] =
      GENERATE(std::tuple(0.0, std::size_t{1000}, std::size_t{400}),
               std::tuple(0.9, std::size_t{1000}, std::size_t{400}),
               std::tuple(0.3, std::size_t{103}, std::size_t{4000}));
  constexpr std::size_t realizations = 2;
  Moments lines, halves;
  Moments line_variances, halves_variances;  // where errors within series are not doubted
  for (std::size_t e = 0; e < ensembles; ++e) {
    TrendTest test;
    for (std::size_t r = 0; r < realizations; ++r) {
      test.add(synthetic::autoregressive(rho, n_taps, 500 + e, r));
    }
    const Trend trend = test.result();
    lines.add(trend.line.value);
    halves.add(trend.halves.value);
    if (!trend.line.series_error.known()) continue;
    line_variances.add(std::pow(trend.line.series_error.error, 2));
    halves_variances.add(std::pow(trend.halves.series_error.error, 2));
  }
  // 3 errors of a deviation, and 5 % for what blocks share.
  const double tolerance = 3 / std::sqrt(2.0 * static_cast<double>(ensembles)) + 0.05;
  CAPTURE(rho, n_taps);
  CHECK(std::sqrt(line_variances.mean()) == Approx(lines.sigma()).epsilon(tolerance));
  CHECK(std::sqrt(halves_variances.mean()) == Approx(halves.sigma()).epsilon(tolerance));
}

TEST_CASE("A drift does not inflate the errors within series") {
  std::vector<std::vector<double>> steady, drifting;
  for (std::uint64_t r = 0; r < 3; ++r) {
    steady.push_back(synthetic::autoregressive(0.9, 2000, 14, r));
    drifting.push_back(synthetic::with_ramp(steady.back(), 50));
  }
  CHECK(trend_of(drifting).line.series_error.error ==
        Approx(trend_of(steady).line.series_error.error).epsilon(1e-9));
}

TEST_CASE("Two realizations find drifts beyond their scatter, and report their power") {
  // 7 errors, as their memory has them: over two realizations t of one degree of freedom needs 51.
  std::vector<std::vector<double>> ensemble;
  for (std::uint64_t r = 0; r < 2; ++r)
    ensemble.push_back(synthetic::autoregressive(0.5, 1000, 15, r));
  const Trend steady = trend_of(ensemble);
  CHECK_FALSE(steady.drifts());
  CHECK(steady.statement().starts_with("no drift found (p = "));
  for (auto& series : ensemble)
    series = synthetic::with_ramp(series, 7 * steady.line.series_error.error);
  const Trend drifting = trend_of(ensemble);
  CHECK(drifting.drifts());
  CHECK(drifting.decisive.ends_with("within series"));
  CHECK(drifting.statement().starts_with("it drifts: "));
  // One series of a few times its memory has no test at all.
  const Trend short_one = trend_of({synthetic::autoregressive(0.99, 300, 16)});
  CHECK(short_one.tests == 0);
  CHECK(std::isinf(short_one.detectable));
  CHECK_FALSE(short_one.drifts());
}
