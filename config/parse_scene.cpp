#include "config/parts/parts.hpp"
#include "config/sweep.hpp"

namespace jostle::inline config {

ParsedScene parse_scene(std::string_view json_text) {
  ParsedScene parsed;
  const auto json = read_json(json_text, parsed.faults);
  if (!json) return parsed;
  Scene scene = read_scene(Reader{*json, "", parsed.faults});
  check_consistency(scene, parsed.faults);
  check_sweep_analyses(scene, parsed.faults);
  if (!scene.sweep.empty()) check_sweep(scene, json->at("sweep"), parsed.faults);
  if (parsed.faults.empty()) parsed.scene = std::move(scene);
  return parsed;
}

}  // namespace jostle::inline config
