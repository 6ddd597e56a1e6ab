#include "fitting/intervals/student_intervals.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/intervals/distributions.hpp"
#include "fitting/intervals/profile.hpp"
#include "fitting/numbers.hpp"
#include "fitting/solver/curve_residuals.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double shape_level =
    0.01;                           // level per pair of variables of the test for scatter in shape
constexpr double agreement = 0.25;  // tolerance of two ends, in distances to the value

// The farthest end in the variable.
double farthest(const Curve& curve, const Estimate& estimate, const Transform& transform) {
  if (!transform.is_identity()) return reach_of_logarithm;
  if (estimate.parameter.unit != ParameterUnit::value) return infinite;
  const auto [low, high] = std::minmax_element(curve.x.begin(), curve.x.end());
  return reach_of_values * std::max(*high - *low, std::abs(estimate.value));
}

}  // namespace

bool realizations_differ_in_shape(const DependentErrors& errors, const Fit& fit) {
  const double dof = errors.dof;
  if (fit.n_realizations == 0 || !(dof > 0) || !std::isfinite(dof)) return false;
  const Eigen::MatrixXd& path = errors.independent;
  for (Eigen::Index held = 0; held < path.cols(); ++held) {
    for (Eigen::Index second = 0; second < path.rows(); ++second) {
      const double slope = path(second, held) / path(held, held);
      const double ratio =
          slope * slope * errors.covariance(held, held) / errors.covariance(second, second);
      if (second != held && ratio > 1 && fisher_tail(ratio, dof, dof) < shape_level) return true;
    }
  }
  return false;
}

void use_student_intervals(const Curve& curve, double dof, Estimate& estimate) {
  const Transform transform(estimate.parameter);
  const double middle = transform.to_variable(estimate.value);
  const double error = estimate.error / std::abs(transform.slope(middle));
  const double reach = farthest(curve, estimate, transform);
  if (!(error > 0) || !std::isfinite(error) || !std::isfinite(middle)) return;
  Interval student[2];
  double distance = 0;
  for (int level = 0; level < 2; ++level) {
    distance = two_sided(interval_levels[level], dof) * error;
    student[level] = {-infinite, infinite};
    if (distance > reach) continue;
    const double lower = transform.to_parameter(middle - distance);
    const double upper = transform.to_parameter(middle + distance);
    student[level] = {std::min(lower, upper), std::max(lower, upper)};
  }
  const auto agrees = [&](double profiled, double end) {
    const double difference = transform.to_variable(profiled) - transform.to_variable(end);
    return std::isfinite(profiled) && std::abs(difference) <= agreement * distance;
  };
  const Interval& profiled = estimate.intervals[1];
  if (agrees(profiled.lower, student[1].lower) && agrees(profiled.upper, student[1].upper)) return;
  std::copy(std::begin(student), std::end(student), std::begin(estimate.intervals));
}

}  // namespace jostle::inline fitting
