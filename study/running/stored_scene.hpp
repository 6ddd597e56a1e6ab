#pragma once

#include <string>

#include "config/json/json.hpp"
#include "study/running/scene_file.hpp"

// The scene that a results file keeps.
namespace jostle::inline study {

/// As JSON, every default written out. Throws ResultsError where what is stored is none.
Json stored_scene(const ResultsFile& file);

/// What keeps the file from being resumed with a scene, as fault_lines() writes it; empty where
/// nothing does. Throws ResultsError likewise.
std::string scene_differences(const ResultsFile& file, const LoadedScene& loaded);

}  // namespace jostle::inline study
