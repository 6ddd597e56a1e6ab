#include <algorithm>
#include <cmath>
#include <sstream>

#include "fitting/intervals/distributions.hpp"
#include "fitting/intervals/fit_errors.hpp"
#include "fitting/intervals/fit_statistics.hpp"
#include "fitting/numbers.hpp"
#include "fitting/value_text.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double few_points_share = 0.1;
// Remarks are made without being asked for, on every law of every curve, most of which are rightly
// fitted: at 5 % one sound fit in seven would carry one. The number of independent points behind
// chi2 is itself an estimate, hence the smaller level.
constexpr double runs_level = 0.01;
constexpr double chi2_level = 0.001;
constexpr double wide_factor = 2;  // ratio of limits of a wide positive parameter or factor
constexpr double wide_share =
    0.125;  // share of the curve's range for a wide parameter, for a place or a level

// Where the curvature of the least squares is rounding and a minimum is extremely far from all
// measurements, the data did not close its interval.
constexpr double singular_condition = 4.5e15;  // 1 / epsilon
constexpr double absurd = 100;

double span(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

bool is_wide(const Estimate& estimate, const Curve& curve) {
  const Interval& interval = estimate.intervals[1];
  const double width = interval.upper - interval.lower;
  const ParameterUnit unit = estimate.parameter.unit;
  if (estimate.parameter.of_power) {
    const auto [smaller, larger] =
        std::minmax({std::abs(interval.lower), std::abs(interval.upper)});
    return interval.lower * interval.upper <= 0 || larger > wide_factor * smaller;
  }
  if (unit == ParameterUnit::value) return width > wide_share * span(curve.x);
  if (estimate.parameter.lower == 0) return interval.upper > wide_factor * interval.lower;
  if (unit == ParameterUnit::time) return width > wide_share * span(curve.t);
  return interval.lower <= 0 && interval.upper >= 0;  // nothing to compare with: its sign is open
}

Identifiability verdict(const Estimate& estimate, const Curve& curve) {
  const Interval& interval = estimate.intervals[1];
  const bool has_lower = std::isfinite(interval.lower), has_upper = std::isfinite(interval.upper);
  if (!has_lower && !has_upper) return Identifiability::not_identifiable;
  if (!has_upper) return Identifiability::bounded_below;
  if (!has_lower) return Identifiability::bounded_above;
  return is_wide(estimate, curve) ? Identifiability::wide : Identifiability::identified;
}

std::string statement(const Estimate& estimate) {
  const Interval& interval = estimate.intervals[1];
  const std::string& name = estimate.parameter.name;
  std::ostringstream text;
  constexpr int digits = 4;
  text.precision(digits);
  const std::string limits = limits_text(interval.lower, interval.upper, digits);
  switch (estimate.identifiability) {
    case Identifiability::fixed:
      text << name << " is fixed at " << estimate.value;
      break;
    case Identifiability::not_examined:
      text << name << " was not examined";
      break;
    case Identifiability::unfinished:
      text << name << " is unfinished: the fit stopped before it found both 95 % limits";
      break;
    case Identifiability::identified:
      text << name << " is identified: " << limits << " (95 %)";
      break;
    case Identifiability::wide:
      text << name << " is wide: " << limits << " fit the curve as well (95 %)";
      break;
    case Identifiability::bounded_below:
      text << name << " has only a lower limit: " << name << " > " << interval.lower << " (95 %)";
      break;
    case Identifiability::bounded_above:
      text << name << " has only an upper limit: " << name << " < " << interval.upper << " (95 %)";
      break;
    case Identifiability::not_identifiable:
      text << name << " is not identifiable: the data set no 95 % limit on either side";
      break;
  }
  return text.str();
}

bool is_absurd(const Estimate& estimate, const Curve& curve) {
  const double size = std::abs(estimate.value);
  if (!(estimate.standard_error > absurd * size)) return false;
  if (estimate.parameter.unit != ParameterUnit::value) return estimate.parameter.lower == 0;
  const auto [low, high] = std::minmax_element(curve.x.begin(), curve.x.end());
  return size > absurd * std::max(std::abs(*low), std::abs(*high));
}

bool is_loose(const Estimate& estimate) {
  return estimate.identifiability == Identifiability::wide ||
         estimate.identifiability == Identifiability::bounded_below ||
         estimate.identifiability == Identifiability::bounded_above ||
         estimate.identifiability == Identifiability::not_identifiable;
}

// Two parameters with a correlation of 0.98 have these: below, what is loose is so by noise.
constexpr double tied_condition = 100, tied_inflation = 25;
constexpr double not_unique_condition = 1e3;

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  }
  return text;
}

