#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "fitting/curve.hpp"
#include "fitting/intervals/memory.hpp"

// Errors of a fit whose points are not independent: realizations have memories, and keep to values
// of their own.
namespace jostle::inline fitting {

/// Errors of least squares that count the dependence of its points.
struct DependentErrors {
  Eigen::MatrixXd covariance;  // [n_variables, n_variables]
  /// [n_variables, n_variables]: what the second derivatives of the squares give with independent
  /// points of unit variance, with the level weighed. A profile moves the variables along its
  /// columns.
  Eigen::MatrixXd independent;
  /// [n_variables], > 0: the variance of each variable over its variance in `independent`. A
  /// profile's threshold grows by its root.
  Eigen::VectorXd inflation;
  /// The weight of the residuals' weighted mean in a profile, in (0, 1]: see level_weight().
  double level_weight = 1;
  /// For Student's t; infinite where the errors are known.
  double dof = std::numeric_limits<double>::infinity();
};

/// Part of the second derivatives beyond J^T J, along directions of the variables, the columns
/// V: V^T S V, where S is the sum of r_i times the second derivatives of r_i. It matters where the
/// law misses the curve.
using Curvature = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& directions)>;

/// Realizations as clusters (the sandwich of White 1980, doi:10.2307/1912934, over clusters; Liang
/// & Zeger 1986, doi:10.1093/biomet/73.1.13): to first order the estimate is the mean of one
/// estimate a realization, which are independent whatever the memory within each, so Student's t of
/// n_realizations - 1 degrees of freedom is exact for linear laws and normal noise. jacobian:
/// [n_points, n_variables], weighted; deviations: [n_points, n_realizations] of the realizations
/// from their mean, with the same weights, n_realizations >= 2. `curvature`: makes the sandwich
/// that of the full second derivatives of the squares, as White has it: a law that misses the curve
/// moves with a realization by another amount than J^T J alone gives. None: J^T J.
DependentErrors clustered_errors(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& deviations,
                                 const Curvature& curvature = nullptr);

/// The points of a curve, [n_points], in order of t; of equal t the earlier first.
std::vector<std::size_t> in_order_of_t(const std::vector<double>& t);

/// The weight that the weighted mean of the residuals deserves against their other components: the
/// root of the variance of one of these over that of the mean. Below 1 where realizations keep to
/// levels of their own, which all points of the mean curve share. A profile without this weight has
/// one threshold for a parameter that the shape of the curve determines on one side and its level
/// on the other. It is 1 where the law has no constant to add, as another weight would then move
/// the least squares. weights: [n_points]; jacobian, deviations as of clustered_errors().
double level_weight(const std::vector<double>& weights, const Eigen::MatrixXd& jacobian,
                    const Eigen::MatrixXd& deviations);

/// For one curve alone, whose residuals have a memory; Student's t of effective_size - n_variables
/// degrees of freedom, which may be negative where the memory is as long as the curve. t:
/// [n_points], ascending; jacobian, residuals: [n_points], weighted alike. `sigma_given`: the
/// variance of a residual is 1, and only their correlation is taken from them, where they are no
/// smaller. Without a memory that makes errors longer, given errors are known: dof is infinite.
struct MemoryErrors : DependentErrors {
  Memory memory;
};
MemoryErrors memory_errors(const std::vector<double>& t, const Eigen::MatrixXd& jacobian,
                           const Eigen::VectorXd& residuals, bool sigma_given);

/// Degrees of freedom of clustered errors where realizations are missing at some t: those that stay
/// carry more of a parameter than those that leave, and its variance is estimated from fewer than
/// n_realizations - 1 (Satterthwaite 1946, doi:10.2307/3002019; Bell & McCaffrey 2002 for
/// clusters). In a realization's variance of a parameter, the part of its offset is equal for all;
/// the part of its noise grows with the weight that its values have and with their memory, taken
/// from the correlation of neighbouring points. Returns the least over the variables, from 1 to
/// n_realizations - 1. jacobian: [n_points, n_variables], weighted; the curve has `present`,
/// `offsets` and sigma.
double gapped_dof(const Eigen::MatrixXd& jacobian, const Curve& curve);

}  // namespace jostle::inline fitting
