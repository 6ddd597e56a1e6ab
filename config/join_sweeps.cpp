#include <fmt/format.h>

#include <algorithm>
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

/// What two runs must share: the scene but for its name, its sweep, what the sweep replaces, and
/// the number of realizations, which merging judges.
Json shared_part(const Scene& scene) {
  Json shared = resolved(scene);
  for (const char* own : {"name", "description", "realizations", "sweep"}) shared.erase(own);
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
    if (const Json* other = b.find(key); other == nullptr || *other != value)
      keys.push_back("/" + key);
  }
  for (const auto& [key, value] : b.members()) {
    if (!a.contains(key)) keys.push_back("/" + key);
  }
  return joined(keys, ", ");
}

/// Adds the rows of `more` that `axis` does not have; columns are those of `axis`.
void add_rows(SweepAxis& axis, const SweepAxis& more) {
  const auto row = [](const SweepAxis& of, std::size_t i) {
    std::string text;
    for (const auto& [pointer, values] : of.columns) text += canonical_text(values[i]) + "\n";
    return text;
  };
  std::set<std::string> known;
  for (std::size_t i = 0; i < axis.size(); ++i) known.insert(row(axis, i));
  for (std::size_t i = 0; i < more.size(); ++i) {
    if (!known.insert(row(more, i)).second) continue;
    for (std::size_t c = 0; c < axis.columns.size(); ++c) {
      axis.columns[c].second.push_back(more.columns[c].second[i]);
    }
  }
}

}  // namespace

ParsedScene join_sweeps(const ParsedScene& first, const ParsedScene& other) {
  if (!first.scene) return first;
  if (!other.scene) return other;
  ParsedScene refused;
  const std::string differ = differences(shared_part(*first.scene), shared_part(*other.scene));
  if (first.scene->sweep.empty() || !sweep_the_same(first.scene->sweep, other.scene->sweep)) {
    refused.faults = {{"/sweep", "the same must be swept, in the same order"}};
  } else if (!differ.empty()) {
    refused.faults = {{"", "differs in " + differ + ": only the values of a sweep may"}};
  }
  if (!refused.faults.empty()) return refused;
  Scene joined = *first.scene;
  for (std::size_t i = 0; i < joined.sweep.size(); ++i) {
    add_rows(joined.sweep[i], other.scene->sweep[i]);
  }
  return checked_scene(resolved(joined));
}

}  // namespace jostle::inline config
