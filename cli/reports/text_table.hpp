#pragma once

#include <string>
#include <vector>

namespace jostle::inline cli {

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

/// A value with its error, both to the second digit of the error and with one power of ten:
/// "0.5683 +- 0.0021", "1240 +- 85", "(2.04873 +- 0.00074)e-06". Where both are rounding noise of
/// numbers of the size of `scale`, "0". An error that is not above 0 and finite is left out, and
/// the value has six digits.
std::string value_and_error(double value, double error, double scale = 1);

}  // namespace jostle::inline cli
