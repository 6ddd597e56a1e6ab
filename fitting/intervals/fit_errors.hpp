#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/fit.hpp"
#include "fitting/intervals/dependence.hpp"

// Errors of a fit: what a linear problem with independent points gives, and what the dependence of
// its points makes of that.
namespace jostle::inline fitting {

/// A fit at its minimum, over all points.
struct LinearProblem {
  Eigen::VectorXd residuals;    // [n_points], weighted
  Eigen::MatrixXd jacobian;     // [n_points, n_variables], of the residuals by the variables
  Eigen::VectorXd slopes;       // [n_variables], of the free parameters by the variables
  std::vector<double> weights;  // [n_points], of the residuals
  /// Second derivatives of the residuals at the minimum (dependence.hpp); empty for a law with many
  /// parameters. Refers to the model and the curve.
  Curvature curvature;
};
LinearProblem linear_problem(const Model& model, const Curve& curve, const ParameterValues& values,
                             const std::vector<bool>& free);

/// Fills covariance, correlation and condition. The fit's counts and chi2 are set.
void fill_covariance(const LinearProblem& problem, const std::vector<bool>& free, Fit& fit);

/// Errors from the scatter of realizations, else from the memory of the residuals where `memory`
/// asks for it, else those of independent points. Fills n_realizations, error_dof and memory.
DependentErrors dependent_errors(const Curve& curve, const LinearProblem& problem, bool memory,
                                 Fit& fit);

/// True if the memory of a single curve is too long for reliable errors.
bool too_short_for_errors(const Fit& fit);

}  // namespace jostle::inline fitting
