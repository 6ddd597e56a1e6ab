#include "fitting/fit.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "fitting/curve_residuals.hpp"
#include "fitting/distributions.hpp"
#include "fitting/fit_statistics.hpp"
#include "fitting/profile.hpp"

namespace jostle {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int most_attempts = 5;  // to find a minimum that no profile undercuts
constexpr double unset = std::numeric_limits<double>::quiet_NaN();

bool inside(const Parameter& parameter, double value) {
  return std::isfinite(value) && value > parameter.lower && value < parameter.upper;
}

// "B = -1 is outside its range (0, inf)"
std::string out_of_range(const Parameter& parameter, double value) {
  std::ostringstream text;
  text << parameter.name << " = " << value << " is outside its range (" << parameter.lower << ", "
       << parameter.upper << ")";
  return text.str();
}

std::optional<Refusal> refuse_options(const Model& model, const FitOptions& options) {
  const std::vector<Parameter>& parameters = model.parameters();
  for (const auto& [name, value] : options.fixed) {
    const auto found = std::find_if(parameters.begin(), parameters.end(),
                                    [&](const Parameter& p) { return p.name == name; });
    if (found == parameters.end()) {
      std::string names;
      for (const Parameter& p : parameters) names += (names.empty() ? "" : ", ") + p.name;
      return Refusal{RefusalKind::bad_options,
                     model.name() + " has no parameter " + name + " (it has " + names + ")"};
    }
    if (!inside(*found, value))
      return Refusal{RefusalKind::bad_options, out_of_range(*found, value)};
  }
  if (!options.start) return std::nullopt;
  if (options.start->size() != parameters.size()) {
    return Refusal{RefusalKind::bad_options, "a start needs one value for each parameter"};
  }
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (!inside(parameters[j], (*options.start)[j])) {
      return Refusal{RefusalKind::bad_options, out_of_range(parameters[j], (*options.start)[j])};
    }
  }
  return std::nullopt;
}

std::optional<Refusal> refuse_curve(const Model& model, const Curve& curve, std::size_t n_free) {
  std::string text;
  for (const std::string& fault : faults(curve)) text += (text.empty() ? "" : "; ") + fault;
  if (!text.empty()) return Refusal{RefusalKind::bad_curve, text};
  const std::size_t places = std::set<double>(curve.t.begin(), curve.t.end()).size();
  if (places < n_free) {
    std::ostringstream few;
    few << curve.t.size() << " points at " << places << " different t cannot determine " << n_free
        << " parameters: fix some, or use a wider range";
    return Refusal{RefusalKind::too_few_points, few.str()};
  }
  const auto [low, high] = std::minmax_element(curve.x.begin(), curve.x.end());
  if (*high - *low <= 1e-14 * std::max(std::abs(*low), std::abs(*high))) {
    std::ostringstream constant;
    constant << "X is constant (" << *low << "): it determines no law, only its own value";
    return Refusal{RefusalKind::constant_curve, constant.str()};
  }
  text = model.refusal(curve);
  if (!text.empty()) return Refusal{RefusalKind::bad_domain, text};
  return std::nullopt;
}

// One fit in the making.
class Fitter {
 public:
  Fitter(const Model& model, const Curve& curve, const FitOptions& options);

  std::variant<Fit, Refusal> operator()();
  std::size_t n_free() const {
    return static_cast<std::size_t>(std::count(free_.begin(), free_.end(), true));
  }

 private:
  std::vector<ParameterValues> starts() const;
  bool descend_from_all();
  bool descend(const ParameterValues& start, int number);
  void describe_fit(const CurveResiduals& residuals, Fit& fit) const;
  void estimate_errors(const CurveResiduals& residuals, Fit& fit) const;
  /// False where a profile found a lower minimum; the search then goes on from there.
  bool find_intervals(Fit& fit);
  void void_intervals(Fit& fit) const;
  void remark_on_order(Fit& fit) const;
  bool has_intervals(const Fit& fit) const;
  SolverOptions solver_options(const CurveResiduals& residuals) const;

