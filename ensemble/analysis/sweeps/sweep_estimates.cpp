#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/numbers.hpp"
#include "ensemble/analysis/sweeps/sweep_curve.hpp"
#include "ensemble/statistics/finite_text.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/solver/polynomial.hpp"

namespace jostle::inline ensemble {

namespace {

/// A number that is linear in the values of a curve's points.
using Combination = std::vector<double>;  // [n_points]

Combination sum_of(const Combination& a, double factor, const Combination& b) {
  Combination sum = a;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * b[i];
  return sum;
}

double value_of(const Combination& combination, const std::vector<double>& y) {
  double sum = 0;
  for (std::size_t i = 0; i < y.size(); ++i) sum += combination[i] * y[i];
  return sum;
}

/// A polynomial fitted to points first .. first + points - 1.
struct LinearFit {
  double origin = 0, scale = 1;             // origin of the powers
  std::vector<Combination> coefficients{};  // [coefficients][n_points]
};

LinearFit linear_fit(const SweepCurve& curve, std::size_t first, std::size_t points,
                     std::size_t coefficients) {
  const auto x = std::span(curve.x()).subspan(first, points);
  const std::vector<double> all_weights = curve.weights();
  const auto weights = std::span(all_weights).subspan(first, points);
  LinearFit fit{.origin = 0.5 * (x.front() + x.back()), .scale = 0.5 * (x.back() - x.front())};
  fit.coefficients.assign(coefficients, Combination(curve.n_points(), 0.0));
  for (std::size_t i = 0; i < points; ++i) {
    std::vector<double> unit(points, 0.0);
    unit[i] = 1;
    const auto c = polynomial_fit(x, unit, weights, coefficients, fit.origin, fit.scale);
    for (std::size_t k = 0; k < coefficients; ++k) fit.coefficients[k][first + i] = c[k];
  }
  return fit;
}

// The points about the largest y, as many on both sides as the ends allow.
std::size_t first_of_window(const std::vector<double>& y, std::size_t points) {
  const auto top = static_cast<std::size_t>(std::ranges::max_element(y) - y.begin());
  const std::size_t n_below = points / 2;
  return std::min(top > n_below ? top - n_below : 0, y.size() - points);
}

std::size_t different_values(std::span<const double> ascending) {
  std::size_t n = ascending.empty() ? 0 : 1;
  for (std::size_t i = 1; i < ascending.size(); ++i) n += ascending[i] != ascending[i - 1];
  return n;
}

/// First and last of the points that no other is known to exceed: the highest of the truth is among
/// them with 95 %.
std::pair<std::size_t, std::size_t> possibly_highest(const SweepCurve& curve) {
  const std::size_t n = curve.n_points();
  const double level = significance_level / static_cast<double>(n - 1);
  const auto is_exceeded = [&](std::size_t i) {
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || curve.fitted_y()[j] <= curve.fitted_y()[i]) continue;
      Combination difference(n, 0.0);
      difference[j] = 1;
      difference[i] = -1;
      const double both_sides =
          p_value(value_of(difference, curve.fitted_y()), curve.error_of(difference));
      if (0.5 * both_sides < level) return true;
    }
    return false;
  };
  std::size_t first = 0, last = n - 1;
  while (is_exceeded(first)) ++first;
  while (is_exceeded(last)) --last;
  return {first, last};
}

/// Probability that chance makes a straight line through points first .. last rise (sign 1) or fall
/// (sign -1) like this one; 1 where they have no slope, NaN without a test.
double p_of_slope(const SweepCurve& curve, std::size_t first, std::size_t last, double sign) {
  const std::size_t points = last + 1 - first;
  if (different_values(std::span(curve.x()).subspan(first, points)) < 2) return 1;
  const Combination slope = linear_fit(curve, first, points, 2).coefficients[1];
  const double value = value_of(slope, curve.fitted_y());
  const double both_sides = p_value(value, curve.error_of(slope));
  return sign * value > 0 ? 0.5 * both_sides : 1 - 0.5 * both_sides;
}

