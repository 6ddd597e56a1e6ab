#pragma once

#include <string>
#include <vector>

namespace jostle {

/// Columns as wide as their longest cell, numbers flush right, two spaces apart.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> headers);

  /// One cell a header.
  void add(std::vector<std::string> cells);
  /// One line a row, the headers first, each ending in a newline.
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;  // [1 + n_rows][n_columns]
};

/// Decimals that show a positive error to two digits: 4 for 0.0021. At most 12.
int decimals_for(double error);

/// 4.1e+07 as "41.0 M", 950 as "950".
std::string format_count(double count);
/// Bytes with a binary unit: "12.3 MiB".
std::string format_bytes(double bytes);

}  // namespace jostle
