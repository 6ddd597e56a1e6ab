#pragma once

#include <string>

#include "ensemble/analysis/ageing/law.hpp"

namespace jostle::inline ensemble {

/// The factor by which something changes from the first waiting time to the last, its logarithm in
/// equal steps from one waiting time to the next, by Student's t over realizations.
struct AgeTrend {
  LogEstimate factor;
  double p;           // p-value for no change
  double detectable;  // the factor, up or down, that is found at 5 % with power 0.8
  std::string verdict;
};

/// No numbers, and the verdict "cannot decide: WHY".
AgeTrend cannot_decide(const std::string& reason);

/// The words of a test.
struct TestedChange {
  std::string quantity;                          // "A": what may change
  std::string changes;                           // the verdict where it does: "A changes with age"
  std::string does_not;                          // and where a factor of ten would have been found
  std::string first = "the first waiting time";  // from which it is estimated
};
/// The logarithm of the factor is the sum of weights times `values` over that of the weights'
/// squares, both [n_points].
AgeTrend tested_change(const LogCurves& curves, const Eigen::VectorXd& weights,
                       const Eigen::VectorXd& values, const TestedChange& words);

/// Returns the result of the stricter of two tests of one change, without a factor; nothing is
/// decided where only one finds it.
AgeTrend agreed(const AgeTrend& first, const AgeTrend& second, std::size_t realizations,
                const TestedChange& words);

/// -1/2 for the first waiting time to 1/2 for the last.
double place_of(std::size_t curve, const LogCurves& curves);

/// Change of the quantity `name` ("a") at equal lags, over lags that at least two waiting
/// times have.
AgeTrend trend_with_age(const LogCurves& curves, const std::string& name);

/// Change of B, about a fit with one B that is not held. Scaled curves, A / A_inf against t / tau,
/// are on one another only where there is none.
AgeTrend trend_of_b(const AgeingLeastSquares& fit);

}  // namespace jostle::inline ensemble
