#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/json/json.hpp"
#include "ensemble/statistics/resampled_fit.hpp"
#include "fitting/fit.hpp"
#include "fitting/report.hpp"

namespace jostle {

/// A fit of one model, or why there is none, with the errors of resampled realizations if asked
/// for.
struct FitOutcome {
  std::string model;
  std::variant<Fit, Refusal> result;
  std::optional<ResampledErrors> resampled;
};

/// Everything of a fit but residuals and fitted values; numbers that do not exist are null.
Json fit_json(const FitOutcome& outcome);

/// For people: the report of the fit with the resampled errors under it, or the refusal.
std::string fit_text(const FitOutcome& outcome, ReportDetail detail);

/// The curve with its fits: columns t, X, sigma if given, and one a model that was fitted.
std::string fit_csv(const Curve& curve, const std::vector<FitOutcome>& outcomes);

}  // namespace jostle
