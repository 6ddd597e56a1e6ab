#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "engine/random.hpp"
#include "ensemble/jackknife.hpp"
#include "ensemble/moments.hpp"
#include "ensemble/sweep_curve.hpp"
#include "fitting/polynomial.hpp"

namespace jostle {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int drawn_curves = 1000;
constexpr double doubtful_below = 0.95;

using Pair = std::array<double, 2>;  // two numbers read off a curve, with their errors
using Estimator = std::function<Pair(const std::vector<double>& y)>;

std::vector<double> weights_of(const SweepCurve& curve) {
  std::vector<double> weights(curve.n_points(), 1.0);
  if (!curve.errors_known()) return weights;
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = 1 / curve.error()[i];
  return weights;
}

// Of a group's estimates without one of its realizations each. A lone realization says nothing of
// its scatter: the error is known only where the estimate does without it.
double error_of_group(std::span<const double> left_out) {
  if (left_out.size() == 1) return std::isnan(left_out[0]) ? not_a_number : 0;
  return jackknife_error(left_out);
}

// Leaving out one of a group of n, the groups being independent of each other.
Pair jackknife_errors(const SweepCurve& curve, const Estimator& estimator) {
  Pair variance = {0, 0};
  const auto groups = curve.left_out();
  if (groups.empty()) return {not_a_number, not_a_number};
  for (const auto& group : groups) {
    std::array<std::vector<double>, 2> estimates;
    for (const std::vector<double>& y : group) {
      const Pair found = estimator(y);
      for (std::size_t k = 0; k < 2; ++k) estimates[k].push_back(found[k]);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const double error = error_of_group(estimates[k]);
      variance[k] += error * error;
    }
  }
  return {std::sqrt(variance[0]), std::sqrt(variance[1])};
}

double standard_normal(RandomStream& random) {
  const double radius = std::sqrt(-2 * std::log(random.uniform()));
  return radius * std::cos(2 * M_PI * random.uniform());
}

struct Drawn {
  Pair errors = {not_a_number, not_a_number};  // deviation over curves with an estimate
  double share = not_a_number;                 // of those curves
};

Drawn drawn(const SweepCurve& curve, const Estimator& estimator) {
  if (!curve.errors_known()) return {};
  RandomStream random(stream_key(1, 0, 0, Purpose::resampling));
  std::array<Moments, 2> moments;
  for (int i = 0; i < drawn_curves; ++i) {
    std::vector<double> y = curve.y();
    for (std::size_t k = 0; k < y.size(); ++k) y[k] += curve.error()[k] * standard_normal(random);
    const Pair found = estimator(y);
    for (std::size_t k = 0; k < 2; ++k) moments[k].add(found[k]);
  }
  return {.errors = {moments[0].sigma(), moments[1].sigma()},
          .share = static_cast<double>(moments[0].count()) / drawn_curves};
}

// The points about the largest y, as many on both sides as the ends allow.
std::size_t first_of_window(const SweepCurve& curve, std::size_t points) {
  const auto top =
      static_cast<std::size_t>(std::ranges::max_element(curve.y()) - curve.y().begin());
  const std::size_t below = points / 2;
  return std::min(top > below ? top - below : 0, curve.n_points() - points);
}

// The vertex of the parabola through points first .. first + points - 1, NaN where it is no maximum
// between them.
Pair vertex(const SweepCurve& curve, std::span<const double> weights, std::size_t first,
            std::size_t points, const std::vector<double>& y) {
  const auto x = std::span(curve.x()).subspan(first, points);
  const double origin = 0.5 * (x.front() + x.back()), scale = 0.5 * (x.back() - x.front());
  const std::vector<double> c = polynomial_fit(x, std::span(y).subspan(first, points),
                                               weights.subspan(first, points), 3, origin, scale);
  const double at = -0.5 * c[1] / c[2];
  if (!(c[2] < 0) || !(std::abs(at) <= 1)) return {not_a_number, not_a_number};
  return {origin + scale * at, c[0] + 0.5 * c[1] * at};
}

std::size_t different_values(const std::vector<double>& ascending) {
  std::size_t n = ascending.empty() ? 0 : 1;
  for (std::size_t i = 1; i < ascending.size(); ++i) n += ascending[i] != ascending[i - 1];
  return n;
}

std::string verdict_of(const SweepCurve& curve, double x, double resolved) {
  if (std::isnan(x)) {
    const auto top = std::ranges::max_element(curve.y());
    const bool at_end = top == curve.y().begin() || top + 1 == curve.y().end();
    return at_end ? "no maximum inside: the largest value is at an end of the sweep"
                  : "no maximum: the points about the largest value do not bend down";
  }
  if (std::isnan(resolved)) return "maximum, without errors";
  if (resolved < doubtful_below) {
    return "doubtful: " + std::to_string(std::lround(100 * resolved)) +
           " % of curves drawn from the errors have a maximum there";
  }
  return "maximum";
}

}  // namespace

