#pragma once

#include <span>

#include "ensemble/statistics/log_estimate.hpp"

namespace jostle::inline ensemble {

/// Quantile p in (0, 1) of chi2 with dof > 0 degrees of freedom.
double chi_squared_quantile(double p, double dof);

/// The variance of normal values over realizations (of n - 1) with the intervals of chi2, exact for
/// any number of them from two on; error: value sqrt(2 / (n - 1)). NaN values are left out. Without
/// errors where all are equal.
LogEstimate variance_estimate(std::span<const double> values);

}  // namespace jostle::inline ensemble