void remark_on_tied(const std::vector<std::string>& names, Fit& fit) {
  if (names.empty()) return;
  const bool partly = fit.condition < not_unique_condition;
  std::ostringstream text;
  text.precision(2);
  text << (partly ? "Parameters are correlated: " : "The parameters are not unique: ")
       << listed(names) << (partly ? " can partly make up for " : " can make up for ")
       << (names.size() > 1 ? "each other" : "the others")
       << " over the range of t fitted (condition number " << fit.condition
       << "); quote intervals, not standard errors, and compare only fits over the same range.";
  fit.remarks.push_back(text.str());
}

// Lists unconstrained parameters by cause: without influence on the curve, compensated by others,
// or lost in noise.
void remark_on_loose(Fit& fit) {
  std::vector<std::string> without_influence, tied, noisy;
  for (std::size_t j = 0; j < fit.estimates.size(); ++j) {
    const Estimate& estimate = fit.estimates[j];
    if (!is_loose(estimate)) continue;
    const double inflation = fit.variance_inflation[j];
    const bool is_tied = fit.condition >= tied_condition && inflation >= tied_inflation;
    (inflation == 0 ? without_influence
     : is_tied      ? tied
                    : noisy)
        .push_back(estimate.parameter.name);
  }
  remark_on_tied(tied, fit);
  if (!noisy.empty()) {
    fit.remarks.push_back("The data hardly constrain " + listed(noisy) +
                          ": few or noisy points; quote intervals, not standard errors.");
  }
  if (!without_influence.empty()) {
    const std::string names = listed(without_influence);
    fit.remarks.push_back("The curve does not change with small changes of " + names +
                          ": errors and limits of " + names + " cannot be computed.");
  }
}

void remark_on_memory(const Curve& curve, const std::string& t_unit, Fit& fit) {
  if (!(fit.memory.time > 0)) return;
  std::ostringstream text;
  text.precision(3);
  text << "One curve: its residuals are correlated over ";
  if (fit.memory.time > span(curve.t)) {
    text << "the whole curve";
  } else {
    text << "about " << fit.memory.time << ' ' << (t_unit.empty() ? "units of t" : t_unit);
  }
  text << ". Its " << fit.n_points << " points count as " << fit.effective_size
       << " independent points";
  if (too_short_for_errors(fit)) {
    text << ", too few for errors and intervals. Fit several realizations; if every point is an "
            "experiment of its own, fit them as independent points.";
  } else {
    text << "; errors and intervals include this.";
  }
  fit.remarks.push_back(text.str());
}

void remark_on_weights(Fit& fit) {
  if (fit.weighted_size > few_points_share * static_cast<double>(fit.n_points)) return;
  std::ostringstream text;
  text.precision(3);
  text << "Few points dominate: by their errors the " << fit.n_points << " points weigh as "
       << fit.weighted_size << " equal ones. Unless these errors are known that well, fit without "
       << "them.";
  fit.remarks.push_back(text.str());
}

// By chi2 of as many degrees of freedom as independent points leave; approximately normal in its
// cube root (Wilson & Hilferty 1931).
void remark_on_chi2(Fit& fit) {
  const double dof = fit.effective_size - static_cast<double>(fit.n_free);
  if (!fit.sigma_given || !(dof >= 1) || fit.reason == EndReason::exact) return;
  const double z = (std::cbrt(fit.reduced_chi2) - 1 + 2 / (9 * dof)) / std::sqrt(2 / (9 * dof));
  if (normal_tails(z) > chi2_level) return;
  std::ostringstream text;
  text.precision(3);
  text << "Reduced chi2 is " << fit.reduced_chi2 << ", far from 1 (p < 0.001 for "
       << fit.effective_size << " independent points): ";
  if (z > 0 && (fit.n_realizations > 0 || too_short_for_errors(fit))) {
    text << "the law misses the curve, or its errors are too small.";
  } else if (z > 0) {
    const double variance = fit.memory.time > 0 ? fit.memory.variance : fit.reduced_chi2;
    fit.scatter_ratio = std::max(1.0, std::sqrt(variance));
    text << "the law misses the curve, or the errors given are too small. Intervals take them as "
            "exact; by the scatter around the law they are "
         << fit.scatter_ratio << " times longer.";
  } else if (fit.n_realizations > 0 && !fit.logarithmic) {
    text << "the points of a realization deviate together, as those of a level of its own do; "
            "errors and intervals include this.";
  } else {
    text << (fit.n_realizations > 0 ? "the errors of the means" : "the errors given")
         << " are larger than the scatter of the points.";
  }
  fit.remarks.push_back(text.str());
}

