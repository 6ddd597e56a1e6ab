#include "fitting/intervals/profile.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/intervals/held_fits.hpp"
#include "fitting/numbers.hpp"
#include "fitting/solver/bounds.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double reach_of_errors = 1e4;
constexpr double flat = 0.01;  // rise of z over the last half of the way, in thresholds

// z as a function of the distance on one side. An end of an interval is closed by a settled fit
// alone, and where z rises to it without a jump.
class Side {
 public:
  Side(const ProfileProblem& problem, std::size_t index, double direction,
       const Coordinate& coordinate)
      : problem_(problem), index_(index), fits_(problem, index, direction, coordinate) {}

  /// Fills the ends of the intervals on this side; infinite where nothing closes one. `step`: about
  /// one standard error in the coordinate.
  void find_ends(double step, double ends[2]);
  const std::optional<ParameterValues>& better() const { return fits_.better(); }

 private:
  double reach(double& step) const;
  double room() const;
  std::vector<HeldFit> march(double step);
  void revise(std::vector<HeldFit>& points, const HeldFit& found);
  double crossing(HeldFit low, HeldFit high, double threshold);
  bool is_flat_before(double distance, const std::vector<HeldFit>& points, double threshold);

  const ProfileProblem& problem_;
  std::size_t index_;
  HeldFits fits_;
};

// Illinois variant of false position: z is close to linear in u.
double Side::crossing(HeldFit low, HeldFit high, double threshold) {
  double distance = high.distance;
  double f_low = low.z - threshold, f_high = high.z - threshold;
  // The march meets the end of linear laws at its first step, where the sign of f is rounding.
  constexpr double equal = 1e-9;
  for (const HeldFit& end : {low, high}) {
    if (end.settled && std::abs(end.z - threshold) <= equal * threshold) return end.distance;
  }
  for (int i = 0; i < 60; ++i) {
    const double width = high.distance - low.distance;
    distance = low.distance - f_low * width / (f_high - f_low);
    distance = std::clamp(distance, low.distance + 1e-3 * width, high.distance - 1e-3 * width);
    if (width <= 1e-7 * high.distance) break;
    const HeldFit point = fits_.fit_at(distance, low, &high);
    const double f = point.z - threshold;
    if (fits_.better() || (point.settled && std::abs(f) <= 1e-6 * threshold)) return distance;
    if (f < 0) {
      low = point;
      f_low = f;
      f_high *= 0.5;
    } else if (point.settled) {
      high = point;
      f_high = f;
      f_low *= 0.5;
    } else {
      return infinite;
    }
  }
  // A jump is no end: one of its sides is not the least cost.
  return high.z - low.z < 0.1 * threshold ? distance : infinite;
}

// Tests if z is nearly level where it passes the threshold: half as far out it is as high within
// `flat`. The place of such an end rests on digits of chi2 that mean nothing.
bool Side::is_flat_before(double distance, const std::vector<HeldFit>& points, double threshold) {
  const bool logarithmic = fits_.coordinate().is_logarithmic();
  const double half = logarithmic ? distance - std::log(2.0) : 0.5 * distance;
  if (!(half > 0)) return false;
  const auto next =
      std::ranges::find_if(points, [&](const HeldFit& point) { return point.distance >= half; });
  if (next == points.begin() || next == points.end()) return false;
  if (std::prev(next)->z < (1 - flat) * threshold && next->z < (1 - flat) * threshold) {
    return false;
  }
  const HeldFit previous = *std::prev(next), beyond = *next;
  const HeldFit point = fits_.fit_at(half, previous, &beyond);
  return point.settled && point.z > (1 - flat) * threshold;
}

// The distance to a bound ahead that the coordinate does not know.
double Side::room() const {
  constexpr double left = 1e-9;
  const Parameter& parameter = problem_.model.parameters()[index_];
  const double value = problem_.minimum[index_];
  return (1 - left) * (fits_.direction() > 0 ? parameter.upper - value : value - parameter.lower);
}

// How far a side is explored.
double Side::reach(double& step) const {
  if (fits_.coordinate().is_logarithmic()) {
    step = std::min(step, 1.0);
    if (!fits_.coordinate().is_far()) return reach_of_logarithm;
    const double end = fits_.coordinate().to_variable(fits_.largest());
    return std::max(fits_.direction() * fits_.centre() > 0 ? end - std::abs(fits_.centre())
                                                           : end + std::abs(fits_.centre()),
                    0.0);
  }
  const Parameter& parameter = problem_.model.parameters()[index_];
  if (parameter.unit != ParameterUnit::value) {
    return std::min(reach_of_errors * std::max(step, std::abs(fits_.centre())), room());
  }
  // A standard error can be anything where the problem is degenerate; the curve's range cannot.
  const auto [low, high] = std::minmax_element(problem_.curve.x.begin(), problem_.curve.x.end());
  step = std::min(step, *high - *low);
  return std::min(reach_of_values * std::max(*high - *low, std::abs(fits_.centre())), room());
}

// Where a search met a lower branch of z, the points before it may belong to the higher one.
void Side::revise(std::vector<HeldFit>& points, const HeldFit& found) {
  const HeldFit* source = &found;
  for (std::size_t i = points.size() - 1; i > 0 && !fits_.better(); --i) {
    if (!fits_.improve(points[i], fits_.fit_beside(points[i].distance, *source))) {
      return;
    }
    source = &points[i];
  }
}

