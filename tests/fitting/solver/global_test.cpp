#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "tests/fitting/noise.hpp"

// Minima and intervals beside scans of a law's nonlinear parameters, which no descent can mislead.
namespace jostle {
namespace {

constexpr double sigma = 2.5e-3;
constexpr double limit_95 = 3.841;  // 95 % limit of chi2 above its minimum

/// Least chi2 of X = sum of c_k columns_k, every sigma the same.
double linear_chi2(const Eigen::MatrixXd& columns, const Eigen::VectorXd& x) {
  const Eigen::VectorXd c = columns.colPivHouseholderQr().solve(x);
  return (x - columns * c).squaredNorm() / (sigma * sigma);
}

Curve curve_of(double (*law)(double), double noise_size, int every = 1) {
  Noise noise(5);
  Curve curve;
  for (int t = 1; t <= 130; t += every) {
    curve.t.push_back(t);
    curve.x.push_back(law(t) + noise_size * noise());
    curve.sigma.push_back(sigma);
  }
  return curve;
}

// A compressed law whose step comes late, and a hump that early steps fit: a trap for descents.
double late_step(double t) {
  const double hump = 9e-3 * std::exp(-std::pow((t - 22) / 6, 2));
  return 0.5723 - 0.0065 * std::exp(-std::pow(t / 117, 8)) + hump;
}

double parabola(double t) {
  return 0.5655 + 1e-4 * t + 1e-6 * t * t;
}

double saturating(double t) {
  return 0.58 - 0.04 / (1 + t / 60);
}

double two_decays(double t) {
  return 0.588 + 0.006 * std::exp(-t / 1.5) - 0.0144 * std::exp(-t / 60);
}

Fit fitted(const Model& model, const Curve& curve, const FitOptions& options = {}) {
  return std::get<Fit>(fit(model, curve, options));
}

Eigen::VectorXd values(const Curve& curve) {
  return Eigen::Map<const Eigen::VectorXd>(curve.x.data(),
                                           static_cast<Eigen::Index>(curve.x.size()));
}

/// Column k of row i is f(t_i, k).
template <class Function>
Eigen::MatrixXd columns(const Curve& curve, Eigen::Index n, Function f) {
  Eigen::MatrixXd m(static_cast<Eigen::Index>(curve.t.size()), n);
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index k = 0; k < n; ++k) m(i, k) = f(curve.t[static_cast<std::size_t>(i)], k);
  }
  return m;
}

bool holds(const Interval& interval, double value) {
  return interval.lower <= value && value <= interval.upper;
}

}  // namespace

TEST_CASE("the least squares of a late, compressed step are found behind a nearer minimum") {
  const Curve curve = curve_of(late_step, 1e-3);
  const StretchedExponential model;
  double least = 1e300;
  for (const double beta : geometric(0.1, 40, 40)) {
    for (const double tau : geometric(2, 400, 100)) {
      const Eigen::MatrixXd basis = columns(curve, 2, [&](double t, Eigen::Index k) {
        return k == 0 ? 1 : std::exp(-std::pow(t / tau, beta));
      });
      least = std::min(least, linear_chi2(basis, values(curve)));
    }
  }
  const Fit found = fitted(model, curve);
  CHECK(found.residual_sum <= least);
  CHECK(found.estimates[2].value == Approx(117).margin(8));
}

TEST_CASE("no fit with a parameter held is better than the free one") {
  for (const auto& [name, parameter] :
       {std::pair{"kww", "beta"}, std::pair{"two_exponentials", "tau1"},
        std::pair{"two_exponentials", "tau2"}, std::pair{"inverse_log", "tau"},
        std::pair{"inverse_log", "B"}, std::pair{"inverse_log_height", "B"}}) {
    const auto model = make_model(name);
    for (double (*law)(double) : {late_step, parabola, saturating}) {
      const Curve curve = curve_of(law, 1e-3, 4);
      const double least = fitted(*model, curve).residual_sum;
      for (const double value : {8.0, 500.0, 1871.0}) {
        CAPTURE(name, parameter, value, law(100));
        const FitOptions held{.fixed = {{parameter, value}}, .profiles = false};
        // Minima at infinity are approached, not reached.
        CHECK(fitted(*model, curve, held).residual_sum > least - 0.02);
      }
    }
  }
}

