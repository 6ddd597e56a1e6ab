#include "fitting/report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>

#include "fitting/intervals/fit_errors.hpp"
#include "fitting/value_text.hpp"

namespace jostle::inline fitting {

namespace {

constexpr double rounding_of_r2 = 1e-6;

std::string number(double value, int digits) {
  return std::isfinite(value) ? number_text(value, digits) : "-";
}

// To four digits, or as many as distinguish it from 1.
std::string r2_text(double r2) {
  constexpr int most_digits = 12;
  if (!std::isfinite(r2)) return "-";
  if (std::abs(r2) < rounding_of_r2) return "0";
  return number_text(r2, distinguishing_digits(r2, 1, 4, most_digits));
}

// Columns as wide as their longest cell; texts to the left, numbers to the right.
std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::ostringstream text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const int width = static_cast<int>(widths[c]);
      const std::string& header = rows.front()[c];
      const bool words = c == 0 || header == "verdict";
      text << "  " << (words ? std::left : std::right);
      text << std::setw(c + 1 < row.size() ? width : 0) << row[c];
    }
    text << '\n';
  }
  return text.str();
}

const char* verdict_text(Identifiability identifiability) {
  switch (identifiability) {
    case Identifiability::fixed:
      return "fixed";
    case Identifiability::not_examined:
      return "not examined";
    case Identifiability::unfinished:
      return "unfinished";
    case Identifiability::identified:
      return "identified";
    case Identifiability::wide:
      return "wide";
    case Identifiability::bounded_below:
      return "only a lower limit";
    case Identifiability::bounded_above:
      return "only an upper limit";
    case Identifiability::not_identifiable:
      return "not identifiable";
  }
  return "";
}

std::vector<Estimate> shown_estimates(const Fit& fit) {
  std::vector<Estimate> shown = fit.estimates;
  shown.insert(shown.end(), fit.combinations.begin(), fit.combinations.end());
  return shown;
}

std::string parameter_table(const std::vector<Estimate>& estimates) {
  std::vector<std::vector<std::string>> rows = {{"", "value", "95 %", "verdict"}};
  for (const Estimate& e : estimates) {
    rows.push_back(
        {e.parameter.name, estimate_text(e), interval_text(e, 1), verdict_text(e.identifiability)});
  }
  return table(rows);
}

// "  units: X_inf, dX in d; tau in taps": of parameters that are no plain numbers, in the order of
// the tables. Empty if all are plain numbers.
std::string listed_units(const Fit& fit, const CurveUnits& units) {
  std::vector<std::pair<std::string, std::string>> groups;  // unit, names
  std::set<std::string> known;
  for (const ParameterTable& table : parameter_tables(fit)) {
    for (const Estimate& e : table.estimates) {
      const std::string unit = unit_text(e.parameter.unit, units);
      if (unit == "1" || !known.insert(e.parameter.name).second) continue;
      auto group = std::ranges::find(groups, unit, &std::pair<std::string, std::string>::first);
      if (group == groups.end()) group = groups.insert(groups.end(), {unit, ""});
      group->second += (group->second.empty() ? "" : ", ") + e.parameter.name;
    }
  }
  std::string text;
  for (const auto& [unit, names] : groups) {
    text += (text.empty() ? "  units: " : "; ") + names + " in " + unit;
  }
  return text.empty() ? "" : text + '\n';
}

std::string more_of_the_parameters(const Fit& fit) {
  std::vector<std::vector<std::string>> rows = {{"", "68 %", "linear error"}};
  std::string meanings;
  for (const Estimate& e : shown_estimates(fit)) {
    rows.push_back({e.parameter.name, interval_text(e, 0), number(e.standard_error, 2)});
    meanings += (meanings.empty() ? "  " : "; ") + e.parameter.name + ": " + e.parameter.meaning;
  }
  return table(rows) + meanings + '\n';
}

// ", taken as exact; by the scatter around the law they are 2.1 times longer"
std::string scatter_text(const Fit& fit) {
  return ", taken as exact; by the scatter around the law they are " +
         number(fit.scatter_ratio, 2) + " times longer";
}

// The source of the errors.
std::string basis_of_errors(const Fit& fit) {
  std::ostringstream text;
  text << fit.n_points << " points";
  if (fit.n_bins > 0) text << " fitted as " << fit.n_bins << " means over at most 1 % of t";
  if (fit.n_realizations == 0 && too_short_for_errors(fit)) {
    text << "; no errors, because the residuals are correlated for too long";
    return text.str();
  }
  text << (fit.n_free > 0 ? "; errors at 68 %, from " : "; weights from ");
  if (fit.n_realizations > 0) {
    text << "the scatter of " << fit.n_realizations << " realizations";
  } else {
    text << (fit.sigma_given ? "the errors given" : "the scatter about the law");
  }
  if (fit.scatter_ratio > 1) text << scatter_text(fit);
  if (fit.error_dof < 100) {
    text << ", Student's t of " << number(std::max(fit.error_dof, 0.0), 3)
         << (fit.error_dof == 1 ? " degree of freedom" : " degrees of freedom");
  }
  return text.str();
}

