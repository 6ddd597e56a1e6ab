#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "fitting/fit.hpp"
#include "fitting/intervals/diagnostics.hpp"
#include "fitting/intervals/distributions.hpp"
#include "tests/fitting/line_law.hpp"
#include "tests/fitting/noise.hpp"

namespace jostle {
namespace {

// y = 1, 3, 2, 5 at t = 0, 1, 2, 3 by hand.
const Curve by_hand = {{0, 1, 2, 3}, {1, 3, 2, 5}, {}};

}  // namespace

TEST_CASE("quantiles agree with tables") {
  CHECK(normal_two_sided(0.95) == Approx(1.959963984540054).epsilon(1e-12));
  CHECK(normal_two_sided(interval_levels[0]) == Approx(1.0).epsilon(1e-12));
  CHECK(student_two_sided(0.95, 1) == Approx(12.706204736174698).epsilon(1e-11));
  CHECK(student_two_sided(0.95, 4) == Approx(2.7764451051977987).epsilon(1e-11));
  CHECK(student_two_sided(0.95, 30) == Approx(2.0422724563012373).epsilon(1e-11));
  CHECK(student_two_sided(0.95, 1e6) == Approx(1.959966356).epsilon(1e-8));
  CHECK(student_tails(2.0422724563012373, 30) == Approx(0.05).epsilon(1e-11));
  CHECK(fisher_tail(2.0422724563012373 * 2.0422724563012373, 1, 30) == Approx(0.05).epsilon(1e-11));
  CHECK(fisher_tail(3.3258345304130112, 5, 10) == Approx(0.05).epsilon(1e-9));
  CHECK(chi_squared_tail(3.841458820694124, 1) == Approx(0.05).epsilon(1e-11));
  CHECK(chi_squared_tail(18.307038053275146, 10) == Approx(0.05).epsilon(1e-11));
  CHECK(chi_squared_tail(3.9402991361190605, 10) == Approx(0.95).epsilon(1e-11));
  CHECK(chi_squared_tail(0, 3) == 1);
  CHECK(normal_tails(-1) == Approx(0.31731050786291415).epsilon(1e-13));
}

TEST_CASE("the report of a straight line is that of the textbook") {
  const Fit line = std::get<Fit>(fit(Line(), by_hand));
  // b = S_ty / S_tt = 5.5 / 5, a = 2.75 - 1.1 * 1.5; residuals -0.1, 0.8, -1.3, 0.6.
  CHECK(line.estimates[1].value == Approx(1.1).epsilon(1e-9));
  CHECK(line.estimates[0].value == Approx(1.1).epsilon(1e-9));
  CHECK(line.residual_sum == Approx(2.7).epsilon(1e-12));
  CHECK(line.dof == 2);
  CHECK(line.reduced_chi2 == Approx(1.35).epsilon(1e-12));
  CHECK(line.r2 == Approx(1 - 2.7 / 8.75).epsilon(1e-12));
  CHECK(line.estimates[1].standard_error == Approx(std::sqrt(1.35 / 5)).epsilon(1e-10));
  CHECK(line.estimates[0].standard_error ==
        Approx(std::sqrt(1.35 * (0.25 + 2.25 / 5))).epsilon(1e-10));
  CHECK(line.correlation(0, 1) == Approx(-1.5 / std::sqrt(3.5)).epsilon(1e-10));
  // Linear: profiles are parabolas, and intervals are Student's.
  const double reach = student_two_sided(0.95, 2) * std::sqrt(1.35 / 5);
  CHECK(line.estimates[1].intervals[1].lower == Approx(1.1 - reach).epsilon(1e-5));
  CHECK(line.estimates[1].intervals[1].upper == Approx(1.1 + reach).epsilon(1e-5));
}

TEST_CASE("given errors are absolute") {
  Curve curve = by_hand;
  curve.sigma = {0.5, 0.5, 0.5, 0.5};
  const Fit line = std::get<Fit>(fit(Line(), curve));
  CHECK(line.residual_sum == Approx(2.7 / 0.25).epsilon(1e-12));
  CHECK(line.estimates[1].standard_error == Approx(0.5 / std::sqrt(5.0)).epsilon(1e-10));
  const double reach = normal_two_sided(0.95) * 0.5 / std::sqrt(5.0);
  CHECK(line.estimates[1].intervals[1].upper == Approx(1.1 + reach).epsilon(1e-5));
  // A point with a huge error does not count.
  curve.sigma[3] = 1e9;
  const Fit bare_fit = std::get<Fit>(fit(Line(), curve));
  CHECK(bare_fit.estimates[1].value == Approx(0.5).epsilon(1e-9));
}

TEST_CASE("a fixed parameter keeps its value and has no error") {
  const Fit line = std::get<Fit>(fit(Line(), by_hand, {.fixed = {{"a", 0}}}));
  CHECK(line.estimates[0].value == 0);
  CHECK(line.estimates[0].standard_error == 0);
  CHECK(line.estimates[0].identifiability == Identifiability::fixed);
  CHECK(line.estimates[1].value == Approx(22.0 / 14).epsilon(1e-12));
  CHECK(line.covariance(0, 1) == 0);
  CHECK(line.dof == 3);
}

TEST_CASE("runs are counted, and too few of them noticed") {
  const RunsTest test = runs_test({1, 2, -1, -2, -3, 4, 5, -6});
  CHECK(test.runs == 4);
  CHECK(test.expected == Approx(5));
  CHECK(test.z == Approx(-1 / std::sqrt(4 * 3 / 7.0)));
  std::vector<double> slow;
  for (int i = 0; i < 200; ++i) slow.push_back(std::sin(0.1 * i));
  CHECK(runs_test(slow).p < 1e-6);
  CHECK(runs_test({1, 1, 1}).p == 1);
  CHECK(runs_test({}).p == 1);
}

TEST_CASE("residuals that are correlated are worth fewer points", "[statistics]") {
  // AR(1) with rho = 0.9: n_eff / n = (1 - rho) / (1 + rho) = 1 / 19.
  Noise noise(7);
  double value = 0, mean_factor = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<double> series;
    for (int i = 0; i < 4000; ++i) {
      value = 0.9 * value + noise();
      series.push_back(value);
    }
    mean_factor += 4000 / effective_sample_size(series) / 20;
  }
  // Its estimate scatters by about 15 % a series, 4 % over 20 of them.
  CHECK(mean_factor == Approx(19).margin(4 * 0.04 * 19));
  std::vector<double> independent;
  for (int i = 0; i < 4000; ++i) independent.push_back(noise());
  CHECK(effective_sample_size(independent) > 3000);
  CHECK(effective_sample_size({0, 0, 0, 0, 0}) == 5);
}

}  // namespace jostle
