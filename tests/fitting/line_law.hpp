#pragma once

#include <string>
#include <vector>

#include "fitting/models/model.hpp"

namespace jostle {

/// The law a + b t: every number of its fit is known in closed form.
class Line final : public Model {
 public:
  std::string name() const override { return "line"; }
  std::string formula() const override { return "a + b t"; }
  const std::vector<Parameter>& parameters() const override {
    static const std::vector<Parameter> list = {
        {.name = "a", .meaning = "intercept", .unit = ParameterUnit::value, .linear = true},
        {.name = "b", .meaning = "slope", .unit = ParameterUnit::value_per_time, .linear = true}};
    return list;
  }
  double value(double t, const double* p) const override { return p[0] + p[1] * t; }
};

}  // namespace jostle
