#include "fitting/limit_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fitting/binned_curve.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/intervals/fit_errors.hpp"
#include "fitting/intervals/fit_statistics.hpp"
#include "fitting/intervals/profile.hpp"
#include "fitting/numbers.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double unnoticed = 0.01;  // rise of the cost, in variances of a residual
constexpr double rounding = 1e-14;  // rounding of a residual, relative to the data

std::optional<std::size_t> index_of(const Model& model, const std::string& name) {
  const std::vector<Parameter>& all = model.parameters();
  const auto found = std::ranges::find(all, name, &Parameter::name);
  if (found == all.end()) return std::nullopt;
  return static_cast<std::size_t>(found - all.begin());
}

std::optional<FitOptions> options_at(const Limit& limit, const FitOptions& options) {
  FitOptions inner = options;
  inner.start.reset();
  inner.multi_start = true;
  inner.limits = false;
  for (const auto& [name, value] : options.fixed) {
    if (!index_of(*limit.law, name)) return std::nullopt;
  }
  return inner;
}

bool inside(const Model& model, const ParameterValues& p) {
  for (std::size_t j = 0; j < p.size(); ++j) {
    const Parameter& parameter = model.parameters()[j];
    if (!std::isfinite(p[j]) || !(p[j] > parameter.lower && p[j] < parameter.upper)) return false;
  }
  return true;
}

// Times of a curve that are above 0.
std::pair<double, double> times(const Curve& curve) {
  double first = infinite, last = 0;
  for (const double t : curve.t) {
    if (t > 0) first = std::min(first, t);
    last = std::max(last, t);
  }
  return last > 0 ? std::pair{first, last} : std::pair{1.0, 1.0};
}

double squared_norm(const Curve& curve) {
  double sum = 0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double term = curve.sigma.empty() ? curve.x[i] : curve.x[i] / curve.sigma[i];
    sum += term * term;
  }
  return sum;
}

// The residuals that rounding leaves where a law meets the curve.
double exact_cost(const Curve& curve) {
  return rounding * rounding * squared_norm(curve);
}

// The law near its limit, with the limits that a curve sets to what has no value there.
class NearLimit {
 public:
  NearLimit(const Model& model, const Limit& limit, const Curve& curve, const FitOptions& options,
            const Fit& found)
      : model_(model),
        limit_(limit),
        curve_(with_pooled_errors(curve)),
        searched_(binned(curve_)),
        options_(options),
        found_(found),
        at_limit_(found.values()) {
    for (const Parameter& parameter : model.parameters()) {
      free_.push_back(!options.fixed.contains(parameter.name));
    }
  }

  /// Parameters within the accuracy of the curve; empty where none are known.
  ParameterValues place() {
    if (!limit_.near) return {};
    const auto [first, last] = times(curve_);
    cost_ = linear_problem(*limit_.law, searched_, at_limit_, limit_free()).residuals.squaredNorm();
    for (distance_ = 1e2; distance_ < 1e9; distance_ *= 10) {
      const ParameterValues p = limit_.near(at_limit_, distance_, first, last);
      if (!inside(model_, p)) continue;
      const double cost = linear_problem(model_, searched_, p, free_).residuals.squaredNorm();
      if (!(cost <= cost_ + 0.1 * unnoticed * variance())) continue;
      // The law may lie below its limit by as much as was not noticed.
      cost_ -= unnoticed * variance();
      return p;
    }
    return {};
  }

  /// Closes the intervals of parameter j, which the limit does not have, on the side that leads
  /// away from the limit.
  void bound(const ParameterValues& place, std::size_t j, Estimate& estimate) const {
    const auto [first, last] = times(curve_);
    const ParameterValues beyond = limit_.near(at_limit_, 10 * distance_, first, last);
    if (beyond[j] == place[j]) return;
    const int inward = beyond[j] > place[j] ? -1 : 1;
    const auto profiled = profiled_from(place, j, std::abs(place[j]), inward);
    if (!profiled) return;
    for (int level = 0; level < 2; ++level) {
      Interval& interval = estimate.intervals[level];
      if (inward < 0) interval.lower = profiled->intervals[level].lower;
      if (inward > 0) interval.upper = profiled->intervals[level].upper;
    }
  }

