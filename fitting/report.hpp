#pragma once

#include <string>
#include <vector>

#include "fitting/fit.hpp"

namespace jostle::inline fitting {

enum class ReportDetail {
  brief,  // values with errors, 95 % intervals, verdicts, remarks
  full    // 68 % intervals, linear errors, what parameters mean and the statistics of the fit too
};

/// A fit for people: the law, a table of parameters, what errors and intervals rest on, and
/// remarks. Several lines, each ended by a newline; tables are at most 80 wide, sentences are not
/// folded. A value stands with its error only (value_with_error): half of the 68 % interval, which
/// holds the value; "-" where that interval is open.
std::string describe(const Fit& fit, ReportDetail detail = ReportDetail::brief);

/// Fits of one curve by several models, best AIC first: reduced chi2 (chi2/dof), AIC and BIC
/// with their distance from the best.
std::string compare(const std::vector<Fit>& fits);

/// One line without a newline: the law of the least AIC, where the next is, and which of its
/// parameters the data identify. Nothing where there is no fit.
std::string verdict(const std::vector<Fit>& fits);

}  // namespace jostle::inline fitting
