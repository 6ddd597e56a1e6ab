#include <algorithm>
#include <array>
#include <charconv>
#include <span>

#include "results/file/study_writer.hpp"
#include "results/groups/layout.hpp"
#include "results/groups/mixtures.hpp"
#include "results/hdf5/read.hpp"

namespace jostle::inline results {
namespace {

/// Returns the layout.
std::uint32_t check_layout(hid_t file) {
  if (checked(H5Aexists(file, "jostle_format")) == 0)
    throw Hdf5Error("not written by jostle: the root has no attribute jostle_format");
  const auto version = read_number_attribute<std::uint32_t>(file, "jostle_format");
  if (version != layout_version && version != layout_of_mixtures)
    throw Hdf5Error(fmt::format("layout {}, but this jostle reads layouts {} and {}", version,
                                layout_version, layout_of_mixtures));
  return version;
}

Container read_container(hid_t group) {
  const auto widths = read_numbers_attribute<double>(group, "widths");
  const std::string kind = read_text_attribute(group, "container");
  if (widths.size() == 3)
    if (const auto container = container_of(kind, {widths[0], widths[1], widths[2]}))
      return *container;
  throw Hdf5Error("unknown container \"" + kind + "\"");
}

std::vector<Column> read_labels(hid_t group, const char* named, const std::string& prefix) {
  const auto names = read_texts(group, named), units = read_texts(group, prefix + "units");
  const auto long_names = read_texts(group, prefix + "long_names"),
             sources = read_texts(group, prefix + "sources");
  std::vector<Column> columns;
  for (std::size_t i = 0; i < names.size(); ++i)
    columns.push_back({names[i], units.at(i), long_names.at(i), sources.at(i)});
  return columns;
}

Shown shown_named(const std::string& name) {
  const auto found = std::ranges::find(shown_names, name);
  if (found == std::end(shown_names))
    throw Hdf5Error("unknown way to show a column: \"" + name + "\"");
  return static_cast<Shown>(found - std::begin(shown_names));
}

int decimals_from(const std::string& text) {
  int decimals = -1;
  std::from_chars(text.data(), text.data() + text.size(), decimals);
  return decimals;
}

std::vector<Column> read_diagnostics(hid_t group) {
  if (!exists(group, diagnostics_name)) return unnamed_diagnostics();
  const std::string prefix = diagnostics_prefix;
  std::vector<Column> columns = read_labels(group, diagnostics_name, prefix);
  const auto shown = read_texts(group, prefix + "shown"),
             decimals = read_texts(group, prefix + "decimals"),
             if_any = read_texts(group, prefix + "if_any"),
             if_none = read_texts(group, prefix + "if_none");
  for (std::size_t i = 0; i < columns.size(); ++i) {
    columns[i].shown = shown_named(shown.at(i));
    columns[i].decimals = decimals_from(decimals.at(i));
    columns[i].if_any = if_any.at(i);
    columns[i].if_none = if_none.at(i);
  }
  return columns;
}

Snapshots read_snapshot_settings(hid_t group) {
  const auto kept = read_numbers_attribute<std::uint8_t>(group, "snapshots_keep");
  if (kept.size() < n_kept_by_all || kept.size() > std::size(kept_fields))
    throw Hdf5Error("snapshots_keep is not as long as what snapshots may keep");
  Snapshots snapshots{.taps = read_numbers<std::uint64_t>(group, "snapshot_taps"),
                      .contact_cut = read_number_attribute<double>(group, "contact_cut"),
                      .bin_width = read_number_attribute<double>(group, "bin_width")};
  for (std::size_t k = 0; k < std::size(kept_fields); ++k)
    snapshots.*kept_fields[k] = k < kept.size() && kept[k] != 0;
  return snapshots;
}

std::optional<MotionSettings> read_motion_settings(hid_t group) {
  if (checked(H5Aexists(group, motion_origins)) == 0) return std::nullopt;
  const bool by_kind = checked(H5Aexists(group, motion_kinds)) != 0;
  return MotionSettings{
      .origins = read_numbers_attribute<std::uint64_t>(group, motion_origins),
      .lags = read_numbers_attribute<std::uint64_t>(group, motion_lags),
      .overlap_lengths = read_numbers_attribute<double>(group, motion_lengths),
      .layers = read_number_attribute<std::uint32_t>(group, motion_layers),
      .kinds = by_kind ? read_number_attribute<std::uint32_t>(group, motion_kinds) : 0};
}

/// /sweep/value, [n_points, n_pointers].
struct SweptValues {
  std::vector<std::string> pointers, values;
};

SweptValues read_swept_values(hid_t sweep, std::size_t n_points) {
  if (!exists(sweep, "pointer")) return {};
  SweptValues all{read_texts(sweep, "pointer"), {}};
  require_shape(sweep, "value", {n_points, all.pointers.size()});
  all.values = read_texts(sweep, "value");
  return all;
}

/// The pointers of an earlier point, with the values of this one.
std::vector<std::pair<std::string, std::string>> values_like(const StudyPoint& earlier,
                                                             const SweptValues& swept,
                                                             std::size_t number) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto& [pointer, unused] : earlier.sweep_values) {
    const auto found = std::ranges::find(swept.pointers, pointer);
    if (found == swept.pointers.end()) throw Hdf5Error("the sweep has no values of " + pointer);
    const auto column = static_cast<std::size_t>(found - swept.pointers.begin());
    values.emplace_back(pointer, swept.values.at(number * swept.pointers.size() + column));
  }
  return values;
}

