#include "config/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "config/grids.hpp"
#include "config/json/suggestion.hpp"
#include "config/parts/parts.hpp"

namespace jostle::inline config {

namespace {

constexpr std::size_t most_points = 100'000;

/// Keys that a sweep may set: simulation and measurement. The other keys belong to the whole study.
const std::vector<std::string> swept_parts{"container", "spheres",  "pour_order", "start",
                                           "protocol",  "engine",   "relax",      "relax_start",
                                           "observe",   "snapshots"};

/// Every pointer that leads somewhere in a value.
void collect_pointers(const Json& value, const std::string& pointer,
                      std::vector<std::string>& target) {
  if (!pointer.empty()) target.push_back(pointer);
  if (value.is_object()) {
    for (const auto& [key, member] : value.members()) {
      collect_pointers(member, pointer_to(pointer, key), target);
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      collect_pointers(value.at(i), pointer_to(pointer, i), target);
    }
  }
}

bool leads_somewhere(const Json& scene, const std::string& pointer) {
  return scene.find_pointer(pointer) != nullptr;
}

/// Where the file lists the values of a swept pointer.
std::string location(const Json& written_sweep, const std::string& pointer) {
  if (written_sweep.contains(pointer)) return pointer_to("/sweep", pointer);
  const Json& zip = written_sweep.at("zip");
  if (zip.is_object()) return pointer_to("/sweep/zip", pointer);
  std::size_t group = 0;
  while (!zip.at(group).contains(pointer)) ++group;
  return pointer_to(pointer_to("/sweep/zip", group), pointer);
}

/// True if the point has grains and the scene has trials: `relax` does not apply to grains.
bool has_grains(const SweepPoint& point) {
  return std::ranges::any_of(point.values, [](const auto& set) {
    const auto& [pointer, value] = set;
    return pointer == "/engine" && (value.is_object() ? value.contains("discrete_element")
                                                      : value == Json("discrete_element"));
  });
}

/// The scene of one point, without a sweep: the values put into the resolved scene. Notes in
/// `faults` what makes it no scene; pointers are those of that scene.
Scene scene_at(const Json& resolved_scene, const SweepPoint& point, std::vector<Fault>& faults) {
  const bool leave_trials = has_grains(point);
  Json changed = Json::object();  // without the sweep, which may be longer than all the rest
  for (const auto& [key, part] : resolved_scene.members()) {
    const bool of_trials = key == "relax" || key == "relax_start";
    const bool of_sweep = key == "sweep" || key == "point_labels";
    if (!of_sweep && !(of_trials && leave_trials)) changed[key] = part;
  }
  for (const auto& [pointer, value] : point.values) {
    if (pointer == "/engine") {
      changed["engine"] = value;  // a resolved scene of Monte Carlo does not name it
    } else if (Json* place = changed.find_pointer(pointer)) {
      *place = value;
    } else if (!value.is_null()) {
      faults.push_back({pointer,
                        "applies only to Monte Carlo, and this point has discrete elements: sweep "
                        "it in a \"zip\" with \"/engine\", and give null here"});
    }
  }
  Scene scene = read_scene(Reader{changed, "", faults});
  check_consistency(scene, faults);
  return scene;
}

class SweepCheck {
 public:
  SweepCheck(const Scene& scene, const Json& written_sweep, std::vector<Fault>& faults)
      : scene_(scene),
        written_sweep_(written_sweep),
        faults_(faults),
        base_faults_(faults),
        resolved_(resolved(scene)) {
    may_be_swept_ = Json::object();
    for (const std::string& part : swept_parts) {
      if (resolved_.contains(part)) may_be_swept_[part] = resolved_.at(part);
    }
    if (!resolved_.contains("engine")) may_be_swept_["engine"] = "monte_carlo";
  }

  /// The scenes of the points, in their order; nothing where the sweep itself is at fault.
  std::vector<Scene> operator()() {
    for (const SweepAxis& axis : scene_.sweep) {
      for (const auto& [pointer, values] : axis.columns) check_pointer(pointer);
    }
    if (faults_.size() > base_faults_.size() || !points_are_few()) return {};
    const std::vector<SweepPoint> points = sweep_points(scene_.sweep);
    check_amounts(points.size());
    std::vector<Scene> scenes = read_points(points);
    points_differ(points);
    return scenes;
  }

