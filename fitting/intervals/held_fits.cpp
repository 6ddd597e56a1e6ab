#include "fitting/intervals/held_fits.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/numbers.hpp"
#include "fitting/solver/grid.hpp"
#include "fitting/solver/projection.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double edge = 1e-3;      // how near two parameters in order come, relatively
constexpr double far_away = 100;   // in largest values of X
constexpr double rounding = 1e-6;  // negligible rounding of a value, in errors of the curve

double largest_size(const Curve& curve) {
  const auto [low, high] = std::minmax_element(curve.x.begin(), curve.x.end());
  return std::max(std::abs(*low), std::abs(*high));
}

// The size of a value whose own rounding is felt beside the errors of the curve.
double rounded_size(const ProfileProblem& problem) {
  const Curve& curve = problem.curve;
  double weights = 0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    weights += curve.sigma.empty() ? 1 : 1 / (curve.sigma[i] * curve.sigma[i]);
  }
  const double error = std::sqrt(problem.variance * static_cast<double>(curve.x.size()) / weights);
  return std::max(rounding * error / std::numeric_limits<double>::epsilon(),
                  far_away * largest_size(curve));
}

}  // namespace

Coordinate::Coordinate(const ProfileProblem& problem, std::size_t index, bool plain)
    : transform_(plain ? Parameter{} : problem.model.parameters()[index]) {
  if (plain || !transform_.is_identity()) return;
  if (problem.model.parameters()[index].unit != ParameterUnit::value) return;
  const auto [low, high] = std::minmax_element(problem.curve.x.begin(), problem.curve.x.end());
  far_ = std::abs(problem.minimum[index]) > far_away * largest_size(problem.curve);
  scale_ = *high - *low;
}

HeldFits::HeldFits(const ProfileProblem& problem, std::size_t index, double direction,
                   const Coordinate& coordinate)
    : problem_(problem),
      index_(index),
      direction_(direction),
      coordinate_(coordinate),
      centre_(coordinate_.to_variable(problem.minimum[index])),
      free_(problem.free),
      largest_(rounded_size(problem)),
      ordered_(problem.model.canonical(problem.minimum) == problem.minimum),
      noticeable_(0.01 * problem.thresholds[0]) {
  free_[index] = false;
}

// Along the line from the minimum through `start_fit`, in variables.
ParameterValues HeldFits::line(double distance, const HeldFit& start_fit) const {
  ParameterValues p = start_fit.p;
  for (std::size_t j = 0; j < p.size() && start_fit.distance > 0; ++j) {
    if (!free_[j]) continue;
    const Transform transform(problem_.model.parameters()[j]);
    const double start = transform.to_variable(problem_.minimum[j]);
    const double rate = (transform.to_variable(start_fit.p[j]) - start) / start_fit.distance;
    const double extrapolated = transform.to_parameter(start + rate * distance);
    // Far out the line means nothing.
    if (distance < 3 * start_fit.distance && std::isfinite(extrapolated)) p[j] = extrapolated;
  }
  return p;
}

ParameterValues HeldFits::interpolated(double distance, const HeldFit& low,
                                       const HeldFit& high) const {
  ParameterValues p = low.p;
  const double share = (distance - low.distance) / (high.distance - low.distance);
  for (std::size_t j = 0; j < p.size(); ++j) {
    const Transform transform(problem_.model.parameters()[j]);
    const double start = transform.to_variable(low.p[j]);
    const double extrapolated =
        transform.to_parameter(start + share * (transform.to_variable(high.p[j]) - start));
    if (free_[j] && std::isfinite(extrapolated)) p[j] = extrapolated;
  }
  return p;
}

// The linear parameters solved for, the others as they are.
ParameterValues HeldFits::solved(double distance, ParameterValues p) const {
  p[index_] = parameter(distance);
  ParameterValues fixed = p;
  for (std::size_t j = 0; j < p.size(); ++j) {
    if (free_[j]) fixed[j] = std::numeric_limits<double>::quiet_NaN();
  }
  ParameterValues q = p;
  return std::isfinite(Projection(problem_.model, problem_.curve, fixed, problem_.level_weight)(q))
             ? q
             : p;
}

// With the parameters in `free` fitted anew, from one guess.
HeldFit HeldFits::held(double distance, const ParameterValues& guess,
                       const std::vector<bool>& free) const {
  HeldFit point{distance, infinite, false, guess};
  const CurveResiduals residuals(problem_.model, problem_.curve, guess, free,
                                 problem_.level_weight);
  double cost = infinite;
  if (residuals.n_variables() == 0) {
    Eigen::VectorXd r(residuals.n_residuals());
    residuals.values(Eigen::VectorXd(0), r);
    cost = r.squaredNorm();
    point.settled = true;
  } else {
    SolverOptions options = problem_.solver;
    options.fallbacks = false;
    options.cost_tolerance = 1e-10;
    options.polish = false;
    options.data_norm = residuals.data_norm();
    const Minimum minimum = minimise(residuals, residuals.to_variables(guess), options);
    cost = minimum.cost;
    point.settled = is_minimum(minimum.reason);
    if (std::isfinite(cost)) point.p = residuals.to_parameters(minimum.x);
  }
  point.settled = point.settled && std::isfinite(cost) && has_digits(point.p);
  const double rise = (cost - problem_.cost) / problem_.variance;
  if (std::isfinite(cost)) point.z = rise < 0 ? -std::sqrt(-rise) : std::sqrt(rise);
  return point;
}

