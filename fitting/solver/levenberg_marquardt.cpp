#include "fitting/solver/levenberg_marquardt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fitting/solver/decompositions.hpp"
#include "fitting/solver/trust_step.hpp"

namespace jostle::inline fitting {

namespace {

// The second-order correction is added where twice its length is at most this part of the step.
constexpr double largest_acceleration = 0.03;

class Descent {
 public:
  Descent(const Residuals& residuals, const SolverOptions& options)
      : residuals_(residuals), options_(options) {}

  Minimum run(const Eigen::VectorXd& start);

 private:
  bool evaluate_all(const Eigen::VectorXd& x);
  bool evaluate(const Eigen::VectorXd& x);
  void update_scale();
  double scaled_length(const Eigen::VectorXd& v) const { return v.cwiseProduct(scale_).norm(); }
  Eigen::VectorXd accelerated(const TrustStep& steps, const Eigen::VectorXd& step);
  /// One Jacobian: shortens the step until one is taken. False where the descent is over.
  bool iterate();
  bool try_step(TrustStep& steps);
  void take(const Eigen::VectorXd& x);
  void polish();
  bool spent() const { return options_.budget && options_.budget->spent(); }
  void spend(Eigen::Index n) {
    if (options_.budget) options_.budget->spend(n);
  }
  bool finish(EndReason reason) {
    current_.reason = reason;
    return false;
  }

