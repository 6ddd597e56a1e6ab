#include "engine/number_reading.hpp"

#include <locale.h>
#include <stdlib.h>
#if defined(__APPLE__)
#include <xlocale.h>
#endif

#include <cmath>
#include <string>
#include <string_view>

namespace jostle::inline engine {

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

const char* after_digits(const char* position, const char* end) {
  while (position != end && is_digit(*position)) ++position;
  return position;
}

/// The end of "inf", "infinity", "nan" or "nan(...)" in either case; `begin` where it is none.
const char* after_word(const char* begin, const char* end) {
  const auto starts_with = [=](const char* word, const char* position) {
    for (; *word != 0; ++word, ++position) {
      if (position == end || (*position | 0x20) != *word) return false;
    }
    return true;
  };
  if (starts_with("infinity", begin)) return begin + 8;
  if (starts_with("inf", begin)) return begin + 3;
  if (!starts_with("nan", begin)) return begin;
  const char* position = begin + 3;
  if (position == end || *position != '(') return position;
  do {
    ++position;
  } while (position != end && (is_digit(*position) || *position == '_' ||
                               ((*position | 0x20) >= 'a' && (*position | 0x20) <= 'z')));
  return position != end && *position == ')' ? position + 1 : begin + 3;
}

/// The end of the longest number from `begin`, or `begin`.
const char* after_number(const char* begin, const char* end, std::chars_format format) {
  const char* const digits = begin != end && *begin == '-' ? begin + 1 : begin;
  if (const char* const word = after_word(digits, end); word != digits) return word;
  const char* position = after_digits(digits, end);
  auto n_digits = position - digits;
  if (position != end && *position == '.') {
    const char* const tail = after_digits(position + 1, end);
    n_digits += tail - (position + 1);
    if (n_digits > 0) position = tail;
  }
  if (n_digits == 0) return begin;
  if ((format & std::chars_format::scientific) == std::chars_format{}) return position;
  if (position != end && (*position | 0x20) == 'e') {
    const char* exponent = position + 1;
    if (exponent != end && (*exponent == '+' || *exponent == '-')) ++exponent;
    const char* const tail = after_digits(exponent, end);
    if (tail != exponent) position = tail;
  }
  return position;
}

}  // namespace

std::from_chars_result portable::read_decimal(const char* begin, const char* end, double& value,
                                              std::chars_format format) {
  const char* const last = after_number(begin, end, format);
  if (last == begin) return {begin, std::errc::invalid_argument};
  static const locale_t plain = ::newlocale(LC_ALL_MASK, "C", locale_t{});
  const std::string text(begin, last);
  const double number = ::strtod_l(text.c_str(), nullptr, plain);
  const std::string_view mantissa = std::string_view(text).substr(0, text.find_first_of("eE"));
  const bool has_digits = is_digit(last[-1]);  // words end in letters or a bracket
  const bool too_large = std::isinf(number) && has_digits;
  const bool too_small =
      number == 0 && has_digits && mantissa.find_first_of("123456789") != std::string_view::npos;
  if (too_large || too_small) return {last, std::errc::result_out_of_range};
  value = number;
  return {last, std::errc{}};
}

std::from_chars_result read_decimal(const char* begin, const char* end, double& value,
                                    std::chars_format format) {
#if defined(__cpp_lib_to_chars) && !defined(JOSTLE_PORTABLE)
  return std::from_chars(begin, end, value, format);
#else
  return portable::read_decimal(begin, end, value, format);
#endif
}

}  // namespace jostle::inline engine
