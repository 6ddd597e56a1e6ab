#include "ensemble/statistics/variance_estimate.hpp"

#include <cassert>
#include <cmath>
#include <vector>

#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

double chi_squared_quantile(double p, double dof) {
  assert(p > 0 && p < 1 && dof > 0);
  double low = 0, high = dof;
  while (chi_squared_tail(high, dof) > 1 - p) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (chi_squared_tail(middle, dof) > 1 - p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

LogEstimate variance_estimate(std::span<const double> values) {
  std::vector<double> known;
  for (const double value : values)
    if (!std::isnan(value)) known.push_back(value);
  LogEstimate estimate = no_estimate();
  estimate.value = variance(known);
  if (!(estimate.value > 0)) return estimate;
  const double dof = static_cast<double>(known.size()) - 1;
  estimate.error = estimate.value * std::sqrt(2 / dof);
  const auto limit = [&](double p) { return estimate.value * dof / chi_squared_quantile(p, dof); };
  const double by_68 = 0.5 * interval_levels[0], by_95 = 0.5 * interval_levels[1];
  estimate.low_68 = limit(0.5 + by_68);
  estimate.high_68 = limit(0.5 - by_68);
  estimate.low_95 = limit(0.5 + by_95);
  estimate.high_95 = limit(0.5 - by_95);
  return estimate;
}

}  // namespace jostle::inline ensemble