 private:
  void check_pointer(const std::string& pointer) {
    const std::string place = location(written_sweep_, pointer);
    for (const std::string& pointer_seen : seen_) {
      if (is_within(pointer, pointer_seen) || is_within(pointer_seen, pointer)) {
        faults_.push_back(
            {place, fmt::format("sets what {} sets too: sweep one of them", pointer_seen)});
      }
    }
    seen_.push_back(pointer);
    // Where the scene itself is faulty, what is missing there may be no fault of the sweep.
    for (const Fault& fault : base_faults_) {
      if (is_within(pointer, fault.pointer) || is_within(fault.pointer, pointer)) return;
    }
    if (leads_somewhere(may_be_swept_, pointer)) return;
    if (leads_somewhere(resolved_, pointer)) {
      faults_.push_back(
          {place,
           fmt::format("{} belongs to the study as a whole and cannot be swept (a sweep sets "
                       "values in {})",
                       pointer, listed(swept_parts))});
      return;
    }
    std::vector<std::string> pointers;
    collect_pointers(may_be_swept_, "", pointers);
    faults_.push_back({place, fmt::format("{} leads to no value of the resolved scene.{}", pointer,
                                          did_you_mean(pointer, pointers))});
  }

  bool points_are_few() {
    std::size_t points = 1;
    for (const SweepAxis& axis : scene_.sweep) {
      points *= axis.size();
      if (points <= most_points) continue;
      faults_.push_back({"/sweep", fmt::format("more than {} points", most_points)});
      return false;
    }
    return true;
  }

  /// Checks the size of the lists that a results file has of all points.
  void check_amounts(std::uint64_t points) {
    const auto check = [&](const char* pointer, const char* subject, std::uint64_t n,
                           std::uint64_t most) {
      if (n * points <= most) return;
      faults_.push_back({pointer, fmt::format("{} {} at {} sweep points are more than {} in all", n,
                                              subject, points, most)});
    };
    const bool grows = !scene_.until.targets.empty();
    const std::uint64_t realizations =
        std::max<std::uint64_t>(scene_.realizations, grows ? scene_.until.at_most : 0);
    check("/realizations", "realizations", realizations, most_realizations_in_all);
    check("/observe", "observables", scene_.observables.size(), most_observables_in_all);
    std::size_t pointers = 0;
    for (const SweepAxis& axis : scene_.sweep) pointers += axis.columns.size();
    check("/sweep", "values", pointers, most_swept_values_in_all);
    const std::uint64_t taps = sound(faults_, "/protocol") ? total_taps(scene_.protocol) : 0;
    check("/snapshots/taps", "taps with snapshots", snapshot_taps(scene_.snapshots, taps).size(),
          most_snapshots_in_all);
    if (!scene_.motion || !sound(faults_, "/protocol")) return;
    const MotionSettings motion = motion_settings(*scene_.motion, total_taps(scene_.protocol));
    check("/motion", "origins and lags", motion.origins.size() + motion.lags.size(),
          most_snapshots_in_all);
  }

  std::vector<Scene> read_points(const std::vector<SweepPoint>& points) {
    struct Found {
      Fault fault;
      std::size_t n_points = 0;
      std::string first_label;
    };
    std::vector<Found> found;
    std::map<std::pair<std::string, std::string>, std::size_t> known;
    std::vector<Scene> scenes;
    scenes.reserve(points.size());
    for (const SweepPoint& point : points) {
      std::vector<Fault> faults;
      scenes.push_back(scene_at(resolved_, point, faults));
      for (Fault& fault : faults) {
        const bool of_value = move_to_sweep(fault, point);
        if (!of_value && !base_faults_.empty()) continue;
        const auto [entry, is_new] =
            known.try_emplace({fault.pointer, fault.message}, found.size());
        if (is_new) found.push_back({fault, 0, of_value ? "" : point_label(point)});
        ++found[entry->second].n_points;
      }
    }
    for (const auto& [fault, n_points, label] : found) {
      std::string place_text;
      if (!label.empty()) {
        place_text = n_points == 1
                         ? fmt::format(" (at the sweep point {})", label)
                         : fmt::format(" (at {} sweep points, first {})", n_points, label);
      }
      faults_.push_back({fault.pointer, fault.message + place_text});
    }
    return scenes;
  }

