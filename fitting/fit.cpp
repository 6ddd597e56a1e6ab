#include "fitting/fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fitting/binned_curve.hpp"
#include "fitting/intervals/derived_estimates.hpp"
#include "fitting/intervals/distributions.hpp"
#include "fitting/intervals/fit_errors.hpp"
#include "fitting/intervals/fit_statistics.hpp"
#include "fitting/intervals/profile.hpp"
#include "fitting/intervals/student_intervals.hpp"
#include "fitting/limit_fit.hpp"
#include "fitting/numbers.hpp"
#include "fitting/solver/bounds.hpp"
#include "fitting/solver/curve_residuals.hpp"
#include "fitting/solver/grid.hpp"
#include "fitting/statements/refusal.hpp"
#include "fitting/statements/remarks.hpp"

namespace jostle::inline fitting {

namespace {

constexpr int most_attempts = 5;           // to find a minimum that no profile undercuts
constexpr std::size_t few_parameters = 5;  // most parameters of a law of the papers
constexpr double unset = std::numeric_limits<double>::quiet_NaN();

// One fit in the making.
class Fitter {
 public:
  Fitter(const Model& model, const Curve& curve, const FitOptions& options);

  /// False where the model has no finite value and slope at any start.
  bool search() { return descend_from_all(); }
  /// The sum of squares over all points at the minimum found.
  double cost_of_all_points() const;
  /// After search().
  Fit finish();
  /// The evaluations that the options allow for a law and a curve like these.
  long long allowed_evaluations() const;
  std::size_t n_free() const {
    return static_cast<std::size_t>(std::count(free_.begin(), free_.end(), true));
  }

 private:
  std::vector<ParameterValues> starts() const;
  bool descend_from_all();
  bool descend(const ParameterValues& start, int number);
  ParameterValues refined() const;
  ParameterValues off_bounds(const ParameterValues& values, const Curve& curve, double cost) const;
  DependentErrors describe_fit(Fit& fit) const;
  /// False where a profile found a lower minimum; the search then continues there.
  bool find_intervals(const DependentErrors& errors, Fit& fit);
  void void_intervals(Fit& fit) const;
  bool has_intervals(const Fit& fit) const;
  SolverOptions solver_options(const CurveResiduals& residuals) const;

