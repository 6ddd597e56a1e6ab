#include "cli/point_scenes.hpp"

#include <cassert>

#include "cli/scene_file.hpp"

namespace jostle {

PointScenes::PointScenes(const ResultsFile& file) {
  const ParsedScene parsed = parse_scene(file.study().resolved_scene);
  if (!parsed.scene) throw BadInput(file.path() + ": its scene is not one that this version reads");
  resolved_ = resolved(*parsed.scene);
  points_ = sweep_points(parsed.scene->sweep);
}

Scene PointScenes::at(std::uint32_t point) const {
  std::vector<Fault> faults;
  Scene scene = scene_at(resolved_, points_.at(point), faults);
  assert(faults.empty());
  return scene;
}

}  // namespace jostle
