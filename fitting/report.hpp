#pragma once

#include <string>
#include <vector>

#include "fitting/comparison/held_out.hpp"
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

/// Fits of one curve by several models: reduced chi2 (chi2/dof) and how they predict realizations
/// that were held out.
std::string compare(const std::vector<Fit>& fits, const LawComparison& comparison);

/// States the chosen law and the grounds, or that the data do not decide: one line without a
/// newline. Empty where fewer than two laws were fitted.
std::string choice_text(const LawComparison& comparison);

/// The choice of a law, then which parameters of the chosen law the data identify, then the other
/// laws of which all parameters are identified. One line without a newline; nothing without a fit.
std::string verdict(const std::vector<Fit>& fits, const LawComparison& comparison);

}  // namespace jostle::inline fitting
