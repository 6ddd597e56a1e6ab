#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "config/scene.hpp"
#include "ensemble/analysis/table.hpp"
#include "ensemble/statistics/resampled_fit.hpp"
#include "fitting/comparison/held_out.hpp"
#include "fitting/fit.hpp"
#include "fitting/models/models.hpp"
#include "study/tables/fit_source.hpp"

namespace jostle::inline study {

/// How curves are fitted and how the errors of resampled realizations are made.
struct FitManner {
  std::map<std::string, double> fixed = {};  // parameters that keep a value
  bool memory =
      true;  // memory of a single curve, sought in its residuals; not for independent points
  std::string t_unit = {};  // unit of t in remarks; fit_curve() takes that of its source
  bool resampled = false;
  ResamplingOptions resampling = {};
};

/// A fit of one model, or why there is none, with the errors of resampled realizations if asked
/// for.
struct FitOutcome {
  std::string model;
  std::variant<Fit, Refusal> result;
  std::optional<ResampledErrors> resampled;
};

/// A curve with its fits, one per model, and their comparison.
struct FittedCurve {
  FitSource source;
  std::vector<FitOutcome> outcomes;
  LawComparison comparison = {};
};

/// A model of docs/reference/laws.md, or for "all" every law of an approach to a final value. Empty
/// where there is none of that name.
std::vector<std::unique_ptr<Model>> models_named(const std::string& name);

std::vector<FitOutcome> fit_models(const std::vector<std::unique_ptr<Model>>& models,
                                   const Curve& curve, const FitManner& manner);

/// Why no law could be fitted to a curve, each reason with the laws that it concerns; empty where
/// one was fitted.
std::string refusal_of_all(const FittedCurve& fitted);

/// Fits every model to a curve and compares the laws that could be fitted.
FittedCurve fit_curve(const std::vector<std::unique_ptr<Model>>& models, FitSource source,
                      const FitManner& manner);

/// One table per fit, point_PPPP/<observable>/<model>, in the form of results files. `manner`
/// describes resampled errors.
std::vector<Table> fit_tables(const FittedCurve& fitted, const FitManner& manner);

/// Returns the units of a parameter as they are printed, for units as tables of fits name them:
/// "d/taps" for "X/t" of a height against taps. Other units stay.
std::string units_of_parameter(const std::string& table_units, const CurveUnits& curve_units);

/// Called for every curve after its fits; may be empty.
using FitObserver = std::function<void(const FittedCurve&)>;

/// The fits that a scene asks for, at every sweep point of its results. Throws BadArgument for an
/// observable that there is not, ResultsError for the file.
std::vector<FittedCurve> scene_fits(const ResultsFile& file, std::span<const FitRequest> requests,
                                    const FitManner& manner, const FitObserver& observer = {});

}  // namespace jostle::inline study