void remark_on_residuals(Fit& fit) {
  if (!has_correlated_residuals(fit)) return;
  std::ostringstream text;
  text.precision(3);
  text << "The residuals are correlated (" << fit.runs.runs << " runs of one sign, "
       << fit.runs.expected
       << " expected): the law misses the curve, or points are not independent.";
  fit.remarks.push_back(text.str());
}

}  // namespace

bool Interval::closed() const {
  return std::isfinite(lower) && std::isfinite(upper);
}

const char* name_of(Identifiability identifiability) {
  switch (identifiability) {
    case Identifiability::fixed:
      return "fixed";
    case Identifiability::not_examined:
      return "not_examined";
    case Identifiability::unfinished:
      return "unfinished";
    case Identifiability::identified:
      return "identified";
    case Identifiability::wide:
      return "wide";
    case Identifiability::bounded_below:
      return "bounded_below";
    case Identifiability::bounded_above:
      return "bounded_above";
    case Identifiability::not_identifiable:
      return "not_identifiable";
  }
  return "";
}

bool Estimate::has_value() const {
  if (identifiability == Identifiability::fixed) return true;
  if (identifiability == Identifiability::not_examined) {
    return !(standard_error > absurd * std::abs(value)) || !std::isfinite(standard_error);
  }
  const Interval& wide = intervals[1];
  return intervals[0].closed() && (std::isfinite(wide.lower) || std::isfinite(wide.upper));
}

double Estimate::half_width() const {
  if (identifiability == Identifiability::fixed) return 0;
  return intervals[0].closed() ? 0.5 * (intervals[0].upper - intervals[0].lower)
                               : std::numeric_limits<double>::infinity();
}

void open_absurd_intervals(const Curve& curve, const Fit& fit, std::vector<Estimate>& estimates) {
  if (fit.condition <= singular_condition) return;
  for (Estimate& estimate : estimates) {
    if (estimate.identifiability <= Identifiability::not_examined) continue;
    if (!is_absurd(estimate, curve)) continue;
    for (Interval& interval : estimate.intervals) interval = {-infinite, infinite};
  }
}

void take_errors_of_intervals(const Fit& fit, std::vector<Estimate>& estimates) {
  if (!(fit.error_dof > 0)) return;
  for (Estimate& estimate : estimates) {
    if (estimate.identifiability <= Identifiability::not_examined) continue;
    estimate.error = estimate.half_width() / two_sided(interval_levels[0], fit.error_dof);
  }
}

void mark_unfinished(const SolverOptions& solver, Estimate& estimate) {
  if (solver.budget != nullptr && solver.budget->spent() && !estimate.intervals[1].closed())
    estimate.identifiability = Identifiability::unfinished;
}

void judge_estimates(const Curve& curve, std::vector<Estimate>& estimates) {
  for (Estimate& estimate : estimates) {
    const bool judged = estimate.identifiability > Identifiability::unfinished;
    if (judged) estimate.identifiability = verdict(estimate, curve);
    estimate.statement = statement(estimate);
  }
}

bool has_correlated_residuals(const Fit& fit) {
  return fit.reason != EndReason::exact && fit.runs.z < 0 && fit.runs.p < runs_level;
}

void judge(const Curve& curve, const std::string& t_unit, Fit& fit) {
  open_absurd_intervals(curve, fit, fit.estimates);
  take_errors_of_intervals(fit, fit.estimates);
  judge_estimates(curve, fit.estimates);
  remark_on_memory(curve, t_unit, fit);
  remark_on_loose(fit);
  remark_on_weights(fit);
  remark_on_chi2(fit);
  remark_on_residuals(fit);
}

}  // namespace jostle::inline fitting
