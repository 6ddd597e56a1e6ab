#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "config/json/json.hpp"
#include "config/scene.hpp"
#include "results/results_file.hpp"

namespace jostle {

/// A scene or a command line that cannot be run; what() says what, why and what to do. Exit code 2.
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A scene file, read, with all that is needed to run it.
struct LoadedScene {
  Scene scene;
  std::string text;      // the file, word for word
  std::string resolved;  // with every default written out
  std::vector<Plan> plans;
  std::vector<std::string> files;  // what it was read from: the scene, packings it starts from
};

/// Reads a scene and the packings it starts from. Throws BadInput listing every fault.
LoadedScene load_scene(const std::string& path);

/// A scene made of that in `path`: it starts from the same packings. Throws BadInput likewise.
LoadedScene load_derived(const Scene& scene, const std::string& path);

/// The scene that a results file was made from, every default written out. Throws ResultsError
/// where what is stored is none.
Json stored_scene(const ResultsFile& file);

Study study_of(const LoadedScene& loaded);

/// "pointer: message", one fault a line.
std::string fault_lines(const std::vector<Fault>& faults);

}  // namespace jostle
