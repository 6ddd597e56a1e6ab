#pragma once

#include <vector>

#include "fitting/fit.hpp"

// Estimates in other parameters than those that were fitted: combinations of two of them, and the
// parameters of a law that draws this curves.
namespace jostle::inline fitting {

/// A minimum and what its errors and intervals rest on. Keeps references.
struct FittedCurveOf {
  const Model& model;
  const Curve& curve;             // all points, with their errors
  const Curve& searched;          // the points or means that were searched and profiled
  const ParameterValues& values;  // [n_parameters], at the minimum of `searched`
  const std::vector<bool>& free;  // [n_parameters]
  double cost = 0;                // at that minimum
  bool has_intervals = false;     // true if intervals are profiled
  const FitOptions& options;
};

/// Adds the combinations that have both limits where neither of their parameters has. The fit's
/// parameters are judged.
void add_combinations(const FittedCurveOf& fitted, Fit& fit);

/// Adds the fit in the parameters of the equivalent law, where the curve has a place among them.
void add_restated(const FittedCurveOf& fitted, Fit& fit);

}  // namespace jostle::inline fitting
