#include "cli/reports/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace jostle::inline cli {
namespace {

constexpr std::size_t longest_list = 40, first_of_long = 10;  // elements

/// " m", " kg/m^3": units of the settings of discrete elements; lengths elsewhere are in diameters.
std::string unit_of(std::string_view key) {
  using Unit = std::pair<std::string_view, const char*>;
  constexpr std::array<Unit, 7> units{{{"diameter", " m"},
                                       {"density", " kg/m^3"},
                                       {"gravity", " m/s^2"},
                                       {"stiffness", " N/m"},
                                       {"kinetic_energy", " m g d"},
                                       {"seconds", " s"},
                                       {"most_seconds", " s"}}};
  const auto found = std::ranges::find(units, key, &Unit::first);
  return found == units.end() ? "" : found->second;
}

/// Units that numbers are printed with.
enum class Units { none, discrete_elements };

/// A value of a scene in words: {"polar": {"max_step": 0.1}} as "polar (max_step 0.1)".
std::string in_words(const Json& value, Units units = Units::none) {
  if (value.is_string()) return value.text();
  if (!value.is_structured()) return value.dump();
  std::string words;
  if (value.is_array()) {
    const auto& elements = value.elements();
    const bool is_long = elements.size() > longest_list;
    for (std::size_t i = 0; i < (is_long ? first_of_long : elements.size()); ++i) {
      words += fmt::format("{}{}", words.empty() ? "" : "; ", in_words(elements[i], units));
    }
    if (is_long) {
      words +=
          fmt::format("; ...; {} ({} values)", in_words(elements.back(), units), elements.size());
    }
    return words;
  }
  for (const auto& [key, member] : value.members()) {
    if (member.is_array() && member.empty()) continue;  // a default that depends on the run
    if (!words.empty()) words += ", ";
    if (!member.is_object()) {
      const bool has_unit = units == Units::discrete_elements && member.is_number();
      words += fmt::format("{} {}{}", key, in_words(member, units), has_unit ? unit_of(key) : "");
    } else {
      words += member.empty() ? key : fmt::format("{} ({})", key, in_words(member, units));
    }
  }
  return words;
}

/// A part without its empty lists.
Json without_empty_lists(const Json& part) {
  if (!part.is_object()) return part;
  Json kept = Json::object();
  for (const auto& [key, member] : part.members()) {
    if (!member.is_array() || !member.empty()) kept[key] = member;
  }
  return kept;
}

/// A snapshot without taps is kept of none.
bool is_on(const std::string& part, const Json& value) {
  if (part == "snapshots") return value.contains("taps");
  return !value.empty();
}

/// The scene with the word "swept" in place of every value that the sweep replaces.
Json with_swept(Json scene) {
  const Json* const sweep = scene.find("sweep");
  if (sweep == nullptr || !sweep->is_object()) return scene;
  std::vector<std::string> pointers;
  for (const auto& [key, value] : sweep->members()) {
    if (key != "zip") {
      pointers.push_back(key);
      continue;
    }
    const std::vector<Json> groups = value.is_array() ? value.elements() : std::vector<Json>{value};
    for (const Json& group : groups)
      for (const auto& [pointer, values] : group.members()) pointers.push_back(pointer);
  }
  for (const std::string& pointer : pointers) {
    if (!pointer.starts_with('/')) continue;
    if (Json* const value = scene.find_pointer(pointer))
      *value = "swept";
    else if (pointer.find('/', 1) == std::string::npos)
      scene[std::string_view(pointer).substr(1)] = "swept";
  }
  return scene;
}

}  // namespace

std::string effects_text(const Json& scene) {
  const Json resolved = with_swept(scene);
  std::string enabled = "effects\n", disabled;
  for (const char* part :
       {"container", "start", "protocol", "engine", "relax", "observe", "snapshots", "motion",
        "sweep", "until", "fits", "analyse", "structure"}) {
    const Json value =
        without_empty_lists(resolved.contains(part) ? resolved.at(part) : Json::object());
    // One of the two is there: Monte Carlo's settings are "relax".
    const bool is_of_engine =
        std::string_view(part) == "engine" || std::string_view(part) == "relax";
    if (is_of_engine && value.empty()) continue;
    if (is_on(part, value)) {
      const bool is_engine = std::string_view(part) == "engine";
      enabled += fmt::format("  {:<11}{}\n", part,
                             in_words(value, is_engine ? Units::discrete_elements : Units::none));
    } else {
      disabled += fmt::format("{}{}", disabled.empty() ? "" : ", ", part);
    }
  }
  return disabled.empty() ? enabled : enabled + fmt::format("  {:<11}{}\n", "off", disabled);
}

}  // namespace jostle::inline cli
