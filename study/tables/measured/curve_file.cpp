#include "study/tables/measured/curve_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fitting/mean_of_present.hpp"
#include "results/disk/printable.hpp"
#include "study/bad_input.hpp"
#include "study/number_text.hpp"
#include "study/tables/repeated_series.hpp"

namespace jostle::inline study {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// Words of R, pandas and spreadsheets for a missing value.
bool is_gap(const std::string& cell) {
  static constexpr std::array words = {"", "nan", "na", "n/a", "null", "none"};
  std::string lower;
  for (const char c : cell) lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::ranges::find(words, lower) != words.end();
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool has_decimal_comma(const std::string& text) {
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == ',' && is_digit(text[i - 1]) && is_digit(text[i + 1])) return true;
  }
  return false;
}

/// A file as it is read.
class Reader {
 public:
  Reader(const std::string& path, const ColumnRoles& roles) : path_(path), roles_(roles) {}

  /// A number; NaN where the field has no value. Throws BadInput.
  double value(const DelimitedLine& line, std::size_t column) const {
    const std::string& cell = line.cells[column];
    if (is_gap(cell)) return missing;
    if (const auto number = read_number(cell)) return *number;
    // In "1 0,5" the comma divides, and a cell has two numbers.
    const bool is_divided =
        cell.find_first_of(" \t") != std::string::npos && has_decimal_comma(line.text);
    fail(line, column, fmt::format("\"{}\" is not a number", printable(cell, 100)),
         has_decimal_comma(cell) || is_divided
             ? "Write decimal points, not commas."
             : "Write it like 12, -0.5 or 1e-3; leave a gap empty or write NaN.");
  }

  [[noreturn]] void fail(const DelimitedLine& line, std::size_t column, const std::string& fault,
                         const std::string& remedy) const {
    throw BadInput(fmt::format("{}: line {}, column {} ({}): {}. {}", path_, line.number,
                               column + 1, printable(roles_.names[column], 60), fault, remedy));
  }

  /// Empty fields behind the last column are no columns.
  void require_columns(const DelimitedLine& line) const {
    const std::size_t n = line.cells.size();
    const bool is_whole =
        n >= roles_.n_columns &&
        std::all_of(line.cells.begin() + static_cast<std::ptrdiff_t>(roles_.n_columns),
                    line.cells.end(), [](const std::string& cell) { return cell.empty(); });
    if (is_whole) return;
    const std::string hint =
        has_decimal_comma(line.text) ? " If its commas are decimal, write points." : "";
    throw BadInput(fmt::format("{}: line {} has {} field{}, the {} {} column{} ({}): \"{}\".{}",
                               path_, line.number, n, n == 1 ? "" : "s",
                               roles_.first_row > 0 ? "heading" : "file", roles_.n_columns,
                               roles_.n_columns == 1 ? "" : "s", printable(joined_names(), 100),
                               printable(line.text, 100), hint));
  }

  bool is_blank(const DelimitedLine& line) const {
    return std::ranges::all_of(line.cells, [](const std::string& cell) { return cell.empty(); });
  }

 private:
  std::string joined_names() const {
    std::string all;
    for (const std::string& name : roles_.names) all += (all.empty() ? "" : ", ") + name;
    return all;
  }

  const std::string& path_;
  const ColumnRoles& roles_;
};

/// The rows in the range that have a t.
struct Rows {
  std::vector<double> t, values, sigma;  // values: [n_rows, n_columns of x], NaN where missing
  std::size_t without_value = 0;         // left out
};

Rows rows_of(const Reader& reader, const DelimitedText& text, const ColumnRoles& roles,
             const CurveReading& reading) {
  Rows rows;
  for (std::size_t i = roles.first_row; i < text.lines.size(); ++i) {
    const DelimitedLine& line = text.lines[i];
    if (reader.is_blank(line)) continue;
    reader.require_columns(line);
    const double t = reader.value(line, roles.t);
    std::vector<double> values;
    for (const std::size_t column : roles.x) values.push_back(reader.value(line, column));
    const double sigma = roles.sigma ? reader.value(line, *roles.sigma) : 1;
    if (std::isnan(t)) reader.fail(line, roles.t, "t has no value", "Give every row its t.");
    if (t < reading.first || t > reading.last) continue;
    if (std::ranges::all_of(values, [](double x) { return std::isnan(x); })) {
      ++rows.without_value;
      continue;
    }
    if (!(sigma > 0)) {
      reader.fail(line, *roles.sigma,
                  std::isnan(sigma) ? "X has a value and sigma has none"
                                    : fmt::format("sigma is {}", sigma),
                  "Give every X an error above 0, or remove the column.");
    }
    rows.t.push_back(t);
    rows.values.insert(rows.values.end(), values.begin(), values.end());
    if (roles.sigma) rows.sigma.push_back(sigma);
  }
  return rows;
}

std::string counted_rows(std::size_t n) {
  return fmt::format("{} {}", n, n == 1 ? "row" : "rows");
}

/// The realizations of these rows that have a value in one of them.
std::vector<std::size_t> realizations_with_values(const Rows& rows, std::size_t m) {
  std::vector<std::size_t> found;
  for (std::size_t r = 0; r < m; ++r) {
    for (std::size_t i = r; i < rows.values.size(); i += m) {
      if (std::isnan(rows.values[i])) continue;
      found.push_back(r);
      break;
    }
  }
  return found;
}

