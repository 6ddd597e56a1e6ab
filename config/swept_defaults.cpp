#include "config/swept_defaults.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

/// True if the scene sweeps the pointer, and one of its values is one that `is_meant` picks.
template <class IsMeant>
bool sweeps(const Scene& scene, std::string_view pointer, const IsMeant& is_meant) {
  return std::ranges::any_of(scene.sweep, [&](const SweepAxis& axis) {
    return std::ranges::any_of(axis.columns, [&](const auto& column) {
      return column.first == pointer && std::ranges::any_of(column.second, is_meant);
    });
  });
}

bool sweeps(const Scene& scene, std::string_view pointer) {
  return sweeps(scene, pointer, [](const Json&) { return true; });
}

bool has_other_kinds(const Json& spheres, const Scene& scene) {
  std::vector<std::string> names;
  for (std::size_t k = 0; spheres.is_array() && k < spheres.size(); ++k)
    if (spheres.at(k).contains("name") && spheres.at(k).at("name").is_string())
      names.push_back(spheres.at(k).at("name").text());
  return !std::ranges::equal(names, scene.kinds, {}, {}, &MixtureKind::name);
}

}  // namespace

bool leaves_steps_out(const Scene& scene) {
  const std::string grains = "/engine/discrete_element", law = "linear_spring_dashpot";
  const bool has_dashpots = std::holds_alternative<LinearSpringDashpot>(scene.grains->spheres);
  const auto has_another_law = [&](const Json& value) {
    return (value.is_object() ? value.contains(law) : value == Json(law)) != has_dashpots;
  };
  return !scene.grains->steps_per_contact && sweeps(scene, grains + "/contact", has_another_law) &&
         !sweeps(scene, grains + "/steps_per_contact");
}

bool leaves_kept_data_out(const Scene& scene) {
  return sweeps(scene, "/engine") &&
         written_part(scene.snapshots).at("keep") ==
             written_part(default_snapshots(scene.grains.has_value())).at("keep");
}

bool leaves_observables_out(const Scene& scene) {
  const auto is_other = [&](const Json& spheres) { return has_other_kinds(spheres, scene); };
  const std::vector<Observable> by_default =
      scene.kinds.empty() ? Scene{}.observables : default_observables(scene.kinds);
  return sweeps(scene, "/spheres", is_other) && !sweeps(scene, "/observe") &&
         scene.observables == by_default;
}

}  // namespace jostle::inline config
