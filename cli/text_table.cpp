#include "cli/text_table.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

namespace jostle {
namespace {

std::string scaled(double number, double base, std::initializer_list<const char*> units) {
  auto unit = units.begin();
  while (std::abs(number) >= base && unit + 1 != units.end()) {
    number /= base;
    ++unit;
  }
  if (unit == units.begin()) return fmt::format("{:.0f}{}", number, *unit);
  return fmt::format("{:.1f}{}", number, *unit);
}

}  // namespace

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

std::string format_count(double count) {
  return scaled(count, 1000, {"", " k", " M", " G", " T"});
}

std::string format_bytes(double bytes) {
  return scaled(bytes, 1024, {" B", " KiB", " MiB", " GiB", " TiB"});
}

}  // namespace jostle
