#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

// What is measured inside one packing, in a form that can be averaged over packings whatever it is.
namespace jostle {

/// Where the values of a quantity stand: heights, distances, numbers of neighbours, names.
struct Places {
  std::string name;  // snake_case
  std::variant<std::vector<double>, std::vector<std::string>> values{};
  std::string units{};      // "1" where there is none
  std::string long_name{};  // one line for people

  std::size_t size() const {
    return std::visit([](const auto& list) { return list.size(); }, values);
  }
};

/// One value, or one at each of some places.
struct MeasuredQuantity {
  std::string name{};            // snake_case
  std::string places{};          // name of its Places; empty for a single value
  std::vector<double> values{};  // [n_places] or [1]; NaN where there is none
  std::string units{"1"};
  std::string long_name{};
  std::string source{};  // paper and equation; empty where it is our own
  /// Its value at places that only another packing has, as heights above this one's surface: 0
  /// where there is nothing to find, NaN where there is nothing to measure.
  double beyond = 0;
  /// Whether its change since the first tap is of interest too.
  bool with_change = false;

  double at(std::size_t place) const { return place < values.size() ? values[place] : beyond; }
};

/// One part of the structure of one packing.
struct Measurement {
  std::string part;  // "profile", "pores", ...
  std::vector<Places> places{};
  std::vector<MeasuredQuantity> quantities{};
  std::vector<std::pair<std::string, std::string>> notes{};
  /// Why there is nothing: the container has no such thing, or the region is empty.
  std::string refused{};

  /// Null where there is none of that name.
  const MeasuredQuantity* find(const std::string& name) const {
    for (const MeasuredQuantity& quantity : quantities) {
      if (quantity.name == name) return &quantity;
    }
    return nullptr;
  }
};

}  // namespace jostle
