#include "ensemble/trend.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "synthetic_series.hpp"

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
  CHECK(pure.change == Approx(0.01).epsilon(1e-9));
  CHECK(pure.share == Approx(1).epsilon(1e-9));

  // 4 standard deviations over the range, on noise with a memory of 9.5 taps.
  const double change = 4 / std::sqrt(1 - 0.81);
  CHECK(
      trend_of({synthetic::with_ramp(synthetic::autoregressive(0.9, 4000, 11), change)}).drifts());
  std::vector<std::vector<double>> ensemble;
  for (std::uint64_t r = 0; r < 10; ++r) {
    ensemble.push_back(synthetic::with_ramp(synthetic::autoregressive(0.9, 1000, 12, r), change));
  }
  const Trend many = trend_of(ensemble);
  CHECK(many.drifts());
  CHECK(std::abs(many.change - change) < 3 * many.slope_error * 1000);
  CHECK(many.dof == 9);
}

TEST_CASE("A constant series does not drift") {
  const Trend trend = trend_of({std::vector<double>(64, 0.1), std::vector<double>(64, 0.3)});
  CHECK(trend.slope == 0);
  CHECK_FALSE(trend.drifts());
}

TEST_CASE("Steady series are flagged as often as chance does", "[statistics]") {
  const std::size_t realizations = GENERATE(1, 2, 8);
  constexpr int ensembles = 2000;
  int five_percent = 0, drifting = 0;
  for (int e = 0; e < ensembles; ++e) {
    TrendTest test;
    for (std::size_t r = 0; r < realizations; ++r) {
      test.add(synthetic::autoregressive(0.5, 512, 13 + e, r));
    }
    const Trend trend = test.result();
    five_percent += trend.tails < 0.05;
    drifting += trend.drifts();
  }
  CAPTURE(realizations, five_percent, drifting);
  // Binomial, 3 deviations; the blocks of a single series share a little memory: 1 % more.
  const double mean = 0.05 * ensembles, deviation = std::sqrt(mean * 0.95);
  CHECK(five_percent > mean - 3 * deviation);
  CHECK(five_percent < mean + 3 * deviation + (realizations == 1 ? 0.01 * ensembles : 0));
  CHECK(drifting <= 0.0027 * ensembles + 3 * std::sqrt(0.0027 * ensembles));
}