std::string statistics(const Fit& fit) {
  std::ostringstream text;
  text << "  " << fit.n_free << " free parameters; ended by " << describe(fit.reason) << " ("
       << fit.iterations << " iterations)\n";
  text << "  " << (fit.sigma_given ? "chi2 " : "residual sum ") << number(fit.residual_sum, 5)
       << ", worth " << number(fit.effective_size, 4) << " independent points, by weight "
       << number(fit.weighted_size, 4) << " points\n";
  text << "  condition " << number(fit.condition, 3) << ", " << fit.runs.runs << " runs ("
       << number(fit.runs.expected, 4) << " expected, " << p_value_text(fit.runs.p) << ")\n";
  return text.str();
}

bool all_identified(const Fit& fit) {
  return std::ranges::all_of(fit.estimates, [](const Estimate& estimate) {
    return estimate.identifiability == Identifiability::identified ||
           estimate.identifiability == Identifiability::fixed;
  });
}

/// "X_inf, tau identified; B wide".
std::string listed_verdicts(const Fit& fit) {
  if (fit.n_free == 0) return "all parameters fixed";
  if (all_identified(fit)) {
    return fit.n_free == fit.estimates.size() ? "all parameters identified"
                                              : "all free parameters identified";
  }
  std::map<Identifiability, std::string> names;
  for (const Estimate& estimate : fit.estimates) {
    std::string& listed = names[estimate.identifiability];
    listed += (listed.empty() ? "" : ", ") + estimate.parameter.name;
  }
  std::string text;
  for (const auto& [identifiability, listed] : names) {
    text += (text.empty() ? "" : "; ") + listed + " " + verdict_text(identifiability);
  }
  return text;
}

/// Adds the basis of the verdicts where the curve contradicts the errors given.
std::string what_is_identified(const Fit& fit) {
  const std::string listed = listed_verdicts(fit);
  return fit.scatter_ratio > 1 ? listed + ", from the errors given" + scatter_text(fit) : listed;
}

// Laws that draw this curves are one law: the first of them competes.
std::vector<const Fit*> distinct(const std::vector<Fit>& fits) {
  std::vector<const Fit*> found;
  for (const Fit& fit : fits) {
    const bool known = std::ranges::any_of(found, [&](const Fit* earlier) {
      return earlier->restated && earlier->restated->model == fit.model;
    });
    if (!known) found.push_back(&fit);
  }
  return found;
}

// How a law compares with the leading one: "two_exponentials (p = 0.0013)".
std::string compared_text(const HeldOutLaw& law) {
  return law.model + " (" + (law.same_curve ? "same curve" : p_value_text(law.p)) + ")";
}

std::string listed(const std::vector<std::string>& texts) {
  std::string all;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (i > 0) all += i + 1 < texts.size() ? ", " : " and ";
    all += texts[i];
  }
  return all;
}

}  // namespace

std::string difference_text(const HeldOutLaw& law) {
  return value_with_error(law.difference, half_width(law.error, law.dof), 1);
}

std::string estimate_text(const Estimate& estimate, const std::string& unit) {
  if (estimate.identifiability == Identifiability::fixed) {
    return number(estimate.value, 6) + unit + " fixed";
  }
  if (!estimate.has_value()) return "-";
  if (!estimate.intervals[0].closed()) return number(estimate.value, 4) + unit + ", error unknown";
  const double half = estimate.half_width();
  const Interval &middle = estimate.intervals[0], &wide = estimate.intervals[1];
  if (is_lopsided(estimate.value, middle.lower, middle.upper, wide.lower, wide.upper))
    return value_with_limits(estimate.value, middle.lower, middle.upper) + unit;
  return value_with_error(estimate.value, half) + unit;
}

std::string interval_text(const Estimate& estimate, std::size_t level) {
  if (estimate.identifiability <= Identifiability::not_examined) return "-";
  const Interval& interval = estimate.intervals[level];
  return limits_text(interval.lower, interval.upper, 5);
}

std::vector<ParameterTable> parameter_tables(const Fit& fit) {
  std::vector<ParameterTable> tables;
  if (fit.limit) {
    tables.push_back({"fitted as its limit, X = " + fit.limit->formula, fit.limit->estimates});
    tables.push_back({"full law: " + fit.model +
                          " fits equally well, and may differ from its limit after the last t",
                      fit.estimates});
  } else {
    tables.push_back({"", shown_estimates(fit)});
  }
  if (fit.restated) {
    tables.push_back({"the same curve as " + fit.restated->model + ", " + fit.restated->formula +
                          "  [" + fit.restated->source + "]",
                      fit.restated->estimates});
  }
  return tables;
}