HeldFit HeldFits::descend(double distance, ParameterValues guess) {
  guess[index_] = parameter(distance);
  if (!std::isfinite(guess[index_])) return {distance, infinite, false, guess};
  HeldFit point = in_order(held(distance, guess, free_));
  // Lower by what the thresholds could notice: the minimum was not one.
  const bool is_lower = point.z < -1e-2 * problem_.thresholds[0];
  if (problem_.seek_better && is_lower && has_digits(point.p)) better_ = point.p;
  point.z = std::max(point.z, 0.0);
  return point;
}

// The point with its parameters in the law's order, where those of the minimum are. A fit that ends
// in another order is free to, so its z is not too high, but it may be too low: then the order's
// edge counts, the parameter that would change places with this one beside it.
HeldFit HeldFits::in_order(HeldFit point) const {
  const Model& model = problem_.model;
  const ParameterValues ordered = model.canonical(point.p);
  if (!ordered_ || ordered == point.p) return point;
  if (ordered[index_] == point.p[index_]) {
    point.p = ordered;
    return point;
  }
  if (point.settled && point.z >= problem_.thresholds[1]) return point;
  for (std::size_t partner = 0; partner < point.p.size(); ++partner) {
    if (!free_[partner] || ordered[partner] != point.p[index_]) continue;
    std::vector<bool> free = free_;
    free[partner] = false;
    for (const double ratio : {1 - edge, 1 + edge}) {
      ParameterValues guess = point.p;
      guess[partner] = ratio * guess[index_];
      if (model.canonical(guess) == guess) {
        return held(point.distance, solved(point.distance, guess), free);
      }
    }
  }
  return {point.distance, infinite, false, point.p};
}

// True if no term of the model is so large that the curve is its rounding.
bool HeldFits::has_digits(const ParameterValues& p) const {
  for (std::size_t j = 0; j < p.size(); ++j) {
    const Parameter& parameter = problem_.model.parameters()[j];
    if (parameter.linear && parameter.unit == ParameterUnit::value && std::abs(p[j]) > largest_)
      return false;
  }
  return true;
}

// Takes over what is lower, or as low and settled.
bool HeldFits::improve(HeldFit& point, const HeldFit& candidate) const {
  const bool lower = candidate.z < point.z - noticeable_;
  const bool as_low =
      candidate.z <= point.z + 0.01 * noticeable_ && candidate.settled && !point.settled;
  if (lower || as_low || (candidate.z < point.z && candidate.settled)) point = candidate;
  return lower;
}

// From the model's own starts with this parameter held.
void HeldFits::search(HeldFit& fit) {
  ParameterValues fixed = problem_.minimum;
  for (std::size_t j = 0; j < fixed.size(); ++j) {
    if (free_[j]) fixed[j] = std::numeric_limits<double>::quiet_NaN();
  }
  fixed[index_] = parameter(fit.distance);
  if (std::none_of(free_.begin(), free_.end(), [](bool free) { return free; })) return;
  int agreeing = 0;
  // A grid of all nonlinear parameters is the expensive one, and few points suffice to distinguish
  // its nodes.
  const bool all_nonlinear = problem_.model.parameters()[index_].linear;
  const Curve sample = all_nonlinear ? thinned(problem_.curve, 32) : problem_.curve;
  EvaluationBudget* const budget = problem_.solver.budget;
  if (budget) {
    if (budget->spent()) return;
    const double share =
        static_cast<double>(sample.t.size()) / static_cast<double>(problem_.curve.t.size());
    budget->left -= std::llround(
        share * static_cast<double>(evaluations_of_starts(problem_.model, sample, fixed)));
  }
  for (ParameterValues& start : problem_.model.starts(sample, fixed, 8)) {
    const HeldFit candidate = descend(fit.distance, std::move(start));
    agreeing =
        candidate.z < fit.z - noticeable_ ? 0 : agreeing + (candidate.z < fit.z + noticeable_);
    improve(fit, candidate);
    if (agreeing == 1 || (budget && budget->spent())) break;
  }
}

// A fit from the neighbour nearer to the minimum. z is continuous: one that does not settle, or
// jumps, has lost its way, and is sought from elsewhere.
HeldFit HeldFits::fit_at(double distance, const HeldFit& start_fit, const HeldFit* beyond) {
  const double allowed = beyond ? std::max(beyond->z, start_fit.z) + noticeable_
                                : start_fit.z + 0.75 * problem_.thresholds[1];
  HeldFit point = descend(
      distance, beyond ? interpolated(distance, start_fit, *beyond) : line(distance, start_fit));
  if (beyond) {
    // The one beyond may be on another branch of z, which is the higher one here.
    const double share = (distance - start_fit.distance) / (beyond->distance - start_fit.distance);
    const double bend = (point.z - start_fit.z) - (share + 0.1) * (beyond->z - start_fit.z);
    if (bend > 0) improve(point, fit_beside(distance, start_fit));
  }
  const auto astray = [&] { return !better_ && (!point.settled || point.z > allowed); };
  if (astray()) improve(point, descend(distance, solved(distance, start_fit.p)));
  if (astray()) improve(point, descend(distance, start_fit.p));
  if (astray() && beyond) improve(point, descend(distance, solved(distance, beyond->p)));
  if (astray()) search(point);
  return point;
}

}  // namespace jostle::inline fitting