  /// Widens the intervals of parameter j, which the limit has, to what the law allows away from it.
  void widen(const ParameterValues& place, std::size_t j, Estimate& estimate) const {
    const auto profiled = profiled_from(place, j, estimate.error, 0);
    for (int level = 0; profiled && level < 2; ++level) {
      Interval& interval = estimate.intervals[level];
      interval.lower = std::min(interval.lower, profiled->intervals[level].lower);
      interval.upper = std::max(interval.upper, profiled->intervals[level].upper);
    }
  }

 private:
  // Errors are inflated as they are where the law has begun to differ from its limit.
  std::optional<ParameterProfile> profiled_from(const ParameterValues& place, std::size_t j,
                                                double error, int side) const {
    const auto [first, last] = times(curve_);
    const ParameterValues start_values = limit_.near(at_limit_, 1e2, first, last);
    if (!inside(model_, start_values)) return std::nullopt;
    Fit counts = found_;
    LinearProblem linear = linear_problem(model_, curve_, start_values, free_);
    if (!linear.jacobian.allFinite()) return std::nullopt;
    linear.curvature = nullptr;  // this is beside the minimum
    const DependentErrors errors = dependent_errors(curve_, linear, options_.memory, counts);
    const auto variable =
        std::count(free_.begin(), free_.begin() + static_cast<std::ptrdiff_t>(j), true);
    ProfileProblem problem{model_, searched_,       place,
                           free_,  cost_,           variance(),
                           {0, 0}, options_.solver, errors.level_weight};
    for (int level = 0; level < 2; ++level) {
      problem.thresholds[level] = std::sqrt(errors.inflation[variable]) *
                                  two_sided(interval_levels[level], found_.error_dof);
    }
    const ParameterProfile profiled = profile(problem, j, error, side);
    if (profiled.better) return std::nullopt;
    return profiled;
  }

  double variance() const { return found_.sigma_given ? 1 : found_.reduced_chi2; }
  std::vector<bool> limit_free() const {
    std::vector<bool> free;
    for (const Estimate& estimate : found_.estimates) {
      free.push_back(estimate.identifiability != Identifiability::fixed);
    }
    return free;
  }

  const Model& model_;
  const Limit& limit_;
  const Curve curve_, searched_;
  const FitOptions& options_;
  const Fit& found_;
  ParameterValues at_limit_;
  std::vector<bool> free_;
  double cost_ = 0, distance_ = 0;
};

// Covariances of the parameters that both laws have; the others vary without limit.
void restore_covariance(const Model& model, const Limit& limit, const Fit& found, Fit& fit) {
  const auto n = static_cast<Eigen::Index>(model.parameters().size());
  fit.covariance = Eigen::MatrixXd::Zero(n, n);
  fit.correlation = Eigen::MatrixXd::Identity(n, n);
  const auto place = [&](Eigen::Index i) {
    return index_of(*limit.law, model.parameters()[static_cast<std::size_t>(i)].name);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto a = place(i);
    if (!a) fit.covariance(i, i) = infinite;
    for (Eigen::Index j = 0; a && j < n; ++j) {
      const auto b = place(j);
      if (!b) continue;
      const auto row = static_cast<Eigen::Index>(*a), column = static_cast<Eigen::Index>(*b);
      fit.covariance(i, j) = found.covariance(row, column);
      fit.correlation(i, j) = found.correlation(row, column);
    }
  }
}

// "B and tau"
std::string listed_limits(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  }
  return text;
}

}  // namespace

