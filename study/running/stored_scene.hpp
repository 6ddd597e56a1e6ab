#pragma once

#include <string>

#include "config/json/json.hpp"
#include "study/running/scene_file.hpp"

// The scene that a results file keeps.
namespace jostle::inline study {

/// The scene as JSON, with all defaults. Throws ResultsError if the stored text is no scene.
Json stored_scene(const ResultsFile& file);

/// Reasons against a resume of the file with a scene, in the form of fault_lines(); empty without.
/// Throws ResultsError, too.
std::string scene_differences(const ResultsFile& file, const LoadedScene& loaded);

}  // namespace jostle::inline study
