#include "study/tables/curve_file.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "results/export/input_file.hpp"
#include "results/export/printable.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline study {

namespace {

constexpr const char* blanks = " \t\r";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// What semicolons, else commas, else blanks divide: never two of them, so that a decimal comma is
/// no number and not two.
std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found;
  const char divider = line.find(';') != std::string::npos   ? ';'
                       : line.find(',') != std::string::npos ? ','
                                                             : ' ';
  std::istringstream words(line);
  if (divider == ' ') {
    for (std::string word; words >> word;) found.push_back(word);
    return found;
  }
  for (std::string word; std::getline(words, word, divider);) found.push_back(trimmed(word));
  while (!found.empty() && found.back().empty()) found.pop_back();
  return found;
}

std::optional<double> number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool whole = !text.empty() && end == text.c_str() + text.size();
  return whole ? std::optional(value) : std::nullopt;
}

/// So that a first line that is wrong is not taken for one of names.
bool begins_as_number(const std::string& text) {
  return !text.empty() && std::string_view("+-.0123456789").find(text[0]) != std::string_view::npos;
}

std::optional<std::vector<double>> numbers(const std::vector<std::string>& words) {
  std::vector<double> values;
  for (const std::string& word : words) {
    const auto value = number(word);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

/// As many as the lines before, or as a first line may have.
bool fits(std::size_t numbers, std::size_t columns, CurveColumns kind) {
  if (columns != 0) return numbers == columns;
  return kind == CurveColumns::realizations ? numbers >= 3 : numbers == 2 || numbers == 3;
}

std::string wanted(std::size_t columns, CurveColumns kind) {
  if (kind == CurveColumns::realizations) {
    return columns == 0 ? "numbers t, X, X, ..., of two realizations or more"
                        : fmt::format("{} numbers, t and X of {} realizations like those before",
                                      columns, columns - 1);
  }
  return columns == 3   ? "three numbers t, X, sigma"
         : columns == 2 ? "two numbers t, X like those before"
                        : "two numbers t, X or three t, X, sigma (or, where realizations are asked "
                          "for, t and a "
                          "column each)";
}

}  // namespace

Curve read_curve(const std::string& path, CurveColumns kind) {
  InputFile file(path, Pipes::allowed);
  Curve curve;
  std::size_t columns = 0, line_number = 0;
  bool named = false;
  for (std::string line; file.next_line(line);) {
    ++line_number;
    const std::vector<std::string> words = cells(line);
    if (words.empty() || words.front().starts_with('#')) continue;
    const auto values = numbers(words);
    if (!values && curve.t.empty() && !named && !begins_as_number(words.front())) {
      named = true;
      continue;
    }
    if (!values || !fits(values->size(), columns, kind)) {
      throw BadInput(
          fmt::format("{}: line {} is not {}, with decimal points and one kind of divider (\"{}\")",
                      path, line_number, wanted(columns, kind), printable(line)));
    }
    columns = values->size();
    curve.t.push_back((*values)[0]);
    if (kind == CurveColumns::realizations) {
      curve.values.insert(curve.values.end(), values->begin() + 1, values->end());
      continue;
    }
    curve.x.push_back((*values)[1]);
    if (columns == 3) curve.sigma.push_back((*values)[2]);
  }
  if (kind == CurveColumns::errors || columns == 0) return curve;
  return mean_curve(std::move(curve.t), std::move(curve.values), columns - 1);
}

}  // namespace jostle::inline study
