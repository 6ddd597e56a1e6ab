#include "study/tables/fits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "engine/numbers.hpp"
#include "fitting/report.hpp"
#include "fitting/value_text.hpp"
#include "results/groups/layout.hpp"
#include "study/results_input.hpp"

namespace jostle::inline study {

namespace {

/// In the parameters of the law, whichever law was fitted.
ResampledErrors resampled_errors(const Model& model, const RealizationCurves& curves,
                                 const Fit& fit, const ResamplingOptions& options) {
  if (!fit.limit) return resample(model, curves, fit, options);
  Fit at_limit = fit;
  at_limit.estimates = fit.limit->estimates;
  const ResampledErrors found = resample(*fit.limit->law, curves, at_limit, options);
  ResampledErrors errors;
  errors.resamples = found.resamples;
  errors.failed = found.failed;
  const std::vector<Parameter>& known = fit.limit->law->parameters();
  for (const Estimate& estimate : fit.estimates) {
    const auto place = std::ranges::find(known, estimate.parameter.name, &Parameter::name);
    const auto k = static_cast<std::size_t>(place - known.begin());
    const bool has = place != known.end();
    errors.errors.push_back(has ? found.errors[k] : infinite);
    if (found.central.empty()) continue;
    errors.middle.push_back(has ? found.middle[k] : Interval{-infinite, infinite});
    errors.central.push_back(has ? found.central[k] : Interval{-infinite, infinite});
  }
  return errors;
}

constexpr double noticed_difference = 1.25;  // ratio of two errors of one parameter

// Where errors of resampled realizations differ from those of the profiles, and by how much at
// most.
void remark_on_resampled(const ResampledErrors& resampled, Fit& fit) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < fit.estimates.size(); ++j) {
    const double error = fit.estimates[j].error, resampled_error = resampled.errors[j];
    if (!fit.estimates[j].has_value() || !(error > 0 && resampled_error > 0)) continue;
    if (!std::isfinite(error) || !std::isfinite(resampled_error)) continue;
    if (std::max(error / resampled_error, resampled_error / error) <= noticed_difference) continue;
    names.push_back(fmt::format("{} ({}, profile {})", fit.estimates[j].parameter.name,
                                number_text(half_width(resampled_error, fit.error_dof), 2),
                                number_text(half_width(error, fit.error_dof), 2)));
  }
  if (names.empty()) return;
  fit.remarks.push_back(fmt::format(
      "Errors from resamples and from profiles differ by more than 25 % (half widths at 68 %): {}. "
      "The law is far from linear here, or misses the curve; quote the longer error.",
      fmt::join(names, ", ")));
}

FitOutcome fit_model(const Model& model, const Curve& curve, const FitManner& manner) {
  FitOptions options;
  options.fixed = manner.fixed;
  options.memory = manner.memory;
  options.t_unit = manner.t_unit;
  FitOutcome outcome{model.name(), fit(model, curve, options), {}};
  const auto* found = std::get_if<Fit>(&outcome.result);
  if (!found || curve.n_realizations < 2 || !manner.resampled) return outcome;
  const bool logarithmic = is_fitted_in_logarithms(model, curve);
  const Curve weighted = curve.present.empty() ? curve : with_pooled_errors(curve, logarithmic);
  const RealizationCurves curves{curve.t, weighted.sigma, curve.values,
                                 static_cast<std::uint32_t>(curve.n_realizations)};
  outcome.resampled = resampled_errors(model, curves, *found, manner.resampling);
  remark_on_resampled(*outcome.resampled, std::get<Fit>(outcome.result));
  return outcome;
}

/// Units of the observable and of taps, as tables name them.
const CurveUnits units_of_tables = {"X", "t"};

std::string lines(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all.append(all.empty() ? "" : "\n").append(text);
  return all;
}

Quantity values(std::string name, std::vector<std::string> axes, std::vector<double> numbers,
                std::string long_name) {
  return {std::move(name), std::move(axes), std::move(numbers), "", std::move(long_name), ""};
}

/// Columns of estimates as tables hold them.
struct EstimateColumns {
  explicit EstimateColumns(const std::vector<Estimate>& estimates) {
    for (const Estimate& estimate : estimates) {
      names.push_back(estimate.parameter.name);
      units.push_back(unit_text(estimate.parameter.unit, units_of_tables));
      statements.push_back(estimate.statement);
      found.push_back(name_of(estimate.identifiability));
      value.push_back(estimate.has_value() ? estimate.value : not_a_number);
      error.push_back(estimate.has_value() ? estimate.error : not_a_number);
      linear.push_back(estimate.standard_error);
      for (const Interval& interval : estimate.intervals) {
        lower.push_back(interval.lower);
        upper.push_back(interval.upper);
      }
    }
  }

