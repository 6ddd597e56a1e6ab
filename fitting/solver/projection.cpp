#include "fitting/solver/projection.hpp"

#include <cmath>

#include "fitting/numbers.hpp"
#include "fitting/solver/curve_residuals.hpp"
#include "fitting/solver/decompositions.hpp"

namespace jostle::inline fitting {

Projection::Projection(const Model& model, const Curve& curve, std::span<const double> fixed,
                       double level_weight)
    : model_(model), curve_(curve), level_weight_(level_weight), weight_(curve.t.size(), 1.0) {
  for (std::size_t i = 0; i < curve.sigma.size(); ++i) weight_[i] = 1 / curve.sigma[i];
  const std::vector<Parameter>& parameters = model.parameters();
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (parameters[j].linear && std::isnan(fixed[j])) linear_.push_back(j);
  }
  const auto rows = static_cast<Eigen::Index>(curve.t.size());
  basis_.resize(rows, static_cast<Eigen::Index>(linear_.size()));
  rest_.resize(rows);
}

double Projection::operator()(ParameterValues& p) {
  for (std::size_t j : linear_) p[j] = 0;
  std::vector<double> gradient(p.size());
  for (Eigen::Index i = 0; i < rest_.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double weight = weight_[k];
    const double f = model_.value_and_gradient(curve_.t[k], p.data(), gradient.data());
    rest_[i] = weight * (curve_.x[k] - f);
    for (std::size_t j = 0; j < linear_.size(); ++j) {
      basis_(i, static_cast<Eigen::Index>(j)) = weight * gradient[linear_[j]];
    }
  }
  if (!basis_.allFinite() || !rest_.allFinite()) return infinite;
  weigh_level(weight_, level_weight_, rest_);
  weigh_level(weight_, level_weight_, basis_);
  if (!linear_.empty()) solve(p);
  const double cost = rest_.squaredNorm();
  return std::isfinite(cost) ? cost : infinite;
}

void Projection::solve(ParameterValues& p) {
  Eigen::VectorXd norms = basis_.colwise().norm().transpose();
  for (double& norm : norms) norm = norm > 0 ? norm : 1;
  basis_ = basis_ * norms.cwiseInverse().asDiagonal();
  const Eigen::VectorXd c = least_squares(basis_, rest_);
  rest_ -= basis_ * c;
  for (std::size_t j = 0; j < linear_.size(); ++j) {
    const auto k = static_cast<Eigen::Index>(j);
    const Parameter& parameter = model_.parameters()[linear_[j]];
    p[linear_[j]] = c[k] / norms[k];
    if (!(p[linear_[j]] > parameter.lower && p[linear_[j]] < parameter.upper)) {
      rest_[0] = infinite;
    }
  }
}

}  // namespace jostle::inline fitting
