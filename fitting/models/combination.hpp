#pragma once

#include "fitting/models/model.hpp"

namespace jostle::inline fitting {

/// A model with one of its parameters, `kept`, replaced by a combination of it with another,
/// kept * other^power: what a curve may still determine where the two diverge together.
class CombinedModel final : public Model {
 public:
  /// Keeps a reference to the model. Both parameters are positive.
  CombinedModel(const Model& model, const Combination& combination);

  std::string name() const override { return model_.name(); }
  const std::vector<Parameter>& parameters() const override { return parameters_; }
  double value(double t, const double* p) const override;
  double value_and_gradient(double t, const double* p, double* gradient) const override;
  ResidualScale residual_scale() const override { return model_.residual_scale(); }
  std::vector<ParameterValues> starts(const Curve& curve, std::span<const double> fixed,
                                      std::size_t n) const override;

  /// One curve in the parameters of both laws.
  ParameterValues combined(ParameterValues p) const;
  ParameterValues separate(ParameterValues p) const;

 private:
  const Model& model_;
  Combination combination_;
  std::vector<Parameter> parameters_;
};

}  // namespace jostle::inline fitting
