#include "config/json/suggestion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace jostle::inline config {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

namespace {

constexpr std::size_t shortest_part = 4;

}  // namespace

std::string did_you_mean(std::string_view written, const std::vector<std::string>& candidates) {
  const std::string* nearest = nullptr;
  std::size_t least = 2 + written.size() / 4;
  for (const std::string& candidate : candidates) {
    const bool part = written.size() >= shortest_part && candidate.find(written) != candidate.npos;
    const std::size_t distance = part ? 1 : edit_distance(written, candidate);
    if (distance < least) {
      least = distance;
      nearest = &candidate;
    }
  }
  return nearest ? fmt::format(" Did you mean \"{}\"?", *nearest) : "";
}

namespace {

constexpr std::string_view strength_hint =
    " The strength of a Monte Carlo tap is \"dilate\" (eps: heights are multiplied by 1 + eps) or "
    "\"lift\", not an acceleration. Roughly, eps = Gamma^2 g / (2 (2 pi f)^2 h) for a bed of "
    "height h "
    "(Philippe & Bideau 2001, eq. 2): 1.7e-4 Gamma^2 in the tube of Knight et al. (30 Hz, 0.8 m). "
    "Discrete elements have the \"acceleration\" Gamma of \"half_sine\" and \"vibration\".";
constexpr std::string_view sizes_hint =
    " Sizes belong to the kinds of a mixture: \"spheres\": [{\"name\": \"a\", \"count\": 100, "
    "\"diameter\": 1.2}, ...].";
constexpr std::string_view friction_hint =
    " Contact laws belong to \"engine\": {\"discrete_element\": ...}; Monte Carlo has none.";

// Names that papers give to quantities, and what scenes have for them.
constexpr std::pair<std::string_view, std::string_view> known_elsewhere[] = {
    {"acceleration", strength_hint},
    {"gamma", strength_hint},
    {"Gamma", strength_hint},
    {"amplitude", strength_hint},
    {"intensity", strength_hint},
    {"epsilon", strength_hint},
    {"eps", strength_hint},
    {"polydispersity", sizes_hint},
    {"diameters", sizes_hint},
    {"radius", sizes_hint},
    {"size_distribution", sizes_hint},
    {"friction", friction_hint},
    {"restitution", friction_hint},
    {"mu", friction_hint}};

}  // namespace

std::string key_hint(std::string_view written, const std::vector<std::string>& candidates) {
  const auto known = std::ranges::find(known_elsewhere, written,
                                       &std::pair<std::string_view, std::string_view>::first);
  const std::string nearest = did_you_mean(written, candidates);
  if (!nearest.empty() || known == std::end(known_elsewhere)) return nearest;
  return std::string(known->second);
}

}  // namespace jostle::inline config
