#include "results/file/particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/bed/boundary.hpp"
#include "results/file/axes.hpp"
#include "results/file/validate.hpp"
#include "results/hdf5/read.hpp"
#include "results/hdf5/write.hpp"

namespace jostle::inline results {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double));

/// H5MD's box. An open top ends at the highest point any frame reaches.
void write_box(hid_t group, const Container& container, double highest) {
  const Boundary boundary(container);
  const auto word = [](bool periodic) { return std::string(periodic ? "periodic" : "none"); };
  const Hdf5Handle box = create_group(group, "box");
  write_attribute(box, "dimension", std::uint32_t{3});
  const std::array<std::string, 3> words = {word(boundary.periodic_x), word(boundary.periodic_y),
                                            word(boundary.periodic_z)};
  write_attribute(box, "boundary", words);
  const std::vector<double> edges = {boundary.width_x, boundary.width_y,
                                     boundary.periodic_z ? boundary.height : highest};
  const Hdf5Handle dataset = write_numbers(box, "edges", edges);
  write_label(dataset, {"edges", "diameter", "", ""});
  const Hdf5Handle directions = write_bare_axis(box, "direction", 3);
  const Hdf5Handle* const axes[] = {&directions};
  attach_axes(dataset, axes);
}

}  // namespace

void write_particles(hid_t file, const std::string& name, const Container& container,
                     std::uint32_t n_spheres, const std::vector<std::uint64_t>& taps,
                     const std::function<std::vector<Vec3>(std::uint64_t tap)>& centres_at) {
  const Hdf5Handle group = create_group(file, "particles/" + name);
  const Hdf5Handle position = create_group(group, "position");
  const Hdf5Handle step = write_numbers(position, "step", taps);
  write_label(step, {"step", "1", "number of taps; 0 is the start", ""});
  make_axis(step, "step");
  const Hdf5Handle spheres = write_bare_axis(position, "sphere", n_spheres);
  const Hdf5Handle directions = write_bare_axis(position, "direction", 3);
  RowsDataset<double> value(position, "value", {taps.size(), n_spheres, 3}, {1, n_spheres, 3});
  double highest = 0;
  for (std::size_t frame = 0; frame < taps.size(); ++frame) {
    const std::vector<Vec3> centres = centres_at(taps[frame]);
    if (centres.size() != n_spheres) throw Hdf5Error(name + ": a snapshot of other spheres");
    for (const Vec3 centre : centres) highest = std::max(highest, centre.z + sphere_radius);
    value.write(frame, {&centres[0].x, 3 * centres.size()});
  }
  write_label(value.dataset(),
              {"value", "diameter", "centres of the spheres along x, y, z (z is up)", ""});
  const Hdf5Handle* const axes[] = {&step, &spheres, &directions};
  attach_axes(value.dataset(), axes);
  write_box(group, container, highest);
}

ParticleFrames::ParticleFrames(hid_t file, const std::string& name, std::uint32_t n_spheres)
    : n_spheres_(n_spheres) {
  if (!exists(file, "particles/" + name)) return;
  const Hdf5Handle position = open_group(file, "particles/" + name + "/position");
  taps_ = read_numbers<std::uint64_t>(position, "step");
  require_shape(position, "value", {taps_.size(), n_spheres, 3});
  value_ = open_dataset(position, "value");
}

std::vector<Vec3> ParticleFrames::centres(std::uint64_t tap) const {
  const auto found = std::ranges::find(taps_, tap);
  if (found == taps_.end()) return {};
  std::vector<Vec3> centres(n_spheres_);
  read_rows(value_, Hdf5Number<double>::memory(), {1, n_spheres_, 3},
            static_cast<hsize_t>(found - taps_.begin()), centres.data());
  if (!std::ranges::all_of(centres, is_position))
    throw Hdf5Error(fmt::format("the snapshot of tap {} has a position that is none", tap));
  return centres;
}

}  // namespace jostle::inline results