  const Model& model_;
  const Curve& curve_;
  const FitOptions& options_;
  ParameterValues fixed_;  // [n_parameters], NaN where free
  std::vector<bool> free_;
  Minimum best_;
  ParameterValues values_;  // at the best minimum
  int best_start_ = 0, tried_ = 0;
};

Fitter::Fitter(const Model& model, const Curve& curve, const FitOptions& options)
    : model_(model), curve_(curve), options_(options) {
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
    for (ParameterValues& p : model_.starts(curve_, fixed_, wanted)) all.push_back(std::move(p));
  }
  for (ParameterValues& p : all) {
    for (std::size_t j = 0; j < p.size(); ++j) p[j] = free_[j] ? p[j] : fixed_[j];
  }
  return all;
}

SolverOptions Fitter::solver_options(const CurveResiduals& residuals) const {
  SolverOptions options = options_.solver;
  options.data_norm = residuals.data_norm();
  return options;
}

// Keeps the better minimum; true where this one agrees with the best so far.
bool Fitter::descend(const ParameterValues& start, int number) {
  const CurveResiduals residuals(model_, curve_, start, free_);
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
    const double before = values_.empty() ? infinite : best_.cost;
    const bool agrees = descend(start, tried_++);
    if (!values_.empty() && best_.cost < before * (1 - 1e-6)) agreeing = 0;
    if (agrees && ++agreeing == 2) break;
  }
  return !values_.empty();
}

void Fitter::estimate_errors(const CurveResiduals& residuals, Fit& fit) const {
  const auto n = static_cast<Eigen::Index>(free_.size());
  fit.covariance = Eigen::MatrixXd::Zero(n, n);
  fit.correlation = Eigen::MatrixXd::Zero(n, n);
  if (fit.n_free == 0) return;
  const InverseNormal inverse = inverse_normal(best_.jacobian);
  fit.condition = inverse.condition;
  const Eigen::VectorXd slopes = residuals.slopes(best_.x);
  const double variance = fit.sigma_given ? 1 : fit.reduced_chi2;
  Eigen::Index a = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!free_[static_cast<std::size_t>(i)]) continue;
    Eigen::Index b = 0;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (!free_[static_cast<std::size_t>(j)]) continue;
      const double entry = inverse.matrix(a, b);
      const double scale = std::sqrt(inverse.matrix(a, a)) * std::sqrt(inverse.matrix(b, b));
      const double sign = slopes[a] * slopes[b] < 0 ? -1 : 1;
      fit.covariance(i, j) = entry * slopes[a] * slopes[b] * variance;
      if (std::isnan(fit.covariance(i, j))) fit.covariance(i, j) = 0;  // 0 times infinity
      fit.correlation(i, j) = i == j ? 1 : std::clamp(sign * entry / scale, -1.0, 1.0);
      ++b;
    }
    ++a;
  }
}

void Fitter::describe_fit(const CurveResiduals& residuals, Fit& fit) const {
  fit.model = model_.name();
  fit.formula = model_.formula();
  fit.source = model_.source();
  fit.logarithmic = model_.residual_scale() == ResidualScale::logarithmic;
  fit.n_points = curve_.t.size();
  fit.n_free = n_free();
  fit.dof = fit.n_points - fit.n_free;
  fit.sigma_given = !curve_.sigma.empty();
  fit.reason = best_.reason;
  fit.iterations = best_.iterations;
  fit.evaluations = best_.evaluations;
  fit.jacobian_evaluations = best_.jacobian_evaluations;
  fit.fallback = best_.fallback;
  fit.start = best_start_;
  fit.starts_tried = tried_;
  for (std::size_t i = 0; i < fit.n_points; ++i) {
    fit.fitted.push_back(model_.value(curve_.t[i], values_.data()));
    fit.residuals.push_back(fit.logarithmic ? std::log(curve_.x[i]) - std::log(fit.fitted[i])
                                            : curve_.x[i] - fit.fitted[i]);
  }
  fill_statistics(curve_, best_.r, fit);
  estimate_errors(residuals, fit);
  for (std::size_t j = 0; j < free_.size(); ++j) {
    const auto k = static_cast<Eigen::Index>(j);
    Estimate estimate;
    estimate.parameter = model_.parameters()[j];
    estimate.value = values_[j];
    estimate.standard_error = free_[j] ? std::sqrt(fit.covariance(k, k)) : 0;
    for (Interval& interval : estimate.intervals) {
      interval = free_[j] ? Interval{-infinite, infinite} : Interval{values_[j], values_[j]};
    }
    if (!free_[j]) estimate.identifiability = Identifiability::fixed;
    fit.estimates.push_back(std::move(estimate));
  }
}