std::string realizations_of(const SweepCurve& curve) {
  if (!curve.has_realizations()) return {};
  const auto [least, most] = std::ranges::minmax(curve.count());
  const std::string range =
      least == most ? fmt::to_string(most) : fmt::format("{} to {}", least, most);
  return fmt::format(" with {} {}", range, most == 1 ? "realization" : "realizations");
}

/// Words of a verdict for an extremum and for the curve on both sides of it.
struct ExtremumWords {
  const char *extremum, *end_value, *slope_before, *slope_behind, *bend;
};
constexpr ExtremumWords of_maximum{"maximum", "largest", "rises", "falls", "down"};
constexpr ExtremumWords of_minimum{"minimum", "least", "falls", "rises", "up"};

/// For a curve whose extremum is its maximum: a minimum's is reflected.
std::string verdict_of(const SweepCurve& curve, const SweepExtremum& found,
                       const ExtremumWords& words) {
  if (std::isnan(found.p)) {
    return fmt::format("cannot decide: there are no errors to test a {} by", words.extremum);
  }
  const std::string test = p_text(found.p) + ", two-lines test";
  if (found.found()) {
    const bool open = std::isnan(found.x_low) || std::isnan(found.x_high);
    return fmt::format("found inside the sweep: the curve {} to it and {} behind it ({}){}",
                       words.slope_before, words.slope_behind, test,
                       open ? "; the 95 % interval of its place, by a test of its own, reaches an "
                              "end of the sweep"
                            : "");
  }
  const auto& y = curve.fitted_y();
  const auto top = std::ranges::max_element(y);
  if (top == y.begin() || top + 1 == y.end()) {
    return fmt::format("none found: the {} value is at an end of the sweep ({})", words.end_value,
                       test);
  }
  const std::string reason =
      std::isnan(found.x)
          ? fmt::format("the points about the {} value do not bend {}", words.end_value, words.bend)
          : fmt::format("no {} is established, chance alone often gives one", words.extremum);
  return fmt::format("cannot decide{}: {} ({})", realizations_of(curve), reason, test);
}

// F of the squares about a line: their sum over what the errors of the residuals make of it.
void test_line(const SweepCurve& curve, const LinearFit& fit, StraightLine& line) {
  const std::vector<double> weights = curve.weights();
  const double dof = static_cast<double>(curve.n_points()) - 2;
  double squares = 0, expected = 0, uncertain = 0;
  for (std::size_t i = 0; i < curve.n_points(); ++i) {
    const double u = (curve.x()[i] - fit.origin) / fit.scale;
    Combination residual = sum_of(fit.coefficients[0], u, fit.coefficients[1]);
    for (double& c : residual) c = -c;
    residual[i] += 1;
    const ErrorOf error = curve.error_of(residual);
    if (!error.known()) return;
    squares += std::pow(weights[i] * value_of(residual, curve.fitted_y()), 2);
    const double variance = std::pow(weights[i] * error.error, 2);
    expected += variance;
    uncertain += variance * variance / error.dof;
  }
  if (!(dof > 0) || !(expected > 0)) return;
  // One pooled variance, or several of their own (Satterthwaite).
  const double dof_of_errors = curve.pools() ? curve.pooled().dof : expected * expected / uncertain;
  line.reduced_chi2 = squares / expected;
  line.p = fisher_tail(line.reduced_chi2, dof, std::min(dof_of_errors, 1e6));
}

// Without errors of the points: from the scatter about the line.
ErrorOf scatter_error(const SweepCurve& curve, const LinearFit& fit,
                      const Combination& combination) {
  const double dof = static_cast<double>(curve.n_points()) - 2;
  if (!(dof > 0)) return {};
  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < curve.n_points(); ++i) {
    const double u = (curve.x()[i] - fit.origin) / fit.scale;
    const Combination fitted = sum_of(fit.coefficients[0], u, fit.coefficients[1]);
    squares += std::pow(curve.fitted_y()[i] - value_of(fitted, curve.fitted_y()), 2);
    sum += combination[i] * combination[i];
  }
  return {std::sqrt(squares / dof * sum), dof};
}

