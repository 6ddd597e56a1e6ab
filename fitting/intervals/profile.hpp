#pragma once

#include <optional>

#include "fitting/fit.hpp"

namespace jostle::inline fitting {

/// How far from the minimum an end is searched: the logarithm of a factor, and values or ranges of
/// X.
inline constexpr double reach_of_logarithm = 13.8;  // a factor 10^6
inline constexpr double reach_of_values = 100;

/// A minimum whose neighbourhood is explored with one parameter held at a time.
struct ProfileProblem {
  const Model& model;
  const Curve& curve;
  ParameterValues minimum;        // [n_parameters]
  std::vector<bool> free;         // [n_parameters]
  double cost = 0;                // at the minimum
  double variance = 0;            // variance of a residual: 1 where errors were given
  double thresholds[2] = {0, 0};  // sqrt of how much cost / variance may rise, ascending
  SolverOptions solver;
  double level_weight = 1;  // DependentErrors::level_weight, on which the thresholds rest
  /// True if a lower cost is looked for. False where one was met that no descent confirms: rounding
  /// decides there, and all of it counts as the minimum.
  bool seek_better = true;
};

struct ParameterProfile {
  /// In the order of the thresholds; open on every side that was not searched to its end.
  Interval intervals[2] = {
      {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()},
      {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}};
  /// Parameters of a lower cost than the minimum's, where one was met; the intervals are then void.
  std::optional<ParameterValues> better;
};

/// The profile of free parameter `index`, whose standard error is about `error` (any positive
/// number). side: -1 or 1 for that below or above the minimum alone, the other end is infinite
/// then.
ParameterProfile profile(const ProfileProblem& problem, std::size_t index, double error,
                         int side = 0);

}  // namespace jostle::inline fitting