bool Fitter::has_intervals(const Fit& fit) const {
  if (!options_.profiles) return false;
  return fit.sigma_given || (fit.dof > 0 && fit.residual_sum > 0);
}

bool Fitter::find_intervals(Fit& fit) {
  ProfileProblem problem{model_, curve_,         values_,
                         free_,  best_.cost,     fit.sigma_given ? 1 : fit.reduced_chi2,
                         {0, 0}, options_.solver};
  for (int level = 0; level < 2; ++level) {
    problem.thresholds[level] =
        fit.sigma_given ? normal_two_sided(interval_levels[level])
                        : student_two_sided(interval_levels[level], static_cast<double>(fit.dof));
  }
  for (std::size_t j = 0; j < free_.size(); ++j) {
    if (!free_[j]) continue;
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
    const ParameterProfile found = profile(problem, j, estimate.standard_error);
    if (found.better) {
      const double before = best_.cost;
      descend(*found.better, best_start_);
      if (best_.cost < before) return false;
    }
    estimate.intervals[0] = found.intervals[0];
    estimate.intervals[1] = found.intervals[1];
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

// A parameter that is fixed keeps its name, whatever the others are.
void Fitter::remark_on_order(Fit& fit) const {
  const ParameterValues canonical = model_.canonical(values_);
  if (canonical == values_) return;
  std::ostringstream text;
  text.precision(4);
  text << "With a parameter fixed the others came out in another order than this law's: in its "
          "order "
          "the same curve reads";
  for (std::size_t j = 0; j < canonical.size(); ++j) {
    text << (j == 0 ? " " : ", ") << model_.parameters()[j].name << " = " << canonical[j];
  }
  text << ", and what names and meanings say of order does not hold here.";
  fit.remarks.push_back(text.str());
}

std::variant<Fit, Refusal> Fitter::operator()() {
  if (!descend_from_all()) {
    return Refusal{RefusalKind::no_start, "the model has no finite value and slope at any start"};
  }
  const bool any_fixed = n_free() < free_.size();
  for (int attempt = 0;; ++attempt) {
    const ParameterValues canonical = any_fixed ? values_ : model_.canonical(values_);
    if (canonical != values_) {
      values_ = canonical;
      const CurveResiduals reordered(model_, curve_, values_, free_);
      best_.x = reordered.to_variables(values_);
      reordered.values_and_jacobian(best_.x, best_.r, best_.jacobian);
    }
    Fit fit;
    describe_fit(CurveResiduals(model_, curve_, values_, free_), fit);
    if (has_intervals(fit) && !find_intervals(fit)) {
      if (attempt < most_attempts) continue;
      void_intervals(fit);
    }
    if (!is_minimum(fit.reason)) {
      fit.remarks.push_back(std::string("The fit did not settle: ") + describe(fit.reason) + ".");
    }
    if (fit.dof == 0) {
      fit.remarks.push_back("As many parameters as points: there are no errors to estimate.");
    }
    if (any_fixed) remark_on_order(fit);
    judge(curve_, fit);
    return fit;
  }
}

}  // namespace

ParameterValues Fit::values() const {
  ParameterValues p;
  for (const Estimate& estimate : estimates) p.push_back(estimate.value);
  return p;
}

std::variant<Fit, Refusal> fit(const Model& model, const Curve& curve, const FitOptions& options) {
  if (auto refusal = refuse_options(model, options)) return *refusal;
  Fitter fitter(model, curve, options);
  if (auto refusal = refuse_curve(model, curve, fitter.n_free())) return *refusal;
  return fitter();
}

}  // namespace jostle
