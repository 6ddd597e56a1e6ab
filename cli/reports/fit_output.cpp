#include "cli/reports/fit_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/tables/table_output.hpp"
#include "cli/tables/text_table.hpp"
#include "cli/tables/wrapped.hpp"
#include "fitting/report.hpp"
#include "fitting/summary.hpp"
#include "fitting/value_text.hpp"

namespace jostle::inline cli {

namespace {

constexpr const char* verdict_legend =
    "\na(b): b, in the last digits of a, is half the 68 % interval; a(+b/-c): its two sides; -: "
    "the 68 % interval is open, or the 95 % interval is open on both sides (not identifiable).\n"
    "wide: the 95 % interval is longer than an eighth of the curve's range (a level or a place), "
    "has ends that differ by more than a factor 2 (another positive parameter, or the factor of a "
    "power of t), or contains 0 (a slope or a factor); identified: the interval has two ends and "
    "is not wide.\n";

/// The conventions of the tables, and placeholders of units that the file does not give.
std::string legend(const CurveUnits& units) {
  std::string text = verdict_legend;
  if (units.x.empty() && units.t.empty()) {
    text += "[X], [t]: the units of the values and of t, which the file does not give.\n";
  } else if (units.x.empty() || units.t.empty()) {
    text += fmt::format("{}, which the file does not give.\n",
                        units.x.empty() ? "[X]: the unit of the values" : "[t]: the unit of t");
  }
  return text + "docs/reference/laws.md describes all terms.\n";
}

/// "  verdict    ...", at most four lines: the law, its asymptote, a warning.
std::string summary_lines(const std::vector<Fit>& fits, const FittedCurve& fitted) {
  const FitsSummary found = summary(fits, fitted.comparison, fitted.source.units);
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    if (!value.empty()) text += fmt::format("  {:<9}  {}\n", name, value);
  };
  line("verdict", found.choice);
  line("asymptote", found.asymptote);
  line("warning", found.warning);
  return text;
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json interval_json(const Interval& interval) {
  return Json::array({number(interval.lower), number(interval.upper)});
}

Json matrix_json(const Fit& fit, bool correlation) {
  const auto& matrix = correlation ? fit.correlation : fit.covariance;
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(number(matrix(i, j)));
    rows.push_back(row);
  }
  return rows;
}

Json estimate_json(const Estimate& estimate) {
  const bool known = estimate.has_value();
  return {{"value", known ? number(estimate.value) : Json()},
          {"error", known ? number(estimate.error) : Json()},
          {"half_width_68", known ? number(estimate.half_width()) : Json()},
          {"standard_error", number(estimate.standard_error)},
          {"interval_68", interval_json(estimate.intervals[0])},
          {"interval_95", interval_json(estimate.intervals[1])},
          {"identifiability", name_of(estimate.identifiability)},
          {"statement", estimate.statement}};
}

Json parameters_json(const Fit& fit, const std::optional<ResampledErrors>& resampled) {
  Json parameters = Json::object();
  for (std::size_t j = 0; j < fit.estimates.size(); ++j) {
    const Estimate& estimate = fit.estimates[j];
    Json entry = estimate_json(estimate);
    if (resampled) {
      const bool known = fit.estimates[j].has_value();
      entry["resampled_error"] = known ? number(resampled->errors[j]) : Json();
      if (!resampled->central.empty()) {
        const Interval open = {-std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity()};
        entry["bootstrap_68"] = interval_json(known ? resampled->middle[j] : open);
        entry["bootstrap_95"] = interval_json(known ? resampled->central[j] : open);
      }
    }
    parameters[estimate.parameter.name] = entry;
  }
  return parameters;
}

/// The report of the fit with the resampled errors under it, or the refusal.
std::string fit_text(const FitOutcome& outcome, ReportDetail detail, const CurveUnits& units) {
  if (const auto* refusal = std::get_if<Refusal>(&outcome.result)) {
    return fmt::format("{}: no fit: {}\n", outcome.model, refusal->message);
  }
  const Fit& fit = std::get<Fit>(outcome.result);
  std::string text = describe(fit, detail, units);
  if (!outcome.resampled) return text;
  const ResampledErrors& resampled = *outcome.resampled;
  text +=
      fmt::format("  standard errors from {} resamples of the realizations:", resampled.resamples);
  for (std::size_t j = 0; j < fit.estimates.size(); ++j) {
    const Estimate& estimate = fit.estimates[j];
    text += fmt::format("{} {} {}", j == 0 ? "" : ",", estimate.parameter.name,
                        estimate.has_value() ? number_text(resampled.errors[j], 2) : "-");
  }
  text += "\n";
  if (resampled.failed > 0) {
    text += fmt::format("  ! {} of the resamples did not settle and are not counted\n",
                        resampled.failed);
  }
  return text;
}

}  // namespace

