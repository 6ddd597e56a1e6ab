#include "fitting/solver/curve_residuals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace jostle::inline fitting {

namespace {

// Returns a power of two near the largest of these, or 1 where the largest has a common size.
double unit_of(const std::vector<double>& values) {
  constexpr double least_common = 1e-15, largest_common = 1e15;
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  const bool is_common = largest >= least_common && largest <= largest_common;
  if (is_common || largest == 0 || !std::isfinite(largest)) return 1;
  return std::exp2(std::ilogb(largest));
}

double unit_of(ParameterUnit unit, double of_x, double of_t) {
  switch (unit) {
    case ParameterUnit::none:
      return 1;
    case ParameterUnit::value:
      return of_x;
    case ParameterUnit::time:
      return of_t;
    case ParameterUnit::value_per_time:
      return of_x / of_t;
    case ParameterUnit::value_time:
      return of_x * of_t;
    case ParameterUnit::per_time:
      return 1 / of_t;
  }
  return 1;
}

}  // namespace

Transform::Transform(const Parameter& parameter, double unit)
    : lower_(parameter.lower),
      upper_(parameter.upper),
      unit_(unit),
      lower_bound_(std::isfinite(parameter.lower)),
      upper_bound_(std::isfinite(parameter.upper)) {}

double Transform::to_variable(double p) const {
  const double tiny = std::numeric_limits<double>::min();
  if (lower_bound_ && upper_bound_) {
    const double share = std::clamp((p - lower_) / (upper_ - lower_), 1e-12, 1 - 1e-12);
    return std::log(share / (1 - share));
  }
  if (lower_bound_) return std::log(std::max((p - lower_) / unit_, tiny));
  if (upper_bound_) return std::log(std::max((upper_ - p) / unit_, tiny));
  return p / unit_;
}

double Transform::to_parameter(double u) const {
  if (lower_bound_ && upper_bound_) return lower_ + (upper_ - lower_) / (1 + std::exp(-u));
  if (lower_bound_) return lower_ + unit_ * std::exp(u);
  if (upper_bound_) return upper_ - unit_ * std::exp(u);
  return unit_ * u;
}

double Transform::slope(double u) const {
  if (lower_bound_ && upper_bound_) {
    const double share = 1 / (1 + std::exp(-u));
    return (upper_ - lower_) * share * (1 - share);
  }
  if (lower_bound_) return unit_ * std::exp(u);
  if (upper_bound_) return -unit_ * std::exp(u);
  return unit_;
}

void weigh_level(const std::vector<double>& weights, double level_weight,
                 Eigen::Ref<Eigen::MatrixXd> columns) {
  if (level_weight == 1) return;
  const Eigen::Map<const Eigen::VectorXd> level(weights.data(),
                                                static_cast<Eigen::Index>(weights.size()));
  const Eigen::RowVectorXd means = level.transpose() * columns / level.squaredNorm();
  columns -= (1 - level_weight) * level * means;
}

CurveResiduals::CurveResiduals(const Model& model, const Curve& curve, ParameterValues values,
                               const std::vector<bool>& free, double level_weight)
    : model_(model),
      curve_(curve),
      fixed_values_(std::move(values)),
      target_(curve.x),
      weight_(curve.x.size(), 1.0),
      level_weight_(level_weight),
      unit_(unit_of(curve.x)),
      logarithmic_(is_fitted_in_logarithms(model, curve)) {
  const double of_t = unit_of(curve.t);
  for (std::size_t j = 0; j < free.size(); ++j) {
    const Parameter& parameter = model.parameters()[j];
    transforms_.emplace_back(parameter, unit_of(parameter.unit, unit_, of_t));
    if (free[j]) free_.push_back(j);
  }
  for (std::size_t i = 0; i < target_.size(); ++i) {
    if (!curve.sigma.empty()) weight_[i] = (logarithmic_ ? curve.x[i] : 1) / curve.sigma[i];
    if (logarithmic_) target_[i] = std::log(curve.x[i] / unit_);
  }
}

void CurveResiduals::values(const Eigen::VectorXd& u, Eigen::VectorXd& r) const {
  const ParameterValues p = to_parameters(u);
  for (std::size_t i = 0; i < target_.size(); ++i) {
    const double f = model_.value(curve_.t[i], p.data());
    r[static_cast<Eigen::Index>(i)] =
        ((logarithmic_ ? std::log(f / unit_) : f) - target_[i]) * weight_[i];
  }
  weigh_level(weight_, level_weight_, r);
}

void CurveResiduals::values_and_jacobian(const Eigen::VectorXd& u, Eigen::VectorXd& r,
                                         Eigen::MatrixXd& jacobian) const {
  const ParameterValues p = to_parameters(u);
  const Eigen::VectorXd slope = slopes(u);
  std::vector<double> gradient(p.size());
  for (std::size_t i = 0; i < target_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double f = model_.value_and_gradient(curve_.t[i], p.data(), gradient.data());
    r[row] = ((logarithmic_ ? std::log(f / unit_) : f) - target_[i]) * weight_[i];
    const double factor = logarithmic_ ? weight_[i] / f : weight_[i];
    for (std::size_t j = 0; j < free_.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      jacobian(row, column) = factor * gradient[free_[j]] * slope[column];
    }
  }
  weigh_level(weight_, level_weight_, r);
  weigh_level(weight_, level_weight_, jacobian);
}

Eigen::VectorXd CurveResiduals::to_variables(const ParameterValues& p) const {
  Eigen::VectorXd u(n_variables());
  for (std::size_t j = 0; j < free_.size(); ++j) {
    u[static_cast<Eigen::Index>(j)] = transforms_[free_[j]].to_variable(p[free_[j]]);
  }
  return u;
}

ParameterValues CurveResiduals::to_parameters(const Eigen::VectorXd& u) const {
  ParameterValues p = fixed_values_;
  for (std::size_t j = 0; j < free_.size(); ++j) {
    p[free_[j]] = transforms_[free_[j]].to_parameter(u[static_cast<Eigen::Index>(j)]);
  }
  return p;
}

Eigen::VectorXd CurveResiduals::slopes(const Eigen::VectorXd& u) const {
  Eigen::VectorXd slope(n_variables());
  for (std::size_t j = 0; j < free_.size(); ++j) {
    const auto k = static_cast<Eigen::Index>(j);
    slope[k] = transforms_[free_[j]].slope(u[k]);
  }
  return slope;
}

double CurveResiduals::data_norm() const {
  double sum = 0;
  for (std::size_t i = 0; i < target_.size(); ++i) {
    const double term = target_[i] * weight_[i];
    sum += term * term;
  }
  return std::sqrt(sum);
}

}  // namespace jostle::inline fitting
