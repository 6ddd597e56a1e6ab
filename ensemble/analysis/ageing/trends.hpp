#pragma once

#include <string>

#include "ensemble/analysis/ageing/law.hpp"

namespace jostle::inline ensemble {

/// The factor by which something changes from the first waiting time to the last, its logarithm in
/// equal steps from one waiting time to the next, by Student's t over realizations.
struct AgeTrend {
  LogEstimate factor;
  double p;           // of no change
  double detectable;  // the factor, up or down, that is found at 5 % with power 0.8
  std::string verdict;
};

AgeTrend cannot_decide(const std::string& why);

/// Of what the curves are of, `name` ("a"), at equal lags, over lags that at least two waiting
/// times have.
AgeTrend trend_with_age(const LogCurves& curves, const std::string& name);

/// Of B, about a fit with one B that is not held. Scaled curves, A / A_inf against t / tau, lie on
/// one another only where there is none.
AgeTrend trend_of_b(const AgeingLeastSquares& fit);

}  // namespace jostle::inline ensemble
