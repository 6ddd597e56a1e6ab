#pragma once

#include <string>
#include <vector>

#include "config/scene.hpp"
#include "results/file/results_file.hpp"
#include "study/bad_input.hpp"

namespace jostle::inline study {

/// A scene file, read, with all that is needed to run it.
struct LoadedScene {
  Scene scene;
  std::vector<Scene> points;  // number of its sweep points
  std::string text;           // the file, word for word
  std::string resolved;       // with every default written out
  std::vector<Plan> plans;
  std::vector<std::string> files;  // its inputs: the scene, and packings from which it starts
};

/// Reads a scene and the packings it starts from. Throws BadInput listing every fault.
LoadedScene load_scene(const std::string& path);

/// A scene made of that in `path`: it starts from the same packings. Throws BadInput likewise.
LoadedScene load_derived(const Scene& scene, const std::string& path);

/// Contents of its future results file.
Study study_of(const LoadedScene& loaded);

/// "pointer: message", one fault a line.
std::string fault_lines(const std::vector<Fault>& faults);

}  // namespace jostle::inline study
