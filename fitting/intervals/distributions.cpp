#include "fitting/intervals/distributions.hpp"

#include <cmath>
#include <limits>

namespace jostle::inline fitting {

namespace {

// Continued fraction of the incomplete beta function, modified Lentz: Abramowitz & Stegun 26.5.8.
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  const auto guarded = [](double v) { return std::abs(v) < tiny ? tiny : v; };
  double c = 1, d = 1 / guarded(1 - (a + b) * x / (a + 1)), h = d;
  for (int m = 1; m <= 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / guarded(1 + even * d);
    c = guarded(1 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / guarded(1 + odd * d);
    c = guarded(1 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return h;
}

// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front = std::exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * std::log(x) +
                                b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
  return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

// The value at which a falling tail probability equals `wanted`.
template <typename Tails>
double solve_tails(double wanted, Tails tails) {
  double low = 0, high = 1;
  while (tails(high) > wanted && high < 1e300) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (tails(middle) > wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

double normal_tails(double z) {
  return std::erfc(std::abs(z) / std::sqrt(2.0));
}

double student_tails(double t, double dof) {
  return incomplete_beta(0.5 * dof, 0.5, dof / (dof + t * t));
}

double fisher_tail(double f, double dof_1, double dof_2) {
  return incomplete_beta(0.5 * dof_2, 0.5 * dof_1, dof_2 / (dof_2 + dof_1 * f));
}

// Q(a, x), a = dof / 2: the series of P below a + 1 (Abramowitz & Stegun 6.5.29), the continued
// fraction by the modified Lentz method above (6.5.31).
double chi_squared_tail(double x, double dof) {
  const double a = 0.5 * dof, y = 0.5 * x;
  if (y <= 0) return 1;
  const double front = std::exp(a * std::log(y) - y - log_gamma(a));
  if (y < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10'000 && term > 1e-16 * sum; ++n) sum += term *= y / (a + n);
    return 1 - front * sum;
  }
  double b = y + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 10'000; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = 1 / (numerator * d + b);
    c = b + numerator / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return front * h;
}

double normal_two_sided(double level) {
  return solve_tails(1 - level, [](double z) { return normal_tails(z); });
}

double student_two_sided(double level, double dof) {
  return solve_tails(1 - level, [dof](double t) { return student_tails(t, dof); });
}

double two_sided(double level, double dof) {
  return std::isfinite(dof) ? student_two_sided(level, dof) : normal_two_sided(level);
}

double half_width(double error, double dof, double level) {
  return dof > 0 ? error * two_sided(level, dof) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jostle::inline fitting
