#include "fitting/intervals/diagnostics.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/intervals/distributions.hpp"

namespace jostle::inline fitting {

RunsTest runs_test(const std::vector<double>& residuals) {
  double n_positive = 0, n_negative = 0;
  int last = 0;
  RunsTest test;
  for (double r : residuals) {
    const int sign = (r > 0) - (r < 0);
    if (sign == 0) continue;
    (sign > 0 ? n_positive : n_negative) += 1;
    if (sign != last) ++test.runs;
    last = sign;
  }
  const double n = n_positive + n_negative;
  test.expected = n > 0 ? 1 + 2 * n_positive * n_negative / n : 0;
  if (n_positive == 0 || n_negative == 0 || n < 3) return test;
  const double variance = (test.expected - 1) * (test.expected - 2) / (n - 1);
  if (!(variance > 0)) return test;
  test.z = (static_cast<double>(test.runs) - test.expected) / std::sqrt(variance);
  test.p = normal_tails(test.z);
  return test;
}

double effective_sample_size(const std::vector<double>& residuals) {
  const std::size_t n = residuals.size();
  const double largest =
      std::abs(*std::max_element(residuals.begin(), residuals.end(),
                                 [](double a, double b) { return std::abs(a) < std::abs(b); }));
  if (n < 4 || !(largest > 0)) return static_cast<double>(n);
  double mean = 0;
  for (double r : residuals) mean += r / largest / static_cast<double>(n);
  const auto covariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < n; ++i) {
      sum += (residuals[i] / largest - mean) * (residuals[i + lag] / largest - mean);
    }
    return sum;
  };
  const double variance = covariance(0);
  if (!(variance > 0)) return static_cast<double>(n);
  double sum = 0;
  for (std::size_t lag = 1; lag + 1 < n; lag += 2) {
    const double first = covariance(lag) / variance, second = covariance(lag + 1) / variance;
    if (first <= 0) break;
    sum += first + std::max(second, 0.0);
    if (second <= 0) break;
  }
  // Chance correlations of independent points are below two standard errors: not counted.
  if (sum < 2 / std::sqrt(static_cast<double>(n))) return static_cast<double>(n);
  return std::max(1.0, static_cast<double>(n) / (1 + 2 * sum));
}

}  // namespace jostle::inline fitting