  std::vector<std::string> names, units, statements, found;
  std::vector<double> value, error, linear, lower, upper;
};

/// Along `axis`; `prefix` is that of their names.
void add_estimates(Table& table, const EstimateColumns& columns, const std::string& axis,
                   const std::string& prefix) {
  const std::vector<std::string> axes = {axis}, ends = {axis, "level"};
  const std::vector<Quantity> added = {
      values(prefix + "value", axes, columns.value,
             "least squares; not a number where the data set no limits"),
      values(prefix + "error", axes, columns.error,
             "standard error that counts realizations or memory: half the 68 % interval over "
             "Student's t of error_dof"),
      values(prefix + "standard_error", axes, columns.linear,
             "of a linear problem with independent points"),
      {prefix + "units", axes, columns.units, "", "units of the parameter", ""},
      {prefix + "statement", axes, columns.statements, "", "how well the data limit the parameter",
       ""},
      {prefix + "identifiability", axes, columns.found, "", "the statement in a word", ""},
      values(prefix + "interval_lower", ends, columns.lower,
             "lower end of the interval: by profile likelihood, or Student's t where "
             "realizations differ in shape"),
      values(prefix + "interval_upper", ends, columns.upper,
             "upper end of the interval: by profile likelihood, or Student's t where "
             "realizations differ in shape")};
  table.quantities.insert(table.quantities.end(), added.begin(), added.end());
}

void add_parameters(Table& table, const FitOutcome& outcome, const Fit& fit) {
  const EstimateColumns columns(fit.estimates);
  std::vector<double> resampled, covariance, correlation;
  for (std::size_t j = 0; j < fit.estimates.size(); ++j) {
    if (outcome.resampled) {
      resampled.push_back(fit.estimates[j].has_value() ? outcome.resampled->errors[j]
                                                       : not_a_number);
    }
    for (std::size_t k = 0; k < fit.estimates.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(j), column = static_cast<Eigen::Index>(k);
      covariance.push_back(fit.covariance(row, column));
      correlation.push_back(fit.correlation(row, column));
    }
  }
  const std::vector<std::string> axes = {"parameter"}, matrix = {"parameter", "other_parameter"};
  table.axes = {{"parameter", axes, columns.names, "", "parameters of the law", ""},
                {"other_parameter", {"other_parameter"}, columns.names, "", "the same", ""},
                values("level", {"level"}, {interval_levels[0], interval_levels[1]},
                       "probability of an interval")};
  add_estimates(table, columns, "parameter", "");
  table.quantities.push_back(values("covariance", matrix, covariance, "covariance"));
  table.quantities.push_back(values("correlation", matrix, correlation, "correlation"));
  if (!resampled.empty()) {
    table.quantities.push_back(
        values("resampled_error", axes, resampled, "error from resampled realizations"));
  }
}

/// Estimates of another law of the same curve, along an axis of their own.
void add_other_law(Table& table, const std::vector<Estimate>& estimates, const std::string& prefix,
                   const std::string& meaning) {
  const EstimateColumns columns(estimates);
  const std::string axis = prefix + "parameter";
  table.axes.push_back({axis, {axis}, columns.names, "", meaning, ""});
  add_estimates(table, columns, axis, prefix);
}

void add_restated(Table& table, const RestatedFit& restated) {
  table.notes.emplace_back("restated_model", restated.model);
  table.notes.emplace_back("restated_law", restated.formula);
  table.notes.emplace_back("restated_source", restated.source);
  add_other_law(table, restated.estimates, "restated_",
                "parameters of the law that draws the same curve");
}

void add_limit(Table& table, const LimitingFit& limit) {
  table.notes.emplace_back("limit_model", limit.name);
  table.notes.emplace_back("limit_law", limit.formula);
  table.notes.emplace_back("limit", limit.statement);
  add_other_law(table, limit.estimates, "limit_", "parameters of the limit that was fitted");
}

