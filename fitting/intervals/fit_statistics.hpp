#pragma once

#include <Eigen/Core>
#include <string>

#include "fitting/fit.hpp"

namespace jostle::inline fitting {

/// Inverse of J^T J, and the condition number of J^T J for columns of unit length, from the
/// singular values of J's triangle. Directions that J does not see get a variance as large as
/// rounding allows, never an infinite one.
struct InverseNormal {
  Eigen::MatrixXd matrix;  // [n_variables, n_variables]
  double condition = 1;
};
InverseNormal inverse_normal(const Eigen::MatrixXd& jacobian);

/// Fills what follows from residuals and counts: residual sum, reduced chi2, R2, runs, weighted
/// and effective size. `weighted`: [n_points], the residuals over their errors; the fit's
/// n_points, n_free, dof, sigma_given and residuals are set.
void fill_statistics(const Curve& curve, const Eigen::VectorXd& weighted, Fit& fit);

/// Fills error_factor from effective_size.
void count_effective_points(Fit& fit);

/// `t_unit`: unit of t in remarks, or empty. Classifies every estimate by its 95 % interval. Adds
/// remarks on the source of errors, on parameters that can compensate each other, on few points
/// that dominate, on chi2 far from 1 and on correlated residuals.
void judge(const Curve& curve, const std::string& t_unit, Fit& fit);

/// True if the residuals change sign significantly less often than independent residuals would.
bool has_correlated_residuals(const Fit& fit);
/// Opens the intervals of examined estimates at which a singular search ended by rounding alone.
void open_absurd_intervals(const Curve& curve, const Fit& fit, std::vector<Estimate>& estimates);
/// Takes the errors of examined estimates from their 68 % intervals, infinite where these are open:
/// in an ill-conditioned problem those of the linear one mean nothing.
void take_errors_of_intervals(const Fit& fit, std::vector<Estimate>& estimates);
/// Calls an estimate unfinished whose 95 % interval is open when the budget of the fit is spent.
void mark_unfinished(const SolverOptions& solver, Estimate& estimate);
/// Classifies estimates by their 95 % intervals, without remarks; unfinished ones stay so.
void judge_estimates(const Curve& curve, std::vector<Estimate>& estimates);

}  // namespace jostle::inline fitting
