#pragma once

#include <charconv>

namespace jostle::inline engine {

/// Reads a decimal number as std::from_chars does, which libc++ before version 20 has for whole
/// numbers only. `value` is kept where there is no number, and where it is out of range.
std::from_chars_result read_decimal(const char* begin, const char* end, double& value,
                                    std::chars_format format = std::chars_format::general);

/// Its twin without std::from_chars: strtod in the locale "C", with the same results.
namespace portable {
std::from_chars_result read_decimal(const char* begin, const char* end, double& value,
                                    std::chars_format format);
}

}  // namespace jostle::inline engine
