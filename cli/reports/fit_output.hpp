#pragma once

#include <string>
#include <vector>

#include "config/json/json.hpp"
#include "fitting/report.hpp"
#include "study/tables/fits.hpp"

namespace jostle::inline cli {

/// Everything of a fit but residuals and fitted values; numbers that do not exist are null.
Json fit_json(const FitOutcome& outcome);

/// For people: the report of the fit with the resampled errors under it, or the refusal.
std::string fit_text(const FitOutcome& outcome, ReportDetail detail);

/// The report of a curve and its fits, for people.
std::string fits_text(const FittedCurve& fitted, ReportDetail detail = ReportDetail::brief);

/// The curve with its fits: columns t, X, sigma if given, and one a model that was fitted.
std::string fit_csv(const Curve& curve, const std::vector<FitOutcome>& outcomes);

}  // namespace jostle::inline cli
