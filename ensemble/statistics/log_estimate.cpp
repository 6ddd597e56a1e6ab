#include "ensemble/statistics/log_estimate.hpp"

#include <cassert>
#include <cmath>
#include <vector>

#include "engine/numbers.hpp"
#include "ensemble/moments.hpp"
#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"

namespace jostle::inline ensemble {

LogEstimate no_estimate() {
  return {not_a_number, not_a_number, not_a_number, not_a_number, not_a_number, not_a_number};
}

LogEstimate log_estimate(double value, const ErrorOf& of_logarithm) {
  LogEstimate estimate = no_estimate();
  estimate.value = value;
  if (!of_logarithm.known() || !std::isfinite(of_logarithm.error)) return estimate;
  estimate.error = value * of_logarithm.error;
  const auto factor = [&](double level) {
    return std::exp(student_two_sided(level, of_logarithm.dof) * of_logarithm.error);
  };
  const double by_68 = factor(interval_levels[0]), by_95 = factor(interval_levels[1]);
  estimate.low_68 = value / by_68;
  estimate.high_68 = value * by_68;
  estimate.low_95 = value / by_95;
  estimate.high_95 = value * by_95;
  return estimate;
}

bool is_limited(const LogEstimate& estimate) {
  return estimate.low_95 > 0 && std::isfinite(estimate.high_95);
}

std::vector<double> ln_means_without_one(std::span<const double> values) {
  const std::size_t n = values.size();
  if (n < 2) return {};
  std::vector<double> first_sums = {0}, last_sums = {0},
                      logarithms;  // sums of the first, of the last
  for (std::size_t i = 0; i < n; ++i) {
    first_sums.push_back(first_sums.back() + values[i]);
    last_sums.push_back(last_sums.back() + values[n - 1 - i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    logarithms.push_back(
        std::log((first_sums[i] + last_sums[n - 1 - i]) / static_cast<double>(n - 1)));
  }
  return logarithms;
}

double variance(std::span<const double> values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  const double error = moments.standard_error();
  return error * error * static_cast<double>(values.size());
}

std::vector<double> ln_variances_without_one(std::span<const double> values) {
  constexpr std::size_t fewest = 4;
  if (values.size() < fewest) return {};
  Moments moments;
  for (const double value : values) moments.add(value);
  const auto n = static_cast<double>(values.size());
  const double squares = (n - 1) * variance(values);
  // Without value i: squares - n/(n - 1) (x_i - mean)^2, but for rounding.
  std::vector<double> logarithms;
  for (const double value : values) {
    const double rest = squares - n / (n - 1) * std::pow(value - moments.mean(), 2);
    logarithms.push_back(std::log((rest > 1e-13 * squares ? rest : 0) / (n - 2)));
  }
  return logarithms;
}

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
