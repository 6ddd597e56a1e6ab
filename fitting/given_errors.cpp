#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/solver/decompositions.hpp"

// Errors that a user gives with a curve, and that were computed from the measured X: as the root of
// a count, or as a share of X. A low X then has a small error and a large weight, which biases the
// fit (Neyman's chi2; Pearson's takes the errors at the law).
namespace jostle::inline fitting {

namespace {

// Errors that are computed from X follow it almost exactly. Differences of independent numbers are
// correlated, so that the test is nominal: hence the small level.
constexpr double significance = 1e-4;
constexpr Eigen::Index smooth_columns = 4;  // quadratic in the rank of t, and ln of the law
constexpr double least_exponent = 1e-3;
constexpr double least_variation = 1e-9;  // variation of ln sigma that is more than rounding
constexpr int most_rounds = 10;
constexpr double least_change = 1e-9;  // change of the law, relative to X

// ln sigma, ln of X over the law, and ln of the law, from one point to the next in t: [n - 1, 3].
// Differences leave little of errors that vary smoothly, and of a memory of the noise. Points where
// X and the law have opposite signs are left out.
Eigen::MatrixXd steps_of_logarithms(const Curve& curve, const std::vector<double>& fitted) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < curve.t.size(); ++i) {
    const double ratio = curve.x[i] / fitted[i];
    if (ratio > 0 && std::isfinite(ratio)) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return curve.t[a] < curve.t[b]; });
  const auto n = static_cast<Eigen::Index>(order.size());
  Eigen::MatrixXd logarithms(n, 3);
  for (Eigen::Index row = 0; row < n; ++row) {
    const std::size_t i = order[static_cast<std::size_t>(row)];
    logarithms.row(row) << std::log(curve.sigma[i]), std::log(curve.x[i] / fitted[i]),
        std::log(std::abs(fitted[i]));
  }
  const Eigen::Index steps = std::max<Eigen::Index>(n - 1, 0);
  return logarithms.bottomRows(steps) - logarithms.topRows(steps);
}

// The power of the measured X that given errors follow from point to point, in [0, 1]: 1/2 for the
// roots of counts, 1 for shares of X. 0 where they do not follow X: constant errors, errors that
// vary along the curve alone, or whose regression on the residuals of ln X is not significant.
// fitted: [n_points], a law close to the curve.
double noise_exponent(const Curve& curve, const std::vector<double>& fitted) {
  const Eigen::MatrixXd steps = steps_of_logarithms(curve, fitted);
  const Eigen::Index n = steps.rows(), dof = n - smooth_columns - 1;
  if (dof < 1) return 0;
  Eigen::MatrixXd basis(n, smooth_columns);
  const Eigen::VectorXd place = Eigen::VectorXd::LinSpaced(n, -1, 1);
  basis << Eigen::VectorXd::Ones(n), place, place.cwiseAbs2(), steps.col(2);
  const Eigen::MatrixXd columns = steps.leftCols(2);
  const Eigen::MatrixXd left = columns - basis * least_squares_of_columns(basis, columns);
  const double squares = left.col(1).squaredNorm(), product = left.col(0).dot(left.col(1));
  if (!(left.col(0).norm() > least_variation) || !(squares > 0)) return 0;
  const double slope = product / squares;
  const double missed = (left.col(0) - slope * left.col(1)).squaredNorm();
  const double error = std::sqrt(missed / static_cast<double>(dof) / squares);
  if (!(slope > least_exponent)) return 0;
  if (error > 0 && student_tails(slope / error, static_cast<double>(dof)) > significance) return 0;
  return std::min(slope, 1.0);
}

Curve with_errors_at(const Curve& source, const std::vector<double>& fitted, double exponent) {
  Curve curve = source;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const double ratio = fitted[i] / source.x[i];
    if (ratio > 0 && std::isfinite(ratio)) curve.sigma[i] *= std::pow(ratio, exponent);
  }
  return curve;
}

bool are_equal(const std::vector<double>& values) {
  return std::ranges::adjacent_find(values, std::not_equal_to()) == values.end();
}

// The curve with its errors at the law, by repeated fits without intervals. Fills the exponent.
Curve with_errors_at_law(const Model& model, const Curve& source, const FitOptions& options,
                         double& exponent) {
  if (source.sigma.size() != source.x.size() || source.n_realizations > 0) return source;
  if (are_equal(source.sigma)) return source;
  FitOptions quick = options;
  quick.profiles = quick.memory = quick.limits = false;
  Curve curve = source;
  std::vector<double> previous;
  for (int round = 0; round < most_rounds; ++round) {
    const auto outcome = fit_as_given(model, curve, quick);
    const Fit* found = std::get_if<Fit>(&outcome);
    if (!found) {
      exponent = 0;
      return source;
    }
    if (round == 0) exponent = noise_exponent(source, found->fitted);
    if (exponent == 0) return source;
    double change = previous.empty() ? 1 : 0;
    for (std::size_t i = 0; i < previous.size(); ++i) {
      change = std::max(change, std::abs((found->fitted[i] - previous[i]) / source.x[i]));
    }
    if (!(change > least_change)) break;
    previous = found->fitted;
    curve = with_errors_at(source, previous, exponent);
    quick.start = found->values();
    quick.multi_start = false;
  }
  return curve;
}

void remark_on_given_errors(double exponent, Fit& fit) {
  if (exponent == 0) return;
  std::ostringstream text;
  text.precision(2);
  text << "The errors given follow the scatter of X, as X^" << exponent
       << ": they are taken at the law, because low values would have too large weights.";
  fit.remarks.push_back(text.str());
}

}  // namespace

std::variant<Fit, Refusal> fit(const Model& model, const Curve& curve, const FitOptions& options) {
  const bool outermost = options.solver.budget == nullptr;
  double exponent = 0;
  auto outcome =
      outermost ? fit_as_given(model, with_errors_at_law(model, curve, options, exponent), options)
                : fit_as_given(model, curve, options);
  if (auto* found = std::get_if<Fit>(&outcome)) remark_on_given_errors(exponent, *found);
  return outcome;
}

}  // namespace jostle::inline fitting
