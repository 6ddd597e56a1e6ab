#include "fitting/models/combination.hpp"

#include <cmath>

namespace jostle::inline fitting {

CombinedModel::CombinedModel(const Model& model, const Combination& combination)
    : model_(model), combination_(combination), parameters_(model.parameters()) {
  Parameter& kept = parameters_[combination.kept];
  kept.name = combination.name;
  kept.meaning = combination.meaning;
  kept.unit = combination.unit;
  kept.lower = 0;
  kept.linear = false;  // its logarithm is profiled, like its factors
}

ParameterValues CombinedModel::combined(ParameterValues p) const {
  p[combination_.kept] *= std::pow(p[combination_.partner], combination_.power);
  return p;
}

ParameterValues CombinedModel::separate(ParameterValues p) const {
  p[combination_.kept] *= std::pow(p[combination_.partner], -combination_.power);
  return p;
}

double CombinedModel::value(double t, const double* p) const {
  return model_.value(t, separate({p, p + parameters_.size()}).data());
}

double CombinedModel::value_and_gradient(double t, const double* p, double* gradient) const {
  const ParameterValues q = separate({p, p + parameters_.size()});
  const double value = model_.value_and_gradient(t, q.data(), gradient);
  const std::size_t kept = combination_.kept, partner = combination_.partner;
  gradient[partner] -= gradient[kept] * combination_.power * q[kept] / q[partner];
  gradient[kept] *= q[kept] / p[kept];
  return value;
}

// Those of the model, brought to the values that are held.
std::vector<ParameterValues> CombinedModel::starts(const Curve& curve,
                                                   std::span<const double> fixed,
                                                   std::size_t n) const {
  std::vector<double> free(fixed.begin(), fixed.end());
  const double held = free[combination_.kept];
  free[combination_.kept] = std::numeric_limits<double>::quiet_NaN();
  std::vector<ParameterValues> starts;
  for (const ParameterValues& p : model_.starts(curve, free, n)) {
    if (!(p[combination_.kept] > 0)) continue;
    starts.push_back(combined(p));
    if (!std::isnan(held)) starts.back()[combination_.kept] = held;
  }
  return starts;
}

}  // namespace jostle::inline fitting
