#include "fitting/profile.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/curve_residuals.hpp"

namespace jostle {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double reach_of_logarithm = 13.8;  // a factor 10^6
constexpr double reach_of_errors = 1e4;

// z(u) = sqrt((cost with the parameter held at u - least cost) / variance) on one side.
class Side {
 public:
  Side(const ProfileProblem& problem, std::size_t index, double direction)
      : problem_(problem),
        index_(index),
        direction_(direction),
        transform_(problem.model.parameters()[index]),
        centre_(transform_.to_variable(problem.minimum[index])),
        nearest_(problem.minimum) {}

  /// Fills the ends of the intervals on this side. `step`: about one standard error of u.
  void find_ends(double step, double ends[2]);
  const std::optional<ParameterValues>& better() const { return better_; }

 private:
  struct Point {
    double distance, z;
  };
  double z_at(double distance);
  double parameter(double distance) const {
    return transform_.to_parameter(centre_ + direction_ * distance);
  }
  double crossing(Point low, Point high, double threshold);

  const ProfileProblem& problem_;
  std::size_t index_;
  double direction_;
  Transform transform_;
  double centre_;
  ParameterValues nearest_;  // the last fit: where the next begins
  std::optional<ParameterValues> better_;
};

double Side::z_at(double distance) {
  std::vector<bool> free = problem_.free;
  free[index_] = false;
  ParameterValues values = nearest_;
  values[index_] = parameter(distance);
  if (!std::isfinite(values[index_])) return infinite;
  const CurveResiduals residuals(problem_.model, problem_.curve, values, free);
  double cost = infinite;
  if (residuals.n_variables() == 0) {
    Eigen::VectorXd r(residuals.n_residuals());
    residuals.values(Eigen::VectorXd(0), r);
    cost = r.squaredNorm();
  } else {
    SolverOptions options = problem_.solver;
    options.fallbacks = false;
    options.cost_tolerance = 1e-10;
    options.polish = false;
    options.data_norm = residuals.data_norm();
    const Minimum held = minimise(residuals, residuals.to_variables(values), options);
    cost = held.cost;
    if (std::isfinite(cost)) nearest_ = residuals.to_parameters(held.x);
  }
  if (!std::isfinite(cost)) return infinite;
  const double rise = (cost - problem_.cost) / problem_.variance;
  // Lower by what the thresholds could notice: the minimum was not one.
  if (rise < -1e-4 * problem_.thresholds[0] * problem_.thresholds[0]) better_ = nearest_;
  return std::sqrt(std::max(rise, 0.0));
}

// Illinois variant of false position: z is close to linear in u.
double Side::crossing(Point low, Point high, double threshold) {
  double at = high.distance;
  double f_low = low.z - threshold, f_high = high.z - threshold;
  for (int i = 0; i < 60; ++i) {
    const double width = high.distance - low.distance;
    at = std::isfinite(f_high) ? low.distance - f_low * width / (f_high - f_low)
                               : low.distance + 0.5 * width;
    at = std::clamp(at, low.distance + 1e-3 * width, high.distance - 1e-3 * width);
    if (width <= 1e-7 * high.distance) break;
    const double f = z_at(at) - threshold;
    if (std::abs(f) <= 1e-6 * threshold || better_) break;
    if (f < 0) {
      low.distance = at;
      f_low = f;
      f_high *= 0.5;
    } else {
      high.distance = at;
      f_high = f;
      f_low *= 0.5;
    }
  }
  return at;
}

void Side::find_ends(double step, double ends[2]) {
  const double reach = transform_.is_identity()
                           ? reach_of_errors * std::max(step, std::abs(centre_))
                           : reach_of_logarithm;
  if (!transform_.is_identity()) step = std::min(step, 1.0);
  std::vector<Point> points = {{0, 0}};
  while (points.back().z < problem_.thresholds[1] && points.back().distance < reach && !better_) {
    const double distance = std::min(points.back().distance + step, reach);
    const double z = z_at(distance);
    if (z - points.back().z < 0.5 * problem_.thresholds[0]) step *= 2;
    if (!transform_.is_identity()) step = std::min(step, 2.0);
    points.push_back({distance, z});
  }
  for (int level = 0; level < 2 && !better_; ++level) {
    const double threshold = problem_.thresholds[level];
    const auto above = std::find_if(points.begin(), points.end(),
                                    [&](const Point& point) { return point.z >= threshold; });
    ends[level] = above == points.end() ? direction_ * infinite
                                        : parameter(crossing(*(above - 1), *above, threshold));
  }
}

}  // namespace

ParameterProfile profile(const ProfileProblem& problem, std::size_t index, double error) {
  ParameterProfile result;
  const Transform transform(problem.model.parameters()[index]);
  const double slope = std::abs(transform.slope(transform.to_variable(problem.minimum[index])));
  const double step = std::clamp(error / slope, std::numeric_limits<double>::min(), 1e300);
  for (double direction : {-1.0, 1.0}) {
    double ends[2] = {-infinite, infinite};
    // Below a bound from above, u and p run against each other.
    const bool reversed = transform.slope(0) < 0;
    Side side(problem, index, reversed ? -direction : direction);
    side.find_ends(step, ends);
    for (int level = 0; level < 2; ++level) {
      if (!std::isfinite(ends[level])) ends[level] = direction * infinite;
      (direction < 0 ? result.intervals[level].lower : result.intervals[level].upper) = ends[level];
    }
    if (side.better()) {
      result.better = side.better();
      break;
    }
  }
  return result;
}

}  // namespace jostle
