#include "study/point_scenes.hpp"

#include <algorithm>
#include <cassert>

#include "study/scene_file.hpp"

namespace jostle {

PointScenes::PointScenes(const ResultsFile& file) {
  const ParsedScene parsed = parse_scene(file.study().resolved_scene);
  if (!parsed.scene) throw BadInput(file.path() + ": its scene is not one that this version reads");
  resolved_ = resolved(*parsed.scene);
  axes_ = parsed.scene->sweep;
  points_ = sweep_points(axes_);
}

bool PointScenes::vary_together(const std::string& a, const std::string& b) const {
  return std::ranges::any_of(axes_, [&](const SweepAxis& axis) {
    const auto holds = [&](const std::string& pointer) {
      return std::ranges::any_of(axis.columns,
                                 [&](const auto& column) { return column.first == pointer; });
    };
    return holds(a) && holds(b);
  });
}

Scene PointScenes::at(std::uint32_t point) const {
  std::vector<Fault> faults;
  Scene scene = scene_at(resolved_, points_.at(point), faults);
  assert(faults.empty());
  return scene;
}

}  // namespace jostle
