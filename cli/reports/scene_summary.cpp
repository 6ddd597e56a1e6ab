#include "cli/reports/scene_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "cli/tables/wrapped.hpp"
#include "fitting/fit.hpp"
#include "fitting/value_text.hpp"

namespace jostle::inline cli {
namespace {

/// Notes that give a result, in the order in which they are printed, and their subjects.
constexpr std::pair<const char*, const char*> results[] = {{"refused", "not possible: "},
                                                           {"verdict", ""},
                                                           {"ageing_verdict", ""},
                                                           {"collapse_verdict", "collapse: "},
                                                           {"age", ""},
                                                           {"maximum", "maximum: "},
                                                           {"minimum", "minimum: "}};

/// "steady/mean_height" of "point_0000/steady/mean_height".
std::string name_without_point(const std::string& name) {
  const std::size_t slash = name.find('/');
  return name.starts_with("point_") && slash != std::string::npos ? name.substr(slash + 1) : name;
}

std::string note(const Table& table, const char* name) {
  for (const auto& [key, text] : table.notes) {
    if (key == name) return text;
  }
  return "";
}

/// Without tests and intervals in parentheses, which --verbose prints. Those that follow a space
/// are meant: AR(1) stays.
std::string without_parentheses(const std::string& text) {
  std::string kept;
  int depth = 0;
  for (const char c : text) {
    if (c == '(' && (depth > 0 || kept.ends_with(' ')) && depth++ == 0) kept.pop_back();
    if (depth == 0) kept += c;
    if (c == ')' && depth > 0) --depth;
  }
  return kept;
}

void append(std::string& verdict, const std::string& text) {
  if (!text.empty()) verdict += (verdict.empty() ? "" : "; ") + text;
}

double single_value(const Table& table, const std::string& name) {
  for (const Quantity& quantity : table.quantities) {
    const auto* values = std::get_if<std::vector<double>>(&quantity.values);
    if (quantity.name == name && values != nullptr && values->size() == 1) return values->front();
  }
  return std::nan("");
}

/// "slope -0.43(18)" of a spectrum, else empty.
std::string slope_text(const Table& table) {
  const double slope = single_value(table, "slope");
  if (!std::isfinite(slope)) return "";
  const double half =
      half_width(single_value(table, "slope_error"), single_value(table, "slope_dof"));
  return "slope " + value_with_error(slope, half, 1);
}

/// Empty for a table without a result in words.
std::string verdict_of(const Table& table) {
  std::string verdict;
  append(verdict, slope_text(table));
  for (const auto& [name, subject] : results) {
    if (const std::string text = without_parentheses(note(table, name)); !text.empty()) {
      append(verdict, subject + text);
    }
  }
  for (const Quantity& quantity : table.quantities) {
    const auto* texts = std::get_if<std::vector<std::string>>(&quantity.values);
    if (texts == nullptr || quantity.name != "area_verdict") continue;
    for (const std::string& text : *texts) append(verdict, without_parentheses(text));
  }
  return verdict;
}

}  // namespace

void SceneSummary::add(const Table& table) {
  const std::string name = name_without_point(table.name);
  if (const std::string verdict = verdict_of(table); !verdict.empty()) {
    lines_.push_back({name, note(table, "sweep_point"), verdict});
  } else if (std::ranges::find(parts_, name) == parts_.end()) {
    parts_.push_back(name);
  }
}

std::string SceneSummary::text(std::size_t width) const {
  std::string text;
  std::vector<std::string> printed;
  for (const Line& first : lines_) {
    if (std::ranges::find(printed, first.analysis) != printed.end()) continue;
    printed.push_back(first.analysis);
    text += first.analysis + "\n";
    for (const Line& line : lines_) {
      if (line.analysis != first.analysis) continue;
      text += line.point.empty() ? fmt::format("  {}\n", line.verdict)
                                 : fmt::format("  {}  {}\n", line.point, line.verdict);
    }
  }
  if (!parts_.empty()) {
    text += fmt::format("stored tables: {}\n", fmt::join(parts_, ", "));
  }
  if (text.empty()) return "";
  return wrapped(text + "--verbose prints every table; jostle report draws them.\n", width);
}

}  // namespace jostle::inline cli
