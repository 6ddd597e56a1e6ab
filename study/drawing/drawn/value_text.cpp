#include "study/drawing/drawn/value_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "fitting/value_text.hpp"

namespace jostle::inline study {
namespace {

constexpr const char* minus = "−";
constexpr double largest_plain = 1e6, smallest_plain = 1e-4;
constexpr double rounding = 1e-11;  // errors below it, relative to their value, are rounding noise

std::string with_minus(const std::string& text) {
  return text.starts_with('-') ? minus + text.substr(1) : text;
}

void drop_zeros(std::string& text) {
  if (text.find('.') == std::string::npos) return;
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
}

std::string fixed(double value, int decimals) {
  return fmt::format("{:.{}f}", value, decimals);
}

/// The power of ten of a number that is rounded to so many digits.
int exponent_of(double value, int digits) {
  const std::string text = fmt::format("{:.{}e}", value, digits - 1);
  return std::stoi(text.substr(text.find('e') + 1));
}

}  // namespace

std::string superscript(int n) {
  static constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (const char c : std::to_string(n)) text += c == '-' ? "⁻" : digits[c - '0'];
  return text;
}

std::string typeset_number(double value, int digits) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0 ? "no limit" : std::string(minus) + " no limit";
  if (value == 0) return "0";
  const double size = std::abs(value);
  const bool is_whole = value == std::trunc(value);
  if (is_whole && size < largest_plain) return with_minus(fixed(value, 0));
  const int power = exponent_of(value, digits);
  if (size >= largest_plain || size < smallest_plain) {
    const std::string text = fmt::format("{:.{}e}", value, digits - 1);
    std::string mantissa = text.substr(0, text.find('e'));
    if (is_whole) drop_zeros(mantissa);
    return with_minus(mantissa) + "×10" + superscript(power);
  }
  std::string text;
  if (const int decimals = digits - 1 - power; decimals >= 0) {
    text = fixed(value, decimals);
  } else {  // digits before the point that are not asked for are zero
    const double unit = std::pow(10.0, -decimals);
    text = fixed(std::round(value / unit) * unit, 0);
  }
  drop_zeros(text);
  return with_minus(text);
}

std::string typeset_with_error(double value, double error) {
  const bool has_error = std::isfinite(error) && error > rounding * std::abs(value);
  if (!std::isfinite(value) || !has_error) return typeset_number(value, 5);
  if (error > 1e3 * std::max(std::abs(value), 1e-300)) {
    return typeset_number(value, 2) + " ± " + typeset_number(error, 2);
  }
  const int scale = static_cast<int>(std::floor(std::log10(std::max(std::abs(value), error))));
  if (scale >= 6 || scale < -4) {
    const double factor = std::pow(10.0, scale);
    return typeset_with_error(value / factor, error / factor) + "×10" + superscript(scale);
  }
  const int decimals = 1 - exponent_of(error, 2);
  const double unit = std::pow(10.0, -decimals);
  if (decimals <= 0) {
    const auto rounded = [&](double number) { return fixed(std::round(number / unit) * unit, 0); };
    return with_minus(rounded(value)) + "(" + rounded(error) + ")";
  }
  const std::string in_units = fixed(std::round(error / unit), 0);
  const std::string shown = error >= 1 ? fixed(error, decimals) : in_units;
  return with_minus(fixed(value, decimals)) + "(" + shown + ")";
}

std::string typeset_probability(double p) {
  if (!(p < smallest_p)) return typeset_number(p, probability_digits(p));
  return "< 10" + superscript(exponent_of(smallest_p, 1));
}

std::string typeset_p(double p) {
  return (p < smallest_p ? "p " : "p = ") + typeset_probability(p);
}

std::string typeset_count(double n) {
  if (n < largest_plain) {
    std::string text = fixed(n, 0);
    if (text.size() > 3) text.insert(text.size() - 3, "\u202f");
    return text;
  }
  const int power = static_cast<int>(std::floor(std::log10(n)));
  return fixed(n / std::pow(10.0, power), 2) + "×10" + superscript(power);
}

std::string typeset_plural(double n, const std::string& word) {
  return typeset_count(n) + " " + word + (n == 1 || word.ends_with('s') ? "" : "s");
}

std::string typeset_duration(double seconds) {
  constexpr double minute = 60, hour = 3600, day = 86400;
  if (!(seconds > 0)) return "no time";
  if (seconds < 2 * minute) return typeset_number(seconds, 3) + " s";
  if (seconds < 2 * hour) return typeset_number(seconds / minute, 3) + " min";
  return seconds < 2 * day ? typeset_number(seconds / hour, 3) + " h"
                           : typeset_number(seconds / day, 3) + " days";
}

}  // namespace jostle::inline study