SweepMaximum maximum(const SweepCurve& curve, std::size_t points) {
  SweepMaximum found = {not_a_number,
                        not_a_number,
                        not_a_number,
                        not_a_number,
                        not_a_number,
                        0,
                        "fewer than three different strengths"};
  points = std::min(std::max<std::size_t>(points, 3), curve.n_points());
  if (points < 3) return found;
  const std::size_t first = first_of_window(curve, points);
  const auto window = std::span(curve.x()).subspan(first, points);
  if (different_values({window.begin(), window.end()}) < 3) return found;
  const std::vector<double> weights = weights_of(curve);
  const auto estimator = [&](const std::vector<double>& y) {
    return vertex(curve, weights, first, points, y);
  };
  const Pair top = estimator(curve.y());
  const Drawn draws = drawn(curve, estimator);
  const Pair errors = curve.has_realizations() ? jackknife_errors(curve, estimator) : draws.errors;
  const bool exists = !std::isnan(top[0]);
  found.x = top[0];
  found.y = top[1];
  found.x_error = exists ? errors[0] : not_a_number;
  found.y_error = exists ? errors[1] : not_a_number;
  found.resolved = draws.share;
  found.points = points;
  found.verdict = verdict_of(curve, top[0], draws.share);
  return found;
}

StraightLine straight_line(const SweepCurve& curve) {
  StraightLine line = {not_a_number, not_a_number, not_a_number, not_a_number, not_a_number};
  if (different_values(curve.x()) < 2) return line;
  const std::vector<double> weights = weights_of(curve);
  const Estimator estimator = [&](const std::vector<double>& y) -> Pair {
    const std::vector<double> c = polynomial_fit(curve.x(), y, weights, 2);
    return {c[0], c[1]};
  };
  const Pair found = estimator(curve.y());
  line.intercept = found[0];
  line.slope = found[1];
  double sum = 0, w = 0, wx = 0, wxx = 0;
  for (std::size_t i = 0; i < curve.n_points(); ++i) {
    const double x = curve.x()[i], square = weights[i] * weights[i];
    const double residual = weights[i] * (curve.y()[i] - found[0] - found[1] * x);
    sum += residual * residual;
    w += square;
    wx += square * x;
    wxx += square * x * x;
  }
  const auto dof = static_cast<double>(curve.n_points()) - 2;
  if (curve.errors_known() && dof > 0) line.reduced_chi2 = sum / dof;
  if (curve.has_realizations()) {
    const Pair errors = jackknife_errors(curve, estimator);
    line.intercept_error = errors[0];
    line.slope_error = errors[1];
    return line;
  }
  const double variance = curve.errors_known() ? 1 : dof > 0 ? sum / dof : not_a_number;
  const double determinant = w * wxx - wx * wx;
  line.intercept_error = std::sqrt(variance * wxx / determinant);
  line.slope_error = std::sqrt(variance * w / determinant);
  return line;
}

}  // namespace jostle
