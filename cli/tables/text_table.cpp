#include "cli/tables/text_table.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "cli/tables/wrapped.hpp"

namespace jostle::inline cli {
namespace {

constexpr std::size_t column_gap = 2;

}  // namespace

TextTable::TextTable(std::vector<std::string> headers, std::size_t keys) : keys_(keys) {
  rows_.push_back(std::move(headers));
}

void TextTable::add(std::vector<std::string> cells) {
  assert(cells.size() == rows_.front().size());
  rows_.push_back(std::move(cells));
}

std::size_t TextTable::width_of_column(std::size_t column) const {
  std::size_t width = 0;
  for (const auto& row : rows_) width = std::max(width, width_of(row[column]));
  return width;
}

std::string TextTable::rows_of(const std::vector<std::size_t>& columns) const {
  std::vector<std::size_t> widths;
  for (const std::size_t column : columns) widths.push_back(width_of_column(column));
  std::string text;
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string& cell = row[columns[i]];
      if (i > 0) text.append(column_gap, ' ');
      text.append(widths[i] - width_of(cell), ' ').append(cell);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

std::string TextTable::text(std::size_t width) const {
  std::vector<std::size_t> keys(std::min(keys_, rows_.front().size()));
  std::iota(keys.begin(), keys.end(), 0);
  std::size_t width_of_keys = 0;
  for (const std::size_t key : keys) width_of_keys += width_of_column(key) + column_gap;
  std::string text;
  std::vector<std::size_t> block = keys;
  std::size_t used = width_of_keys;
  for (std::size_t column = keys.size(); column < rows_.front().size(); ++column) {
    const std::size_t needed = width_of_column(column);
    if (block.size() > keys.size() && (needed > width || used > width - needed)) {
      text += rows_of(block) + '\n';
      block = keys;
      used = width_of_keys;
    }
    block.push_back(column);
    used += needed + column_gap;
  }
  return text + rows_of(block);
}

}  // namespace jostle::inline cli
