#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "tests/test_files.hpp"

namespace jostle {

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The .json files of a folder and its folders, sorted.
inline std::vector<std::filesystem::path> json_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

inline const std::filesystem::path good_scenes = test_data("scenes/good");
inline const std::filesystem::path bad_scenes = test_data("scenes/bad");
inline const std::filesystem::path shipped_scenes = source_file("config/scenes");

/// One line a fault, "pointer: message".
inline std::string lines(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) text += fault.pointer + ": " + fault.message + "\n";
  return text;
}

/// The scene of a text that must be one.
inline Scene scene_of(const std::string& text) {
  const ParsedScene parsed = parse_scene(text);
  if (!parsed.scene) throw std::runtime_error(lines(parsed.faults));
  return *parsed.scene;
}

}  // namespace jostle
