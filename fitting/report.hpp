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

/// Units of a curve, as they are printed; empty where they are not known.
struct CurveUnits {
  std::string x, t;  // "d", "taps"; "1" is a number without a unit
};

/// "d", "taps", "1/taps", "1": the unit of a parameter. Units that are not known are "[X]", "[t]".
std::string unit_text(ParameterUnit unit, const CurveUnits& units);

/// A table of parameters in a report of a fit.
struct ParameterTable {
  std::string heading;  // empty for the law that was asked for, where it is the first
  std::vector<Estimate> estimates;
};

/// The tables of a fit in the order in which every report has them: where the least squares are at
/// a limit of the law first that of the limit, then that of the law, then that of the law that
/// draws this curve.
std::vector<ParameterTable> parameter_tables(const Fit& fit);

/// "0.5735(17)", value and half of the 68 % interval; "-" where that is open; "0.5 fixed".
std::string estimate_text(const Estimate& estimate, const std::string& unit = "");

/// "0.021(6)", the difference from the leading law and half of its 68 % interval.
std::string difference_text(const HeldOutLaw& law);

/// The interval of level 0 (68 %) or 1 (95 %): "0.571 to 0.576", "> 0.571", "no limit".
std::string interval_text(const Estimate& estimate, std::size_t level);

/// A fit for people: the law, a table of parameters and their units, what errors and intervals rest
/// on, and remarks. Several lines, each ended by a newline; tables are at most 80 wide, sentences
/// are not folded. A value is printed with its error (value_with_error): half of the 68 % interval,
/// which holds the value; "-" where that interval is open.
std::string describe(const Fit& fit, ReportDetail detail = ReportDetail::brief,
                     const CurveUnits& units = {});

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
