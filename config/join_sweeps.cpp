#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "config/parts/parts.hpp"
#include "config/sweep.hpp"

namespace jostle::inline config {

namespace {

std::vector<std::string> pointers_of(const SweepAxis& axis) {
  std::vector<std::string> pointers;
  for (const auto& [pointer, values] : axis.columns) pointers.push_back(pointer);
  return pointers;
}

bool sweep_the_same(const std::vector<SweepAxis>& a, const std::vector<SweepAxis>& b) {
  return std::ranges::equal(a, b, {}, pointers_of, pointers_of);
}

/// The part that two runs must share: the scene without its name, its sweep, the values that the
/// sweep replaces, and the number of realizations, which merging checks.
Json shared_part(const Scene& scene) {
  Json shared = resolved(scene);
  for (const char* own : {"name", "description", "realizations", "sweep", "point_labels"})
    shared.erase(own);
  for (const SweepAxis& axis : scene.sweep) {
    for (const std::string& pointer : pointers_of(axis)) {
      if (Json* place = shared.find_pointer(pointer)) *place = nullptr;
    }
  }
  return shared;
}

/// The top-level keys in which they differ.
std::string differences(const Json& a, const Json& b) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : a.members()) {
    if (const Json* counterpart = b.find(key); counterpart == nullptr || *counterpart != value)
      keys.push_back("/" + key);
  }
  for (const auto& [key, value] : b.members()) {
    if (!a.contains(key)) keys.push_back("/" + key);
  }
  return joined(keys, ", ");
}

/// Adds the rows of `added` that `axis` does not have; columns are those of `axis`.
void add_rows(SweepAxis& axis, const SweepAxis& added) {
  const auto row = [](const SweepAxis& axis_of_row, std::size_t i) {
    std::string text;
    for (const auto& [pointer, values] : axis_of_row.columns)
      text += canonical_text(values[i]) + "\n";
    return text;
  };
  std::set<std::string> known;
  for (std::size_t i = 0; i < axis.size(); ++i) known.insert(row(axis, i));
  for (std::size_t i = 0; i < added.size(); ++i) {
    if (!known.insert(row(added, i)).second) continue;
    for (std::size_t c = 0; c < axis.columns.size(); ++c) {
      axis.columns[c].second.push_back(added.columns[c].second[i]);
    }
  }
}

/// The labels that both scenes give to the points of the joined one, the first scene's before the
/// other's; none where a point has no label, or two points have the same.
std::vector<std::string> joined_labels(const Scene& first, const Scene& second,
                                       const Scene& joined) {
  std::map<std::uint64_t, std::string> known;
  for (const Scene* const scene : {&first, &second}) {
    const std::vector<SweepPoint> points = sweep_points(scene->sweep);
    for (std::size_t i = 0; i < scene->point_labels.size(); ++i)
      known.try_emplace(point_id(points[i]), scene->point_labels[i]);
  }
  std::vector<std::string> labels;
  if (known.empty()) return labels;
  for (const SweepPoint& point : sweep_points(joined.sweep)) {
    const auto label = known.find(point_id(point));
    if (label == known.end()) return {};
    labels.push_back(label->second);
  }
  const std::set<std::string> distinct(labels.begin(), labels.end());
  return distinct.size() == labels.size() ? labels : std::vector<std::string>{};
}

}  // namespace

ParsedScene join_sweeps(const ParsedScene& first, const ParsedScene& second) {
  if (!first.scene) return first;
  if (!second.scene) return second;
  ParsedScene refused;
  const std::string differ = differences(shared_part(*first.scene), shared_part(*second.scene));
  if (first.scene->sweep.empty() || !sweep_the_same(first.scene->sweep, second.scene->sweep)) {
    refused.faults = {{"/sweep", "the same must be swept, in the same order"}};
  } else if (!differ.empty()) {
    refused.faults = {{"", "differs in " + differ + ": only the values of a sweep may"}};
  }
  if (!refused.faults.empty()) return refused;
  Scene joined = *first.scene;
  for (std::size_t i = 0; i < joined.sweep.size(); ++i) {
    add_rows(joined.sweep[i], second.scene->sweep[i]);
  }
  joined.point_labels = joined_labels(*first.scene, *second.scene, joined);
  return checked_scene(resolved(joined));
}

}  // namespace jostle::inline config
