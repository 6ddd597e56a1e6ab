#pragma once

#include <string>
#include <vector>

#include "fitting/fit.hpp"

namespace jostle::inline fitting {

enum class ReportDetail {
  brief,  // values with errors, 95 % intervals, verdicts, remarks
  full    // linear errors, 68 % intervals and the statistics of the fit as well
};

/// A fit for people: the law, a table of parameters, what errors and intervals rest on, and
/// remarks. Several lines, each ended by a newline. A value stands with its error only: half of
/// the 68 % interval, which holds the value; "-" where that interval is open.
std::string describe(const Fit& fit, ReportDetail detail = ReportDetail::brief);

/// Fits of one curve by several models, best AIC first: reduced chi2, R2, AIC and BIC with their
/// distance from the best.
std::string compare(const std::vector<Fit>& fits);

}  // namespace jostle::inline fitting
