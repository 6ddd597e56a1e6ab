#include "fitting/intervals/fit_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/intervals/dependence.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/intervals/fit_statistics.hpp"
#include "fitting/numbers.hpp"
#include "fitting/solver/curve_residuals.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double least_error_dof = 10;  // memory of a single curve

// Deviations of every realization from the mean, in errors of the mean: [n_points, n_realizations].
Eigen::MatrixXd deviations(const Curve& curve) {
  const std::size_t m = curve.n_realizations;
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(curve.x.size()), static_cast<Eigen::Index>(m));
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    for (std::size_t r = 0; r < m; ++r) {
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(r)) =
          (curve.values[i * m + r] - curve.x[i]) / curve.sigma[i];
    }
  }
  return matrix;
}

DependentErrors errors_of_realizations(const Curve& curve, const LinearProblem& problem) {
  Eigen::MatrixXd jacobian = problem.jacobian, scatter = deviations(curve);
  const double weight = level_weight(problem.weights, jacobian, scatter);
  weigh_level(problem.weights, weight, jacobian);
  weigh_level(problem.weights, weight, scatter);
  DependentErrors errors = clustered_errors(jacobian, scatter, problem.curvature);
  errors.level_weight = weight;
  return errors;
}

DependentErrors of_memory(const Curve& curve, const LinearProblem& problem, Fit& fit) {
  const auto order = in_order_of_t(curve.t);
  std::vector<double> t(curve.t);
  std::sort(t.begin(), t.end());
  // Eigen 3.4 and 5 have different names for all columns.
  const auto columns = Eigen::seqN(0, problem.jacobian.cols());
  const Eigen::MatrixXd jacobian = problem.jacobian(order, columns);
  const Eigen::VectorXd residuals = problem.residuals(order);
  MemoryErrors errors = memory_errors(t, jacobian, residuals, fit.sigma_given);
  fit.memory = errors.memory;
  fit.effective_size = std::clamp(errors.memory.effective_size, 1.0, 1.0 * t.size());
  count_effective_points(fit);
  return errors;
}

DependentErrors of_independent_points(const LinearProblem& problem, Fit& fit) {
  fit.effective_size = static_cast<double>(fit.n_points);
  count_effective_points(fit);
  const Eigen::Index n = problem.jacobian.cols();
  DependentErrors errors;
  errors.covariance =
      inverse_normal(problem.jacobian).matrix * (fit.sigma_given ? 1 : fit.reduced_chi2);
  errors.inflation = Eigen::VectorXd::Ones(n);
  errors.dof = fit.sigma_given ? infinite : static_cast<double>(fit.dof);
  return errors;
}

// By central differences of J^T r with these residuals, which are those of the minimum.
Eigen::MatrixXd curvature_along(const CurveResiduals& residuals, const Eigen::VectorXd& minimum,
                                const Eigen::VectorXd& missed, const Eigen::MatrixXd& directions) {
  constexpr double step = 1e-2,
                   farthest =
                       1e-3;  // step along a direction; change of a variable, absolute or relative
  const Eigen::ArrayXd room = farthest * minimum.array().abs().max(1);
  Eigen::VectorXd r(residuals.n_residuals());
  Eigen::MatrixXd jacobian(residuals.n_residuals(), residuals.n_variables());
  const auto gradient = [&](const Eigen::VectorXd& u) -> Eigen::VectorXd {
    residuals.values_and_jacobian(u, r, jacobian);
    return jacobian.transpose() * missed;
  };
  Eigen::MatrixXd hessian(directions.cols(), directions.cols());
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    const Eigen::VectorXd direction = directions.col(k);
    const double share = (direction.array().abs() / room).maxCoeff();
    const double length = std::min(step, 1 / std::max(share, 1e-300));
    const Eigen::VectorXd change = length * direction;
    hessian.col(k) = directions.transpose() *
                     (gradient(minimum + change) - gradient(minimum - change)) / (2 * length);
  }
  return 0.5 * (hessian + hessian.transpose());
}

}  // namespace

