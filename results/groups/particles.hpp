#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/bed/container.hpp"
#include "results/content/stored_realization.hpp"
#include "results/groups/contact_network.hpp"
#include "results/hdf5/handle.hpp"

namespace jostle::inline results {

/// For H5MD's box: its dimension and which directions are periodic.
void write_boundary(const Hdf5Handle& box, const Container& container);

/// Writes one group of H5MD's /particles, of the snapshots that keep positions: box, and for each
/// of sphere_vectors that was kept an element {step, value} with a frame a snapshot; and the
/// contacts. Without such snapshots it writes nothing. `diameters`: [n_spheres], or empty where all
/// are 1.
void write_particles(hid_t file, const std::string& name, const Container& container,
                     std::uint32_t n_spheres, std::span<const double> diameters,
                     const std::vector<SnapshotOutline>& snapshots, StoredRealization& realization);

/// Such a group, read frame by frame. Throws Hdf5Error, also where it holds another number of
/// spheres.
class ParticleFrames {
 public:
  /// Without frames where there is no such group.
  ParticleFrames(hid_t file, const std::string& name, std::uint32_t n_spheres,
                 const Container& container);
  /// With a frame of sphere_vectors[which].
  const std::vector<std::uint64_t>& taps(std::size_t index) const { return elements_[index].taps; }
  /// [n_spheres]; empty where the tap is none of taps(which).
  std::vector<Vec3> vectors(std::uint64_t tap, std::size_t index) const;
  const ContactNetwork& network() const { return network_; }

 private:
  struct Element {
    std::vector<std::uint64_t> taps;
    Hdf5Handle value;
  };

  std::uint32_t n_spheres_;
  std::array<Element, n_sphere_vectors> elements_;
  ContactNetwork network_;
};

}  // namespace jostle::inline results
