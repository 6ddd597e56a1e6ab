#pragma once

#include <Eigen/Core>

#include "fitting/solver/decompositions.hpp"

namespace jostle::inline fitting {

/// Steps of one Jacobian: the QR decomposition of J, made once, and of the small augmented matrix
/// [R P^T; sqrt(lambda) D] for every damping lambda.
class TrustStep {
 public:
  /// jacobian: [n_residuals, n_variables]; r: [n_residuals]; scale D: [n_variables], all > 0.
  TrustStep(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& r,
            const Eigen::VectorXd& scale);

  /// The step that minimises |J p + r| under |D p| <= radius, to 10 % of the radius; sets the
  /// damping. More 1978.
  Eigen::VectorXd step_within(double radius);
  /// Solves (J^T J + lambda D^2) p = -J^T v with the damping of the last step.
  Eigen::VectorXd damped(const Eigen::VectorXd& v) const;

  double lambda() const { return lambda_; }
  bool full_rank() const { return full_rank_; }
  /// Largest cosine between r and a column of J; 0 where r is 0.
  double gradient_cosine() const;
  /// |J p|^2.
  double linear_change(const Eigen::VectorXd& step) const;
  const Eigen::VectorXd& scale() const { return scale_; }

 private:
  /// Least squares solution of [R; sqrt(lambda) D] p = -[b; 0]; `factor` is left for derivatives.
  Eigen::VectorXd solve(double lambda, const Eigen::VectorXd& b,
                        Eigen::MatrixXd* triangle = nullptr) const;

  PivotedQr qr_;
  Eigen::MatrixXd triangle_;   // R P^T, [min(n_residuals, n_variables), n_variables]
  Eigen::VectorXd projected_;  // first rows of Q^T r
  Eigen::VectorXd scale_;
  Eigen::VectorXd column_norms_;
  double r_norm_ = 0;
  double lambda_ = 0;
  bool full_rank_ = false;
};

}  // namespace jostle::inline fitting
