#include "config/parts/parts.hpp"
#include "config/sweep.hpp"

namespace jostle::inline config {
namespace {

/// `faults`: those that the text has already.
ParsedScene checked(const Json& document, std::vector<Fault> faults) {
  ParsedScene parsed{.scene = std::nullopt, .faults = std::move(faults)};
  Scene scene = read_scene(Reader{document, "", parsed.faults});
  check_consistency(scene, parsed.faults);
  check_sweep_analyses(scene, parsed.faults);
  if (!scene.sweep.empty()) check_sweep(scene, document.at("sweep"), parsed.faults);
  if (parsed.faults.empty()) parsed.scene = std::move(scene);
  return parsed;
}

}  // namespace

ParsedScene checked_scene(const Json& document) {
  return checked(document, {});
}

ParsedScene parse_scene(std::string_view json_text) {
  std::vector<Fault> faults;
  const auto json = read_json(json_text, faults);
  if (!json) return {.scene = std::nullopt, .faults = std::move(faults)};
  return checked(*json, std::move(faults));
}

}  // namespace jostle::inline config