void add_curve(Table& table, const Curve& source, const Fit& fit) {
  const Curve curve = with_pooled_errors(source, fit.logarithmic);
  const std::vector<std::string> axes = {"t"};
  table.axes.push_back(values("t", axes, curve.t, "taps"));
  table.quantities.push_back(values("x", axes, curve.x, "mean over realizations"));
  if (!curve.sigma.empty()) {
    table.quantities.push_back(
        values("x_error", axes, curve.sigma, "standard error of the mean, pooled over taps"));
    const double dof =
        curve.n_realizations > 1 ? static_cast<double>(curve.n_realizations - 1) : infinite;
    table.quantities.push_back(
        values("x_dof", {}, {dof}, "degrees of freedom of x_error; infinite for given errors"));
  }
  table.quantities.push_back(values("fitted", axes, fit.fitted, "the law"));
}

void add_statistics(Table& table, const Fit& fit) {
  const std::tuple<const char*, double, const char*> numbers[] = {
      {"points", static_cast<double>(fit.fitted.size()), "points of the curve"},
      {"residual_sum", fit.residual_sum,
       "sum of squared residuals, over x_error where the points have errors"},
      {"reduced_chi2", fit.reduced_chi2, "residual_sum over points less free parameters"},
      {"r2", fit.r2, "1 - residual_sum / weighted sum of squares about the weighted mean"},
      {"condition", fit.condition,
       "condition of J^T J for columns of the Jacobian J of unit length"},
      {"effective_points", fit.effective_size, "independent points that the residuals are worth"},
      {"weighted_points", fit.weighted_size, "points of equal weight, (sum w)^2 / sum w^2"},
      {"error_dof", std::max(fit.error_dof, 0.0), "degrees of freedom of error"},
      {"error_factor", fit.error_factor, "(points / effective_points)^(1/2)"},
      {"runs_p", fit.runs.p, "p-value of the runs of signs of the residuals in order of t"}};
  for (const auto& [name, value, meaning] : numbers) {
    table.quantities.push_back(values(name, {}, {value}, meaning));
  }
}

// How the law predicts held-out realizations, and the choice among those fitted with it.
void add_comparison(Table& table, const std::string& model, const LawComparison& comparison) {
  const std::string choice = choice_text(comparison);
  if (choice.empty()) return;
  table.notes.emplace_back("choice", choice);
  table.notes.emplace_back("left_out", lines(comparison.left_out));
  const auto law = std::ranges::find(comparison.laws, model, &HeldOutLaw::model);
  if (law == comparison.laws.end()) return;
  const std::tuple<const char*, double, const char*> numbers[] = {
      {"held_out_error", law->squared_error,
       "mean squared error of prediction of held-out realizations, in variances of one"},
      {"held_out_difference", law->difference, "held_out_error less that of the leading law"},
      {"held_out_difference_error", law->error, "standard error of held_out_difference"},
      {"held_out_difference_dof", law->dof, "its degrees of freedom"},
      {"held_out_p", law->p,
       "p-value of the hypothesis that this law is as close to the mean as the leading law"}};
  for (const auto& [name, value, meaning] : numbers) {
    table.quantities.push_back(values(name, {}, {value}, meaning));
  }
}

}  // namespace

std::vector<std::unique_ptr<Model>> models_named(const std::string& name) {
  std::vector<std::unique_ptr<Model>> models;
  if (name == "all") {
    for (const std::string& law : competing_laws()) models.push_back(make_model(law));
  } else if (auto model = make_model(name)) {
    models.push_back(std::move(model));
  }
  return models;
}

std::vector<FitOutcome> fit_models(const std::vector<std::unique_ptr<Model>>& models,
                                   const Curve& curve, const FitManner& manner) {
  std::vector<FitOutcome> outcomes;
  for (const auto& model : models) outcomes.push_back(fit_model(*model, curve, manner));
  return outcomes;
}

std::string refusal_of_all(const FittedCurve& fitted) {
  std::vector<std::pair<std::string, std::string>> reasons;  // and the laws
  for (const FitOutcome& outcome : fitted.outcomes) {
    const auto* refusal = std::get_if<Refusal>(&outcome.result);
    if (refusal == nullptr) return "";
    const auto known =
        std::ranges::find(reasons, refusal->message, &decltype(reasons)::value_type::first);
    if (known == reasons.end()) {
      reasons.emplace_back(refusal->message, outcome.model);
    } else {
      known->second += ", " + outcome.model;
    }
  }
  std::string text = fitted.source.title + ": no law could be fitted";
  for (const auto& [reason, laws] : reasons) text += fmt::format("\n  {}: {}", laws, reason);
  return text;
}