  const Residuals& residuals_;
  const SolverOptions& options_;
  Minimum current_;
  Eigen::VectorXd trial_r_;
  Eigen::VectorXd scale_;
  double radius_ = 0;
  bool stepped_ = false;  // true if the last try_step moved
};

bool Descent::evaluate_all(const Eigen::VectorXd& x) {
  residuals_.values_and_jacobian(x, current_.r, current_.jacobian);
  ++current_.evaluations;
  ++current_.jacobian_evaluations;
  spend(1 + residuals_.n_variables());
  return current_.r.allFinite() && current_.jacobian.allFinite() &&
         std::isfinite(current_.r.squaredNorm());
}

bool Descent::evaluate(const Eigen::VectorXd& x) {
  residuals_.values(x, trial_r_);
  ++current_.evaluations;
  spend(1);
  return trial_r_.allFinite() && std::isfinite(trial_r_.squaredNorm());
}

// A column of zeros gets the smallest scale of the others: its variable is free to move.
void Descent::update_scale() {
  Eigen::VectorXd norms = current_.jacobian.colwise().norm().transpose();
  const double largest = norms.maxCoeff();
  if (scale_.size() == 0) {
    scale_ = Eigen::VectorXd::Zero(norms.size());
  } else if (options_.scaling == StepScaling::first) {
    return;
  }
  for (Eigen::Index j = 0; j < norms.size(); ++j) {
    double floor = std::max(largest * 1e-16, std::numeric_limits<double>::min());
    if (options_.scaling == StepScaling::largest) floor = std::max(floor, scale_[j]);
    if (options_.scaling == StepScaling::current) floor = std::max(floor, 0.1 * scale_[j]);
    scale_[j] = std::max(norms[j], floor);
  }
}

// r along x + h v has the second derivative r_vv in h; half the step that undoes it is added.
Eigen::VectorXd Descent::accelerated(const TrustStep& steps, const Eigen::VectorXd& step) {
  constexpr double h = 0.1;
  if (!evaluate(current_.x + h * step)) return step;
  const Eigen::VectorXd first_derivative = current_.jacobian * step;
  const Eigen::VectorXd second = (2 / h) * ((trial_r_ - current_.r) / h - first_derivative);
  const Eigen::VectorXd correction = 0.5 * steps.damped(second);
  const double length = scaled_length(correction);
  if (!(2 * length <= largest_acceleration * scaled_length(step))) return step;
  return step + correction;
}

void Descent::take(const Eigen::VectorXd& x) {
  current_.x = x;
  current_.r = trial_r_;
  current_.cost = current_.r.squaredNorm();
}

bool Descent::try_step(TrustStep& steps) {
  stepped_ = false;
  Eigen::VectorXd step = steps.step_within(radius_);
  const double linear_length = scaled_length(step);
  if (!step.allFinite() || linear_length == 0) return finish(EndReason::no_progress);
  const double damping = steps.lambda() * linear_length * linear_length;
  const double predicted = (steps.linear_change(step) + 2 * damping) / current_.cost;
  const bool small = predicted <= options_.cost_tolerance;
  const bool short_step = linear_length <= options_.step_tolerance * scaled_length(current_.x);
  if (options_.geodesic_acceleration && !small) step = accelerated(steps, step);

  const Eigen::VectorXd x = current_.x + step;
  const bool finite = x.allFinite() && evaluate(x);
  const double cost = finite ? trial_r_.squaredNorm() : std::numeric_limits<double>::infinity();
  const double gain = finite ? (current_.cost - cost) / current_.cost : -1;
  const double ratio = predicted > 0 ? gain / predicted : 0;
  if (ratio < 0.25) {
    radius_ = (gain >= 0 ? 0.5 : 0.25) * std::min(radius_, linear_length);
  } else if (ratio > 0.75 || steps.lambda() == 0) {
    radius_ = std::max(radius_, 2 * linear_length);
  }
  if (ratio > 1e-4) {
    take(x);
    stepped_ = true;
  }
  if (small && gain <= options_.cost_tolerance) return finish(EndReason::cost);
  if (short_step) return finish(EndReason::step);
  if (radius_ <= std::numeric_limits<double>::epsilon() * 1e-3 * scaled_length(current_.x)) {
    return finish(EndReason::no_progress);
  }
  return true;
}

bool Descent::iterate() {
  if (!evaluate_all(current_.x)) return finish(EndReason::no_progress);
  ++current_.iterations;
  update_scale();
  if (current_.iterations == 1) {
    const double length = scaled_length(current_.x);
    radius_ = options_.first_radius * (length > 0 ? length : 1);
  }
  if (std::sqrt(current_.cost) <= options_.exact_tolerance * options_.data_norm ||
      current_.cost == 0) {
    return finish(EndReason::exact);
  }
  TrustStep steps(current_.jacobian, current_.r, scale_);
  if (steps.gradient_cosine() <= options_.gradient_tolerance) return finish(EndReason::gradient);
  do {
    if (spent()) return finish(EndReason::budget);
    if (!try_step(steps)) return false;
  } while (!stepped_);
  return true;
}

// The cost is blind below sqrt(epsilon) of the errors, the gradient is not: undamped steps, as long
// as they shrink. Where the residuals are large these converge as a geometric series: once two
// steps in line show its ratio, the rest of it is taken at once.
void Descent::polish() {
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * options_.data_norm;
  Eigen::VectorXd last;
  double last_length = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 30; ++i) {
    if (!evaluate_all(current_.x)) return;
    scale_ = current_.jacobian.colwise().norm().transpose();
    if (!(scale_.minCoeff() > 0)) return;
    TrustStep steps(current_.jacobian, current_.r, scale_);
    if (!steps.full_rank()) return;
    Eigen::VectorXd step = steps.step_within(std::numeric_limits<double>::infinity());
    const double change = steps.linear_change(step) / current_.cost;
    const double length = scaled_length(step);
    if (change > 1e-6 || change < 1e-27 || !(length < 0.97 * last_length)) return;
    const double ratio = last.size() > 0 ? step.dot(last) / last.squaredNorm() : 0;
    const bool in_line =
        ratio > 0 && ratio < 0.97 && (step - ratio * last).norm() < 0.1 * step.norm();
    last = step;
    last_length = length;
    if (in_line) {
      step /= 1 - ratio;
      last.resize(0);
    }
    const Eigen::VectorXd x = current_.x + step;
    if (!x.allFinite() || !evaluate(x)) return;
    if (trial_r_.squaredNorm() > current_.cost * (1 + 1e-10) + rounding * std::sqrt(current_.cost))
      return;
    take(x);
    ++current_.iterations;
  }
}

Minimum Descent::run(const Eigen::VectorXd& start) {
  current_.x = start;
  current_.r.resize(residuals_.n_residuals());
  trial_r_.resize(residuals_.n_residuals());
  current_.jacobian.resize(residuals_.n_residuals(), residuals_.n_variables());
  current_.jacobian.setZero();
  if (!start.allFinite() || !evaluate(start)) {
    current_.cost = std::numeric_limits<double>::infinity();
    return current_;
  }
  take(start);
  current_.reason = EndReason::iteration_limit;
  while (current_.iterations < options_.max_iterations && iterate()) {
  }
  if (options_.polish && is_minimum(current_.reason) && current_.reason != EndReason::exact)
    polish();
  // r and J belong to x, whichever step was the last.
  evaluate_all(current_.x);
  return current_;
}

// A minimum where every variable still matters.
bool settled(const Minimum& minimum) {
  if (!is_minimum(minimum.reason)) return false;
  const Eigen::VectorXd norms = minimum.jacobian.colwise().norm().transpose();
  if (!(norms.minCoeff() > 0)) return false;
  return column_rank(minimum.jacobian * norms.cwiseInverse().asDiagonal()) == minimum.x.size();
}

}  // namespace