TEST_CASE("strengths and times that only their ratio matters of are not identifiable") {
  const Curve curve = curve_of(parabola, 0);
  const InverseLogHeight model;
  const Fit found = fitted(model, curve);
  // Along B / tau = const the curve is the same.
  for (const double strength : {1e2, 1e4, 1e8, 1e13, 1e16}) {
    CAPTURE(strength);
    const FitOptions held{.fixed = {{"B", strength}}, .profiles = false};
    CHECK(fitted(model, curve, held).residual_sum == Approx(found.residual_sum).margin(0.05));
  }
  for (const std::size_t j : {std::size_t{2}, std::size_t{3}}) {
    INFO(found.estimates[j].statement);
    CHECK_FALSE(found.estimates[j].intervals[1].closed());
    CHECK(found.estimates[j].intervals[1].upper > 1e300);
    CHECK(found.estimates[j].identifiability > Identifiability::wide);
  }
}

TEST_CASE("an interval leaves out nothing that fits: X_inf of inverse logs beside scans") {
  const InverseLog model;
  int inside = 0;
  for (double (*law)(double) : {saturating, late_step, parabola}) {
    const Curve curve = curve_of(law, 1e-3, 4);
    const Fit found = fitted(model, curve);
    const Interval& interval = found.estimates[0].intervals[1];
    for (const double x_inf : {0.5695, 0.572, 0.575, 0.58, 0.585, 0.6, 0.65, 1.0, 10.0, 260.0}) {
      double least = 1e300;
      for (const double growth : geometric(1e-4, 1e3, 140)) {
        for (const double tau : geometric(0.1, 1e5, 20)) {
          const double strength = growth / std::log1p(130 / tau);
          const Eigen::MatrixXd basis = columns(curve, 1, [&](double t, Eigen::Index) {
            return 1 / (1 + strength * std::log1p(t / tau));
          });
          least = std::min(least, linear_chi2(basis, values(curve).array() - x_inf));
        }
      }
      CAPTURE(x_inf, least, found.residual_sum, interval.lower, interval.upper, law(100));
      if (least - found.residual_sum > 0.95 * limit_95) continue;
      ++inside;
      CHECK(holds(interval, x_inf));
    }
  }
  CHECK(inside > 5);
}

TEST_CASE("times of two decays are profiled in their order, and scans agree") {
  const Curve curve = curve_of(two_decays, 5e-4);
  const Fit found = fitted(TwoExponentials(), curve);
  const Interval& interval = found.estimates[4].intervals[1];
  const auto rise = [&](double slow) {
    double least = 1e300;
    for (const double fast : geometric(0.1, 0.9999 * slow, 200)) {
      const Eigen::MatrixXd basis = columns(curve, 3, [&](double t, Eigen::Index k) {
        return k == 0 ? 1 : std::exp(-t / (k == 1 ? fast : slow));
      });
      least = std::min(least, linear_chi2(basis, values(curve)));
    }
    return least - found.residual_sum;
  };
  CAPTURE(interval.lower, interval.upper, found.estimates[4].value);
  REQUIRE(std::isfinite(interval.lower));
  CHECK(rise(interval.lower) == Approx(limit_95).epsilon(0.01));
  CHECK(rise(0.97 * interval.lower) > limit_95);
  if (std::isfinite(interval.upper)) {
    CHECK(rise(interval.upper) == Approx(limit_95).epsilon(0.01));
  }
}

TEST_CASE("a fixed time that breaks the order of two decays is remarked on") {
  const Curve curve = curve_of(two_decays, 5e-4);
  const auto remarked = [](const Fit& fit) {
    return std::any_of(fit.remarks.begin(), fit.remarks.end(), [](const std::string& remark) {
      return remark.find("from the order of this law") != std::string::npos;
    });
  };
  CHECK(remarked(fitted(TwoExponentials(), curve, {.fixed = {{"tau2", 1}}})));
  CHECK_FALSE(remarked(fitted(TwoExponentials(), curve, {.fixed = {{"tau1", 1}}})));
}

}  // namespace jostle
