#include "results/export/h5md.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <string_view>

#include "engine/bed/boundary.hpp"
#include "results/disk/output_path.hpp"
#include "results/disk/temporary_file.hpp"
#include "results/file/study_writer.hpp"
#include "results/groups/particles.hpp"
#include "results/hdf5/writable_file.hpp"
#include "results/hdf5/write.hpp"

namespace jostle::inline results {
namespace {

using Frames = std::span<const ExportedFrame>;

static_assert(sizeof(Vec3) == 3 * sizeof(double));

/// step and time of the frames, which are written once and linked to from every other element.
class FrameTimes {
 public:
  FrameTimes(hid_t first_element, Frames frames) : first_(first_element) {
    std::vector<std::uint64_t> steps;
    for (const ExportedFrame& frame : frames) steps.push_back(frame.tap);
    write_numbers(first_, "step", steps);
    write_numbers(first_, "time", std::vector<double>(steps.begin(), steps.end()));
  }
  void link(hid_t element) const {
    for (const char* name : {"step", "time"})
      checked(H5Lcreate_hard(first_, name, element, name, H5P_DEFAULT, H5P_DEFAULT));
  }

 private:
  hid_t first_;
};

/// value [n_frames, rest ...], a frame at a time.
template <class Number>
void write_values(hid_t element, Frames frames, const Shape& rest,
                  const std::function<std::vector<Number>(const ExportedFrame&)>& value_of) {
  Shape shape{frames.size()}, chunk{1};
  shape.insert(shape.end(), rest.begin(), rest.end());
  chunk.insert(chunk.end(), rest.begin(), rest.end());
  RowsDataset<Number> value(element, "value", shape, chunk);
  for (std::size_t i = 0; i < frames.size(); ++i) value.write(i, value_of(frames[i]));
}

std::vector<double> centres(const ExportedFrame& frame) {
  return components_of(frame.packing.centres);
}

/// The edges of the box as the rows of a matrix; an open top ends at the highest point.
std::vector<double> edges(const ExportedFrame& frame) {
  const Boundary boundary(frame.packing.container);
  const double height = boundary.periodic_z ? boundary.height : surface_height(frame.packing);
  return {boundary.width_x, 0, 0, 0, boundary.width_y, 0, 0, 0, height};
}

void write_box(hid_t trajectory, Frames frames, const FrameTimes& times) {
  const Hdf5Handle box = create_group(trajectory, "box");
  write_boundary(box, frames.front().packing.container);
  const Hdf5Handle element = create_group(box, "edges");
  times.link(element);
  write_values<double>(element, frames, {3, 3}, edges);
}

/// Column number i of every frame.
void write_column(hid_t trajectory, Frames frames, std::size_t i, const FrameTimes& times) {
  const ParticleColumn& first = frames.front().columns[i];
  const Hdf5Handle element = create_group(trajectory, first.name);
  times.link(element);
  const auto write = [&]<class Number>(const std::vector<Number>& values) {
    write_values<Number>(element, frames, {values.size()}, [i](const ExportedFrame& frame) {
      return std::get<std::vector<Number>>(frame.columns[i].values);
    });
  };
  std::visit(write, first.values);
}

/// Vector number i of every frame.
void write_vectors(hid_t trajectory, Frames frames, std::size_t i, const FrameTimes& times) {
  const VectorColumn& first = frames.front().vectors[i];
  const Hdf5Handle element = create_group(trajectory, first.name);
  times.link(element);
  write_values<double>(element, frames, {first.values.size(), 3}, [i](const ExportedFrame& frame) {
    return components_of(frame.vectors.at(i).values);
  });
}

void write_trajectory(hid_t file, Frames frames) {
  const Hdf5Handle particles = create_group(file, "particles");
  const Hdf5Handle trajectory = create_group(particles, "trajectory");
  const Hdf5Handle position = create_group(trajectory, "position");
  const FrameTimes times(position, frames);
  write_values<double>(position, frames, {frames.front().packing.centres.size(), 3}, centres);
  write_box(trajectory, frames, times);
  for (std::size_t i = 0; i < frames.front().columns.size(); ++i)
    write_column(trajectory, frames, i, times);
  for (std::size_t i = 0; i < frames.front().vectors.size(); ++i)
    write_vectors(trajectory, frames, i, times);
}

bool have_equal_columns(const ExportedFrame& a, const ExportedFrame& b) {
  const auto is_alike = [](const ParticleColumn& lhs, const ParticleColumn& rhs) {
    return lhs.name == rhs.name && lhs.values.index() == rhs.values.index();
  };
  const auto name_of = [](const VectorColumn& vectors) { return std::string_view(vectors.name); };
  return std::ranges::equal(a.columns, b.columns, is_alike) &&
         std::ranges::equal(a.vectors, b.vectors, {}, name_of, name_of);
}

}  // namespace

void write_h5md(const std::string& path, Frames frames, ExistingFile existing) {
  const std::size_t n_spheres = frames.front().packing.centres.size();
  for (const ExportedFrame& frame : frames) {
    const std::size_t n = frame.packing.centres.size();
    if (n != n_spheres)
      throw std::invalid_argument(
          fmt::format("H5MD keeps frames of one number of spheres: frame {} has {}, the first {}; "
                      "export them one by one",
                      frame.tap, n, n_spheres));
    if (frame.packing.container.index() != frames.front().packing.container.index())
      throw std::invalid_argument(
          fmt::format("H5MD keeps frames of one kind of container: frame {} has another than the "
                      "first; export them one by one",
                      frame.tap));
    if (!have_equal_columns(frame, frames.front()))
      throw std::invalid_argument(
          fmt::format("H5MD keeps frames of the same columns: frame {} has others than the first; "
                      "export them one by one",
                      frame.tap));
  }
  TemporaryFile temporary(output_path(path), existing);
  naming_file(temporary.name(), [&] {
    WritableHdf5File file(temporary.name());
    write_h5md_root(file);
    write_trajectory(file, frames);
    file.close();
  });
  temporary.publish();
}

}  // namespace jostle::inline results
