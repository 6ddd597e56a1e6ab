#include "fitting/value_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace jostle::inline fitting {

namespace {

std::string in_format(double value, std::chars_format format, int precision) {
  std::array<char, 400> text;  // the largest double has 309 digits before its point
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format, precision);
  return {text.data(), end.ptr};
}

std::string fixed(double value, int decimals) {
  std::string text = in_format(value, std::chars_format::fixed, decimals);
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  return zero && text.starts_with('-') ? text.substr(1) : text;
}

/// For the number as it is printed with two digits: 0.00996 has its first digit where 0.010 has it.
int exponent_of(double number) {
  const std::string text = in_format(number, std::chars_format::scientific, 1);
  return std::atoi(text.c_str() + text.find('e') + 1);
}

std::string power_text(int power) {
  const std::string digits = std::to_string(std::abs(power));
  return (power < 0 ? "e-" : "e+") + std::string(digits.size() < 2 ? "0" : "") + digits;
}

/// Both to `decimals` behind the point, or, where these are fewer than none, to a power of ten.
std::string in_last_digits(double value, double error, int decimals) {
  if (decimals <= 0) {
    const double unit = std::pow(10.0, -decimals);
    const auto rounded = [&](double number) { return fixed(std::round(number / unit) * unit, 0); };
    return rounded(value) + "(" + rounded(error) + ")";
  }
  std::string digits = fixed(error, decimals);
  if (digits.starts_with("0.")) {  // below 1: the digits alone
    digits.erase(0, 2);
    digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
  }
  return fixed(value, decimals) + "(" + digits + ")";
}

}  // namespace

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "infinite" : "-infinite";
  return in_format(value, std::chars_format::general, digits);
}

int distinguishing_digits(double a, double b, int digits, int most) {
  while (a != b && digits < most && number_text(a, digits) == number_text(b, digits)) ++digits;
  return digits;
}

int probability_digits(double p) {
  constexpr double level = 0.05;
  return distinguishing_digits(p, level, 2, 6);
}

std::string probability_text(double p) {
  if (p < smallest_p) return "< " + number_text(smallest_p, 1);
  return number_text(p, probability_digits(p));
}

std::string p_value_text(double p) {
  return p < smallest_p ? "p " + probability_text(p) : "p = " + probability_text(p);
}

bool is_lopsided(double value, double low, double high, double least, double most) {
  if (!(low < value && value < high)) return false;
  const double half = (high - low) / 2;
  const bool crosses_zero = (low >= 0 && value < half) || (high <= 0 && value > -half);
  return value - half < least || value + half > most || crosses_zero;
}

std::string limits_text(double low, double high, int digits) {
  const bool has_lower = std::isfinite(low), has_upper = std::isfinite(high);
  if (has_lower && has_upper) {
    // A unit of the last digit is a twentieth of the width at most.
    constexpr int most_digits = std::numeric_limits<double>::max_digits10;
    const double larger = std::max(std::abs(low), std::abs(high)), part = (high - low) / 20;
    if (part > 0)
      digits = std::clamp(exponent_of(larger) - exponent_of(part) + 1, digits, most_digits);
    digits = distinguishing_digits(low, high, digits);
    return number_text(low, digits) + " to " + number_text(high, digits);
  }
  if (has_lower) return "> " + number_text(low, digits);
  return has_upper ? "< " + number_text(high, digits) : "no limit";
}

namespace {

/// True if a number as large is printed with so many decimals, and without a power of ten.
bool is_plain(double larger, int decimals) {
  constexpr double smallest = 1e-3, largest = 1e7;
  constexpr int most_decimals = 6;
  return (larger >= smallest || decimals <= most_decimals) && larger < largest;
}

}  // namespace

std::string value_with_error(double value, double error, double scale) {
  constexpr int most_digits = 6;
  constexpr double noise = 64 * std::numeric_limits<double>::epsilon(), rounding = 1e-11;
  if (!std::isfinite(value)) return number_text(value, most_digits);
  const double larger = std::max(std::abs(value), error > 0 ? error : 0.0);
  if (larger < noise * scale) return "0";
  const bool has_error = error >= std::max(noise * scale, rounding * larger);
  if (!has_error) return number_text(value, most_digits);
  if (std::isinf(error)) return "no limit";
  const int decimals = 1 - exponent_of(error);
  if (is_plain(larger, decimals)) return in_last_digits(value, error, decimals);
  const int power = exponent_of(larger);
  const double unit = std::pow(10.0, power);
  return in_last_digits(value / unit, error / unit, decimals + power) + power_text(power);
}

std::string value_with_limits(double value, double low, double high) {
  const double upper_width = high - value, lower_width = value - low;
  const double larger = std::max({std::abs(value), upper_width, lower_width});
  const int decimals = 1 - exponent_of(std::min(upper_width, lower_width));
  const int power = is_plain(larger, decimals) ? 0 : exponent_of(larger);
  const auto text = [&](double number) {
    return fixed(number / std::pow(10.0, power), std::max(0, decimals + power));
  };
  const std::string with_limits =
      text(value) + "(+" + text(upper_width) + "/-" + text(lower_width) + ")";
  return power == 0 ? with_limits : with_limits + power_text(power);
}

}  // namespace jostle::inline fitting
