#include "study/tables/measured/curve_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "config/json/json_text.hpp"
#include "fitting/models/models.hpp"
#include "results/disk/printable.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline study {

namespace {

constexpr std::array t_names = {"t", "tap", "taps", "time"};
constexpr std::array x_names = {"x", "mean", "value"};
constexpr std::array sigma_names = {"sigma", "error", "se", "standard_error"};
// Words of names that speak of an error, a count, a weight or a mean.
constexpr std::array statistic_words = {
    "std",       "stdev", "stddev", "stderr",  "stderror", "sd",       "sem",
    "se",        "sigma", "err",    "error",   "errors",   "variance", "uncertainty",
    "deviation", "rms",   "count",  "counts",  "nobs",     "weight",   "weights",
    "mean",      "means", "avg",    "average", "median",   "averages"};
constexpr std::array statistic_names = {"n", "w", "var", "number", "value"};  // whole names
constexpr const char* allowed =
    "t, tap, taps or time; X, mean or value; sigma, error, se or standard_error (where "
    "realizations are asked for, t and a column of any name each)";

template <class Names>
bool is_in(const Names& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// Lower case, without a unit in brackets behind it: "Time [s]" is "time".
std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char c : name) plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const std::size_t bracket = plain.find_first_of("([");
  if (bracket != std::string::npos && bracket > 0) plain.resize(bracket);
  while (plain.ends_with(' ')) plain.pop_back();
  return plain;
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Words of a name in lower case: of "SIGMA_X", "r0_error", "std.dev" and "meanPhi". Digits end a
/// word.
std::vector<std::string> name_words(const std::string& name) {
  std::vector<std::string> words = {""};
  bool was_lower = false;
  for (const char c : name) {
    const bool is_upper = c >= 'A' && c <= 'Z';
    if (!is_letter(c) || (is_upper && was_lower)) words.emplace_back();
    if (is_letter(c)) words.back() += is_upper ? static_cast<char>(c - 'A' + 'a') : c;
    was_lower = is_letter(c) && !is_upper;
  }
  return words;
}

/// True if a column of this name holds an error, a count, a weight or a mean.
bool is_statistic(const std::string& name) {
  return is_in(statistic_names, plain_name(name)) ||
         std::ranges::any_of(name_words(name),
                             [](const std::string& word) { return is_in(statistic_words, word); });
}

/// True for numbered columns of one name that speaks of a mean: "mean_height_0", "mean_height_1".
bool are_numbered_means(const std::vector<std::string>& names,
                        const std::vector<std::size_t>& columns) {
  constexpr std::array mean_words = {"mean", "means", "avg", "average", "averages", "median"};
  const auto words_of = [&](std::size_t column) {
    std::vector<std::string> words = name_words(names[column]);
    std::erase(words, "");
    return words;
  };
  const std::vector<std::string> words = words_of(columns.front());
  const bool is_mean = std::ranges::none_of(words, [&](const std::string& word) {
    return is_in(statistic_words, word) && !is_in(mean_words, word);
  });
  return is_mean && std::ranges::all_of(columns, [&](std::size_t column) {
           return words_of(column) == words &&
                  names[column].find_first_of("0123456789") != std::string::npos;
         });
}

/// "s" of "Time [s]"; empty without brackets, and for a text that is too long for a unit.
std::string unit_of(const std::string& name) {
  const std::size_t open = name.find_first_of("([");
  if (open == std::string::npos || open == 0) return "";
  const std::size_t close = name.find_first_of(")]", open);
  if (close == std::string::npos) return "";
  const std::string unit = printable(name.substr(open + 1, close - open - 1), 40);
  return unit.size() > 12 ? "" : unit;
}

/// pandas writes the index of a frame as a first column without a name, and reads that as
/// "Unnamed: 0".
bool is_index(const std::vector<std::string>& names, std::size_t column) {
  const std::string name = plain_name(names[column]);
  return column == 0 && (name.empty() || name == "unnamed: 0" || name == "index");
}

bool is_law(const std::string& name) {
  return name == "own" || std::ranges::any_of(all_models(), [&](const auto& model) {
           return model->name() == name;
         });
}

std::string list_of_names(const std::vector<std::string>& names) {
  std::vector<std::string> shown;
  for (const std::string& name : names) shown.push_back(name.empty() ? "(no name)" : name);
  return printable(joined(shown, ", "), 300);
}

[[noreturn]] void refuse(const std::string& path, const std::vector<std::string>& names,
                         const std::string& fault) {
  throw BadInput(fmt::format("{}: {}. Columns found: {}. Allowed names: {}.", path, fault,
                             list_of_names(names), allowed));
}

std::string column_text(const ColumnRoles& roles, std::size_t column) {
  const std::string& name = roles.names[column];
  return fmt::format("Column {} ({})", column + 1, name.empty() ? "no name" : printable(name, 60));
}

std::size_t only_column(const std::string& path, const std::vector<std::string>& names,
                        const std::vector<std::size_t>& columns, const char* role) {
  if (columns.size() == 1) return columns.front();
  if (columns.empty()) refuse(path, names, fmt::format("no column is named as {}", role));
  std::vector<std::string> several;
  for (const std::size_t column : columns) several.push_back(names[column]);
  refuse(path, names,
         fmt::format("{} columns are named as {} ({})", columns.size(), role,
                     printable(joined(several, ", "), 100)));
}

/// Columns of the heading by their names.
struct NamedColumns {
  std::vector<std::size_t> t, x, sigma, laws, unused;
};

NamedColumns named_columns(ColumnRoles& roles) {
  NamedColumns found;
  for (std::size_t c = 0; c < roles.names.size(); ++c) {
    const std::string name = plain_name(roles.names[c]);
    if (is_index(roles.names, c)) {
      roles.notes.push_back(column_text(roles, c) + " is an index and is not used.");
    } else if (is_in(t_names, name)) {
      found.t.push_back(c);
    } else if (is_in(x_names, name)) {
      found.x.push_back(c);
    } else if (is_in(sigma_names, name)) {
      found.sigma.push_back(c);
    } else if (is_law(name)) {
      found.laws.push_back(c);
    } else {
      found.unused.push_back(c);
    }
  }
  return found;
}

void note_laws(const NamedColumns& found, ColumnRoles& roles) {
  for (const std::size_t column : found.laws) {
    roles.notes.push_back(column_text(roles, column) + " is a fitted law and is not used.");
  }
}

/// Units that denote a plain number are none.
std::string sigma_unit_of(const std::string& name) {
  const std::string unit = unit_of(name);
  return unit == "1" || unit == "-" ? "" : unit;
}

void require_unit_of_sigma(const std::string& path, const std::vector<std::string>& names,
                           std::size_t x, std::size_t sigma) {
  const std::string unit = sigma_unit_of(names[sigma]), unit_of_x = sigma_unit_of(names[x]);
  if (unit.empty() || unit == unit_of_x) return;
  refuse(
      path, names,
      fmt::format("{} has the unit {} and {} {}: an error has the unit of its value; convert the "
                  "column",
                  printable(names[sigma], 60), unit, printable(names[x], 60),
                  unit_of_x.empty() ? "none" : "has " + unit_of_x));
}

/// Brackets with a number, or behind one name for all, are labels: "run (1)", "run (b)".
void require_one_unit(const std::string& path, const std::vector<std::string>& names,
                      const std::vector<std::size_t>& columns) {
  std::set<std::string> plain, units;
  for (const std::size_t column : columns) {
    const std::string unit = unit_of(names[column]);
    const bool is_label = std::ranges::all_of(unit, [](char c) { return c >= '0' && c <= '9'; });
    plain.insert(plain_name(names[column]));
    if (unit.empty() || !is_label) units.insert(unit.empty() ? "none" : unit);
  }
  if (units.size() < 2 || plain.size() < 2) return;
  refuse(
      path, names,
      fmt::format("the realizations have several units ({}), and their mean has one: convert the "
                  "columns",
                  printable(joined({units.begin(), units.end()}, ", "), 100)));
}

void take_errors(const std::string& path, const NamedColumns& found, ColumnRoles& roles) {
  const auto& names = roles.names;
  if (!found.unused.empty()) {
    std::vector<std::string> unknown;
    for (const std::size_t column : found.unused) unknown.push_back(names[column]);
    refuse(path, names,
           fmt::format("the meaning of the column{} {} is not known",
                       unknown.size() == 1 ? "" : "s", list_of_names(unknown)));
  }
  roles.x = {only_column(path, names, found.x, "X")};
  if (!found.sigma.empty()) {
    roles.sigma = only_column(path, names, found.sigma, "sigma");
    require_unit_of_sigma(path, names, roles.x.front(), *roles.sigma);
  }
  note_laws(found, roles);
}

void take_realizations(const std::string& path, const NamedColumns& found, ColumnRoles& roles) {
  const auto& names = roles.names;
  std::vector<std::size_t> columns = found.unused;
  note_laws(found, roles);
  // A heading t, X, X, ... names every realization X.
  const bool all_x = columns.empty() && found.sigma.empty() && found.x.size() >= 2 &&
                     std::ranges::all_of(found.x, [&](std::size_t column) {
                       return plain_name(names[column]) == "x";
                     });
  if (all_x) columns = found.x;
  std::ranges::sort(columns);
  if (!all_x && (!found.x.empty() || !found.sigma.empty())) {
    columns.insert(columns.end(), found.x.begin(), found.x.end());
    columns.insert(columns.end(), found.sigma.begin(), found.sigma.end());
  }
  const auto statistic = std::ranges::find_if(
      columns, [&](std::size_t column) { return is_statistic(names[column]); });
  if (statistic != columns.end() && !are_numbered_means(names, columns)) {
    refuse(path, names,
           fmt::format("{} names an error, a count, a weight or a mean, not a realization: remove "
                       "the column",
                       printable(names[*statistic], 60)));
  }
  const auto x = std::ranges::find_if(
      columns, [&](std::size_t column) { return plain_name(names[column]) == "x"; });
  if (!all_x && x != columns.end()) {
    refuse(path, names,
           fmt::format("{} names the only curve, not one of several: rename the column",
                       printable(names[*x], 60)));
  }
  std::set<std::string> seen;
  for (const std::size_t column : columns) {
    const std::string& name = names[column];
    if (name.empty()) refuse(path, names, fmt::format("column {} has no name", column + 1));
    if (!all_x && !seen.insert(name).second) {
      refuse(path, names, fmt::format("two realizations are named {}", printable(name, 60)));
    }
  }
  if (columns.size() < 2) refuse(path, names, "fewer than two columns are realizations");
  require_one_unit(path, names, columns);
  roles.x = columns;
}

ColumnRoles roles_by_name(const std::string& path, std::vector<std::string> names,
                          CurveColumns kind) {
  while (!names.empty() && names.back().empty()) names.pop_back();
  ColumnRoles roles;
  roles.names = std::move(names);
  roles.n_columns = roles.names.size();
  const NamedColumns found = named_columns(roles);
  roles.t = only_column(path, roles.names, found.t, "t");
  if (kind == CurveColumns::errors) {
    take_errors(path, found, roles);
  } else {
    take_realizations(path, found, roles);
  }
  roles.t_unit = unit_of(roles.names[roles.t]);
  roles.x_unit = unit_of(roles.names[roles.x.front()]);
  const auto has_it = [&](std::size_t c) { return unit_of(roles.names[c]) == roles.x_unit; };
  // Realizations may be named "run (1)", "run (2)".
  if (!std::ranges::all_of(roles.x, has_it)) roles.x_unit.clear();
  return roles;
}

/// Cells up to the last that is not empty.
std::size_t filled(const std::vector<std::string>& cells) {
  std::size_t n = cells.size();
  while (n > 0 && cells[n - 1].empty()) --n;
  return n;
}

/// The columns of the first line, but for those that are empty in every line.
std::size_t columns_without_heading(const DelimitedText& text) {
  std::size_t n = text.lines.front().cells.size();
  const auto is_empty = [&](const DelimitedLine& line) { return filled(line.cells) < n; };
  while (n > 0 && std::ranges::all_of(text.lines, is_empty)) --n;
  return n;
}

ColumnRoles roles_by_place(const std::string& path, const DelimitedText& text, CurveColumns kind) {
  const std::size_t n = columns_without_heading(text);
  const bool several = kind == CurveColumns::realizations;
  if (several ? n < 3 : n != 2 && n != 3) {
    const DelimitedLine& first = text.lines.front();
    throw BadInput(fmt::format(
        "{}: line {} has {} column{} and no heading (\"{}\"). Without a heading the columns are "
        "{}.",
        path, first.number, n, n == 1 ? "" : "s", printable(first.text, 100),
        several ? "t and one column per realization, of two or more"
                : "t, X or t, X, sigma (where realizations are asked for, t and a column each)"));
  }
  ColumnRoles roles;
  roles.n_columns = n;
  roles.names = {"t"};
  for (std::size_t c = 1; c < n; ++c) {
    roles.names.push_back(several ? fmt::format("X{}", c) : c == 1 ? "X" : "sigma");
    if (several || c == 1) roles.x.push_back(c);
  }
  if (!several && n == 3) roles.sigma = 2;
  return roles;
}

/// A wrong first row is not taken for names: those begin with a letter, or with nothing.
bool is_heading(const std::vector<std::string>& cells) {
  constexpr std::string_view of_numbers = "+-.0123456789";
  const auto first = std::ranges::find_if(cells, [](const auto& cell) { return !cell.empty(); });
  return first != cells.end() && of_numbers.find(first->front()) == std::string_view::npos &&
         plain_name(*first) != "nan";
}

/// numpy's savetxt writes its header as a comment.
bool is_heading_in_comment(const DelimitedText& text) {
  const auto& cells = text.comment.cells;
  return cells.size() == columns_without_heading(text) &&
         std::ranges::any_of(cells,
                             [](const auto& name) { return is_in(t_names, plain_name(name)); });
}

}  // namespace

ColumnRoles column_roles(const std::string& path, const DelimitedText& text, CurveColumns kind) {
  if (text.lines.empty()) throw BadInput(path + ": the file has no rows of numbers.");
  if (is_heading(text.lines.front().cells)) {
    ColumnRoles roles = roles_by_name(path, text.lines.front().cells, kind);
    roles.first_row = 1;
    return roles;
  }
  if (is_heading_in_comment(text)) return roles_by_name(path, text.comment.cells, kind);
  return roles_by_place(path, text, kind);
}

}  // namespace jostle::inline study