  /// Points a fault of a swept value to where the sweep lists it; false for any other fault.
  bool move_to_sweep(Fault& fault, const SweepPoint& point) const {
    std::size_t column = 0;
    for (std::size_t axis = 0; axis < scene_.sweep.size(); ++axis) {
      for (std::size_t i = 0; i < scene_.sweep[axis].columns.size(); ++i, ++column) {
        const std::string& pointer = point.values[column].first;
        if (!is_within(fault.pointer, pointer)) continue;
        fault.pointer = pointer_to(location(written_sweep_, pointer), point.indices[axis]) +
                        fault.pointer.substr(pointer.size());
        return true;
      }
    }
    return false;
  }

  void points_differ(const std::vector<SweepPoint>& points) {
    std::map<std::uint64_t, std::size_t> first;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [earlier, is_new] = first.emplace(point_id(points[i]), i);
      if (is_new) continue;
      faults_.push_back(
          {"/sweep", fmt::format("points {} and {} are the same, {}: list a value once",
                                 earlier->second, i, point_label(points[i]))});
    }
  }

  const Scene& scene_;
  const Json& written_sweep_;
  std::vector<Fault>& faults_;
  const std::vector<Fault> base_faults_;
  const Json resolved_;
  Json may_be_swept_;
  std::vector<std::string> seen_;
};

}  // namespace

std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis>& sweep) {
  std::vector<SweepPoint> points(1);
  for (const SweepAxis& axis : sweep) {
    std::vector<SweepPoint> crossed;
    crossed.reserve(points.size() * axis.size());
    for (const SweepPoint& point : points) {
      for (std::size_t i = 0; i < axis.size(); ++i) {
        SweepPoint next = point;
        for (const auto& [pointer, values] : axis.columns) {
          next.values.emplace_back(pointer, values[i]);
        }
        next.indices.push_back(i);
        crossed.push_back(std::move(next));
      }
    }
    points = std::move(crossed);
  }
  return points;
}

std::uint64_t point_id(const SweepPoint& point) {
  if (point.values.empty()) return 0;
  std::vector<std::string> pairs;
  for (const auto& [pointer, value] : point.values) {
    pairs.push_back(fmt::format("{}={}\n", pointer, canonical_text(value)));
  }
  std::sort(pairs.begin(), pairs.end());
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::string& pair : pairs) {
    for (const char c : pair) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return hash == 0 ? 1 : hash;
}

std::string short_name(const std::string& pointer) {
  const std::size_t last = pointer.rfind('/');
  const bool is_index = last + 1 < pointer.size() &&
                        pointer.find_first_not_of("0123456789", last + 1) == std::string::npos;
  if (!is_index || last == 0) return pointer.substr(last + 1);
  return pointer.substr(pointer.rfind('/', last - 1) + 1);
}

std::string point_label(const SweepPoint& point) {
  std::vector<std::string> parts;
  for (const auto& [pointer, value] : point.values) {
    const std::string name = short_name(pointer);
    const auto is_same =
        std::count_if(point.values.begin(), point.values.end(),
                      [&](const auto& entry) { return short_name(entry.first) == name; });
    parts.push_back(fmt::format("{} = {}", is_same > 1 ? pointer : name, canonical_text(value)));
  }
  return joined(parts, ", ");
}

std::vector<Scene> read_sweep_points(const Scene& scene, const Json& written_sweep,
                                     std::vector<Fault>& faults) {
  if (scene.sweep.empty()) return {scene};
  return SweepCheck{scene, written_sweep, faults}();
}

std::vector<Scene> point_scenes(const Scene& scene) {
  if (scene.sweep.empty()) return {scene};
  const Json base = resolved(scene);
  std::vector<Scene> scenes;
  std::vector<Fault> none;  // the scene was checked
  for (const SweepPoint& point : sweep_points(scene.sweep))
    scenes.push_back(scene_at(base, point, none));
  return scenes;
}

}  // namespace jostle::inline config
