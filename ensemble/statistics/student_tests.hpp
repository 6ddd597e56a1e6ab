#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

// Student's tests of an estimate against 0, and what they can see.
namespace jostle::inline ensemble {

/// The level of every test that a verdict rests on: how often chance alone raises an alarm, all
/// tests of one question together.
inline constexpr double significance_level = 0.05;

/// The standard error of an estimate, with its degrees of freedom: infinite where the error is
/// known, 0 where there is none.
struct ErrorOf {
  double error = 0;
  double dof = 0;
  bool known() const { return dof > 0; }
};

/// NaN where there is none: what tables hold.
double error_or_nan(const ErrorOf& error);

/// The error of the sum of two independent numbers: Satterthwaite 1946, doi:10.2307/3002019. None
/// where one has none.
ErrorOf combined(const ErrorOf& a, const ErrorOf& b);

/// Probability that chance makes an estimate of 0 as large as this, on either side. 1 for a value
/// of 0. NaN without an error, and where it is 0: realizations that do not differ are no measure of
/// chance.
double p_value(double value, const ErrorOf& error);

/// "p = 0.019 at the 5 % level": how every verdict names its test.
std::string p_text(double p);

/// "p = 0.019", or not_stated where it is not finite.
std::string plain_p_text(double p);

/// The p-values of several tests made together, so that the chance of any false alarm is the level:
/// Holm 1979, Scand. J. Statist. 6, 65. NaN stays and does not count.
std::vector<double> corrected_for_number(std::span<const double> p_values);

/// Probability that the two-sided test at `level` (its rate of false alarms, in (0, 1)) finds an
/// effect of `effect` true standard errors, with dof > 0 degrees of freedom: the tails of the
/// noncentral t distribution.
double student_power(double effect, double level, double dof);

/// The smallest effect, in true standard errors, that is found with probability `power` (above
/// `level`, below 1): 2.8 for level 0.05, power 0.8 and many degrees of freedom, 16 for one.
double smallest_effect_found(double level, double dof, double power = 0.8);

/// Ends of an interval by tests of its values, [2 levels of interval_levels]: infinite where no
/// value on that side is refuted.
struct TestedEnds {
  double low[2], high[2];
};

/// Going outwards from the best value: where |t| first exceeds Student's at each level. Between
/// `values` (ascending) t is taken for linear, and 0 at the best. A best value at the first or the
/// last of `values` is where a search ended: beyond it nothing is refuted, and a level that refutes
/// it has no ends. t_of: t of a value.
TestedEnds tested_ends(const std::vector<double>& values, double best, double dof,
                       const std::function<double(double value)>& t_of);

}  // namespace jostle::inline ensemble
