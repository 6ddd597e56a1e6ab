#include "cli/scene_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "ensemble/counted.hpp"
#include "results/error.hpp"
#include "results/packing_file.hpp"

namespace jostle {
namespace {

namespace fs = std::filesystem;

std::string read_text(const std::string& path) {
  const auto refuse = [&](const char* why) {
    throw BadInput(fmt::format("{}: cannot read this scene: {}", path, why));
  };
  if (fs::is_directory(path)) refuse("it is a folder");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(std::strerror(errno));
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) refuse(std::strerror(errno));
  return text;
}

std::vector<Vec3> load_packing(const fs::path& folder, const PackingFile& file) {
  const PackingSelector selector{.point = file.point,
                                 .realization = file.realization,
                                 .tap = file.frame ? file.frame : file.tap};
  return read_packing(folder / file.path, selector).centres;
}

LoadedScene load_text(std::string text, const std::string& path) {
  LoadedScene loaded;
  loaded.text = std::move(text);
  loaded.files = {path};
  ParsedScene parsed = parse_scene(loaded.text);
  if (!parsed.scene) {
    throw BadInput(fmt::format("{}: {}, nothing was run\n{}", path,
                               counted(parsed.faults.size(), "fault"), fault_lines(parsed.faults)));
  }
  loaded.scene = std::move(*parsed.scene);
  loaded.resolved = resolved(loaded.scene).dump(2);
  const fs::path folder = fs::path(path).parent_path();
  try {
    loaded.plans = make_plans(loaded.scene, [&](const PackingFile& file) {
      loaded.files.push_back((folder / file.path).string());
      return load_packing(folder, file);
    });
  } catch (const StartError& error) {
    throw BadInput(fmt::format("{}: /start: {}", path, error.what()));
  } catch (const ResultsError& error) {
    throw BadInput(fmt::format("{}: /start/file: {}", path, error.what()));
  }
  return loaded;
}

}  // namespace

std::string fault_lines(const std::vector<Fault>& faults) {
  std::string lines;
  for (const auto& [pointer, message] : faults) {
    lines += fmt::format("{}: {}\n", pointer.empty() ? "(scene)" : pointer, message);
  }
  if (!lines.empty()) lines.pop_back();
  return lines;
}

LoadedScene load_scene(const std::string& path) {
  return load_text(read_text(path), path);
}

LoadedScene load_derived(const Scene& scene, const std::string& path) {
  return load_text(resolved(scene).dump(2), path);
}

nlohmann::ordered_json stored_scene(const ResultsFile& file) {
  auto scene = nlohmann::ordered_json::parse(file.study().resolved_scene, nullptr, false);
  if (!scene.is_object()) {
    throw ResultsError(file.path(),
                       "its scene (/scene/resolved) is not a JSON object: jostle did not write it "
                       "so; restore the file from a copy");
  }
  return scene;
}

Study study_of(const LoadedScene& loaded) {
  return make_study(loaded.plans, loaded.text, loaded.resolved, loaded.scene.realizations);
}

}  // namespace jostle
