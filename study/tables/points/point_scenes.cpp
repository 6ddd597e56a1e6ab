#include "study/tables/points/point_scenes.hpp"

#include <algorithm>

#include "study/bad_input.hpp"

namespace jostle::inline study {
namespace {

ParsedScene scene_of(const ResultsFile& file) {
  ParsedScene parsed = parse_scene(file.study().resolved_scene);
  if (!parsed.scene) throw BadInput(file.path() + ": its scene is not one that this version reads");
  return parsed;
}

}  // namespace

PointScenes::PointScenes(const ResultsFile& file)
    : read_(scene_of(file)), points_(sweep_points(scene().sweep)) {}

bool PointScenes::vary_together(const std::string& a, const std::string& b) const {
  return std::ranges::any_of(scene().sweep, [&](const SweepAxis& axis) {
    const auto holds = [&](const std::string& pointer) {
      return std::ranges::any_of(axis.columns,
                                 [&](const auto& column) { return column.first == pointer; });
    };
    return holds(a) && holds(b);
  });
}

std::optional<Json> PointScenes::value_at(std::uint32_t point, const std::string& pointer) const {
  for (const auto& [swept, value] : points_.at(point).values) {
    if (swept == pointer) return value;
  }
  const Json scene = resolved(point_scene(point));
  const Json* const value = scene.find_pointer(pointer);
  return value != nullptr ? std::optional(*value) : std::nullopt;
}

}  // namespace jostle::inline study
