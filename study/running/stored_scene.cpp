#include "study/running/stored_scene.hpp"

#include "config/json/json_text.hpp"
#include "results/disk/error.hpp"

namespace jostle::inline study {

Json stored_scene(const ResultsFile& file) {
  std::vector<Fault> faults;
  auto scene = read_json(file.study().resolved_scene, faults);
  if (!scene || !scene->is_object()) {
    throw ResultsError(file.path(),
                       "its scene (/scene/resolved) is not a JSON object: jostle did not write it "
                       "so; restore the file from a copy");
  }
  return std::move(*scene);
}

std::string scene_differences(const ResultsFile& file, const LoadedScene& loaded) {
  return fault_lines(resume_faults(checked_scene(stored_scene(file)), loaded.scene, loaded.points));
}

}  // namespace jostle::inline study
