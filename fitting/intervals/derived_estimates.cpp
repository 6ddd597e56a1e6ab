#include "fitting/intervals/derived_estimates.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/intervals/distributions.hpp"
#include "fitting/intervals/fit_errors.hpp"
#include "fitting/intervals/fit_statistics.hpp"
#include "fitting/intervals/profile.hpp"
#include "fitting/intervals/student_intervals.hpp"
#include "fitting/models/combination.hpp"
#include "fitting/numbers.hpp"

namespace jostle::inline fitting {

namespace {

// The minimum in the parameters of another model.
struct Rewritten {
  const Model& model;
  ParameterValues values;
  std::vector<bool> free;
};

// Parameter `index` of the other model with its error, and its intervals where they are profiled.
// Errors rest on what those of the fit do.
Estimate estimate_in(const Rewritten& rewritten, std::size_t index, const FittedCurveOf& fitted,
                     const Fit& fit) {
  Fit counts = fit;
  const LinearProblem linear =
      linear_problem(rewritten.model, fitted.curve, rewritten.values, rewritten.free);
  Estimate estimate;
  estimate.parameter = rewritten.model.parameters()[index];
  estimate.value = rewritten.values[index];
  estimate.error = estimate.standard_error = infinite;
  for (Interval& interval : estimate.intervals) interval = {-infinite, infinite};
  if (!linear.jacobian.allFinite()) return estimate;
  const DependentErrors errors =
      dependent_errors(fitted.curve, linear, fitted.options.memory, counts);
  const auto variable = std::count(
      rewritten.free.begin(), rewritten.free.begin() + static_cast<std::ptrdiff_t>(index), true);
  const double slope = std::abs(linear.slopes[variable]);
  const double variance = fit.sigma_given ? 1 : fit.reduced_chi2;
  estimate.error = std::sqrt(errors.covariance(variable, variable)) * slope;
  estimate.standard_error =
      std::sqrt(inverse_normal(linear.jacobian).matrix(variable, variable) * variance) * slope;
  if (!fitted.has_intervals) return estimate;
  estimate.identifiability = Identifiability::identified;  // until judged
  double thresholds[2];
  for (int level = 0; level < 2; ++level) {
    thresholds[level] =
        std::sqrt(errors.inflation[variable]) * two_sided(interval_levels[level], fit.error_dof);
  }
  if (fit.reason == EndReason::exact && !fit.sigma_given) {
    for (int level = 0; level < 2; ++level) {
      const double reach = thresholds[level] * estimate.standard_error;
      estimate.intervals[level] = {estimate.value - reach, estimate.value + reach};
    }
    return estimate;
  }
  const ProfileProblem problem{rewritten.model,
                               fitted.searched,
                               rewritten.values,
                               rewritten.free,
                               fitted.cost,
                               variance,
                               {thresholds[0], thresholds[1]},
                               fitted.options.solver,
                               errors.level_weight};
  const ParameterProfile found = profile(problem, index, estimate.standard_error);
  if (!found.better) {
    estimate.intervals[0] = found.intervals[0];
    estimate.intervals[1] = found.intervals[1];
    if (fit.has_student_intervals) use_student_intervals(fitted.curve, fit.error_dof, estimate);
  }
  mark_unfinished(fitted.options.solver, estimate);
  return estimate;
}

bool inside(const Model& model, const ParameterValues& p) {
  for (std::size_t j = 0; j < p.size(); ++j) {
    const Parameter& parameter = model.parameters()[j];
    if (!std::isfinite(p[j]) || !(p[j] > parameter.lower && p[j] < parameter.upper)) return false;
  }
  return true;
}

// The free parameters of the equivalent law; none of them where a parameter is fixed that it
// does not have.
std::vector<bool> free_of(const Equivalent& equivalent, const std::vector<bool>& free) {
  std::vector<bool> theirs(equivalent.equal.size(), true);
  std::size_t kept = 0;
  for (std::size_t j = 0; j < theirs.size(); ++j) {
    if (!equivalent.equal[j] || free[*equivalent.equal[j]]) continue;
    theirs[j] = false;
    ++kept;
  }
  const auto fixed = static_cast<std::size_t>(std::count(free.begin(), free.end(), false));
  return fixed == kept ? theirs : std::vector<bool>();
}

}  // namespace

void add_combinations(const FittedCurveOf& fitted, Fit& fit) {
  if (!fitted.has_intervals) return;
  const auto loose = [&](std::size_t j) {
    return fitted.free[j] && fit.estimates[j].identifiability > Identifiability::wide;
  };
  for (const Combination& combination : fitted.model.combinations()) {
    if (!loose(combination.kept) || !loose(combination.partner)) continue;
    const CombinedModel model(fitted.model, combination);
    const Rewritten rewritten{model, model.combined(fitted.values), fitted.free};
    const double value = rewritten.values[combination.kept];
    if (!(value > 0) || !std::isfinite(value)) continue;
    Estimate estimate = estimate_in(rewritten, combination.kept, fitted, fit);
    if (estimate.intervals[1].closed()) fit.combinations.push_back(std::move(estimate));
  }
  take_errors_of_intervals(fit, fit.combinations);
  judge_estimates(fitted.curve, fit.combinations);
}

void add_restated(const FittedCurveOf& fitted, Fit& fit) {
  const auto equivalent = fitted.model.equivalent();
  if (!equivalent || !equivalent->law->refusal(fitted.curve).empty()) return;
  const Rewritten rewritten{*equivalent->law, equivalent->restate(fitted.values),
                            free_of(*equivalent, fitted.free)};
  const ParameterValues values = equivalent->restate(fit.values());
  if (rewritten.free.empty() || !inside(rewritten.model, rewritten.values) ||
      !inside(rewritten.model, values)) {
    return;
  }
  RestatedFit restated{
      rewritten.model.name(), rewritten.model.formula(), rewritten.model.source(), {}};
  for (std::size_t j = 0; j < rewritten.values.size(); ++j) {
    const auto equal = equivalent->equal[j];
    Estimate estimate = equal ? fit.estimates[*equal] : estimate_in(rewritten, j, fitted, fit);
    estimate.parameter = rewritten.model.parameters()[j];
    estimate.value = values[j];
    restated.estimates.push_back(std::move(estimate));
  }
  open_absurd_intervals(fitted.curve, fit, restated.estimates);
  take_errors_of_intervals(fit, restated.estimates);
  judge_estimates(fitted.curve, restated.estimates);
  fit.restated = std::move(restated);
}

}  // namespace jostle::inline fitting
