#include "results/file/validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>

#include "results/disk/printable.hpp"
#include "results/hdf5/handle.hpp"

namespace jostle::inline results {
namespace {

// The limits of scenes, which docs/reference/scene.md gives, and beyond them what no scene comes
// to.
constexpr std::uint64_t most_total_taps = std::uint64_t{1} << 40;
constexpr std::size_t deepest_nesting = 64, longest_name = 200, longest_text = 10'000;
constexpr std::size_t longest_label = 1u << 24;  // longest label; values can be whole protocols

void require(bool sound, const std::string& requirement) {
  if (!sound) throw Hdf5Error(printable(requirement) + ": not written by jostle");
}

bool is_name(const std::string& name) {
  return !name.empty() && name.size() <= longest_name && name != "." &&
         name.find('/') == std::string::npos && name.find('\0') == std::string::npos;
}

void validate_labels(const StudyPoint& point, const std::string& name) {
  std::set<std::string> names(std::begin(names_beside_series), std::end(names_beside_series));
  for (const Column& label : point.columns()) {
    require(is_name(label.name) && names.insert(label.name).second,
            name + " has an observable \"" + label.name + "\"");
    require(std::max({label.units.size(), label.long_name.size(), label.source.size(),
                      label.if_any.size(), label.if_none.size()}) <= longest_text,
            name + " has a label of an observable that is too long");
    require(label.decimals >= 0 && label.decimals <= 17,
            name + " has a column of " + std::to_string(label.decimals) + " decimals");
  }
}

void validate_container(const Container& container, const std::string& name) {
  const Vec3 size = extent(container);
  const auto fault = width_fault(container);
  require(!fault, name + ": " + fault.value_or(""));
  require(std::max({size.x, size.y, size.z}) <= widest_container,
          fmt::format("{} has a container wider than {}", name, widest_container));
}

void validate_snapshots(const Snapshots& snapshots, std::uint64_t taps, const std::string& name) {
  const auto& kept = snapshots.taps;
  const bool ascending =
      std::ranges::adjacent_find(kept, std::ranges::greater_equal{}) == kept.end();
  require(ascending && (kept.empty() || kept.back() <= taps),
          name + " has snapshots at taps that do not ascend up to its last");
  require(snapshots.contact_cut > 0 && std::isfinite(snapshots.contact_cut) &&
              snapshots.bin_width > 0 && std::isfinite(snapshots.bin_width),
          name + " has a contact_cut or a bin_width that is no length");
}

bool ascends(std::span<const std::uint64_t> taps) {
  return std::ranges::adjacent_find(taps, std::ranges::greater_equal{}) == taps.end();
}

void validate_motion(const MotionSettings& motion, const StudyPoint& point,
                     const std::string& name) {
  require(
      ascends(motion.origins) && ascends(motion.lags) && !motion.origins.empty() &&
          motion.origins.back() <= point.taps && motion.origins.size() <= most_motion_taps &&
          motion.lags.size() <= most_motion_taps &&
          (motion.lags.empty() || (motion.lags.front() > 0 && motion.lags.back() <= point.taps)),
      name + " follows motion from taps or over lags that do not ascend up to its last");
  require(std::ranges::all_of(motion.overlap_lengths,
                              [](double a) { return a > 0 && std::isfinite(a); }) &&
              motion.overlap_lengths.size() <= most_overlap_lengths && motion.layers >= 1 &&
              motion.layers <= std::min(most_motion_layers, point.n_spheres),
          name + " follows motion within lengths or in layers that are none");
  require(motion.kinds == 0 || (point.mixture && motion.kinds == point.mixture->kinds.size()),
          name + " follows the motion of other kinds than it has");
  require(motion_bytes(motion, point.n_spheres) <= most_motion_bytes,
          name + " follows motion from more origins than jostle does");
}

void validate_point(const StudyPoint& point, const std::string& name) {
  require(point.n_spheres >= 1 && point.n_spheres <= most_spheres,
          fmt::format("{} has {} spheres", name, point.n_spheres));
  require(point.taps <= most_total_taps, fmt::format("{} has {} taps", name, point.taps));
  require(point.label.size() <= longest_label, name + " has a label that is too long");
  for (const auto& [pointer, value] : point.sweep_values) {
    require(nesting_of(value) <= deepest_nesting, name + " has a value nested too deep");
    require(nlohmann::json::accept(value),
            name + " has a value of " + pointer + " that is no JSON");
  }
  validate_container(point.container, name);
  validate_labels(point, name);
  validate_snapshots(point.snapshots, point.taps, name);
  if (point.motion) validate_motion(*point.motion, point, name);
}

}  // namespace

void validate(const Study& study, const FileProvenance& provenance) {
  require(!study.points.empty(), "the sweep has no points");
  require(study.realizations >= 1 && study.realizations <= most_realizations,
          fmt::format("{} realizations", study.realizations));
  const std::uint64_t in_all = std::uint64_t{study.realizations} * study.points.size();
  require(in_all <= most_realizations_in_all,
          fmt::format("{} realizations of all sweep points together", in_all));
  require(!provenance.processes.empty(), "no process has worked on the file");
  const Shard shard = provenance.shard;
  require(shard.index >= 1 && shard.index <= shard.count && shard.count <= most_realizations,
          fmt::format("shard {}/{}", shard.index, shard.count));
  require(nesting_of(study.resolved_scene) <= deepest_nesting,
          "the scene (/scene/resolved) is nested too deep");
  for (std::size_t p = 0; p < study.points.size(); ++p)
    validate_point(study.points[p], fmt::format("sweep point {}", p));
  for (const StudyPoint& point : study.points)
    require(
        !point.motion || motion_numbers(*point.motion, study.realizations) <= most_motion_numbers,
        "more numbers of motion than jostle writes");
}

namespace {

/// Up to the last tap of its realization, where an origin may be chosen later.
bool is_followed(const MotionState& motion, const MotionSettings& settings, std::uint64_t rows,
                 std::uint32_t n_spheres) {
  const auto are_there = [&](const std::vector<Vec3>& centres) {
    return centres.size() == n_spheres && std::ranges::all_of(centres, is_position);
  };
  const auto passed = static_cast<std::size_t>(std::ranges::lower_bound(settings.origins, rows) -
                                               settings.origins.begin());
  const std::size_t begun = motion.origins.size();
  const bool lacks_last = begun + 1 == passed && settings.origins[begun] + 1 == rows;
  if (!are_there(motion.unwrapped) || (begun != passed && !lacks_last)) return false;
  for (std::size_t i = 0; i < begun; ++i) {
    const MotionOrigin& origin = motion.origins[i];
    if (origin.tap != settings.origins[i] || !are_there(origin.centres) ||
        origin.values.size() !=
            lags_reached(settings, origin.tap, rows) * n_motion_values(settings))
      return false;
  }
  return true;
}

/// The diameters that its realization drew, where it draws any.
bool has_its_sizes(const RealizationState& state, const StudyPoint& point) {
  if (!point.mixture || !point.mixture->drawn()) return state.diameters.empty();
  return !sizes_fault(state.diameters, point.mixture->kind_of, point.mixture->kinds);
}

}  // namespace

void validate(const RealizationState& state, const StudyPoint& point) {
  require(state.rows <= point.taps + 1, "a restart state beyond the last tap");
  // Stopped while its start was made, a realization has nothing yet.
  const bool not_begun = state.rows == 0 && !state.relaxing;
  if (not_begun && state.centres.empty() && state.observable_windows.empty()) return;
  require(
      state.centres.size() == point.n_spheres && std::ranges::all_of(state.centres, is_position),
      "a restart state without its spheres");
  require(has_its_sizes(state, point), "a restart state without the sizes of its spheres");
  // Windows are taken from the bed at tap 0; until that is recorded there are none.
  const std::size_t n_windows = state.rows > 0 ? point.observables.size() : 0;
  require(state.observable_windows.size() == n_windows, "a restart state of other observables");
  require(std::ranges::all_of(state.observable_windows, is_window),
          "a restart state with a window that is none");
  const bool follows = point.motion && state.rows > 0;
  require(state.motion.has_value() == follows &&
              (!follows || is_followed(*state.motion, *point.motion, state.rows, point.n_spheres)),
          "a restart state of another motion");
}

std::size_t nesting_of(std::string_view json) {
  std::size_t depth = 0, deepest = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_text && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_text = !in_text;
    } else if (!in_text && (c == '[' || c == '{')) {
      deepest = std::max(deepest, ++depth);
    } else if (!in_text && (c == ']' || c == '}')) {
      depth -= std::min<std::size_t>(depth, 1);
    }
  }
  return deepest;
}

}  // namespace jostle::inline results