void keep_realizations(const std::vector<std::size_t>& kept, std::size_t m, Rows& rows) {
  std::vector<double> values;
  for (std::size_t i = 0; i < rows.t.size(); ++i) {
    for (const std::size_t r : kept) values.push_back(rows.values[i * m + r]);
  }
  rows.values = std::move(values);
}

/// Drops the rows in which fewer than `least` of m realizations have a value. Returns how many.
std::size_t drop_rows(Rows& rows, std::size_t m, std::size_t least) {
  Rows kept;
  for (std::size_t i = 0; i < rows.t.size(); ++i) {
    const auto row = rows.values.begin() + static_cast<std::ptrdiff_t>(i * m);
    const auto n = std::count_if(row, row + static_cast<std::ptrdiff_t>(m),
                                 [](double x) { return !std::isnan(x); });
    if (static_cast<std::size_t>(n) < least) continue;
    kept.t.push_back(rows.t[i]);
    kept.values.insert(kept.values.end(), row, row + static_cast<std::ptrdiff_t>(m));
  }
  const std::size_t dropped = rows.t.size() - kept.t.size();
  rows = std::move(kept);
  return dropped;
}

/// The realizations of a file and the names of their columns.
struct Realizations {
  Rows rows;
  std::vector<std::string> names;

  std::size_t size() const { return names.size(); }
  std::vector<std::string> names_of(const std::vector<std::size_t>& chosen) const {
    std::vector<std::string> found;
    for (const std::size_t r : chosen) found.push_back(names[r]);
    return found;
  }
  void keep(const std::vector<std::size_t>& kept) {
    keep_realizations(kept, size(), rows);
    names = names_of(kept);
  }
  void keep_those_with_values(std::vector<std::string>& notes) {
    const std::vector<std::size_t> kept = realizations_with_values(rows, size());
    for (std::size_t r = 0; r < size(); ++r) {
      if (std::ranges::find(kept, r) != kept.end()) continue;
      notes.push_back(fmt::format("Realization {} has no value in the rows that are used.",
                                  printable(names[r], 60)));
    }
    keep(kept);
  }
};

Curve mean_of(const std::string& path, Rows rows, const ColumnRoles& roles, Gaps gaps,
              std::vector<std::string>& notes) {
  Realizations read{std::move(rows), {}};
  for (const std::size_t column : roles.x) read.names.push_back(roles.names[column]);
  const std::size_t m = read.size();
  const std::vector<std::size_t> distinct = distinct_columns(read.rows.values, m);
  if (distinct.size() < m) {
    notes.push_back(copies_text(m - distinct.size(), distinct.size()) + ".");
    read.keep(distinct);
  }
  if (read.size() == 1) return mean_of_present(std::move(read.rows.t), read.rows.values, 1);
  if (gaps == Gaps::use_others) {
    // A lone value shows no scatter, and so no error.
    const std::size_t alone = drop_rows(read.rows, read.size(), 2);
    if (alone > 0) {
      notes.push_back(
          fmt::format("{} with a value of one realization alone: left out, for one "
                      "value has no error.",
                      counted_rows(alone)));
    }
  }
  read.keep_those_with_values(notes);
  const auto n_missing = static_cast<std::size_t>(
      std::ranges::count_if(read.rows.values, [](double x) { return std::isnan(x); }));
  if (n_missing > 0 && gaps == Gaps::drop_row) {
    const std::size_t dropped = drop_rows(read.rows, read.size(), read.size());
    notes.push_back(
        fmt::format("{} in which a realization has no value: left out.", counted_rows(dropped)));
  } else if (n_missing > 0) {
    notes.push_back(
        fmt::format("{} of {} values are missing: each mean is over the realizations present, "
                    "corrected for the "
                    "offsets between realizations.",
                    n_missing, read.rows.values.size()));
  }
  if (read.size() < 2) {
    throw BadInput(fmt::format(
        "{}: {} of {} realizations have values in the same rows. A fit needs two; fit one column "
        "as t, X.",
        path, read.size(), m));
  }
  const auto groups = linked_groups(read.rows.values, read.size());
  if (groups.size() > 1) {
    throw BadInput(fmt::format(
        "{}: the realizations {} have no row in common with {}, so the offset between them is not "
        "known. Fit each group on its own: choose its t by a range, or its columns in a file.",
        path, printable(fmt::format("{}", fmt::join(read.names_of(groups[0]), ", ")), 100),
        printable(fmt::format("{}", fmt::join(read.names_of(groups[1]), ", ")), 100)));
  }
  return mean_of_present(std::move(read.rows.t), std::move(read.rows.values), read.size());
}

}  // namespace

MeasuredCurve read_curve(const std::string& path, const CurveReading& reading) {
  const DelimitedText text = read_delimited_text(path);
  const ColumnRoles roles = column_roles(path, text, reading.columns);
  const Reader reader(path, roles);
  Rows rows = rows_of(reader, text, roles, reading);
  MeasuredCurve measured{{}, roles.notes, {roles.x_unit, roles.t_unit}};
  if (rows.without_value > 0) {
    measured.notes.push_back(
        fmt::format("{} without a value: left out.", counted_rows(rows.without_value)));
  }
  if (rows.t.empty()) {
    throw BadInput(fmt::format("{}: no row has a t in the range and a value.", path));
  }
  if (reading.columns == CurveColumns::errors) {
    measured.curve = {
        .t = std::move(rows.t), .x = std::move(rows.values), .sigma = std::move(rows.sigma)};
  } else {
    measured.curve = mean_of(path, std::move(rows), roles, reading.gaps, measured.notes);
  }
  return measured;
}

}  // namespace jostle::inline study
