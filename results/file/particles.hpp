#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"
#include "results/hdf5/handle.hpp"

namespace jostle::inline results {

/// Writes one group of H5MD's /particles: box, and position/{step, value} with a frame a snapshot,
/// which `centres_at` gives one by one, [n_spheres] each.
void write_particles(hid_t file, const std::string& name, const Container& container,
                     std::uint32_t n_spheres, const std::vector<std::uint64_t>& taps,
                     const std::function<std::vector<Vec3>(std::uint64_t tap)>& centres_at);

/// Such a group, read frame by frame. Throws Hdf5Error, also where it holds another number of
/// spheres.
class ParticleFrames {
 public:
  /// Without frames where there is no such group.
  ParticleFrames(hid_t file, const std::string& name, std::uint32_t n_spheres);
  const std::vector<std::uint64_t>& taps() const { return taps_; }
  /// [n_spheres]; empty where the tap is none of taps().
  std::vector<Vec3> centres(std::uint64_t tap) const;

 private:
  std::uint32_t n_spheres_;
  std::vector<std::uint64_t> taps_;
  Hdf5Handle value_;
};

}  // namespace jostle::inline results