/// Limit for all points together: a few bytes of a file can define a list for each point.
class KeptInAll {
 public:
  /// Throws Hdf5Error beyond what memory is for.
  void add(const StudyPoint& point) {
    observables_ += point.observables.size();
    diagnostics_ += point.diagnostics.size();
    values_ += point.sweep_values.size();
    taps_ += point.snapshots.taps.size();
    if (point.motion) moments_ += point.motion->origins.size() + point.motion->lags.size();
    if (observables_ > most_observables_in_all || diagnostics_ > most_observables_in_all ||
        values_ > most_swept_values_in_all || taps_ > most_snapshots_in_all ||
        moments_ > most_snapshots_in_all)
      throw Hdf5Error("the sweep points keep more columns or snapshots than jostle writes");
  }

 private:
  std::uint64_t observables_ = 0, diagnostics_ = 0, values_ = 0, taps_ = 0, moments_ = 0;
};

/// `earlier`: the points before this one.
StudyPoint read_point(hid_t sweep, std::span<const StudyPoint> earlier, const SweptValues& swept) {
  const auto number = static_cast<std::uint32_t>(earlier.size());
  const Hdf5Handle group = open_group(sweep, point_name(number));
  StudyPoint point;
  point.label = read_text_attribute(group, "label");
  point.id = read_number_attribute<std::uint64_t>(group, "id");
  point.seed = read_number_attribute<std::uint64_t>(group, "seed");
  point.container = read_container(group);
  point.n_spheres = read_number_attribute<std::uint32_t>(group, "n_spheres");
  point.taps = read_number_attribute<std::uint64_t>(group, "taps");
  if (checked(H5Aexists(group, keeps_what_point_keeps)) > 0) {
    const auto as = read_number_attribute<std::uint32_t>(group, keeps_what_point_keeps);
    if (as >= number) throw Hdf5Error("a sweep point keeps what a later one keeps");
    point.sweep_values = values_like(earlier[as], swept, number);
    point.observables = earlier[as].observables;
    point.diagnostics = earlier[as].diagnostics;
    point.unit = earlier[as].unit;
    point.snapshots = earlier[as].snapshots;
    point.motion = earlier[as].motion;
  } else {
    const auto pointers = read_texts(group, "pointers"), values = read_texts(group, "values");
    for (std::size_t i = 0; i < pointers.size(); ++i)
      point.sweep_values.emplace_back(pointers[i], values.at(i));
    point.observables = read_labels(group, "observables", "");
    point.diagnostics = read_diagnostics(group);
    if (checked(H5Aexists(group, diagnostics_unit)) > 0)
      point.unit = read_text_attribute(group, diagnostics_unit);
    point.snapshots = read_snapshot_settings(group);
    point.motion = read_motion_settings(group);
  }
  if (checked(H5Aexists(group, "start_sha256")) > 0)
    point.start_sum = read_text_attribute(group, "start_sha256");
  return point;
}

/// The layout number marks mixtures, so that no reader takes one for equal spheres.
void check_mixtures(hid_t file, std::uint32_t layout, const Study& study) {
  const bool mixtures = std::ranges::any_of(
      study.points, [](const StudyPoint& point) { return point.mixture != nullptr; });
  if (mixtures != (layout == layout_of_mixtures) || mixtures != exists(file, spheres_folder))
    throw Hdf5Error(fmt::format("layout {} {} the sizes of spheres: not written by jostle", layout,
                                mixtures || layout == layout_version ? "with" : "without"));
}

RunState state_named(const std::string& name) {
  for (const RunState state : {RunState::running, RunState::interrupted, RunState::complete})
    if (name == name_of(state)) return state;
  throw Hdf5Error("unknown state of the run: \"" + name + "\"");
}

}  // namespace

Study read_study(hid_t file) {
  const std::uint32_t layout = check_layout(file);
  Study study;
  const Hdf5Handle scene = open_group(file, "scene");
  study.scene = read_text(scene, "verbatim");
  study.resolved_scene = read_text(scene, "resolved");
  study.realizations = read_number_attribute<std::uint32_t>(scene, "realizations");
  const Hdf5Handle sweep = open_group(file, "sweep");
  const auto n_points = read_numbers<std::uint32_t>(sweep, "point").size();
  const SweptValues swept = read_swept_values(sweep, n_points);
  KeptInAll kept;
  for (std::size_t p = 0; p < n_points; ++p) {
    StudyPoint point = read_point(sweep, study.points, swept);
    if (layout == layout_of_mixtures)
      point.mixture = read_mixture(file, study.points, point.n_spheres);
    study.points.push_back(std::move(point));
    kept.add(study.points.back());
  }
  check_mixtures(file, layout, study);
  return study;
}

bool has_study(hid_t file, const Study& study) {
  check_layout(file);
  const Hdf5Handle scene = open_group(file, "scene");
  return read_text(scene, "resolved") == study.resolved_scene &&
         read_text(scene, "verbatim") == study.scene &&
         read_number_attribute<std::uint32_t>(scene, "realizations") == study.realizations &&
         std::ranges::all_of(study.points, &std::string::empty, &StudyPoint::start_sum);
}

FileProvenance read_provenance(hid_t file) {
  const Hdf5Handle group = open_group(file, "provenance");
  FileProvenance provenance;
  provenance.run_id = read_text_attribute(group, "run_id");
  provenance.state = state_named(read_text_attribute(group, "state"));
  const auto shard = read_numbers_attribute<std::uint32_t>(group, "shard");
  provenance.shard = {shard.at(0), shard.at(1)};
  for (const auto& [name, field] : provenance_fields) {
    const auto texts = read_texts(group, name);
    provenance.processes.resize(std::max(provenance.processes.size(), texts.size()));
    for (std::size_t i = 0; i < texts.size(); ++i) provenance.processes[i].*field = texts[i];
  }
  return provenance;
}

}  // namespace jostle::inline results
