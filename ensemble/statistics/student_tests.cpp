#include "ensemble/statistics/student_tests.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numbers.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "fitting/fit.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/value_text.hpp"

namespace jostle::inline ensemble {

namespace {

// Beyond, Student's t is a normal variable to all digits that count.
constexpr double large_dof = 1e7;

double tails(double t, double dof) {
  return dof < large_dof ? student_tails(t, dof) : normal_tails(t);
}

// Simpson's rule over the square root of the variable, in which powers at 0 are smooth.
template <class Function>
double integral(double lower, double upper, int n_intervals, const Function& f) {
  if (!(lower < upper)) return 0;
  const double first = std::sqrt(lower), step = (std::sqrt(upper) - first) / n_intervals;
  double sum = 0;
  for (int i = 0; i <= n_intervals; ++i) {
    const double root = first + i * step;
    const double weight = i == 0 || i == n_intervals ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * 2 * root * f(root * root);
  }
  return sum * step / 3;
}

double normal_below(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

// For |N(effect, 1)| > critical s, where s^2 is chi squared over its dof degrees of freedom.
double power_at(double effect, double critical, double dof) {
  if (dof >= large_dof) return normal_below(effect - critical) + normal_below(-effect - critical);
  const double half = 0.5 * dof;
  const double norm = std::log(2.0) + half * std::log(half) - log_gamma(half);
  const auto density = [&](double s) {
    if (s == 0) return dof > 1 ? 0.0 : std::exp(norm);
    return std::exp(norm + (dof - 1) * std::log(s) - half * s * s);
  };
  const auto found = [&](double s) {
    return density(s) *
           (normal_below(effect - critical * s) + normal_below(-effect - critical * s));
  };
  // s outside of which nothing is left, and where the normal variable decides.
  const double spread = 9 / std::sqrt(std::max(dof, 1.0));
  const double start = std::max(0.0, 1 - spread), end = 1 + spread;
  const double low = std::clamp((effect - 8) / critical, start, end);
  const double high = std::clamp((effect + 8) / critical, start, end);
  return integral(start, low, 128, density) + integral(low, high, 128, found);
}

}  // namespace

double error_or_nan(const ErrorOf& error) {
  return error.known() ? error.error : std::numeric_limits<double>::quiet_NaN();
}

ErrorOf combined(const ErrorOf& a, const ErrorOf& b) {
  if (!a.known() || !b.known()) return {};
  const double first = a.error * a.error, second = b.error * b.error;
  if (first + second == 0) return {0, std::min(a.dof, b.dof)};
  // Shares of the variance, so that small numbers keep their squares.
  const double share = first / (first + second), rest = second / (first + second);
  return {std::sqrt(first + second), 1 / (share * share / a.dof + rest * rest / b.dof)};
}

double p_value(double value, const ErrorOf& error) {
  if (!error.known() || std::isnan(value)) return not_a_number;
  if (value == 0) return 1;
  return error.error > 0 ? tails(value / error.error, error.dof) : not_a_number;
}

std::string p_text(double p) {
  if (!std::isfinite(p)) return not_stated;
  return finite_text("{} at the {:g} % level", p_value_text(p), 100 * significance_level);
}

std::string plain_p_text(double p) {
  return std::isfinite(p) ? p_value_text(p) : not_stated;
}

std::vector<double> corrected_for_number(std::span<const double> p_values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p_values.size(); ++i) {
    if (!std::isnan(p_values[i])) order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p_values[i]; });
  std::vector<double> corrected(p_values.begin(), p_values.end());
  double largest = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double times = static_cast<double>(order.size() - rank);
    largest = std::max(largest, std::min(1.0, times * p_values[order[rank]]));
    corrected[order[rank]] = largest;
  }
  return corrected;
}

double student_power(double effect, double level, double dof) {
  return power_at(std::abs(effect), two_sided(1 - level, dof), dof);
}

double smallest_effect_found(double level, double dof, double power) {
  const double critical = two_sided(1 - level, dof);
  double low = 0, high = 1;
  while (power_at(high, critical, dof) < power) high *= 2;
  while (high - low > 1e-6 * high) {
    const double middle = 0.5 * (low + high);
    (power_at(middle, critical, dof) < power ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TestedEnds tested_ends(const std::vector<double>& values, double best, double dof,
                       const std::function<double(double value)>& t_of) {
  TestedEnds ends{{-infinite, -infinite}, {infinite, infinite}};
  const std::size_t n = values.size();
  const double near = 2e-3 * (values.back() - values.front()) / static_cast<double>(n);
  // At an end of the search t need not be 0.
  const bool is_at_end = best - values.front() < near || values.back() - best < near;
  const double t_best = is_at_end ? std::abs(t_of(best)) : 0;
  const double thresholds[] = {student_two_sided(interval_levels[0], dof),
                               student_two_sided(interval_levels[1], dof)};
  std::size_t first = 0;  // levels that do not refute the best value itself
  while (first < 2 && t_best > thresholds[first]) ++first;
  for (const bool is_upper : {false, true}) {
    double inside = best, t_inside = t_best;
    std::size_t found = first;  // levels
    for (std::size_t i = 0; i < n && found < 2; ++i) {
      const double value = is_upper ? values[i] : values[n - 1 - i];
      if (is_upper ? value < best + near : value > best - near) continue;
      const double t = std::abs(t_of(value));
      for (; found < 2; ++found) {
        const double threshold = thresholds[found];
        if (!(t > threshold)) break;
        const double share = std::max(0.0, (threshold - t_inside) / (t - t_inside));
        (is_upper ? ends.high : ends.low)[found] = std::lerp(inside, value, share);
      }
      inside = value;
      t_inside = t;
    }
  }
  return ends;
}

}  // namespace jostle::inline ensemble