FittedCurve fit_curve(const std::vector<std::unique_ptr<Model>>& models, FitSource source,
                      const FitManner& manner) {
  FittedCurve fitted{std::move(source), {}};
  FitManner with_units = manner;
  with_units.t_unit = fitted.source.units.t;
  fitted.outcomes = fit_models(models, fitted.source.curve, with_units);
  std::vector<FittedLaw> laws;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (const auto* found = std::get_if<Fit>(&fitted.outcomes[i].result)) {
      laws.push_back({models[i].get(), found});
    }
  }
  fitted.comparison = compare_laws(laws, fitted.source.curve);
  return fitted;
}

std::string units_of_parameter(const std::string& table_units, const CurveUnits& curve_units) {
  for (const ParameterUnit unit :
       {ParameterUnit::value, ParameterUnit::time, ParameterUnit::value_per_time,
        ParameterUnit::value_time, ParameterUnit::per_time}) {
    if (unit_text(unit, units_of_tables) == table_units) return unit_text(unit, curve_units);
  }
  return table_units;
}

std::vector<Table> fit_tables(const FittedCurve& fitted, const FitManner& manner) {
  const auto& [source, outcomes, comparison] = fitted;
  std::vector<Table> tables;
  for (const FitOutcome& outcome : outcomes) {
    Table table;
    table.name = fmt::format("{}/{}/{}", point_name(source.point.value_or(0)), source.observable,
                             outcome.model);
    table.notes = {{"observable", source.observable}, {"sweep_point", source.label}};
    if (!source.curve.t.empty()) {
      table.notes.emplace_back("range",
                               fmt::format("{}:{}", source.curve.t.front(), source.curve.t.back()));
    }
    if (const auto* refusal = std::get_if<Refusal>(&outcome.result)) {
      table.notes.emplace_back("refused", refusal->message);
      tables.push_back(std::move(table));
      continue;
    }
    const Fit& fit = std::get<Fit>(outcome.result);
    table.notes.emplace_back("law", fit.formula);
    table.notes.emplace_back("reported_law", fit.limit ? fit.limit->formula : fit.formula);
    table.notes.emplace_back("source", fit.source);
    table.notes.emplace_back("ended", describe(fit.reason));
    table.notes.emplace_back("realizations", fmt::to_string(source.curve.n_realizations));
    table.notes.emplace_back("remarks", lines(fit.remarks));
    if (!source.notes.empty()) table.notes.emplace_back("source_notes", lines(source.notes));
    if (!fit.combinations.empty()) {
      std::vector<std::string> statements;
      for (const Estimate& found : fit.combinations) statements.push_back(found.statement);
      table.notes.emplace_back("combinations", lines(statements));
    }
    if (outcome.resampled) {
      const bool bootstrap = manner.resampling.kind == Resampling::bootstrap;
      table.notes.emplace_back(
          "resampling",
          fmt::format("{}, {} resamples, {} of them without a settled fit",
                      bootstrap ? fmt::format("bootstrap with seed {}", manner.resampling.seed)
                                : std::string("jackknife"),
                      outcome.resampled->resamples, outcome.resampled->failed));
    }
    add_parameters(table, outcome, fit);
    if (fit.restated) add_restated(table, *fit.restated);
    if (fit.limit) add_limit(table, *fit.limit);
    add_curve(table, source.curve, fit);
    add_statistics(table, fit);
    add_comparison(table, outcome.model, comparison);
    tables.push_back(std::move(table));
  }
  return tables;
}

std::vector<FittedCurve> scene_fits(const ResultsFile& file, std::span<const FitRequest> requests,
                                    const FitManner& manner, const FitObserver& observer) {
  std::vector<FittedCurve> all;
  for (const FitRequest& request : requests) {
    std::vector<std::unique_ptr<Model>> models;
    for (const std::string& name : request.models) {
      for (auto& model : models_named(name)) models.push_back(std::move(model));
    }
    const FitRange range{static_cast<double>(request.first),
                         request.last ? static_cast<double>(*request.last) : infinite};
    for (FitSource& source :
         results_curves(file, chosen_points(file.study(), ""), request.observable, range)) {
      all.push_back(fit_curve(models, std::move(source), manner));
      if (observer) observer(all.back());
    }
  }
  return all;
}

}  // namespace jostle::inline study
