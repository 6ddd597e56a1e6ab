#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "config/json/json.hpp"

// Writes numbers and texts of a results file for a page.
namespace jostle::inline study {

/// With 7 significant digits; null where it is not a number, "inf" or "-inf" where it has no end.
Json page_number(double value);
Json page_numbers(std::span<const double> values);

/// The text by printable(), cut after the last whole character within `longest` bytes.
Json page_text(std::string_view text, std::size_t longest = 4000);

/// The value with all its texts, keys too, as page_text.
Json page_value(const Json& value);

/// Base64 (RFC 4648, padded).
std::string base64(std::span<const std::uint8_t> bytes);

/// JSON on one line that may be placed between <script> and </script>: no character of it begins a
/// tag, an entity or a comment, and none ends a line.
std::string script_text(const Json& value);

}  // namespace jostle::inline study