LinearProblem linear_problem(const Model& model, const Curve& curve, const ParameterValues& values,
                             const std::vector<bool>& free) {
  const CurveResiduals residuals(model, curve, values, free);
  const Eigen::VectorXd u = residuals.to_variables(values);
  LinearProblem problem;
  problem.residuals.resize(residuals.n_residuals());
  problem.jacobian.resize(residuals.n_residuals(), residuals.n_variables());
  residuals.values_and_jacobian(u, problem.residuals, problem.jacobian);
  problem.slopes = residuals.slopes(u);
  problem.weights = residuals.weights();
  // Each parameter takes two Jacobians, and so many parameters are rare.
  constexpr Eigen::Index most_variables = 8;
  if (residuals.n_variables() <= most_variables) {
    problem.curvature = [=, &model, &curve,
                         missed = problem.residuals](const Eigen::MatrixXd& directions) {
      return curvature_along(CurveResiduals(model, curve, values, free), u, missed, directions);
    };
  }
  return problem;
}

void fill_covariance(const LinearProblem& problem, const std::vector<bool>& free, Fit& fit) {
  const auto n = static_cast<Eigen::Index>(free.size());
  fit.covariance = Eigen::MatrixXd::Zero(n, n);
  fit.correlation = Eigen::MatrixXd::Zero(n, n);
  fit.variance_inflation.assign(free.size(), 0);
  if (fit.n_free == 0) return;
  const InverseNormal inverse = inverse_normal(problem.jacobian);
  fit.condition = inverse.condition;
  const Eigen::VectorXd& slopes = problem.slopes;
  const double variance = fit.sigma_given ? 1 : fit.reduced_chi2;
  Eigen::Index a = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!free[static_cast<std::size_t>(i)]) continue;
    fit.variance_inflation[static_cast<std::size_t>(i)] =
        inverse.matrix(a, a) * problem.jacobian.col(a).squaredNorm();
    Eigen::Index b = 0;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (!free[static_cast<std::size_t>(j)]) continue;
      const double entry = inverse.matrix(a, b);
      const double scale = std::sqrt(inverse.matrix(a, a)) * std::sqrt(inverse.matrix(b, b));
      const double sign = slopes[a] * slopes[b] < 0 ? -1 : 1;
      fit.covariance(i, j) = entry * slopes[a] * slopes[b] * variance;
      if (std::isnan(fit.covariance(i, j))) fit.covariance(i, j) = 0;  // 0 times infinity
      fit.correlation(i, j) = i == j ? 1 : std::clamp(sign * entry / scale, -1.0, 1.0);
      ++b;
    }
    ++a;
  }
}

DependentErrors dependent_errors(const Curve& curve, const LinearProblem& problem, bool memory,
                                 Fit& fit) {
  const bool scattered = curve.n_realizations > 0 && !curve.sigma.empty();
  fit.n_realizations = scattered ? curve.n_realizations : 0;
  DependentErrors errors;
  if (fit.n_free == 0) {
    errors.covariance.resize(0, 0);
  } else if (scattered) {
    errors = errors_of_realizations(curve, problem);
    if (!curve.present.empty()) errors.dof = gapped_dof(problem.jacobian, curve);
  } else if (memory && fit.dof > 0 && fit.residual_sum > 0 && fit.reason != EndReason::exact) {
    errors = of_memory(curve, problem, fit);
  } else {
    errors = of_independent_points(problem, fit);
  }
  fit.error_dof = errors.dof;
  if (too_short_for_errors(fit)) errors.covariance.setConstant(infinite);
  return errors;
}

bool too_short_for_errors(const Fit& fit) {
  return fit.memory.time > 0 && fit.error_dof < least_error_dof;
}

}  // namespace jostle::inline fitting
