#include "results/groups/particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/bed/boundary.hpp"
#include "results/groups/axes.hpp"
#include "results/hdf5/read.hpp"
#include "results/hdf5/write.hpp"

namespace jostle::inline results {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double));

/// H5MD's box. An open top ends at the highest point any frame reaches.
void write_box(hid_t group, const Container& container, double highest) {
  const Boundary boundary(container);
  const Hdf5Handle box = create_group(group, "box");
  write_boundary(box, container);
  const std::vector<double> edges = {boundary.width_x, boundary.width_y,
                                     boundary.periodic_z ? boundary.height : highest};
  const Hdf5Handle dataset = write_numbers(box, "edges", edges);
  write_label(dataset, {"edges", "diameter", "", ""});
  const Hdf5Handle directions = write_bare_axis(box, "direction", 3);
  const Hdf5Handle* const axes[] = {&directions};
  attach_axes(dataset, axes);
}

double highest_point(const std::vector<Vec3>& centres, std::span<const double> diameters) {
  double highest = 0;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const double radius = diameters.empty() ? sphere_radius : diameters[i] / 2;
    highest = std::max(highest, centres[i].z + radius);
  }
  return highest;
}

/// An element of H5MD, [n_steps, n_spheres, 3], whose frames come one by one.
template <class VectorsAt>
void write_element(hid_t group, const SphereVector& vector, std::uint32_t n_spheres,
                   const std::vector<std::uint64_t>& taps, const VectorsAt& vectors_at) {
  const Hdf5Handle element = create_group(group, vector.name);
  const Hdf5Handle step = write_numbers(element, "step", taps);
  write_label(step, {"step", "1", "number of taps; 0 is the start", ""});
  make_axis(step, "step");
  const Hdf5Handle spheres = write_bare_axis(element, "sphere", n_spheres);
  const Hdf5Handle directions = write_bare_axis(element, "direction", 3);
  RowsDataset<double> value(element, "value", {taps.size(), n_spheres, 3}, {1, n_spheres, 3});
  for (std::size_t frame = 0; frame < taps.size(); ++frame) {
    const std::vector<Vec3> vectors = vectors_at(taps[frame]);
    value.write(frame, {&vectors[0].x, 3 * vectors.size()});
  }
  write_label(value.dataset(), {"value", vector.units, vector.long_name, ""});
  const Hdf5Handle* const axes[] = {&step, &spheres, &directions};
  attach_axes(value.dataset(), axes);
}

}  // namespace

void write_boundary(const Hdf5Handle& box, const Container& container) {
  const Boundary boundary(container);
  const auto word = [](bool periodic) { return std::string(periodic ? "periodic" : "none"); };
  const std::array<std::string, 3> words = {word(boundary.periodic_x), word(boundary.periodic_y),
                                            word(boundary.periodic_z)};
  write_attribute(box, "dimension", std::uint32_t{3});
  write_attribute(box, "boundary", words);
}

void write_particles(hid_t file, const std::string& name, const Container& container,
                     std::uint32_t n_spheres, std::span<const double> diameters,
                     const std::vector<SnapshotOutline>& snapshots,
                     StoredRealization& realization) {
  std::vector<ContactFrame> frames;
  for (const SnapshotOutline& outline : snapshots)
    if (outline.n_spheres[kept_positions] > 0) frames.push_back({outline.tap, outline.n_contacts});
  if (frames.empty()) return;
  const Hdf5Handle group = create_group(file, "particles/" + name);
  double highest = 0;
  for (std::size_t k = 0; k < n_sphere_vectors; ++k) {
    std::vector<std::uint64_t> taps;
    for (const SnapshotOutline& outline : snapshots)
      if (outline.n_spheres[k] > 0) taps.push_back(outline.tap);
    const auto vectors_at = [&](std::uint64_t tap) {
      std::vector<Vec3> vectors = realization.vectors(tap, k);
      if (vectors.size() != n_spheres) throw Hdf5Error(name + ": a snapshot of other spheres");
      if (k == kept_positions) highest = std::max(highest, highest_point(vectors, diameters));
      return vectors;
    };
    if (!taps.empty()) write_element(group, sphere_vectors[k], n_spheres, taps, vectors_at);
  }
  write_contacts(group, container, n_spheres, frames,
                 [&](std::uint64_t tap) { return realization.contacts(tap); });
  write_box(group, container, highest);
}

ParticleFrames::ParticleFrames(hid_t file, const std::string& name, std::uint32_t n_spheres,
                               const Container& container)
    : n_spheres_(n_spheres) {
  if (!exists(file, "particles/" + name)) return;
  const Hdf5Handle group = open_group(file, "particles/" + name);
  for (std::size_t k = 0; k < n_sphere_vectors; ++k) {
    if (k != kept_positions && !exists(group, sphere_vectors[k].name)) continue;
    const Hdf5Handle element = open_group(group, sphere_vectors[k].name);
    elements_[k].taps = read_numbers<std::uint64_t>(element, "step");
    require_shape(element, "value", {elements_[k].taps.size(), n_spheres, 3});
    elements_[k].value = open_dataset(element, "value");
  }
  network_ = ContactNetwork(group, n_spheres, container);
}

std::vector<Vec3> ParticleFrames::vectors(std::uint64_t tap, std::size_t index) const {
  const auto& [taps, value] = elements_[index];
  const auto found = std::ranges::find(taps, tap);
  if (found == taps.end()) return {};
  std::vector<Vec3> vectors(n_spheres_);
  read_rows(value, Hdf5Number<double>::memory(), {1, n_spheres_, 3},
            static_cast<hsize_t>(found - taps.begin()), vectors.data());
  if (!std::ranges::all_of(vectors, is_position))
    throw Hdf5Error(fmt::format("the snapshot of tap {} has a {} that is none", tap,
                                sphere_vectors[index].name));
  return vectors;
}

}  // namespace jostle::inline results
