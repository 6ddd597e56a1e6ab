#include "study/running/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <span>

#include "config/json/json_text.hpp"
#include "config/shipped_scenes.hpp"
#include "ensemble/statistics/counted.hpp"
#include "results/disk/error.hpp"
#include "results/disk/input_file.hpp"
#include "results/disk/printable.hpp"
#include "results/export/packing_file.hpp"

namespace jostle::inline study {
namespace {

namespace fs = std::filesystem;

/// The command for the shipped scene of this name, where the file does not exist.
std::string shipped_hint(const std::string& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) return "";
  const std::string wanted = fs::path(path).replace_extension().generic_string();
  const auto is_wanted = [&](const ShippedScene& scene) {
    const std::string name = fmt::format("/{}", scene.name);
    return fmt::format("/{}", wanted).ends_with(name) || name.ends_with(fmt::format("/{}", wanted));
  };
  const auto scene = std::ranges::find_if(shipped_scenes(), is_wanted);
  if (scene == shipped_scenes().end()) return "";
  return fmt::format(". jostle carries a scene of this name, \"{}\": jostle new can write it",
                     scene->name);
}

std::string read_text(const std::string& path) {
  try {
    return read_text_file(path, Pipes::allowed);
  } catch (const ResultsError& error) {
    throw BadInput(fmt::format("cannot read the scene: {}{}", error.what(), shipped_hint(path)));
  }
}

/// "periodic, 4 x 5", a height with a third number.
std::string named(const Container& container) {
  const Vec3 size = extent(container);
  const std::string height = size.z > 0 ? fmt::format(" x {}", size.z) : "";
  return fmt::format("{}, {} x {}{}", name_of(container), size.x, size.y, height);
}

/// For one kind and of the same widths, but for digits that another program did not write.
bool alike(const Container& a, const Container& b) {
  constexpr double rounding = 1e-6;
  const auto near = [](double x, double y) { return std::abs(x - y) <= rounding * y; };
  const Vec3 of_a = extent(a), of_b = extent(b);
  return a.index() == b.index() && near(of_a.x, of_b.x) && near(of_a.y, of_b.y) &&
         near(of_a.z, of_b.z);
}

/// Reads the packings that a scene starts from, and remembers where each was packed.
class PackingFiles {
 public:
  explicit PackingFiles(fs::path folder) : folder_(std::move(folder)) {}

  Packing load(const PackingFile& file) {
    const PackingSelector selector{.point = file.point,
                                   .realization = file.realization,
                                   .tap = file.frame ? file.frame : file.tap};
    const std::string path = folder_ / file.path;
    paths_.push_back(path);
    Packing packing = read_packing(path, selector);
    packed_[packing.centres.data()] = {path, packing.container};  // unchanged by moving the file
    return packing;
  }
  const std::vector<std::string>& paths() const { return paths_; }

  /// Throws StartError where a plan puts a packing into another container: it would overlap, or
  /// fall apart.
  void require_same_container(const Plan& plan) const {
    const auto* given = std::get_if<GivenPacking>(&plan.start);
    if (given == nullptr) return;
    const auto& [path, container] = packed_.at(given->centres->data());
    if (alike(container, plan.container)) return;
    throw StartError(
        fmt::format("{} holds a packing of another container ({}) than the scene's ({})", path,
                    named(container), named(plan.container)));
  }

 private:
  struct Packed {
    std::string path;
    Container container;
  };

  fs::path folder_;
  std::vector<std::string> paths_;
  std::map<const Vec3*, Packed> packed_;
};

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
  loaded.points = std::move(parsed.points);
  loaded.resolved = resolved(loaded.scene).dump(2);
  PackingFiles packings(fs::path(path).parent_path());
  try {
    loaded.plans = make_plans(loaded.scene, loaded.points,
                              [&](const PackingFile& file) { return packings.load(file); });
    for (const Plan& plan : loaded.plans) packings.require_same_container(plan);
  } catch (const StartError& error) {
    throw BadInput(fmt::format("{}: /start: {}", path, error.what()));
  } catch (const ResultsError& error) {
    throw BadInput(fmt::format("{}: /start/file: {}", path, error.what()));
  }
  loaded.files.insert(loaded.files.end(), packings.paths().begin(), packings.paths().end());
  return loaded;
}

}  // namespace

std::string fault_lines(const std::vector<Fault>& faults) {
  constexpr std::size_t most_lines = 50;
  std::string lines;
  for (const auto& [pointer, message] :
       std::span(faults).first(std::min(faults.size(), most_lines))) {
    lines += printable_name(pointer.empty() ? "(scene)" : pointer) + ": " +
             printable_name(message) + "\n";
  }
  if (faults.size() > most_lines) {
    lines += fmt::format("... and {} more\n", faults.size() - most_lines);
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

Study study_of(const LoadedScene& loaded) {
  return make_study(loaded.plans, loaded.text, loaded.resolved, loaded.scene.realizations);
}

}  // namespace jostle::inline study