Json fit_json(const FitOutcome& outcome) {
  if (const auto* refusal = std::get_if<Refusal>(&outcome.result)) {
    return {{"model", outcome.model}, {"refused", refusal->message}};
  }
  const Fit& fit = std::get<Fit>(outcome.result);
  Json names = Json::array(), combinations = Json::object();
  for (const Estimate& found : fit.combinations) {
    combinations[found.parameter.name] = estimate_json(found);
  }
  for (const Estimate& estimate : fit.estimates) names.push_back(estimate.parameter.name);
  Json object = {{"model", fit.model},
                 {"formula", fit.formula},
                 {"source", fit.source},
                 {"parameters", parameters_json(fit, outcome.resampled)},
                 {"order", names},
                 {"combinations", combinations},
                 {"covariance", matrix_json(fit, false)},
                 {"correlation", matrix_json(fit, true)},
                 {"points", fit.n_points},
                 {"free_parameters", fit.n_free},
                 {"realizations", fit.n_realizations},
                 {"error_dof", number(fit.error_dof)},
                 {"weighted_points", number(fit.weighted_size)},
                 {"memory", number(fit.memory.time)},
                 {"bins", fit.n_bins},
                 {"sigma_given", fit.sigma_given && fit.n_realizations == 0},
                 {"logarithmic", fit.logarithmic},
                 {"residual_sum", number(fit.residual_sum)},
                 {"reduced_chi2", number(fit.reduced_chi2)},
                 {"scatter_ratio", number(fit.scatter_ratio)},
                 {"r2", number(fit.r2)},
                 {"condition", number(fit.condition)},
                 {"runs", fit.runs.runs},
                 {"runs_expected", number(fit.runs.expected)},
                 {"runs_p", number(fit.runs.p)},
                 {"effective_points", number(fit.effective_size)},
                 {"error_factor", number(fit.error_factor)},
                 {"ended", describe(fit.reason)},
                 {"settled", is_minimum(fit.reason)},
                 {"iterations", fit.iterations},
                 {"evaluations", fit.evaluations},
                 {"total_evaluations", fit.total_evaluations},
                 {"starts_tried", fit.starts_tried},
                 {"remarks", fit.remarks}};
  const auto parameters = [](const std::vector<Estimate>& estimates) {
    Json all = Json::object();
    for (const Estimate& found : estimates) all[found.parameter.name] = estimate_json(found);
    return all;
  };
  if (fit.restated) {
    object["restated"] = {{"model", fit.restated->model},
                          {"formula", fit.restated->formula},
                          {"source", fit.restated->source},
                          {"parameters", parameters(fit.restated->estimates)}};
  }
  if (fit.limit) {
    object["limit"] = {{"model", fit.limit->name},
                       {"formula", fit.limit->formula},
                       {"statement", fit.limit->statement},
                       {"parameters", parameters(fit.limit->estimates)}};
  }
  // The limit leads where the least squares are there, in every report.
  if (fit.limit) {
    const Json limit = object["limit"];
    object["reported"] = limit;
  } else {
    object["reported"] = {
        {"model", fit.model}, {"formula", fit.formula}, {"parameters", parameters(fit.estimates)}};
  }
  if (outcome.resampled) {
    object["resamples"] = outcome.resampled->resamples;
    object["resamples_failed"] = outcome.resampled->failed;
  }
  return object;
}

