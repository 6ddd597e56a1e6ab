#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/models/model.hpp"
#include "fitting/solver/levenberg_marquardt.hpp"

namespace jostle::inline fitting {

/// A bounded parameter as a free variable: p = lower + unit e^u above a bound, upper - unit e^u
/// below one, and between two p = lower + (upper - lower) / (1 + e^-u). Without bounds p = unit u.
class Transform {
 public:
  explicit Transform(const Parameter& parameter, double unit = 1);

  double to_variable(double p) const;
  double to_parameter(double u) const;
  /// dp/du.
  double slope(double u) const;
  bool is_identity() const { return !lower_bound_ && !upper_bound_; }

 private:
  double lower_, upper_, unit_;
  bool lower_bound_, upper_bound_;
};

/// (model - X) / sigma over a curve, as a function of the transformed free parameters. On the
/// logarithmic scale (ln model - ln X) / (sigma / X). Where X or t are beyond 1e-15 to 1e15, their
/// sizes (powers of two) are the units of the parameters, so that all variables have common sizes.
/// Keeps references to model and curve.
class CurveResiduals final : public Residuals {
 public:
  /// values: [n_parameters], those that are not free keep theirs; free: [n_parameters].
  /// level_weight: in (0, 1], of the weighted mean of the residuals against all else; below 1 where
  /// all points share an error.
  CurveResiduals(const Model& model, const Curve& curve, ParameterValues values,
                 const std::vector<bool>& free, double level_weight = 1);

  Eigen::Index n_residuals() const override { return static_cast<Eigen::Index>(target_.size()); }
  Eigen::Index n_variables() const override { return static_cast<Eigen::Index>(free_.size()); }
  void values(const Eigen::VectorXd& u, Eigen::VectorXd& r) const override;
  void values_and_jacobian(const Eigen::VectorXd& u, Eigen::VectorXd& r,
                           Eigen::MatrixXd& jacobian) const override;

  /// A value on its bound is moved off it.
  Eigen::VectorXd to_variables(const ParameterValues& p) const;
  ParameterValues to_parameters(const Eigen::VectorXd& u) const;
  /// dp/du of the free parameters, [n_variables].
  Eigen::VectorXd slopes(const Eigen::VectorXd& u) const;
  /// 1 / error of X or ln X, [n_points].
  const std::vector<double>& weights() const { return weight_; }
  /// Norm of what the residuals are a difference of.
  double data_norm() const;

 private:
  const Model& model_;
  const Curve& curve_;
  ParameterValues fixed_values_;
  std::vector<std::size_t> free_;      // indices of the free parameters
  std::vector<Transform> transforms_;  // [n_parameters]
  std::vector<double> target_;         // X, or ln(X / unit)
  std::vector<double> weight_;         // 1 / error of the target
  double level_weight_;
  double unit_;  // unit of X
  bool logarithmic_;
};

/// Multiplies the component of each column along the weights [n_points] by level_weight: points of
/// which all share an error are independent afterwards.
void weigh_level(const std::vector<double>& weights, double level_weight,
                 Eigen::Ref<Eigen::MatrixXd> columns);

}  // namespace jostle::inline fitting
