#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// Results of an analysis in the form in which they are stored, printed and written as CSV.
namespace jostle::inline ensemble {

/// Named values along the axes of their table.
struct Quantity {
  std::string name;  // snake_case, the field's term: "tau_a"; its error "tau_a_error"
  std::vector<std::string> axes{};  // names of axes of the table, outermost first; none: one value
  std::variant<std::vector<double>, std::vector<std::uint64_t>, std::vector<std::string>> values{};
  std::string units{};      // "1" where there is none
  std::string long_name{};  // one line for people
  std::string source{};     // paper and equation; empty where it is our own
};

/// Quantities over shared axes, an error beside every value that has one.
struct Table {
  std::string name;              // '/' separates parts: "point_0000/ageing/mean_height"
  std::vector<Quantity> axes{};  // one-dimensional, each along itself
  std::vector<Quantity> quantities{};
  /// Settings and results in words: "observable", "verdict", ...
  std::vector<std::pair<std::string, std::string>> notes{};
};

/// True if the table holds results, and not the reason why there are none, its note "refused".
inline bool is_made(const Table& table) {
  return std::ranges::none_of(table.notes,
                              [](const auto& note) { return note.first == "refused"; });
}

}  // namespace jostle::inline ensemble
