#include "study/drawing/drawn/point_labels.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "config/sweep.hpp"
#include "engine/taps.hpp"
#include "study/drawing/drawn/value_text.hpp"

namespace jostle::inline study {
namespace {

using SweptValues = std::vector<std::pair<std::string, Json>>;

/// Names of scenes in print, beside those of taps; others are written in words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> printed_names{
    {{"theta0", "θ_0"}, {"monte_carlo", "Monte Carlo"}, {"discrete_element", "grains"}}};

std::string printed(std::string name) {
  if (const std::string_view symbol = tap_symbol(name); !symbol.empty()) return std::string(symbol);
  const auto* const known = std::ranges::find(
      printed_names, std::string_view(name), &std::pair<std::string_view, std::string_view>::first);
  if (known != printed_names.end()) return std::string(known->second);
  std::ranges::replace(name, '_', ' ');
  std::ranges::replace(name, '/', ' ');
  return name;
}

constexpr std::size_t longest_part = 24;  // bytes

/// "ε = 0.05", "Monte Carlo"; empty for a value that has no short text.
std::string part_of(const std::string& pointer, const Json& value) {
  const auto equation = [](const std::string& name, const Json& number) {
    return printed(name) + " = " + typeset_number(number.number(), 6);
  };
  if (value.is_number()) return equation(short_name(pointer), value);
  if (value.is_string()) return printed(value.text());
  if (!value.is_object() || value.size() != 1) return "";
  const auto& [name, inner] = *value.members().begin();  // {"dilate": 0.05}, {"discrete_element":
  if (inner.is_number()) return equation(name, inner);   // {...}}
  return inner.is_object() ? printed(name) : "";
}

/// The values of every point as JSON; empty where one is none.
std::vector<SweptValues> values_of(const Study& study) {
  std::vector<SweptValues> all;
  for (const StudyPoint& point : study.points) {
    SweptValues& values = all.emplace_back();
    for (const auto& [pointer, text] : point.sweep_values) {
      try {
        values.emplace_back(pointer, Json::parse(text));
      } catch (const std::exception&) {
        return {};
      }
    }
    if (values.size() != all.front().size()) return {};
  }
  return all;
}

/// True if no two points have the same values in `columns`.
bool are_distinct(const Study& study, const std::vector<std::size_t>& columns) {
  std::set<std::string> seen;
  return std::ranges::all_of(study.points, [&](const StudyPoint& point) {
    std::string text;
    for (const std::size_t column : columns) text += point.sweep_values[column].second + "\n";
    return seen.insert(text).second;
  });
}

/// Columns of the sweep without those that vary with earlier ones.
std::vector<std::size_t> needed_columns(const Study& study) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < study.points.front().sweep_values.size(); ++i) columns.push_back(i);
  for (std::size_t last = columns.size(); last-- > 0;) {
    std::vector<std::size_t> fewer = columns;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(last));
    if (are_distinct(study, fewer)) columns = fewer;
  }
  return columns;
}

/// Empty where a value has no short text, or two points would have one label.
std::vector<std::string> short_labels(const Study& study, const std::vector<SweptValues>& values) {
  std::vector<std::string> labels;
  const std::vector<std::size_t> columns = needed_columns(study);
  for (const SweptValues& of_point : values) {
    std::string& label = labels.emplace_back();
    for (const std::size_t column : columns) {
      const auto& [pointer, value] = of_point[column];
      const std::string part = part_of(pointer, value);
      if (part.empty() || part.size() > longest_part) return {};
      label += (label.empty() ? "" : ", ") + part;
    }
  }
  const std::set<std::string> distinct(labels.begin(), labels.end());
  return distinct.size() == labels.size() ? labels : std::vector<std::string>{};
}

}  // namespace

std::vector<std::string> shown_labels(const Study& study) {
  std::vector<std::string> stored;
  for (const StudyPoint& point : study.points) stored.push_back(point.label);
  const std::vector<SweptValues> values = values_of(study);
  if (values.empty() || values.front().empty()) return stored;
  for (std::size_t i = 0; i < values.size(); ++i) {  // other labels were given
    if (stored[i] != point_label({values[i], {}})) return stored;
  }
  std::vector<std::string> labels = short_labels(study, values);
  return labels.empty() ? stored : labels;
}

}  // namespace jostle::inline study