  const Model& model_;
  const FitOptions& options_;
  Curve curve_;     // with errors, where its realizations give them
  Curve searched_;  // the curve that is searched and profiled: all points, or means over 1 % of t
  ParameterValues fixed_;  // [n_parameters], NaN where free
  std::vector<bool> free_;
  Minimum best_;
  ParameterValues values_;  // at the best minimum
  int best_start_ = 0, tried_ = 0;
};

Fitter::Fitter(const Model& model, const Curve& curve, const FitOptions& options)
    : model_(model), options_(options) {
  const bool logarithmic = is_fitted_in_logarithms(model, curve);
  curve_ = with_pooled_errors(curve, logarithmic);
  searched_ = logarithmic ? curve_ : binned(curve_);
  for (const Parameter& parameter : model.parameters()) {
    const auto found = options.fixed.find(parameter.name);
    fixed_.push_back(found == options.fixed.end() ? unset : found->second);
    free_.push_back(found == options.fixed.end());
  }
}

std::vector<ParameterValues> Fitter::starts() const {
  std::vector<ParameterValues> all;
  if (options_.start) all.push_back(*options_.start);
  if (options_.multi_start || !options_.start) {
    const std::size_t wanted = options_.multi_start ? 8 : 1;
    for (ParameterValues& p : model_.starts(searched_, fixed_, wanted)) all.push_back(std::move(p));
    options_.solver.budget->left -= evaluations_of_starts(model_, searched_, fixed_);
  }
  for (ParameterValues& p : all) {
    for (std::size_t j = 0; j < p.size(); ++j) p[j] = free_[j] ? p[j] : fixed_[j];
  }
  return all;
}

long long Fitter::allowed_evaluations() const {
  if (n_free() <= few_parameters) return options_.max_evaluations;
  const auto parameters = static_cast<double>(n_free());
  const double points = std::max<double>(1, static_cast<double>(searched_.t.size()));
  const double affordable = options_.max_work / (points * parameters * parameters);
  constexpr double fewest = 100;
  return static_cast<long long>(
      std::min(std::max(affordable, fewest), static_cast<double>(options_.max_evaluations)));
}

SolverOptions Fitter::solver_options(const CurveResiduals& residuals) const {
  SolverOptions options = options_.solver;
  options.data_norm = residuals.data_norm();
  return options;
}

// Keeps the better minimum; true where this one agrees with the best so far.
bool Fitter::descend(const ParameterValues& start, int number) {
  const CurveResiduals residuals(model_, searched_, start, free_);
  Minimum minimum;
  if (residuals.n_variables() > 0) {
    minimum = minimise(residuals, residuals.to_variables(start), solver_options(residuals));
  } else {
    minimum.x.resize(0);
    minimum.r.resize(residuals.n_residuals());
    residuals.values(minimum.x, minimum.r);
    minimum.jacobian.resize(residuals.n_residuals(), 0);
    minimum.cost = minimum.r.squaredNorm();
    minimum.reason = minimum.r.allFinite() ? EndReason::step : EndReason::not_finite;
  }
  if (minimum.reason == EndReason::not_finite || !minimum.jacobian.allFinite()) return false;
  const bool first = values_.empty();
  const bool agrees = !first && minimum.cost <= best_.cost * (1 + 1e-6);
  if (first || minimum.cost < best_.cost * (1 - 1e-9)) {
    values_ = residuals.to_parameters(minimum.x);
    best_ = std::move(minimum);
    best_start_ = number;
  }
  return agrees;
}

// Until three starts have led to the same minimum.
bool Fitter::descend_from_all() {
  int agreeing = 0;
  for (const ParameterValues& start : starts()) {
    const double previous = values_.empty() ? infinite : best_.cost;
    const bool agrees = descend(start, tried_++);
    if (!values_.empty() && best_.cost < previous * (1 - 1e-6)) agreeing = 0;
    if (agrees && ++agreeing == 2) break;
  }
  return !values_.empty();
}

// The minimum over all points, where a long curve was searched as means.
ParameterValues Fitter::refined() const {
  if (searched_.t.size() == curve_.t.size() || n_free() == 0) return values_;
  const CurveResiduals residuals(model_, curve_, values_, free_);
  const Minimum minimum =
      minimise(residuals, residuals.to_variables(values_), solver_options(residuals));
  if (!is_minimum(minimum.reason)) return values_;
  return off_bounds(residuals.to_parameters(minimum.x), curve_, minimum.cost);
}

ParameterValues Fitter::off_bounds(const ParameterValues& values, const Curve& curve,
                                   double cost) const {
  const auto dof = static_cast<double>(curve.t.size()) - static_cast<double>(n_free());
  const double variance = curve_.sigma.empty() ? cost / dof : 1;
  if (best_.reason == EndReason::exact || !(dof > 0) || !(variance > 0)) return values;
  return fitting::off_bounds({model_, curve, cost, variance}, values, free_);
}

// All but intervals and words, over all points. Returns what dependence makes of the errors.
DependentErrors Fitter::describe_fit(Fit& fit) const {
  fit.model = model_.name();
  fit.formula = model_.formula();
  fit.source = model_.source();
  fit.logarithmic = is_fitted_in_logarithms(model_, curve_);
  fit.n_points = curve_.t.size();
  fit.n_free = n_free();
  fit.dof = fit.n_points - fit.n_free;
  fit.sigma_given = !curve_.sigma.empty();
  fit.n_bins = searched_.t.size() < fit.n_points ? searched_.t.size() : 0;
  fit.reason = best_.reason;
  fit.iterations = best_.iterations;
  fit.evaluations = best_.evaluations;
  fit.jacobian_evaluations = best_.jacobian_evaluations;
  fit.fallback = best_.fallback;
  fit.start = best_start_;
  fit.starts_tried = tried_;
  const ParameterValues values = refined();
  for (std::size_t i = 0; i < fit.n_points; ++i) {
    fit.fitted.push_back(model_.value(curve_.t[i], values.data()));
    fit.residuals.push_back(fit.logarithmic ? std::log(curve_.x[i]) - std::log(fit.fitted[i])
                                            : curve_.x[i] - fit.fitted[i]);
  }
  const LinearProblem problem = linear_problem(model_, curve_, values, free_);
  fill_statistics(curve_, problem.residuals, fit);
  const DependentErrors dependent = dependent_errors(curve_, problem, options_.memory, fit);
  fill_covariance(problem, free_, fit);
  Eigen::Index variable = 0;
  for (std::size_t j = 0; j < free_.size(); ++j) {
    const auto k = static_cast<Eigen::Index>(j);
    Estimate estimate;
    estimate.parameter = model_.parameters()[j];
    estimate.value = values[j];
    estimate.standard_error = free_[j] ? std::sqrt(fit.covariance(k, k)) : 0;
    if (free_[j]) {
      estimate.error =
          std::sqrt(dependent.covariance(variable, variable)) * std::abs(problem.slopes[variable]);
      ++variable;
    }
    for (Interval& interval : estimate.intervals) {
      interval = free_[j] ? Interval{-infinite, infinite} : Interval{values[j], values[j]};
    }
    if (!free_[j]) estimate.identifiability = Identifiability::fixed;
    fit.estimates.push_back(std::move(estimate));
  }
  return dependent;
}

bool Fitter::has_intervals(const Fit& fit) const {
  if (!options_.profiles || too_short_for_errors(fit)) return false;
  return fit.sigma_given || (fit.dof > 0 && fit.residual_sum > 0);
}

// Without scatter of a parameter both ends lie at its value, but for rounding.
void include_within_rounding(double value, Interval& interval) {
  const double rounding = 1e-12 * std::abs(value);
  if (interval.lower > value && interval.lower - value <= rounding) interval.lower = value;
  if (interval.upper < value && value - interval.upper <= rounding) interval.upper = value;
}

bool Fitter::find_intervals(const DependentErrors& errors, Fit& fit) {
  ProfileProblem problem{model_, searched_,       values_,
                         free_,  best_.cost,      fit.sigma_given ? 1 : fit.reduced_chi2,
                         {0, 0}, options_.solver, errors.level_weight};
  fit.has_student_intervals = realizations_differ_in_shape(errors, fit);
  Eigen::Index variable = 0;
  for (std::size_t j = 0; j < free_.size(); ++j) {
    if (!free_[j]) continue;
    const double longer = std::sqrt(errors.inflation[variable++]);
    for (int level = 0; level < 2; ++level) {
      problem.thresholds[level] = longer * two_sided(interval_levels[level], fit.error_dof);
    }
    Estimate& estimate = fit.estimates[j];
    estimate.identifiability = Identifiability::identified;
    if (fit.reason == EndReason::exact && !fit.sigma_given) {
      // Nothing but rounding to profile: the linear errors are as good.
      for (int level = 0; level < 2; ++level) {
        const double reach = problem.thresholds[level] * estimate.standard_error;
        estimate.intervals[level] = {estimate.value - reach, estimate.value + reach};
      }
      continue;
    }
    ParameterProfile found = profile(problem, j, estimate.standard_error);
    if (found.better && !options_.solver.budget->spent()) {
      const double previous = best_.cost;
      descend(*found.better, best_start_);
      if (best_.cost < previous) return false;
      problem.seek_better = false;
      found = profile(problem, j, estimate.standard_error);
    }
    estimate.intervals[0] = found.intervals[0];
    estimate.intervals[1] = found.intervals[1];
    if (fit.has_student_intervals) use_student_intervals(curve_, fit.error_dof, estimate);
    for (Interval& interval : estimate.intervals) include_within_rounding(estimate.value, interval);
    mark_unfinished(options_.solver, estimate);
  }
  return true;
}

// Profiles have found lower and lower costs: the minimum, if there is one, is somewhere else.
void Fitter::void_intervals(Fit& fit) const {
  for (std::size_t j = 0; j < free_.size(); ++j) {
    if (!free_[j]) continue;
    fit.estimates[j].identifiability = Identifiability::identified;  // until judged
    for (Interval& interval : fit.estimates[j].intervals) interval = {-infinite, infinite};
  }
  fit.remarks.push_back(
      "The least squares still fall where parameters are held elsewhere: no minimum was found, and "
      "the intervals are open.");
}

double Fitter::cost_of_all_points() const {
  if (searched_.t.size() == curve_.t.size()) return best_.cost;
  return linear_problem(model_, curve_, refined(), free_).residuals.squaredNorm();
}

Fit Fitter::finish() {
  const bool any_fixed = n_free() < free_.size();
  for (int attempt = 0;; ++attempt) {
    const ParameterValues canonical = any_fixed ? values_ : model_.canonical(values_);
    const ParameterValues placed = off_bounds(canonical, searched_, best_.cost);
    if (placed != values_) {
      values_ = placed;
      const CurveResiduals moved(model_, searched_, values_, free_);
      best_.x = moved.to_variables(values_);
      moved.values_and_jacobian(best_.x, best_.r, best_.jacobian);
      best_.cost = canonical == placed ? best_.cost : best_.r.squaredNorm();
    }
    Fit fit;
    const DependentErrors errors = describe_fit(fit);
    if (has_intervals(fit) && !find_intervals(errors, fit)) {
      if (attempt < most_attempts) continue;
      void_intervals(fit);
    }
    remark_on_end(options_, fit);
    if (any_fixed) remark_on_order(model_, values_, fit);
    judge(curve_, options_.t_unit, fit);
    const FittedCurveOf fitted{model_, curve_,     searched_,          values_,
                               free_,  best_.cost, has_intervals(fit), options_};
    add_combinations(fitted, fit);
    add_restated(fitted, fit);
    return fit;
  }
}

}  // namespace

ParameterValues Fit::values() const {
  ParameterValues p;
  for (const Estimate& estimate : estimates) p.push_back(estimate.value);
  return p;
}

std::variant<Fit, Refusal> fit_as_given(const Model& model, const Curve& curve,
                                        const FitOptions& options) {
  if (auto refusal = refuse_options(model, options)) return *refusal;
  // A search that crawls towards infinity leaves enough for what is fitted there instead.
  constexpr int share_of_search = 5;
  const bool outermost = options.solver.budget == nullptr;
  EvaluationBudget budget;
  FitOptions counted = options;
  if (outermost) counted.solver.budget = &budget;
  Fitter fitter(model, curve, counted);
  if (auto refusal = refuse_curve(model, curve, fitter.n_free())) return *refusal;
  const long long allowed = fitter.allowed_evaluations();
  budget.left = allowed / share_of_search;
  const bool limits =
      options.profiles && options.limits && fitter.n_free() > 0 && curve.t.size() > fitter.n_free();
  const auto candidates =
      limits ? limit_candidates(model, curve, counted) : std::vector<LimitCandidate>();
  const std::size_t dof = curve.t.size() - fitter.n_free();
  const LimitCandidate* limit = reached(candidates, curve, std::nullopt, dof);
  if (!limit) {
    if (!fitter.search()) {
      return Refusal{RefusalKind::no_start, "the model has no finite value and slope at any start"};
    }
    limit = reached(candidates, curve, fitter.cost_of_all_points(), dof);
  }
  if (outermost) budget.left = allowed - budget.used;
  std::variant<Fit, Refusal> outcome =
      limit ? fit_at_limit(model, curve, counted, *limit) : fitter.finish();
  if (auto* found = std::get_if<Fit>(&outcome)) {
    found->total_evaluations = counted.solver.budget->used;
    const bool stopped = budget.spent() || found->reason == EndReason::budget;
    if (outermost && stopped) remark_on_budget(allowed, few_parameters, options, *found);
  }
  return outcome;
}

}  // namespace jostle::inline fitting
