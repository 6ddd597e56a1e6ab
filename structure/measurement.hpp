#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

// Measurements inside one packing, in a form that can be averaged over packings.
// Units, meanings and sources are views of text that lives as long as the program: literals.
namespace jostle::inline structure {

/// Axis of the values of a quantity: heights, distances, numbers of neighbours, names.
struct Places {
  std::string_view name;  // snake_case
  std::variant<std::vector<double>, std::vector<std::string>> values{};
  std::string_view units{};      // "1" where there is none
  std::string_view long_name{};  // one line for people

  std::size_t size() const {
    return std::visit([](const auto& list) { return list.size(); }, values);
  }
};

/// How the values of packings become one.
enum class Pooling {
  mean,      // all packings that have a value alike
  weighted,  // by their `weights`: a ratio of sums, whose denominators the weights are
  sum        // over packings
};

/// One value, or one at each of some places.
struct MeasuredQuantity {
  std::string name{};            // snake_case; of a mixture also with the names of kinds
  std::string_view places{};     // name of its Places; empty for a single value
  std::vector<double> values{};  // [n_places] or [1]; NaN where there is none
  std::string_view units{"1"};
  std::string_view long_name{};
  std::string_view source{};  // paper and equation; empty where it is our own
  Pooling pooling = Pooling::mean;
  std::vector<double> weights{};  // one per value where `pooling` is weighted; 0: no value
  /// Its value at places that only another packing has, as heights above this one's surface: 0
  /// where there is nothing to find, NaN where there is nothing to measure.
  double beyond = 0;
  /// True if its change since the first tap is also relevant.
  bool with_change = false;
  /// True if its mean over packings has an error: not so where it is itself one, or a constant.
  bool with_error = true;
  /// True if the packings that have a value are counted: so where a packing may have none.
  bool with_packings = false;
  /// False if it counts what lies in a region whose height follows each bed: a difference of such
  /// counts between ensembles has no meaning of its own and is not tested.
  bool is_compared = true;

  double value_at(std::size_t place) const {
    return place < values.size() ? values[place] : beyond;
  }
  double weight_at(std::size_t place) const { return place < weights.size() ? weights[place] : 0; }
};

/// One part of the structure of one packing.
struct Measurement {
  std::string_view part;  // "profile", "pores", ...
  std::vector<Places> places{};
  std::vector<MeasuredQuantity> quantities{};
  std::vector<std::pair<std::string, std::string>> notes{};
  /// Why there is nothing: the container has no such thing, or the region is empty.
  std::string refused{};

  /// Null where there is none of that name.
  const MeasuredQuantity* find(std::string_view name) const {
    for (const MeasuredQuantity& quantity : quantities) {
      if (quantity.name == name) return &quantity;
    }
    return nullptr;
  }
};

}  // namespace jostle::inline structure
