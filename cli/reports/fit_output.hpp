#pragma once

#include <string>
#include <vector>

#include "cli/tables/layout.hpp"
#include "config/json/json.hpp"
#include "study/tables/fits.hpp"

namespace jostle::inline cli {

/// Everything of a fit but residuals and fitted values; numbers that do not exist are null.
Json fit_json(const FitOutcome& outcome);

/// How laws predict held-out realizations, and the choice between them.
Json comparison_json(const LawComparison& comparison);

/// The report of a curve and its fits, for people: what it is, what is identified, then every fit
/// with its resampled errors or the refusal, and their comparison. With all columns also what
/// ReportDetail::full has.
std::string fits_text(const FittedCurve& fitted, const Layout& layout);

/// One law of one curve in the summary that ends a run.
struct FitSummary {
  std::string observable, point, law, verdict, difference, asymptote;
  std::string limit = "";  // the law that was fitted instead, where least squares are at a limit
};

/// A row for each law that was fitted to the curve, or refused.
std::vector<FitSummary> summary_of(const FittedCurve& fitted);

/// The rows as one table with the convention of its errors below it. Empty without rows.
std::string summary_text(const std::vector<FitSummary>& rows, const Layout& layout);

/// The option that gives errors where one measured curve remembers for too long; or nothing.
std::string memory_hint(const FittedCurve& fitted);

/// The curve with its fits: columns t, X, sigma if given, and one a model that was fitted.
std::string fit_csv(const Curve& source, const std::vector<FitOutcome>& outcomes);

}  // namespace jostle::inline cli
