#include "study/scenes/point_scenes.hpp"

#include <algorithm>
#include <cassert>

#include "study/bad_input.hpp"

namespace jostle::inline study {
namespace {

Scene scene_of(const ResultsFile& file) {
  ParsedScene parsed = parse_scene(file.study().resolved_scene);
  if (!parsed.scene) throw BadInput(file.path() + ": its scene is not one that this version reads");
  return std::move(*parsed.scene);
}

}  // namespace

PointScenes::PointScenes(const ResultsFile& file)
    : scene_(scene_of(file)), resolved_(resolved(scene_)), points_(sweep_points(scene_.sweep)) {}

bool PointScenes::vary_together(const std::string& a, const std::string& b) const {
  return std::ranges::any_of(scene_.sweep, [&](const SweepAxis& axis) {
    const auto holds = [&](const std::string& pointer) {
      return std::ranges::any_of(axis.columns,
                                 [&](const auto& column) { return column.first == pointer; });
    };
    return holds(a) && holds(b);
  });
}

const Scene& PointScenes::at(std::uint32_t point) const {
  const auto known = read_.find(point);
  if (known != read_.end()) return known->second;
  std::vector<Fault> faults;
  Scene scene = scene_at(resolved_, points_.at(point), faults);
  assert(faults.empty());
  return read_.emplace(point, std::move(scene)).first->second;
}

std::optional<Json> PointScenes::value_at(std::uint32_t point, const std::string& pointer) const {
  for (const auto& [swept, value] : points_.at(point).values) {
    if (swept == pointer) return value;
  }
  const Json scene = resolved(at(point));
  const Json* const value = scene.find_pointer(pointer);
  return value != nullptr ? std::optional(*value) : std::nullopt;
}

}  // namespace jostle::inline study
