#include "results/file/study_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <optional>

#include "engine/number_reading.hpp"
#include "results/groups/layout.hpp"
#include "results/groups/mixtures.hpp"
#include "results/hdf5/write.hpp"

namespace jostle::inline results {
namespace {

using Texts = std::vector<std::string>;

/// The pointers that any point varies, in the order in which they are met.
Texts swept_pointers(const Study& study) {
  Texts pointers;
  for (const StudyPoint& point : study.points)
    for (const auto& [pointer, value] : point.sweep_values)
      if (std::find(pointers.begin(), pointers.end(), pointer) == pointers.end())
        pointers.push_back(pointer);
  return pointers;
}

std::string value_at(const StudyPoint& point, const std::string& pointer) {
  for (const auto& [name, value] : point.sweep_values)
    if (name == pointer) return value;
  return "";
}

using NamedTexts = std::vector<std::pair<std::string, Texts>>;

/// Texts of one length; the first are the axis of the others.
void write_texts_along(hid_t group, const NamedTexts& columns) {
  const auto write = [&](const auto& column) {
    return write_texts(group, column.first, {column.second.size()}, column.second);
  };
  const Hdf5Handle axis = write(columns.front());
  make_axis(axis, columns.front().first);
  const Hdf5Handle* const axes[] = {&axis};
  for (std::size_t i = 1; i < columns.size(); ++i) attach_axes(write(columns[i]), axes);
}

void write_columns(hid_t group, const StudyPoint& point) {
  const auto texts = [](const std::vector<Column>& columns, auto get) {
    Texts all;
    for (const Column& column : columns) all.push_back(get(column));
    return all;
  };
  const auto labels = [&](const std::vector<Column>& columns, const char* names,
                          const std::string& prefix) -> NamedTexts {
    return {
        {names, texts(columns, [](const Column& column) { return column.name; })},
        {prefix + "units", texts(columns, [](const Column& column) { return column.units; })},
        {prefix + "long_names",
         texts(columns, [](const Column& column) { return column.long_name; })},
        {prefix + "sources", texts(columns, [](const Column& column) { return column.source; })}};
  };
  write_texts_along(group, labels(point.observables, "observables", ""));
  if (point.diagnostics == unnamed_diagnostics()) return;
  NamedTexts own = labels(point.diagnostics, diagnostics_name, diagnostics_prefix);
  const auto add = [&](const char* name, auto get) {
    own.emplace_back(std::string(diagnostics_prefix) + name, texts(point.diagnostics, get));
  };
  add("shown", [](const Column& column) {
    return std::string(shown_names[static_cast<int>(column.shown)]);
  });
  add("decimals", [](const Column& column) { return fmt::to_string(column.decimals); });
  add("if_any", [](const Column& column) { return column.if_any; });
  add("if_none", [](const Column& column) { return column.if_none; });
  write_texts_along(group, own);
  write_attribute(group, diagnostics_unit, point.unit);
}

Texts pointers_of(const StudyPoint& point) {
  Texts pointers;
  for (const auto& [pointer, value] : point.sweep_values) pointers.push_back(pointer);
  return pointers;
}

bool keeps_the_same(const StudyPoint& a, const StudyPoint& b) {
  return a.observables == b.observables && a.diagnostics == b.diagnostics &&
         a.snapshots == b.snapshots && a.motion == b.motion && pointers_of(a) == pointers_of(b);
}

/// Kept data of a point.
void write_kept(hid_t group, const StudyPoint& point) {
  Texts values;
  for (const auto& [pointer, value] : point.sweep_values) values.push_back(value);
  write_texts_along(group, {{"pointers", pointers_of(point)}, {"values", values}});
  write_columns(group, point);
  make_axis(write_numbers(group, "snapshot_taps", point.snapshots.taps), "snapshot_taps");
  std::vector<std::uint8_t> kept;
  for (const auto field : kept_fields) kept.push_back(point.snapshots.*field);
  // Data of engines that move spheres in time exist only if a snapshot keeps them.
  while (kept.size() > n_kept_by_all && kept.back() == 0) kept.pop_back();
  write_attribute<std::uint8_t>(group, "snapshots_keep", kept);
  write_attribute(group, "contact_cut", point.snapshots.contact_cut);
  write_attribute(group, "bin_width", point.snapshots.bin_width);
  if (!point.motion) return;
  write_attribute<std::uint64_t>(group, motion_origins, point.motion->origins);
  write_attribute<std::uint64_t>(group, motion_lags, point.motion->lags);
  write_attribute<double>(group, motion_lengths, point.motion->overlap_lengths);
  write_attribute(group, motion_layers, point.motion->layers);
  if (point.motion->kinds > 0) write_attribute(group, motion_kinds, point.motion->kinds);
}

/// `as`: the number of an earlier point that keeps the same, or its own.
void write_point(hid_t sweep, std::uint32_t number, const StudyPoint& point, std::uint32_t as) {
  const Hdf5Handle group = create_group(sweep, point_name(number));
  const Vec3 size = extent(point.container);
  write_attribute(group, "label", point.label);
  write_attribute(group, "id", point.id);
  write_attribute(group, "seed", point.seed);
  write_attribute(group, "container", name_of(point.container));
  write_attribute<double>(group, "widths", std::array{size.x, size.y, size.z});
  write_attribute(group, "n_spheres", point.n_spheres);
  write_attribute(group, "taps", point.taps);
  if (as == number)
    write_kept(group, point);
  else
    write_attribute(group, keeps_what_point_keeps, as);
  if (!point.start_sum.empty()) write_attribute(group, "start_sha256", point.start_sum);
}

/// A pointer's values as numbers, [n_points]; nothing where one of them is none.
std::optional<std::vector<double>> numbers_at(const Study& study, const std::string& pointer) {
  std::vector<double> numbers;
  for (const StudyPoint& point : study.points) {
    const std::string text = value_at(point, pointer);
    const char* const end = text.data() + text.size();
    double number = 0;
    const auto read = read_decimal(text.data(), end, number);
    if (text.empty() || read.ec != std::errc() || read.ptr != end) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

/// Name of a pointer's values as a coordinate: its last token if this is unique in the table, else
/// all of it with underscores.
std::string coordinate_name(const std::string& pointer, const Texts& pointers) {
  const auto last_token = [](const std::string& path) { return path.substr(path.rfind('/') + 1); };
  const std::string name = last_token(pointer);
  const Texts taken = {"point", "label", "id", "pointer", "value"};
  const auto is_same = [&](const std::string& candidate) { return last_token(candidate) == name; };
  const bool is_index = name.find_first_not_of("0123456789") == std::string::npos;
  if (!is_index && std::ranges::count_if(pointers, is_same) == 1 &&
      std::ranges::find(taken, name) == taken.end())
    return name;
  std::string whole = pointer.substr(1);
  std::ranges::replace(whole, '/', '_');
  return whole;
}

/// Writes swept numbers, one dataset per pointer; returns their names.
std::string write_coordinates(hid_t sweep, const Study& study, const Texts& pointers,
                              const Hdf5Handle& points) {
  std::string names = "label";
  const Hdf5Handle* const along_points[] = {&points};
  for (const std::string& pointer : pointers) {
    const auto numbers = numbers_at(study, pointer);
    if (!numbers) continue;
    const std::string name = coordinate_name(pointer, pointers);
    const Hdf5Handle dataset = write_numbers(sweep, name, *numbers);
    write_attribute(dataset, "long_name", "value of " + pointer);
    attach_axes(dataset, along_points);
    names += " " + name;
  }
  return names;
}

/// The sweep as a table for people and programs: label, id and values of every point.
void write_table(hid_t sweep, const Study& study) {
  const Texts pointers = swept_pointers(study);
  Texts labels, values;
  std::vector<std::uint64_t> ids;
  std::vector<std::uint32_t> numbers;
  for (const StudyPoint& point : study.points) {
    numbers.push_back(static_cast<std::uint32_t>(numbers.size()));
    labels.push_back(point.label);
    ids.push_back(point.id);
    for (const std::string& pointer : pointers) values.push_back(value_at(point, pointer));
  }
  const Hdf5Handle points = write_numbers(sweep, "point", numbers);
  make_axis(points, "point");
  const Hdf5Handle* const along_points[] = {&points};
  const Hdf5Handle label = write_texts(sweep, "label", {labels.size()}, labels);
  write_attribute(label, "long_name", std::string("values that the point gives to what is swept"));
  attach_axes(label, along_points);
  const Hdf5Handle id = write_numbers(sweep, "id", ids);
  write_attribute(id, "long_name",
                  std::string("hash of the values, part of the random streams' keys"));
  attach_axes(id, along_points);
  if (pointers.empty()) return;
  const Hdf5Handle axis = write_texts(sweep, "pointer", {pointers.size()}, pointers);
  make_axis(axis, "pointer");
  const Hdf5Handle value = write_texts(sweep, "value", {labels.size(), pointers.size()}, values);
  write_attribute(value, "long_name", std::string("JSON value at the pointer"));
  write_attribute(value, "coordinates", write_coordinates(sweep, study, pointers, points));
  const Hdf5Handle* const axes[] = {&points, &axis};
  attach_axes(value, axes);
}

}  // namespace

void write_root(hid_t file, const Study& study) {
  const bool mixture = std::ranges::any_of(
      study.points, [](const StudyPoint& point) { return point.mixture != nullptr; });
  write_attribute(file, "jostle_format", mixture ? layout_of_mixtures : layout_version);
  write_h5md_root(file);
}

void write_h5md_root(hid_t file) {
  const Hdf5Handle h5md = create_group(file, "h5md");
  const std::array<std::uint32_t, 2> version = {1, 1};
  write_attribute<std::uint32_t>(h5md, "version", version);
  const Hdf5Handle author = create_group(h5md, "author");
  write_attribute(author, "name", std::string("not stated"));
  const Hdf5Handle creator = create_group(h5md, "creator");
  write_attribute(creator, "name", std::string("jostle"));
  write_attribute(creator, "version", std::string(JOSTLE_VERSION));
}

void write_study(hid_t file, const Study& study) {
  const Hdf5Handle scene = create_group(file, "scene");
  write_attribute(scene, "realizations", study.realizations);
  write_texts(scene, "verbatim", {}, {&study.scene, 1});
  write_texts(scene, "resolved", {}, {&study.resolved_scene, 1});
  const Hdf5Handle sweep = create_group(file, "sweep");
  write_table(sweep, study);
  std::uint32_t as = 0;
  for (std::uint32_t p = 0; p < study.points.size(); ++p) {
    if (!keeps_the_same(study.points[as], study.points[p])) as = p;
    write_point(sweep, p, study.points[p], as);
  }
  write_mixtures(file, study);
}

void write_provenance(hid_t file, const FileContent& content, RunState state) {
  const Hdf5Handle group = create_group(file, "provenance");
  write_attribute(group, "run_id", content.run_id);
  write_attribute(group, "state", std::string(name_of(state)));
  const std::array<std::uint32_t, 2> shard = {content.shard.index, content.shard.count};
  write_attribute<std::uint32_t>(group, "shard", shard);
  std::vector<std::uint32_t> numbers(content.provenance.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  const Hdf5Handle processes = write_numbers(group, "process", numbers);
  make_axis(processes, "process");
  const Hdf5Handle* const axes[] = {&processes};
  for (const auto& [name, field] : provenance_fields) {
    Texts texts;
    for (const Provenance& process : content.provenance) texts.push_back(process.*field);
    attach_axes(write_texts(group, name, {texts.size()}, texts), axes);
  }
}

}  // namespace jostle::inline results
