#include "results/particles.hpp"

#include <algorithm>
#include <array>

#include "results/axes.hpp"
#include "results/container_text.hpp"
#include "results/hdf5_read.hpp"
#include "results/hdf5_write.hpp"

namespace jostle {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double));

double highest_top(std::span<const SnapshotRecord* const> frames) {
  double top = 0;
  for (const SnapshotRecord* frame : frames)
    for (const Vec3 centre : frame->centres) top = std::max(top, centre.z + sphere_radius);
  return top;
}

/// H5MD's box. An open top ends at the highest point any frame reaches.
void write_box(hid_t group, const Container& container,
               std::span<const SnapshotRecord* const> frames) {
  const auto [kind, widths] = container_text(container);
  const bool sides = kind == "periodic" || kind == "fully_periodic";
  const std::string side = sides ? "periodic" : "none";
  const std::string top = kind == "fully_periodic" ? "periodic" : "none";
  const Hdf5Handle box = create_group(group, "box");
  write_attribute(box, "dimension", std::uint32_t{3});
  const std::array<std::string, 3> boundary = {side, side, top};
  write_attribute(box, "boundary", boundary);
  const std::vector<double> edges = {widths[0], widths[1],
                                     widths[2] > 0 ? widths[2] : highest_top(frames)};
  const Hdf5Handle dataset = write_numbers(box, "edges", edges);
  write_label(dataset, {"edges", "diameter", "", ""});
  const Hdf5Handle directions = write_bare_axis(box, "direction", 3);
  const Hdf5Handle* const axes[] = {&directions};
  attach_axes(dataset, axes);
}

}  // namespace

void write_particles(hid_t file, const std::string& name, const Container& container,
                     std::span<const SnapshotRecord* const> frames) {
  const Hdf5Handle group = create_group(file, "particles/" + name);
  write_box(group, container, frames);
  const Hdf5Handle position = create_group(group, "position");
  const std::size_t n_spheres = frames.front()->centres.size();
  std::vector<std::uint64_t> taps;
  std::vector<double> values;
  for (const SnapshotRecord* frame : frames) {
    taps.push_back(frame->tap);
    for (const Vec3 centre : frame->centres)
      values.insert(values.end(), {centre.x, centre.y, centre.z});
  }
  const Hdf5Handle step = write_numbers(position, "step", taps);
  write_label(step, {"step", "1", "number of taps; 0 is the start", ""});
  make_axis(step, "step");
  const Hdf5Handle spheres = write_bare_axis(position, "sphere", n_spheres);
  const Hdf5Handle directions = write_bare_axis(position, "direction", 3);
  const Hdf5Handle value = write_numbers<double>(position, "value", {taps.size(), n_spheres, 3},
                                                 values, {1, n_spheres, 3});
  write_label(value, {"value", "diameter", "centres of the spheres along x, y, z (z is up)", ""});
  const Hdf5Handle* const axes[] = {&step, &spheres, &directions};
  attach_axes(value, axes);
}

std::vector<SnapshotRecord> read_particles(hid_t file, const std::string& name,
                                           std::uint32_t n_spheres) {
  if (!exists(file, "particles/" + name)) return {};
  const Hdf5Handle position = open_group(file, "particles/" + name + "/position");
  const auto taps = read_numbers<std::uint64_t>(position, "step");
  const Shape shape{taps.size(), n_spheres, 3};
  const auto values = read_numbers<double>(position, "value", &shape);
  std::vector<SnapshotRecord> frames(taps.size());
  for (std::size_t f = 0; f < taps.size(); ++f) {
    frames[f].tap = taps[f];
    for (std::size_t i = 0; i < n_spheres; ++i) {
      const double* xyz = &values[3 * (f * n_spheres + i)];
      frames[f].centres.push_back({xyz[0], xyz[1], xyz[2]});
    }
  }
  return frames;
}

}  // namespace jostle
