#include "engine/bed/sizes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <utility>

namespace jostle::inline engine {

namespace {

std::string in_short(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

bool in_range(double value, double low, double high) {
  return value >= low && value <= high;  // false for NaN
}

std::optional<std::string> kinds_fault(std::span<const SphereKind> kinds) {
  std::set<std::string> names;
  for (const SphereKind& kind : kinds) {
    if (kind.name.empty()) return "a kind of spheres has no name: give each a name of its own";
    // Files of text part words at blanks and quotes.
    const bool is_word = std::ranges::all_of(kind.name, [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
             c == '_' || c == '-' || c == '+' || c == '.';
    });
    if (!is_word || kind.name.size() > longest_kind_name)
      return "a kind of spheres is named \"" + kind.name + "\": a name has at most " +
             std::to_string(longest_kind_name) + " letters, digits and the characters _ - + .";
    if (!names.insert(kind.name).second)
      return "two kinds of spheres are named \"" + kind.name + "\": give each a name of its own";
    if (!in_range(kind.density, least_density, greatest_density))
      return "spheres of kind \"" + kind.name + "\" have the density " + in_short(kind.density) +
             ": it must lie between " + in_short(least_density) + " and " +
             in_short(greatest_density);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> sizes_fault(std::span<const double> diameters,
                                       std::span<const std::uint32_t> kinds,
                                       std::span<const SphereKind> of_kinds) {
  if (kinds.size() != diameters.size())
    return std::to_string(diameters.size()) + " diameters and the kinds of " +
           std::to_string(kinds.size()) + " spheres are given: give both for every sphere";
  if (auto fault = kinds_fault(of_kinds)) return fault;
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    if (!in_range(diameters[i], least_diameter, greatest_diameter))
      return "sphere " + std::to_string(i) + " has the diameter " + in_short(diameters[i]) +
             ": it must lie between " + in_short(least_diameter) + " and " +
             in_short(greatest_diameter);
    if (kinds[i] >= of_kinds.size())
      return "sphere " + std::to_string(i) + " has kind " + std::to_string(kinds[i]) + ", and " +
             std::to_string(of_kinds.size()) + " kinds exist, counted from 0";
  }
  if (diameters.empty()) return std::nullopt;
  const auto [smallest, largest] = std::ranges::minmax_element(diameters);
  // Diameters that a law computes reach a ratio of 10 to rounding.
  constexpr double rounding = 1e-12;
  if (*largest <= greatest_size_ratio * *smallest * (1 + rounding)) return std::nullopt;
  return "the largest sphere, " + std::to_string(largest - diameters.begin()) +
         ", has the diameter " + in_short(*largest) + ", the smallest, " +
         std::to_string(smallest - diameters.begin()) + ", " + in_short(*smallest) +
         ": their ratio must not exceed " + in_short(greatest_size_ratio);
}

Sizes::Sizes(std::span<const double> diameters, std::vector<std::uint32_t> kinds,
             std::vector<SphereKind> of_kinds)
    : kind_of_(std::move(kinds)), kinds_(std::move(of_kinds)) {
  if (const auto fault = sizes_fault(diameters, kind_of_, kinds_))
    throw std::invalid_argument(*fault);
  radii_.reserve(diameters.size());
  masses_.reserve(diameters.size());
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    const double d = diameters[i];
    radii_.push_back(0.5 * d);
    masses_.push_back(kinds_[kind_of_[i]].density * (d * d * d));
  }
  if (radii_.empty()) return;
  smallest_ = *std::ranges::min_element(radii_);
  largest_ = *std::ranges::max_element(radii_);
}

Sizes::Sizes(std::span<const double> diameters)
    : Sizes(diameters, std::vector<std::uint32_t>(diameters.size(), 0), {{"spheres", 1}}) {}

std::vector<double> diameters_of(const Sizes& sizes) {
  std::vector<double> diameters;
  diameters.reserve(sizes.size());
  for (const double radius : sizes.radii()) diameters.push_back(2 * radius);
  return diameters;
}

}  // namespace jostle::inline engine
