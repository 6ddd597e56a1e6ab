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
        centre_(transform_.to_variable(problem.minimum[index])) {}

  /// Fills the ends of the intervals on this side. `step`: about one standard error of u.
  void find_ends(double step, double ends[2]);
  const std::optional<ParameterValues>& better() const { return better_; }

 private:
  /// A fit with the parameter held at `distance` from the minimum.
  struct Point {
    double distance, z;
    ParameterValues p;
  };
  Point at(double distance, const Point& from);
  ParameterValues guess(double distance, const Point& from) const;
  double parameter(double distance) const {
    return transform_.to_parameter(centre_ + direction_ * distance);
  }
  std::vector<Point> march(double step);
  double crossing(Point low, Point high, double threshold);

  const ProfileProblem& problem_;
  std::size_t index_;
  double direction_;
  Transform transform_;
  double centre_;
  std::optional<ParameterValues> better_;
};

// Along the line from the minimum through `from`, in variables.
ParameterValues Side::guess(double distance, const Point& from) const {
  ParameterValues p = from.p;
  for (std::size_t j = 0; j < p.size() && from.distance > 0; ++j) {
    if (!problem_.free[j]) continue;
    const Transform transform(problem_.model.parameters()[j]);
    const double start = transform.to_variable(problem_.minimum[j]);
    const double rate = (transform.to_variable(from.p[j]) - start) / from.distance;
    const double there = transform.to_parameter(start + rate * distance);
    // Far out the line means nothing.
    if (distance < 3 * from.distance && std::isfinite(there)) p[j] = there;
  }
  p[index_] = parameter(distance);
  return p;
}

Side::Point Side::at(double distance, const Point& from) {
  std::vector<bool> free = problem_.free;
  free[index_] = false;
  const ParameterValues values = guess(distance, from);
  Point point{distance, infinite, values};
  if (!std::isfinite(values[index_])) return point;
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
    if (std::isfinite(cost)) point.p = residuals.to_parameters(held.x);
  }
  if (!std::isfinite(cost)) return point;
  const double rise = (cost - problem_.cost) / problem_.variance;
  // Lower by what the thresholds could notice: the minimum was not one.
  if (rise < -1e-4 * problem_.thresholds[0] * problem_.thresholds[0]) better_ = point.p;
  point.z = std::sqrt(std::max(rise, 0.0));
  return point;
}

// Illinois variant of false position: z is close to linear in u.
double Side::crossing(Point low, Point high, double threshold) {
  double distance = high.distance;
  double f_low = low.z - threshold, f_high = high.z - threshold;
  for (int i = 0; i < 60; ++i) {
    const double width = high.distance - low.distance;
    distance = std::isfinite(f_high) ? low.distance - f_low * width / (f_high - f_low)
                                     : low.distance + 0.5 * width;
    distance = std::clamp(distance, low.distance + 1e-3 * width, high.distance - 1e-3 * width);
    if (width <= 1e-7 * high.distance) break;
    const Point point = at(distance, low);
    const double f = point.z - threshold;
    if (std::abs(f) <= 1e-6 * threshold || better_) break;
    if (f < 0) {
      low = point;
      f_low = f;
      f_high *= 0.5;
    } else {
      high = point;
      f_high = f;
      f_low *= 0.5;
    }
  }
  return distance;
}

// Outwards until z has passed both thresholds, or as far as it is of interest.
std::vector<Side::Point> Side::march(double step) {
  const bool logarithmic = !transform_.is_identity();
  double reach = reach_of_logarithm;
  if (!logarithmic) reach = reach_of_errors * std::max(step, std::abs(centre_));
  if (!logarithmic && problem_.model.parameters()[index_].unit == ParameterUnit::value) {
    // A standard error can be anything where the problem is degenerate; the curve's range cannot.
    const auto [low, high] = std::minmax_element(problem_.curve.x.begin(), problem_.curve.x.end());
    reach = reach_of_errors * std::max(*high - *low, std::abs(centre_));
    step = std::min(step, *high - *low);
  }
  if (logarithmic) step = std::min(step, 1.0);
  std::vector<Point> points = {{0, 0, problem_.minimum}};
  int retries = 0;
  while (points.back().z < problem_.thresholds[1] && points.back().distance < reach && !better_) {
    const Point& last = points.back();
    Point next = at(std::min(last.distance + step, reach), last);
    // Too far to be a neighbour of the last: its fit may have gone astray.
    if (next.z > last.z + 2 * problem_.thresholds[1] && retries < 20) {
      step *= 0.3;
      ++retries;
      continue;
    }
    if (next.z - last.z < 0.5 * problem_.thresholds[0]) step *= 2;
    if (logarithmic) step = std::min(step, 2.0);
    points.push_back(std::move(next));
  }
  return points;
}

void Side::find_ends(double step, double ends[2]) {
  const std::vector<Point> points = march(step);
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
  // Where two parameters run away together the fits along a profile do not all settle, and an end
  // is a little uncertain; but what 95 % allow includes what 68 % do.
  Interval& wide = result.intervals[1];
  wide.lower = std::min(wide.lower, result.intervals[0].lower);
  wide.upper = std::max(wide.upper, result.intervals[0].upper);
  return result;
}

}  // namespace jostle