// Searches outwards until z has passed both thresholds, or to the end of the range.
std::vector<HeldFit> Side::march(double step) {
  const double end = reach(step);
  const double last_threshold = problem_.thresholds[1];
  std::vector<HeldFit> points = {{0, 0, true, problem_.minimum}};
  int retries = 0;
  const EvaluationBudget* const budget = problem_.solver.budget;
  while (points.back().distance < end && !fits_.better() && !(budget && budget->spent())) {
    const HeldFit& last = points.back();
    HeldFit next = fits_.fit_at(std::min(last.distance + step, end), last);
    const bool outside = next.z >= last_threshold;
    // Too far to be a neighbour of the last: its fit may have gone astray.
    if ((next.z > last.z + 2 * last_threshold || (outside && !next.settled)) && retries < 20) {
      step *= 0.3;
      ++retries;
      continue;
    }
    if (outside && !fits_.better()) {
      const HeldFit unsearched = next;
      fits_.search(next);
      if (next.z < unsearched.z - fits_.noticeable()) revise(points, next);
    }
    if (next.z - points.back().z < 0.5 * problem_.thresholds[0]) step *= 2;
    if (fits_.coordinate().is_logarithmic()) step = std::min(step, 2.0);
    const bool passed = next.z >= last_threshold;
    points.push_back(std::move(next));
    if (passed) break;
  }
  return points;
}

void Side::find_ends(double step, double ends[2]) {
  const std::vector<HeldFit> points = march(step);
  for (int level = 0; level < 2 && !fits_.better(); ++level) {
    const double threshold = problem_.thresholds[level];
    const auto inside = std::find_if(points.rbegin(), points.rend(),
                                     [&](const HeldFit& point) { return point.z < threshold; });
    if (inside == points.rend()) continue;  // no threshold that is a positive number
    const auto outside = std::find_if(inside.base(), points.end(),
                                      [](const HeldFit& point) { return point.settled; });
    if (outside == points.end()) continue;
    const double distance = crossing(*inside, *outside, threshold);
    if (!std::isfinite(distance) || is_flat_before(distance, points, threshold)) continue;
    ends[level] = fits_.parameter(distance);
  }
}

// The ends on both sides; all of z must be more than rounding.
ParameterProfile resolved_profile(const ProfileProblem& problem, std::size_t index, double error,
                                  int only) {
  ParameterProfile result;
  const Surroundings minimum{problem.model, problem.curve, problem.cost, problem.variance,
                             problem.level_weight};
  const auto near = near_bound(minimum, problem.minimum, index);
  for (double direction : {-1.0, 1.0}) {
    double ends[2] = {direction * infinite, direction * infinite};
    if (only != 0 && direction * only < 0) continue;
    // Away from a bound that the curve does not distinguish from the minimum, a logarithm would not
    // come to what the curve resolves.
    const bool leaves_bound =
        near && direction == near->direction && near->distance < least_resolved * near->resolved;
    const Coordinate coordinate(problem, index, leaves_bound);
    const double slope = std::abs(coordinate.slope(coordinate.to_variable(problem.minimum[index])));
    const double wanted = leaves_bound ? near->resolved : error / slope;
    const double step = std::clamp(wanted, std::numeric_limits<double>::min(), 1e300);
    // Below a bound from above, u and p run against each other.
    const bool reversed = coordinate.slope(0) < 0;
    Side side(problem, index, reversed ? -direction : direction, coordinate);
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
  // Where fits in between did not settle, 68 % may be open; what 95 % allow includes it.
  Interval& wide = result.intervals[1];
  wide.lower = std::min(wide.lower, result.intervals[0].lower);
  wide.upper = std::max(wide.upper, result.intervals[0].upper);
  return result;
}

// The rounding of a cost, in variances of a residual: relative to the cost itself, and of residuals
// that are differences of data.
double rounding_of_cost(const ProfileProblem& problem) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const CurveResiduals residuals(problem.model, problem.curve, problem.minimum, problem.free,
                                 problem.level_weight);
  const double of_data = epsilon * residuals.data_norm();
  const double root = std::sqrt(problem.cost);
  return (8 * epsilon * root * root + 2 * of_data * root + of_data * of_data) / problem.variance;
}

}  // namespace

// Where a rise of the cost by the thresholds would be lost in its rounding, the errors are tiny and
// the cost is quadratic far beyond them: the profile of longer errors, shortened.
ParameterProfile profile(const ProfileProblem& problem, std::size_t index, double error, int only) {
  constexpr double resolved = 1e-5;
  const double factor = rounding_of_cost(problem) / resolved;
  if (!(factor > 1) || !std::isfinite(factor)) return resolved_profile(problem, index, error, only);
  ProfileProblem longer = problem;
  longer.variance *= factor;
  ParameterProfile found = resolved_profile(longer, index, std::sqrt(factor) * error, only);
  const double value = problem.minimum[index];
  for (Interval& interval : found.intervals) {
    interval.lower = value + (interval.lower - value) / std::sqrt(factor);
    interval.upper = value + (interval.upper - value) / std::sqrt(factor);
  }
  return found;
}

}  // namespace jostle::inline fitting