Json comparison_json(const LawComparison& comparison) {
  Json laws = Json::object(), candidates = Json::array();
  for (const HeldOutLaw& law : comparison.laws) {
    if (!law.worse) candidates.push_back(law.model);
    laws[law.model] = {{"held_out_error", number(law.squared_error)},
                       {"difference", number(law.difference)},
                       {"difference_error", number(law.error)},
                       {"difference_dof", number(law.dof)},
                       {"difference_half_width_68", number(half_width(law.error, law.dof))},
                       {"t", number(law.t)},
                       {"p", number(law.p)},
                       {"worse", law.worse}};
  }
  const bool decided = comparison.is_decided();
  return {{"choice", choice_text(comparison)},
          {"decided", decided},
          {"leading",
           comparison.laws.empty() ? Json() : Json(comparison.laws[comparison.leading].model)},
          {"candidates", candidates},
          {"realizations", comparison.n_realizations},
          {"laws", laws},
          {"left_out", comparison.left_out}};
}

std::string fits_text(const FittedCurve& fitted, const Layout& layout) {
  std::vector<Fit> fits;
  for (const FitOutcome& outcome : fitted.outcomes) {
    if (const auto* found = std::get_if<Fit>(&outcome.result)) fits.push_back(*found);
  }
  std::string text = fitted.source.title + "\n";
  if (!fits.empty()) text += summary_lines(fits, fitted);
  for (const std::string& note : fitted.source.notes) {
    text += fmt::format("  note       {}\n", note);
  }
  const ReportDetail detail =
      layout.columns == Columns::all ? ReportDetail::full : ReportDetail::brief;
  for (const FitOutcome& outcome : fitted.outcomes) {
    text += '\n';
    text += fit_text(outcome, detail, fitted.source.units);
  }
  if (fits.size() > 1) text.append("\n").append(compare(fits, fitted.comparison));
  if (!fits.empty()) text += legend(fitted.source.units);
  text += '\n';
  return wrapped(text, layout.width);
}

namespace {

// The asymptote of the full law, as the summary of the fit has it: the law may go on to rise where
// its limit ends. An asymptote without an upper or lower limit is its 95 % limit.
std::string asymptote_of_law(const Fit& fit) {
  const auto found = std::ranges::find_if(
      fit.estimates, [](const Estimate& e) { return e.parameter.name.ends_with("_inf"); });
  if (found == fit.estimates.end()) return "-";
  const std::string name = found->parameter.name + " ";
  const bool is_limited =
      found->has_value() || found->identifiability == Identifiability::not_examined;
  return name + (is_limited ? estimate_text(*found) : interval_text(*found, 1));
}

// "inverse_log at 0.05 as hyperbola", for each law that was fitted as its limit.
std::string fitted_limits(const std::vector<FitSummary>& rows) {
  std::string text;
  for (const FitSummary& row : rows) {
    if (row.limit.empty()) continue;
    text += fmt::format("{}{}{} as {}", text.empty() ? " Fitted as a limit of the law: " : ", ",
                        row.law, row.point.empty() ? "" : " at " + row.point, row.limit);
  }
  return text.empty() ? "" : text + ".";
}

}  // namespace

