#include "config/json/suggestion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace jostle::inline config {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> second_row_above(b.size() + 1), row_above(b.size() + 1),
      row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row_above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = row_above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({row_above[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], second_row_above[j - 2] + 1);
      }
    }
    second_row_above.swap(row_above);
    row_above.swap(row);
  }
  return row_above[b.size()];
}

namespace {

constexpr std::size_t shortest_part = 4;

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace

std::string did_you_mean(std::string_view written, const std::vector<std::string>& candidates) {
  const std::string word = lower_case(written);
  const std::string* nearest = nullptr;
  std::size_t least = 2 + word.size() / 4;
  for (const std::string& candidate : candidates) {
    const std::string known = lower_case(candidate);
    const bool part = word.size() >= shortest_part && known.find(word) != known.npos;
    const std::size_t distance = part ? 1 : edit_distance(word, known);
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
    "\"lift\" (gamma: heights rise by gamma), not an acceleration. Roughly, eps = Gamma^2 g / (2 "
    "(2 pi f)^2 h) for a bed of "
    "height h "
    "(Philippe & Bideau 2001, eq. 2): 1.7e-4 Gamma^2 in the tube of Knight et al. (30 Hz, 0.8 m). "
    "Discrete elements have the \"acceleration\" Gamma of \"half_sine\" and \"vibration\".";
constexpr std::string_view sizes_hint =
    " Sizes belong to the kinds of a mixture: \"spheres\": [{\"name\": \"a\", \"count\": 100, "
    "\"diameter\": 1.2}, ...].";
constexpr std::string_view friction_hint =
    " Contact laws belong to discrete elements: \"engine\": {\"discrete_element\": {\"contact\": "
    "{\"walton_braun\": {\"friction\": 0.1, \"restitution\": 0.9}}}}. Monte Carlo has none.";
constexpr std::string_view number_hint =
    " The number of spheres is \"spheres\"; that of repetitions is \"realizations\".";
constexpr std::string_view taps_hint =
    " Taps are stages of \"protocol\": [{\"tap\": {\"dilate\": 0.02}, \"count\": 100}].";
constexpr std::string_view container_hint =
    " The box is \"container\": {\"sides\": \"periodic\", \"width\": 8}, in sphere diameters, with "
    "a "
    "floor at z = 0 and an open top.";
constexpr std::string_view tube_hint =
    " A tube is {\"sides\": \"cylinder\", \"diameter\": 10}, a box {\"sides\": \"walls\", "
    "\"width\": 10}, "
    "both in sphere diameters.";
constexpr std::string_view top_hint = " The top is open; \"fully_periodic\" alone has a height.";
constexpr std::string_view temperature_hint =
    " Grains have no temperature. Monte Carlo moves upwards have the \"beta\" of \"metropolis\", "
    "in "
    "units of 1/(m g d).";
constexpr std::string_view gravity_hint =
    " Gravity acts along -z. Its value is a key of \"engine\": {\"discrete_element\": ...}; Monte "
    "Carlo "
    "needs none.";
constexpr std::string_view fraction_hint =
    " The packing fraction is a result (\"observe\": [\"bulk_fraction\"]); \"start\" and "
    "\"protocol\" determine it.";

/// A name that papers give to a quantity, and what scenes have for it.
struct KnownName {
  std::string_view name, hint;
  std::string_view sibling = "";  // a key that is allowed in the place where this hint applies
};
// The first that fits is given.
constexpr KnownName known_elsewhere[] = {{"radius", tube_hint, "sides"},
                                         {"diameter", tube_hint, "sides"},
                                         {"height", top_hint, "sides"},
                                         {"depth", top_hint, "sides"},
                                         {"acceleration", strength_hint},
                                         {"gamma", strength_hint},
                                         {"Gamma", strength_hint},
                                         {"amplitude", strength_hint},
                                         {"frequency", strength_hint},
                                         {"intensity", strength_hint},
                                         {"strength", strength_hint},
                                         {"epsilon", strength_hint},
                                         {"eps", strength_hint},
                                         {"polydispersity", sizes_hint},
                                         {"diameters", sizes_hint},
                                         {"diameter", sizes_hint},
                                         {"radius", sizes_hint, "spheres"},
                                         {"radius", sizes_hint, "count"},
                                         {"radii", sizes_hint},
                                         {"size_distribution", sizes_hint},
                                         {"size_ratio", sizes_hint},
                                         {"density", sizes_hint},
                                         {"friction", friction_hint},
                                         {"restitution", friction_hint},
                                         {"stiffness", friction_hint},
                                         {"cohesion", friction_hint},
                                         {"mu", friction_hint},
                                         {"N", number_hint},
                                         {"n", number_hint},
                                         {"n_spheres", number_hint},
                                         {"n_particles", number_hint},
                                         {"particles", number_hint},
                                         {"grains", number_hint},
                                         {"replicas", number_hint},
                                         {"runs", number_hint},
                                         {"samples", number_hint},
                                         {"taps", taps_hint},
                                         {"n_taps", taps_hint},
                                         {"cycles", taps_hint},
                                         {"tap", taps_hint, "spheres"},
                                         {"box", container_hint},
                                         {"box_size", container_hint},
                                         {"boundary", container_hint},
                                         {"boundary_conditions", container_hint},
                                         {"pbc", container_hint},
                                         {"periodic", container_hint},
                                         {"temperature", temperature_hint},
                                         {"kT", temperature_hint},
                                         {"gravity", gravity_hint},
                                         {"g", gravity_hint},
                                         {"packing_fraction", fraction_hint},
                                         {"volume_fraction", fraction_hint},
                                         {"solids_fraction", fraction_hint},
                                         {"phi", fraction_hint}};

}  // namespace

std::string key_hint(std::string_view written, const std::vector<std::string>& candidates) {
  const auto fits = [&](const KnownName& known) {
    return known.name == written &&
           (known.sibling.empty() ||
            std::ranges::find(candidates, known.sibling) != candidates.end());
  };
  const auto known = std::ranges::find_if(known_elsewhere, fits);
  if (known == std::end(known_elsewhere)) return did_you_mean(written, candidates);
  // A word of the field is no slip of a longer one, but it may be that of its singular or plural.
  const auto slip = std::ranges::find_if(candidates, [&](const std::string& candidate) {
    return written.size() > 3 && edit_distance(written, candidate) == 1;
  });
  return slip != candidates.end() ? fmt::format(" Did you mean \"{}\"?", *slip)
                                  : std::string(known->hint);
}

}  // namespace jostle::inline config