SweepExtremum highest(const SweepCurve& curve, std::size_t points, const ExtremumWords& words) {
  SweepExtremum found{
      .x = not_a_number,
      .y = not_a_number,
      .x_low = not_a_number,
      .x_high = not_a_number,
      .p = not_a_number,
      .verdict = "cannot decide: fewer than three different strengths have a value"};
  points = std::min(std::max<std::size_t>(points, 3), curve.n_points());
  if (points < 3) return found;
  const std::vector<double>& y = curve.fitted_y();
  const std::size_t first = first_of_window(y, points);
  if (different_values(std::span(curve.x()).subspan(first, points)) < 3) return found;
  found.points = points;
  const LinearFit parabola = linear_fit(curve, first, points, 3);
  const double bend = value_of(parabola.coefficients[2], y);
  const double vertex = -0.5 * value_of(parabola.coefficients[1], y) / bend;
  // The top is where y is largest: each point between the ends could have been it.
  const auto top = static_cast<std::size_t>(std::ranges::max_element(y) - y.begin());
  const auto places = static_cast<double>(curve.n_points() - 2);
  const double p_before = p_of_slope(curve, first, top, 1);
  const double p_behind = p_of_slope(curve, top, first + points - 1, -1);
  const bool has_errors = curve.error_of(parabola.coefficients[1]).known();
  if (has_errors && (p_before == 1 || p_behind == 1))
    found.p = 1;  // at an end of the window, whatever the other side
  else if (!std::isnan(p_before) && !std::isnan(p_behind))
    found.p = std::min(1.0, places * std::max(p_before, p_behind));
  if (bend < 0 && std::abs(vertex) <= 1) {
    const Combination height =
        sum_of(sum_of(parabola.coefficients[0], vertex, parabola.coefficients[1]), vertex * vertex,
               parabola.coefficients[2]);
    found.x = parabola.origin + parabola.scale * vertex;
    found.y = value_of(height, y);
  }
  // Where it may be none, its interval is no interval.
  if (found.found()) {
    const auto [lowest, highest] = possibly_highest(curve);
    if (lowest > 0) found.x_low = curve.x()[lowest - 1];
    if (highest + 1 < curve.n_points()) found.x_high = curve.x()[highest + 1];
  }
  found.verdict = verdict_of(curve, found, words);
  return found;
}

}  // namespace

SweepExtremum maximum(const SweepCurve& curve, std::size_t points) {
  return highest(curve, points, of_maximum);
}

SweepExtremum minimum(const SweepCurve& curve, std::size_t points) {
  SweepExtremum found = highest(curve.reflected(), points, of_minimum);
  found.y = -found.y;
  return found;
}

StraightLine straight_line(const SweepCurve& curve) {
  StraightLine line{not_a_number, not_a_number, {}, {}, not_a_number, not_a_number};
  if (different_values(curve.x()) < 2) return line;
  const LinearFit fit = linear_fit(curve, 0, curve.n_points(), 2);
  Combination slope = fit.coefficients[1];
  for (double& c : slope) c /= fit.scale;
  const Combination intercept = sum_of(fit.coefficients[0], -fit.origin, slope);
  line.slope = value_of(slope, curve.fitted_y());
  line.intercept = value_of(intercept, curve.fitted_y());
  line.slope_error = curve.error_of(slope);
  line.intercept_error = curve.error_of(intercept);
  if (line.slope_error.known() && line.slope_error.error > 0) {
    test_line(curve, fit, line);
  } else {
    line.slope_error = scatter_error(curve, fit, slope);
    line.intercept_error = scatter_error(curve, fit, intercept);
  }
  return line;
}

}  // namespace jostle::inline ensemble
