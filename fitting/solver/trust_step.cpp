#include "fitting/solver/trust_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jostle::inline fitting {

namespace {

// J with its columns over D: pivoting and rank then do not depend on the units of the variables.
Eigen::MatrixXd scaled(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& scale) {
  return jacobian * scale.cwiseInverse().asDiagonal();
}

}  // namespace

TrustStep::TrustStep(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& r,
                     const Eigen::VectorXd& scale)
    : qr_(scaled(jacobian, scale)),
      triangle_(qr_.triangle()),
      projected_(qr_.rotated(r)),
      scale_(scale),
      column_norms_(jacobian.colwise().norm().transpose()),
      r_norm_(r.norm()),
      full_rank_(qr_.rank() == jacobian.cols()) {}

Eigen::VectorXd TrustStep::solve(double lambda, const Eigen::VectorXd& b,
                                 Eigen::MatrixXd* triangle) const {
  const Eigen::Index n = scale_.size();
  const Eigen::Index rows = triangle_.rows();
  Eigen::MatrixXd augmented = Eigen::MatrixXd::Zero(rows + n, n);
  augmented.topRows(rows) = triangle_;
  augmented.bottomRows(n).diagonal().setConstant(std::sqrt(lambda));
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows + n);
  right.head(rows) = -b;
  const TriangularSystem system = triangular_system(augmented, right);
  if (triangle) *triangle = system.upper;
  return system.upper.template triangularView<Eigen::Upper>().solve(system.right);
}

Eigen::VectorXd TrustStep::step_within(double radius) {
  // In scaled variables q = D p throughout.
  lambda_ = 0;
  double lower = 0;
  if (full_rank_) {
    Eigen::MatrixXd upper;
    const Eigen::VectorXd newton = solve(0, projected_, &upper);
    const double length = newton.norm();
    if (newton.allFinite() && length <= 1.1 * radius) return newton.cwiseQuotient(scale_);
    const Eigen::VectorXd w =
        upper.transpose().template triangularView<Eigen::Lower>().solve(newton / length);
    lower = (length - radius) / (radius * w.squaredNorm());
    if (!std::isfinite(lower)) lower = 0;
  }
  double upper_bound = (triangle_.transpose() * projected_).norm() / radius;
  if (upper_bound == 0) return Eigen::VectorXd::Zero(scale_.size());
  lambda_ = std::max(lower, 1e-3 * upper_bound);
  Eigen::VectorXd step;
  for (int i = 0; i < 12; ++i) {
    if (lambda_ <= lower && lower > 0) lambda_ = lower;
    if (lambda_ <= 0) lambda_ = std::max(std::numeric_limits<double>::min(), 1e-3 * upper_bound);
    Eigen::MatrixXd upper;
    step = solve(lambda_, projected_, &upper);
    const double length = step.norm();
    const double excess = length - radius;
    if (std::abs(excess) <= 0.1 * radius || length == 0) break;
    const Eigen::VectorXd w =
        upper.transpose().template triangularView<Eigen::Lower>().solve(step / length);
    const double correction = excess / (radius * w.squaredNorm());
    if (excess > 0) lower = std::max(lower, lambda_);
    if (excess < 0) upper_bound = std::min(upper_bound, lambda_);
    const double next = lambda_ + correction;
    // Not full rank, and even an undamped step is inside: damping can go to zero.
    if (excess < 0 && lower == 0 && next <= 1e-12 * upper_bound) break;
    lambda_ = std::max(lower, next);
    if (!(lambda_ < upper_bound) || lambda_ <= 0)
      lambda_ = std::sqrt(std::max(lower, 1e-3 * upper_bound) * upper_bound);
  }
  return step.cwiseQuotient(scale_);
}

Eigen::VectorXd TrustStep::damped(const Eigen::VectorXd& v) const {
  return solve(lambda_, qr_.rotated(v)).cwiseQuotient(scale_);
}

double TrustStep::gradient_cosine() const {
  if (r_norm_ == 0) return 0;
  const Eigen::VectorXd gradient = triangle_.transpose() * projected_;
  double largest = 0;
  for (Eigen::Index j = 0; j < gradient.size(); ++j) {
    const double norm = column_norms_[j] / scale_[j];
    if (norm > 0) largest = std::max(largest, std::abs(gradient[j]) / norm / r_norm_);
  }
  return largest;
}

double TrustStep::linear_change(const Eigen::VectorXd& step) const {
  return (triangle_ * step.cwiseProduct(scale_)).squaredNorm();
}

}  // namespace jostle::inline fitting
