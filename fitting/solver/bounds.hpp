#pragma once

#include <optional>

#include "fitting/curve.hpp"
#include "fitting/models/model.hpp"

// Estimates whose least squares lie on a bound of a parameter, or so near to it that the curve
// cannot distinguish them. Their logarithm has no minimum.
namespace jostle::inline fitting {

/// A minimum and the size of a rise of its cost that matters.
struct Surroundings {
  const Model& model;
  const Curve& curve;
  double cost = 0;
  double variance = 0;  // variance of a residual
  double level_weight = 1;
};

/// The nearer bound of a parameter.
struct NearBound {
  double bound = 0;
  double distance = 0;   // distance of the value
  double direction = 0;  // away from the bound: 1 or -1
  /// Distance at which the cost is higher by its variance, the other parameters held: at most one
  /// standard error.
  double resolved = 0;
};

/// None where the parameter has no bound, or does not change the curve anywhere.
std::optional<NearBound> near_bound(const Surroundings& minimum, const ParameterValues& values,
                                    std::size_t index);

/// Distances over which the curve resolves no difference, in those that it resolves.
inline constexpr double least_resolved = 1e-4;

/// Moves values that are all but on their bounds to where derivatives exist, at 1e-6 of the
/// distance that the curve resolves.
ParameterValues off_bounds(const Surroundings& minimum, ParameterValues values,
                           const std::vector<bool>& free);

}  // namespace jostle::inline fitting