const char* describe(EndReason reason) {
  switch (reason) {
    case EndReason::gradient:
      return "gradient: the residuals are orthogonal to the Jacobian";
    case EndReason::step:
      return "step: too short to matter";
    case EndReason::cost:
      return "cost: the gain is too small to matter";
    case EndReason::exact:
      return "exact: the residuals are rounding";
    case EndReason::no_progress:
      return "no progress: no step lowers the cost";
    case EndReason::iteration_limit:
      return "limit of iterations reached";
    case EndReason::budget:
      return "limit of evaluations reached";
    case EndReason::not_finite:
      return "not finite: the model has no value at the start";
  }
  return "";
}

bool is_minimum(EndReason reason) {
  return reason == EndReason::gradient || reason == EndReason::step || reason == EndReason::cost ||
         reason == EndReason::exact;
}

Minimum minimise(const Residuals& residuals, const Eigen::VectorXd& start,
                 const SolverOptions& options) {
  Minimum best = Descent(residuals, options).run(start);
  const auto ended = [&] {
    return best.reason == EndReason::not_finite || best.reason == EndReason::budget ||
           settled(best);
  };
  if (!options.fallbacks || ended()) return best;
  // A descent that ran to infinity or got stuck: other step lengths lead elsewhere.
  SolverOptions fallbacks[] = {options, options, options};
  fallbacks[0].geodesic_acceleration = !options.geodesic_acceleration;
  fallbacks[1].first_radius = 0.1 * options.first_radius;
  fallbacks[2].scaling = StepScaling::first;
  fallbacks[2].first_radius = 10 * options.first_radius;
  int number = 0;
  for (const SolverOptions& fallback : fallbacks) {
    Minimum next = Descent(residuals, fallback).run(start);
    next.fallback = ++number;
    const bool better = next.cost < best.cost * (1 - 1e-9);
    const int iterations = best.iterations + next.iterations;
    const int evaluations = best.evaluations + next.evaluations;
    const int jacobians = best.jacobian_evaluations + next.jacobian_evaluations;
    if (better) best = std::move(next);
    best.iterations = iterations;
    best.evaluations = evaluations;
    best.jacobian_evaluations = jacobians;
    if (settled(best) || (options.budget && options.budget->spent())) break;
  }
  return best;
}

}  // namespace jostle::inline fitting