std::vector<FitSummary> summary_of(const FittedCurve& fitted) {
  std::vector<FitSummary> rows;
  const LawComparison& comparison = fitted.comparison;
  for (const FitOutcome& outcome : fitted.outcomes) {
    FitSummary row{
        fitted.source.observable, fitted.source.label, outcome.model, "fitted", "-", "-"};
    if (const auto* fit = std::get_if<Fit>(&outcome.result)) {
      row.asymptote = asymptote_of_law(*fit);
      if (fit->limit) row.limit = fit->limit->name;
    } else {
      row.verdict = "no fit";
    }
    const auto law = std::ranges::find(comparison.laws, outcome.model, &HeldOutLaw::model);
    if (law != comparison.laws.end()) {
      if (law->model == comparison.laws[comparison.leading].model) {
        row.verdict = comparison.is_decided() ? "best" : "not rejected";
        row.difference = "least";
      } else {
        row.verdict = law->worse ? "rejected" : "not rejected";
        row.difference = law->same_curve ? "same curve" : difference_text(*law);
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string summary_text(const std::vector<FitSummary>& rows, const Layout& layout) {
  if (rows.empty()) return "";
  const bool is_compared =
      std::ranges::any_of(rows, [](const FitSummary& row) { return row.difference != "-"; });
  const bool has_points =
      std::ranges::any_of(rows, [](const FitSummary& row) { return !row.point.empty(); });
  const auto cells_of = [&](const FitSummary& row) {
    std::vector<std::string> cells{row.law, row.verdict};
    if (has_points) cells.insert(cells.begin(), row.point);
    if (is_compared) cells.push_back(row.difference);
    cells.push_back(row.asymptote);
    return cells;
  };
  const bool has_limits = std::ranges::any_of(rows, [](const FitSummary& row) {
    return row.asymptote.find_first_of("<>") != std::string::npos;
  });
  std::string text;
  std::vector<std::string> printed;
  for (const FitSummary& first : rows) {
    const std::string& observable = first.observable;
    if (std::ranges::find(printed, observable) != printed.end()) continue;
    TextTable table(
        cells_of({observable, "sweep point", "law", "verdict", "difference", "asymptote"}),
        has_points ? 2 : 1);
    for (const FitSummary& row : rows) {
      if (row.observable == observable) table.add(cells_of(row));
    }
    text += fmt::format("{}fits of {}\n{}", printed.empty() ? "" : "\n", observable,
                        table.text(layout.table_width()));
    printed.push_back(observable);
  }
  return text + wrapped(fmt::format("a(b): b, in the last digits of a, is half the 68 % "
                                    "interval.{}{}{} --verbose prints every fit.\n",
                                    has_limits ? " > or <: the only 95 % limit." : "",
                                    is_compared ? " difference: of the held-out errors, from the "
                                                  "leading law."
                                                : "",
                                    fitted_limits(rows)),
                        layout.width);
}

std::string memory_hint(const FittedCurve& fitted) {
  if (fitted.source.point || fitted.source.curve.n_realizations > 0) return "";
  const bool open = std::ranges::any_of(fitted.outcomes, [](const FitOutcome& outcome) {
    const auto* fit = std::get_if<Fit>(&outcome.result);
    return fit != nullptr && fit->memory.time > 0 && !std::isfinite(fit->estimates.front().error);
  });
  return open ? "\nWhere every point is an experiment of its own, --independent gives errors.\n"
              : "";
}

std::string fit_csv(const Curve& source, const std::vector<FitOutcome>& outcomes) {
  const bool logarithmic = std::ranges::all_of(outcomes, [](const FitOutcome& outcome) {
    const auto* fit = std::get_if<Fit>(&outcome.result);
    return fit == nullptr || fit->logarithmic;
  });
  const Curve curve = with_pooled_errors(source, logarithmic);
  std::string text = curve.sigma.empty() ? "t,X" : "t,X,sigma";
  std::vector<const Fit*> fits;
  for (const FitOutcome& outcome : outcomes) {
    if (const auto* fit = std::get_if<Fit>(&outcome.result)) {
      fits.push_back(fit);
      text += "," + fit->model;
    }
  }
  text += "\n";
  for (std::size_t i = 0; i < curve.t.size(); ++i) {
    text += csv_number(curve.t[i]) + "," + csv_number(curve.x[i]);
    if (!curve.sigma.empty()) text += "," + csv_number(curve.sigma[i]);
    for (const Fit* fit : fits) text += "," + csv_number(fit->fitted[i]);
    text += "\n";
  }
  return text;
}

}  // namespace jostle::inline cli
