#pragma once

#include <string>

// Numbers as people read them.
namespace jostle::inline fitting {

/// A value with its error in the last digits, "0.5913(12)" for 0.5913 +- 0.0012: both end at the
/// second digit of the error. An error of 1 or more has its point, "12.3(4.5)"; where both are
/// small or long they have one power of ten, "2.05(74)e-06". Rounding noise of numbers of the size
/// of `scale` is "0"; without a scale every number is relative to itself. An error that is 0, NaN
/// or rounding noise beside the value or `scale` is not known: the value alone, with six digits. An
/// infinite error is "no limit", a value that is NaN
/// "-".
std::string value_with_error(double value, double error, double scale = 0);

/// "56(+18/-11)": a value with the distances to the ends of its interval, the smaller with two
/// digits. Requires finite numbers, low < value < high.
std::string value_with_limits(double value, double low, double high);

/// True if half of the interval [low, high] on both sides of the value would reach beyond the wider
/// limits [least, most], or to the other side of zero, where the interval is on one: the value is
/// then printed with both distances. NaN and infinite limits limit nothing.
bool is_lopsided(double value, double low, double high, double least, double most);

/// Range of a value: "0.57 to 0.61" with so many digits, "> 0.57", "< 0.61", or "no limit" where
/// neither end is finite.
std::string limits_text(double low, double high, int digits);

/// p-values below are not distinguished: tails of distributions are not known so far out.
inline constexpr double smallest_p = 1e-16;

/// Digits of a p-value in print: two, or as many as distinguish it from 0.05, the level of tests.
int probability_digits(double p);

/// "0.019" or "< 1e-16": a p-value without its name; "-" for NaN.
std::string probability_text(double p);

/// "p = 0.019" or "p < 1e-16".
std::string p_value_text(double p);

/// The value with so many significant digits; "-" where it is no number, else "infinite" or
/// "-infinite" where it is not finite.
std::string number_text(double value, int digits);

/// Digits, at least `digits` and at most `most`, for which the number_text() of two numbers differ.
int distinguishing_digits(double a, double b, int digits, int most = 17);

}  // namespace jostle::inline fitting
