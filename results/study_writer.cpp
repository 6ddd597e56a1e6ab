#include "results/study_writer.hpp"

#include <algorithm>
#include <array>

#include "results/container_text.hpp"
#include "results/hdf5_write.hpp"
#include "results/layout.hpp"

namespace jostle {
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

template <class Get>
Texts texts_of(const StudyPoint& point, Get get) {
  Texts texts;
  for (const ObservableLabel& observable : point.observables) texts.push_back(get(observable));
  return texts;
}

void write_point(hid_t sweep, std::uint32_t number, const StudyPoint& point) {
  const Hdf5Handle group = create_group(sweep, point_name(number));
  const ContainerText container = container_text(point.container);
  write_attribute(group, "label", point.label);
  write_attribute(group, "id", point.id);
  write_attribute(group, "seed", point.seed);
  write_attribute(group, "container", container.kind);
  write_attribute<double>(group, "widths", container.widths);
  write_attribute(group, "n_spheres", point.n_spheres);
  write_attribute(group, "taps", point.taps);
  Texts pointers, values;
  for (const auto& [pointer, value] : point.sweep_values) {
    pointers.push_back(pointer);
    values.push_back(value);
  }
  write_texts(group, "pointers", {pointers.size()}, pointers);
  write_texts(group, "values", {values.size()}, values);
  const Shape n{point.observables.size()};
  write_texts(group, "observables", n, texts_of(point, [](auto& one) { return one.name; }));
  write_texts(group, "units", n, texts_of(point, [](auto& one) { return one.units; }));
  write_texts(group, "long_names", n, texts_of(point, [](auto& one) { return one.long_name; }));
  write_texts(group, "sources", n, texts_of(point, [](auto& one) { return one.source; }));
  write_numbers(group, "snapshot_taps", point.snapshots.taps);
  const std::array<std::uint8_t, 3> kept = {point.snapshots.positions, point.snapshots.coordination,
                                            point.snapshots.height_histogram};
  write_attribute<std::uint8_t>(group, "snapshots_keep", kept);
  write_attribute(group, "contact_cut", point.snapshots.contact_cut);
  write_attribute(group, "bin_width", point.snapshots.bin_width);
  if (!point.start_sum.empty()) write_attribute(group, "start_sha256", point.start_sum);
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
  const Hdf5Handle* const axes[] = {&points, &axis};
  attach_axes(value, axes);
}

}  // namespace

void write_root(hid_t file) {
  write_attribute(file, "jostle_format", layout_version);
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
  for (std::uint32_t p = 0; p < study.points.size(); ++p) write_point(sweep, p, study.points[p]);
}

void write_provenance(hid_t file, const FileContent& content, RunState state) {
  const Hdf5Handle group = create_group(file, "provenance");
  write_attribute(group, "run_id", content.run_id);
  constexpr const char* names[] = {"running", "interrupted", "complete"};
  write_attribute(group, "state", std::string(names[static_cast<int>(state)]));
  const std::array<std::uint32_t, 2> shard = {content.shard.index, content.shard.count};
  write_attribute<std::uint32_t>(group, "shard", shard);
  for (const auto& [name, field] : provenance_fields) {
    Texts texts;
    for (const Provenance& process : content.provenance) texts.push_back(process.*field);
    write_texts(group, name, {texts.size()}, texts);
  }
}

}  // namespace jostle
