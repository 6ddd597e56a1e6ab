#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study/tables/measured/delimited_text.hpp"

namespace jostle::inline study {

/// The kind of column beside t in a text of columns.
enum class CurveColumns {
  errors,       // X, and maybe sigma of X
  realizations  // X of a second realization, and of any number more
};

/// The meaning of each column, numbered from 0.
struct ColumnRoles {
  std::size_t t = 0;
  std::vector<std::size_t> x;  // one, or a column per realization
  std::optional<std::size_t> sigma;
  std::size_t n_columns = 0;
  std::vector<std::string> names;  // [n_columns], of the heading, else "t", "X", "sigma", "X1", ...
  std::size_t first_row = 0;       // first row of the text's lines
  std::string t_unit, x_unit;      // in brackets behind a name, "s" of "Time [s]"; else empty
  std::vector<std::string> notes;  // on columns that are not used, a sentence each
};

/// Columns by the names in the heading: t, tap, taps or time; X, mean or value; sigma, error, se or
/// standard_error; or realizations by any other names, but for those of errors, counts, weights and
/// means. Realizations have one unit, sigma that of X. A column that is an unnamed index, and a law
/// that `fit --csv` wrote, are not used. A text without a heading has its columns in this order.
/// Throws BadInput with the names found and those allowed.
ColumnRoles column_roles(const std::string& path, const DelimitedText& text, CurveColumns kind);

}  // namespace jostle::inline study
