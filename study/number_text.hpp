#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

// The one place where a text that a person or another program wrote becomes a number.
namespace jostle::inline study {

/// The number that is all of the text: digits with an optional minus, decimal point and exponent,
/// as "12", "-0.5", ".5" and "1e-3". Empty for any other text (hexadecimal, "inf", "nan", a leading
/// plus, "1e", "1_000", blanks) and for a number outside the range of a double.
std::optional<double> read_number(std::string_view text);

/// The whole number, zero or more, that is all of the text: decimal digits alone.
std::optional<std::uint64_t> read_whole_number(std::string_view text);

}  // namespace jostle::inline study
