#include "fitting/intervals/fit_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/solver/decompositions.hpp"

namespace jostle::inline fitting {

namespace {

// Sum of squares about the weighted mean, of X or ln X.
double total_sum(const Curve& curve, bool logarithmic) {
  double weights = 0, mean = 0;
  const auto weight = [&](std::size_t i) {
    const double inverse =
        curve.sigma.empty() ? 1 : (logarithmic ? curve.x[i] : 1) / curve.sigma[i];
    return inverse * inverse;
  };
  const auto target = [&](std::size_t i) {
    return logarithmic ? std::log(curve.x[i]) : curve.x[i];
  };
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    weights += weight(i);
    mean += weight(i) / weights * (target(i) - mean);
  }
  double sum = 0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    sum += weight(i) * (target(i) - mean) * (target(i) - mean);
  }
  return sum;
}

// Weights are 1 over squared errors, of X or ln X. Points that have none weigh alike.
double weighted_size(const Curve& curve, bool logarithmic) {
  if (curve.sigma.empty()) return static_cast<double>(curve.t.size());
  const auto weight = [&](std::size_t i) {
    const double inverse = (logarithmic ? curve.x[i] : 1) / curve.sigma[i];
    return inverse * inverse;
  };
  double largest = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < curve.t.size(); ++i) largest = std::max(largest, weight(i));
  for (std::size_t i = 0; i < curve.t.size(); ++i) {
    const double share = weight(i) / largest;
    sum += share;
    squares += share * share;
  }
  return sum * sum / squares;
}

}  // namespace

InverseNormal inverse_normal(const Eigen::MatrixXd& jacobian) {
  const Eigen::Index n = jacobian.cols();
  Eigen::VectorXd norms = jacobian.colwise().norm().transpose();
  for (double& norm : norms) norm = norm > 0 ? norm : 1;
  const Eigen::MatrixXd scaled = jacobian * norms.cwiseInverse().asDiagonal();
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(n, n);
  triangle.topRows(std::min(n, scaled.rows())) = upper_triangle(scaled);
  const auto [values, vectors] = singular_values(triangle);
  const double largest = values[0] > 0 ? values[0] : 1;
  const Eigen::VectorXd singular = values.cwiseMax(1e-17 * largest);
  const Eigen::MatrixXd root =
      norms.cwiseInverse().asDiagonal() * vectors * singular.cwiseInverse().asDiagonal();
  return {root * root.transpose(), std::pow(largest / singular[n - 1], 2)};
}

void fill_statistics(const Curve& curve, const Eigen::VectorXd& weighted, Fit& fit) {
  const bool logarithmic = fit.logarithmic;
  fit.residual_sum = weighted.squaredNorm();
  fit.reduced_chi2 = fit.dof > 0 ? fit.residual_sum / static_cast<double>(fit.dof)
                                 : std::numeric_limits<double>::infinity();
  fit.r2 = 1 - fit.residual_sum / total_sum(curve, logarithmic);
  std::vector<double> sorted;
  for (const std::size_t i : in_order_of_t(curve.t))
    sorted.push_back(weighted[static_cast<Eigen::Index>(i)]);
  fit.runs = runs_test(sorted);
  fit.effective_size = effective_sample_size(sorted);
  fit.weighted_size = weighted_size(curve, logarithmic);
  count_effective_points(fit);
}

void count_effective_points(Fit& fit) {
  fit.error_factor = std::sqrt(static_cast<double>(fit.n_points) / fit.effective_size);
}

}  // namespace jostle::inline fitting
