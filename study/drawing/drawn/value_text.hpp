#pragma once

#include <cstdint>
#include <string>

// Numbers as the page and the figures show them to people. report/src/format.js and
// python/jostle/plot/values.py give the same texts (tests/data/value_texts.json).
namespace jostle::inline study {

/// A number of so many significant digits, trailing zeros dropped; from 1e6 on and below 1e-4 with
/// a power of ten. A whole number below 1e6 has all its digits, NaN is "–", an infinite value "no
/// limit".
std::string typeset_number(double value, int digits = 4);

/// "0.5913(12)": the error's first two digits, in units of the value's last digit. The value alone,
/// with five digits, where the error is not finite or not above zero.
std::string typeset_with_error(double value, double error);

/// A p-value with two digits, "0.019"; "< 10⁻¹⁶" below the smallest that is distinguished.
std::string typeset_probability(double p);

/// "p = 0.019" or "p < 10⁻¹⁶".
std::string typeset_p(double p);

/// "12 345", from 1e6 on "1.23×10⁶".
std::string typeset_count(double n);

/// "3 spheres"; a word that ends in s has no other plural.
std::string typeset_plural(double n, const std::string& word);

/// Seconds, minutes, hours or days.
std::string typeset_duration(double seconds);

/// "10⁻³" is "10" and the exponent's superscript.
std::string superscript(int n);

}  // namespace jostle::inline study