std::vector<LimitCandidate> limit_candidates(const Model& model, const Curve& curve,
                                             const FitOptions& options) {
  std::vector<LimitCandidate> candidates;
  for (const Limit& limit : model.limits()) {
    const auto inner = options_at(limit, options);
    if (!inner) continue;
    FitOptions quick = *inner;
    quick.profiles = quick.memory = false;
    const auto outcome = fit(*limit.law, curve, quick);
    const auto* found = std::get_if<Fit>(&outcome);
    if (!found || !std::isfinite(found->residual_sum)) continue;
    candidates.push_back({limit, *inner, found->residual_sum, found->dof});
    // No law is lower, and those of more parameters would crawl towards this one.
    if (found->residual_sum <= exact_cost(with_pooled_errors(curve))) break;
  }
  return candidates;
}

const LimitCandidate* reached(const std::vector<LimitCandidate>& candidates, const Curve& source,
                              std::optional<double> cost, std::size_t dof) {
  if (candidates.empty()) return nullptr;
  const Curve curve = with_pooled_errors(source);
  double allowed = exact_cost(curve);
  if (cost && dof > 0) {
    const double variance = curve.sigma.empty() ? *cost / static_cast<double>(dof) : 1;
    allowed = std::max(allowed, *cost + unnoticed * variance);
  }
  const auto found = std::ranges::find_if(
      candidates, [&](const LimitCandidate& candidate) { return candidate.cost <= allowed; });
  return found == candidates.end() ? nullptr : &*found;
}

std::variant<Fit, Refusal> fit_at_limit(const Model& model, const Curve& curve,
                                        const FitOptions& options,
                                        const LimitCandidate& candidate) {
  const Limit& limit = candidate.limit;
  auto outcome = fit(*limit.law, curve, candidate.options);
  if (!std::holds_alternative<Fit>(outcome)) return outcome;
  const Fit found = std::get<Fit>(std::move(outcome));
  Fit fit = found;
  fit.model = model.name();
  fit.formula = model.formula();
  fit.source = model.source();
  fit.estimates.clear();
  NearLimit near(model, limit, curve, options, found);
  const ParameterValues place = near.place();
  const bool examined = std::ranges::any_of(found.estimates, [](const Estimate& estimate) {
    return estimate.identifiability > Identifiability::not_examined;
  });
  const bool profiled = examined && found.reason != EndReason::exact && !place.empty();
  std::vector<std::string> lost;
  for (std::size_t j = 0; j < model.parameters().size(); ++j) {
    const Parameter& parameter = model.parameters()[j];
    if (const auto shared = index_of(*limit.law, parameter.name)) {
      fit.estimates.push_back(found.estimates[*shared]);
      fit.estimates.back().parameter = parameter;
      if (profiled && fit.estimates.back().identifiability > Identifiability::not_examined) {
        near.widen(place, j, fit.estimates.back());
      }
      continue;
    }
    lost.push_back(parameter.name);
    Estimate estimate;
    estimate.parameter = parameter;
    estimate.value = place.empty() ? infinite : place[j];
    estimate.error = estimate.standard_error = infinite;
    estimate.identifiability = Identifiability::not_identifiable;
    for (Interval& interval : estimate.intervals) interval = {-infinite, infinite};
    if (profiled) near.bound(place, j, estimate);
    fit.estimates.push_back(std::move(estimate));
  }
  if (examined) {
    take_errors_of_intervals(fit, fit.estimates);
    judge_estimates(curve, fit.estimates);
  }
  for (const Estimate& estimate : found.estimates) {
    if (!index_of(model, estimate.parameter.name)) fit.combinations.push_back(estimate);
  }
  restore_covariance(model, limit, found, fit);
  fit.limit = {limit.law->name(), limit.law->formula(),
               "The sum of squared residuals of " + model.name() + " is smallest at its limit " +
                   limit.law->formula() + ": " + limit.approach +
                   ". The data determine this law of " + std::to_string(found.n_free) +
                   (found.n_free == 1 ? " parameter" : " parameters") + ", and not " +
                   listed_limits(lost) + (lost.size() > 1 ? " separately." : "."),
               limit.law, found.estimates};
  fit.remarks.insert(fit.remarks.begin(), fit.limit->statement);
  return fit;
}

}  // namespace jostle::inline fitting
