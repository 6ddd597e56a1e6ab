#include "cli/reports/text_table.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace jostle::inline cli {

TextTable::TextTable(std::vector<std::string> headers) {
  rows_.push_back(std::move(headers));
}

void TextTable::add(std::vector<std::string> cells) {
  assert(cells.size() == rows_.front().size());
  rows_.push_back(std::move(cells));
}

std::string TextTable::text() const {
  std::vector<std::size_t> widths(rows_.front().size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += fmt::format("{}{:>{}}", i == 0 ? "" : "  ", row[i], widths[i]);
    }
    text += '\n';
  }
  return text;
}

int decimals_for(double error) {
  return static_cast<int>(std::clamp(1 - std::floor(std::log10(error)), 0.0, 12.0));
}

std::string value_and_error(double value, double error, double scale) {
  constexpr int most_decimals = 6, most_digits = 15;
  constexpr double largest_plain = 1e7;
  constexpr double noise = 64 * std::numeric_limits<double>::epsilon();
  const bool has_error = std::isfinite(error) && error > 0;
  const double larger = std::max(std::abs(value), has_error ? error : 0.0);
  if (!std::isfinite(value)) return fmt::format("{:.6g}", value);
  if (larger < noise * scale) return "0";
  if (!has_error) return fmt::format("{:.6g}", value);
  // Of the error as it is printed: 0.00996 has its first digit where 0.010 has it.
  const auto exponent = [](double number, int digits) {
    const std::string text = fmt::format("{:.{}e}", number, digits - 1);
    return std::stoi(text.substr(text.find('e') + 1));
  };
  const int decimals = 1 - exponent(error, 2);
  if (decimals <= most_decimals && larger < largest_plain) {
    const int shown = std::max(decimals, 0);
    return fmt::format("{:.{}f} +- {:.{}f}", value, shown, error, shown);
  }
  const int power = exponent(larger, 2);
  const double unit = std::pow(10.0, power);
  const int shown = std::clamp(decimals + power, 0, most_digits);
  return fmt::format("({:.{}f} +- {:.{}f})e{:+03}", value / unit, shown, error / unit, shown,
                     power);
}

}  // namespace jostle::inline cli