std::string unit_text(ParameterUnit unit, const CurveUnits& units) {
  const std::string x = units.x.empty() ? "[X]" : units.x;
  const std::string t = units.t.empty() ? "[t]" : units.t;
  switch (unit) {
    case ParameterUnit::none:
      return "1";
    case ParameterUnit::value:
      return x;
    case ParameterUnit::time:
      return t;
    case ParameterUnit::value_per_time:
      return x + "/" + t;
    case ParameterUnit::value_time:
      return x == "1" ? t : x + " " + t;
    case ParameterUnit::per_time:
      return "1/" + t;
  }
  return "";
}

std::string describe(const Fit& fit, ReportDetail detail, const CurveUnits& units) {
  std::ostringstream text;
  text << fit.model << ": " << (fit.logarithmic ? "ln X = ln of " : "X = ") << fit.formula;
  if (!fit.source.empty()) text << "  [" << fit.source << "]";
  text << '\n';
  for (const ParameterTable& table : parameter_tables(fit)) {
    if (!table.heading.empty()) text << "  " << table.heading << ":\n";
    text << parameter_table(table.estimates);
  }
  text << listed_units(fit, units) << "  " << basis_of_errors(fit) << "; reduced "
       << (fit.sigma_given ? "chi2 " : "residual sum ") << number(fit.reduced_chi2, 3) << ", R2 "
       << r2_text(fit.r2) << '\n';
  if (detail == ReportDetail::full) text << more_of_the_parameters(fit) << statistics(fit);
  for (const std::string& remark : fit.remarks) text << "  ! " << remark << '\n';
  return text.str();
}

std::string compare(const std::vector<Fit>& fits, const LawComparison& comparison) {
  if (fits.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"model", "free", "chi2/dof", "held-out", "difference", "p", "runs p"}};
  for (const Fit* fit : distinct(fits)) {
    const auto law = std::ranges::find(comparison.laws, fit->model, &HeldOutLaw::model);
    const bool is_compared = law != comparison.laws.end();
    const bool is_leading = is_compared && law->model == comparison.laws[comparison.leading].model;
    rows.push_back({fit->model + (fit->logarithmic ? " (ln X)" : ""), std::to_string(fit->n_free),
                    number(fit->reduced_chi2, 4), is_compared ? number(law->squared_error, 5) : "-",
                    is_leading                       ? "least"
                    : is_compared && law->same_curve ? "same curve"
                    : is_compared                    ? difference_text(*law)
                                                     : "-",
                    is_compared && !is_leading ? probability_text(law->p) : "-",
                    probability_text(fit->runs.p)});
  }
  std::string text = table(rows);
  if (!comparison.laws.empty()) {
    text +=
        "  held-out: mean squared error of the prediction of a realization that the fit has "
        "not seen, in variances of one realization\n";
  }
  for (const std::string& sentence : comparison.left_out) text += "  ! " + sentence + '\n';
  return text;
}

std::string choice_text(const LawComparison& comparison) {
  if (!comparison.cannot_decide.empty()) return "cannot decide: " + comparison.cannot_decide;
  if (comparison.laws.empty()) return "";
  std::vector<std::string> worse, open;
  for (const HeldOutLaw& law : comparison.laws) {
    if (law.model == comparison.laws[comparison.leading].model) continue;
    (law.worse ? worse : open).push_back(compared_text(law));
  }
  const std::string& leading = comparison.laws[comparison.leading].model;
  const std::string worse_laws = listed(worse);
  if (open.empty()) return leading + " predicts held-out realizations better than " + worse_laws;
  open.insert(open.begin(), leading);
  std::string text = "undecided: " + listed(open) +
                     " predict held-out realizations equally well, within the errors";
  if (!worse.empty())
    text += "; " + worse_laws + (worse.size() > 1 ? " predict" : " predicts") + " worse";
  return text;
}

std::string verdict(const std::vector<Fit>& fits, const LawComparison& comparison) {
  if (fits.empty()) return "";
  if (fits.size() == 1) return fits.front().model + ": " + what_is_identified(fits.front());
  std::string text = choice_text(comparison);
  for (const Fit* fit : distinct(fits)) {
    const bool is_chosen =
        comparison.is_decided() && fit->model == comparison.laws[comparison.leading].model;
    if (!is_chosen && !all_identified(*fit)) continue;
    text += (text.empty() ? "" : "; ") + fit->model + ": " + what_is_identified(*fit);
  }
  return text;
}

}  // namespace jostle::inline fitting
