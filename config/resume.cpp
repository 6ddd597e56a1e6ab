#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "config/grids.hpp"
#include "config/parts/parts.hpp"
#include "config/sweep.hpp"
#include "ensemble/statistics/counted.hpp"

namespace jostle::inline config {

namespace {

/// One fault for every value that differs, at the deepest pointer that both have.
void compare(const Json& was, const Json& is, const std::string& pointer,
             std::vector<Fault>& faults) {
  if (was == is) return;
  if (!was.is_structured() || was.is_array() != is.is_array() ||
      was.is_object() != is.is_object() || (was.is_array() && was.size() != is.size())) {
    faults.push_back(
        {pointer, fmt::format("was {}, is {}: a resumed run keeps it", was.dump(), is.dump())});
    return;
  }
  if (was.is_array()) {
    for (std::size_t i = 0; i < was.size(); ++i) {
      compare(was.at(i), is.at(i), pointer_to(pointer, i), faults);
    }
    return;
  }
  for (const auto& [key, value] : was.members()) {
    const Json* now = is.find(key);
    compare(value, now ? *now : Json(), pointer_to(pointer, key), faults);
  }
  for (const auto& [key, value] : is.members()) {
    if (!was.contains(key)) compare(Json(), value, pointer_to(pointer, key), faults);
  }
}

/// Taps as runs of equal ones, so that only what is done counts and not how it was written.
std::vector<Stage> merged(const std::vector<Stage>& stages) {
  std::vector<Stage> runs;
  for (const Stage& stage : stages) {
    if (!runs.empty() && runs.back().tap == stage.tap) {
      runs.back().count += stage.count;
    } else {
      runs.push_back(stage);
    }
  }
  return runs;
}

/// The tap of a number from 1 on, as scenes write it.
std::string tap_text(const std::vector<ProtocolLine>& protocol, std::uint64_t number) {
  std::uint64_t end = 0;
  for (const Stage& stage : stages(protocol)) {
    end += stage.count;
    if (number <= end)
      return written_part(ProtocolLine{stage.tap, std::nullopt, 1}).at("tap").dump();
  }
  return "none";
}

/// The change that keeps `is` from beginning with all taps of `was`; empty if it begins with them.
std::optional<std::string> changed_taps(const std::vector<ProtocolLine>& was,
                                        const std::vector<ProtocolLine>& is) {
  const std::uint64_t n_was = total_taps(was), n_is = total_taps(is);
  if (n_is < n_was) {
    return fmt::format("had {}, has {}: taps can be added at the end, not removed",
                       counted(n_was, "tap"), n_is);
  }
  const std::vector<Stage> stages_before = merged(stages(was)), stages_after = merged(stages(is));
  std::uint64_t tap = 1;
  for (std::size_t i = 0; i < stages_before.size(); ++i) {
    const bool last = i + 1 == stages_before.size();
    const bool same_tap = i < stages_after.size() && stages_before[i].tap == stages_after[i].tap;
    const bool long_enough = same_tap && (last ? stages_after[i].count >= stages_before[i].count
                                               : stages_after[i].count == stages_before[i].count);
    if (!long_enough) {
      const std::uint64_t shared =
          same_tap ? std::min(stages_before[i].count, stages_after[i].count) : 0;
      const std::uint64_t changed = tap + shared;
      return fmt::format(
          "tap {} changed from {} to {}: taps can only be added after the last one, {}", changed,
          tap_text(was, changed), tap_text(is, changed), n_was);
    }
    tap += stages_before[i].count;
  }
  return std::nullopt;
}

/// Taps may be chosen from `first` on, in words `from_first`. `key`: "snapshot of tap".
std::optional<std::string> changed_choice(const char* key, std::uint64_t first,
                                          const std::string& from_first,
                                          const std::vector<std::uint64_t>& taps_before,
                                          const std::vector<std::uint64_t>& taps_after) {
  for (const std::uint64_t tap : taps_before) {
    if (!std::binary_search(taps_after.begin(), taps_after.end(), tap)) {
      return fmt::format("the {} {} was removed", key, tap);
    }
  }
  for (const std::uint64_t tap : taps_after) {
    if (tap >= first) break;
    if (!std::binary_search(taps_before.begin(), taps_before.end(), tap)) {
      return fmt::format("a {} {} was added: only those {} can be", key, tap, from_first);
    }
  }
  return std::nullopt;
}

std::string after_the_last(std::uint64_t last) {
  return fmt::format("after the last tap, {},", last);
}

std::optional<std::string> changed_snapshots(const Scene& was, const Scene& is) {
  const std::uint64_t last = total_taps(was.protocol);
  return changed_choice("snapshot of tap", last + 1, after_the_last(last),
                        snapshot_taps(was.snapshots, last),
                        snapshot_taps(is.snapshots, total_taps(is.protocol)));
}

/// Where both follow the motion.
std::optional<std::string> changed_motion(const Scene& was, const Scene& is) {
  if (!was.motion || !is.motion) return std::nullopt;
  const std::uint64_t last = total_taps(was.protocol);
  const MotionSettings settings_before = motion_settings(*was.motion, last),
                       settings_after = motion_settings(*is.motion, total_taps(is.protocol));
  // The state after the last tap is kept: a resumed run begins an origin there.
  auto changed =
      changed_choice("motion origin at tap", last, fmt::format("from the last tap, {}, on", last),
                     settings_before.origins, settings_after.origins);
  return changed ? changed
                 : changed_choice("motion lag of", last + 1, after_the_last(last),
                                  settings_before.lags, settings_after.lags);
}

/// Values may be added to a sweep: notes the points that are gone.
void compare_sweeps(const Scene& was, const Scene& is, std::vector<Fault>& faults) {
  std::vector<std::uint64_t> ids;
  for (const SweepPoint& point : sweep_points(is.sweep)) ids.push_back(point_id(point));
  std::ranges::sort(ids);
  for (const SweepPoint& point : sweep_points(was.sweep)) {
    if (std::ranges::binary_search(ids, point_id(point))) continue;
    const std::string gone = point.values.empty() ? "the run has no sweep"
                                                  : "the point " + point_label(point) + " is gone";
    faults.push_back({"/sweep", gone + ": values can be added to a sweep, not removed, "
                                       "and its keys cannot change"});
    return;
  }
}

/// Compares taps, snapshots and motion of every sweep point, and notes the first that changed.
void compare_points(const ParsedScene& was, const Scene& is, const std::vector<Scene>& points,
                    std::vector<Fault>& faults) {
  std::map<std::uint64_t, const Scene*> found;
  auto scene = points.begin();
  for (const SweepPoint& point : sweep_points(is.sweep)) found[point_id(point)] = &*scene++;
  bool same_taps = true, same_snapshots = true, same_motion = true;
  scene = was.points.begin();
  for (const SweepPoint& point : sweep_points(was.scene->sweep)) {
    const Scene &old_scene = *scene++, &new_scene = *found.at(point_id(point));
    const std::string place_text =
        point.values.empty() ? "" : fmt::format(" (at the sweep point {})", point_label(point));
    const auto taps = changed_taps(old_scene.protocol, new_scene.protocol);
    const auto snapshots = changed_snapshots(old_scene, new_scene);
    if (taps && same_taps) faults.push_back({"/protocol", *taps + place_text});
    if (snapshots && same_snapshots) faults.push_back({"/snapshots/taps", *snapshots + place_text});
    const auto motion = changed_motion(old_scene, new_scene);
    if (motion && same_motion && !taps) faults.push_back({"/motion", *motion + place_text});
    same_motion = same_motion && !motion;
    same_taps = same_taps && !taps;
    same_snapshots = same_snapshots && !snapshots;
    if (!same_taps && !same_snapshots && !same_motion) return;
  }
}

}  // namespace

std::vector<Fault> resume_faults(const ParsedScene& was, const Scene& scene,
                                 const std::vector<Scene>& points) {
  if (!was.scene) {
    return {{"", "the scene of the stored run is no scene for this version of the program: " +
                     was.faults.front().pointer + ": " + was.faults.front().message}};
  }
  std::vector<Fault> faults;
  if (scene.realizations < was.scene->realizations) {
    faults.push_back(
        {"/realizations", fmt::format("were {}, are {}: realizations can be added, not removed",
                                      was.scene->realizations, scene.realizations)});
  }
  Json scene_before = resolved(*was.scene), scene_after = resolved(scene);
  for (Json* scene_json : {&scene_before, &scene_after}) {
    for (const char* free : {"name", "description", "realizations", "protocol", "sweep",
                             "point_labels", "until", "fits", "analyse", "structure"}) {
      scene_json->erase(free);
    }
    (*scene_json)["snapshots"].erase("taps");
    (*scene_json)["snapshots"].erase("every");
    if (!scene_json->contains("motion")) continue;
    for (const char* grid : {"origins", "lags"}) (*scene_json)["motion"].erase(grid);
  }
  compare(scene_before, scene_after, "", faults);
  const std::size_t before_sweeps = faults.size();
  compare_sweeps(*was.scene, scene, faults);
  if (faults.size() == before_sweeps) compare_points(was, scene, points, faults);
  return faults;
}

}  // namespace jostle::inline config
