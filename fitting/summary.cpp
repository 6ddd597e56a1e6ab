#include "fitting/summary.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/intervals/fit_errors.hpp"
#include "fitting/intervals/fit_statistics.hpp"
#include "fitting/value_text.hpp"

namespace jostle::inline fitting {

namespace {

const Estimate* asymptote_of(const Fit& fit) {
  const auto found = std::ranges::find_if(
      fit.estimates, [](const Estimate& e) { return e.parameter.name.ends_with("_inf"); });
  return found == fit.estimates.end() ? nullptr : &*found;
}

bool is_rejected(const Fit& fit, const LawComparison& comparison) {
  const auto law = std::ranges::find(comparison.laws, fit.model, &HeldOutLaw::model);
  return law != comparison.laws.end() && law->worse;
}

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  }
  return text;
}

// " d"; nothing where the unit is not known, or 1.
std::string unit_of_values(const CurveUnits& units) {
  return units.x.empty() || units.x == "1" ? "" : " " + units.x;
}

std::string one_asymptote(const Estimate& estimate, const CurveUnits& units) {
  const std::string& name = estimate.parameter.name;
  const std::string unit = unit_of_values(units);
  const std::string value = name + " " + estimate_text(estimate, unit);
  const std::string none = name + " has no value";
  if (estimate.identifiability <= Identifiability::not_examined)
    return estimate.has_value() ? value : none;
  const Interval& interval = estimate.intervals[1];
  const bool is_open = !std::isfinite(interval.lower) && !std::isfinite(interval.upper);
  if (is_open) return name + " has no limit on either side";
  if (!estimate.has_value()) return none + ", 95 %: " + interval_text(estimate, 1) + unit;
  return value + ", 95 %: " + interval_text(estimate, 1);
}

std::string asymptote_text(const std::vector<Fit>& fits, const LawComparison& comparison,
                           const CurveUnits& units) {
  std::string law;  // the last with an asymptote
  std::vector<const Estimate*> found;
  for (const Fit& fit : fits) {
    const Estimate* estimate = is_rejected(fit, comparison) ? nullptr : asymptote_of(fit);
    if (estimate == nullptr) continue;
    found.push_back(estimate);
    law = fit.model;
  }
  if (found.empty()) return "";
  if (found.size() == 1) {
    return one_asymptote(*found.front(), units) + (fits.size() > 1 ? " (" + law + ")" : "");
  }
  Interval hull = found.front()->intervals[1];
  for (const Estimate* estimate : found) {
    if (estimate->identifiability == Identifiability::not_examined) {
      return "no interval, because errors are unknown";
    }
    hull.lower = std::min(hull.lower, estimate->intervals[1].lower);
    hull.upper = std::max(hull.upper, estimate->intervals[1].upper);
  }
  const bool is_open = !std::isfinite(hull.lower) && !std::isfinite(hull.upper);
  const std::string limits = limits_text(hull.lower, hull.upper, 5);
  return limits + (is_open ? "" : unit_of_values(units)) + " (95 %, over " +
         (found.size() == fits.size() ? "all laws)" : "the laws that are not rejected)");
}

// Names of the fits for which `is_so` holds.
template <typename Test>
std::vector<std::string> laws_with(const std::vector<const Fit*>& fits, const Test& is_so) {
  std::vector<std::string> names;
  for (const Fit* fit : fits) {
    if (is_so(*fit)) names.push_back(fit->model);
  }
  return names;
}

// Laws that are rejected need no warning.
std::string warning_text(const std::vector<Fit>& all, const LawComparison& comparison) {
  std::vector<const Fit*> fits;
  for (const Fit& fit : all) {
    if (!is_rejected(fit, comparison)) fits.push_back(&fit);
  }
  const auto unsettled = laws_with(fits, [](const Fit& fit) { return !is_minimum(fit.reason); });
  if (!unsettled.empty()) return "no minimum was found for " + joined_names(unsettled);
  const auto without_errors = laws_with(fits, too_short_for_errors);
  if (!without_errors.empty()) {
    return "the residuals are correlated for too long: no errors for " +
           joined_names(without_errors);
  }
  const auto contradicted = laws_with(fits, [](const Fit& fit) { return fit.scatter_ratio > 1; });
  if (!contradicted.empty()) {
    return "the points scatter more than the errors given about " + joined_names(contradicted);
  }
  const auto missing = laws_with(fits, has_correlated_residuals);
  if (!missing.empty()) return "the residuals are correlated about " + joined_names(missing);
  return "";
}

}  // namespace

FitsSummary summary(const std::vector<Fit>& fits, const LawComparison& comparison,
                    const CurveUnits& units) {
  if (fits.empty()) return {};
  return {.choice = fits.size() == 1 ? verdict(fits, comparison) : choice_text(comparison),
          .asymptote = asymptote_text(fits, comparison, units),
          .warning = warning_text(fits, comparison)};
}

}  // namespace jostle::inline fitting
