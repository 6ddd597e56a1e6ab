#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace jostle::inline cli {

/// Columns as wide as their longest cell, numbers flush right, two spaces apart.
class TextTable {
 public:
  /// The first `keys` columns identify the row.
  explicit TextTable(std::vector<std::string> headers, std::size_t keys = 1);

  /// One cell a header.
  void add(std::vector<std::string> cells);
  /// Width of a column, in characters.
  std::size_t width_of_column(std::size_t column) const;
  /// One line a row, the headers first, each ending in a newline. Columns that do not fit are
  /// printed below, after the keys and an empty line.
  std::string text(std::size_t width = std::string::npos) const;

 private:
  std::string rows_of(const std::vector<std::size_t>& columns) const;

  std::vector<std::vector<std::string>> rows_;  // [1 + n_rows][n_columns]
  std::size_t keys_;
};

}  // namespace jostle::inline cli
