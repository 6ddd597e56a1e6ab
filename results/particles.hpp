#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/container.hpp"
#include "ensemble/sink.hpp"
#include "results/hdf5_handle.hpp"

namespace jostle {

/// Writes one group of H5MD's /particles: box, and position/{step, value} with a frame a snapshot.
void write_particles(hid_t file, const std::string& name, const Container& container,
                     std::span<const SnapshotRecord* const> frames);

/// The taps and centres of such a group; nothing if it is not there. Throws Hdf5Error, also where
/// it holds another number of spheres.
std::vector<SnapshotRecord> read_particles(hid_t file, const std::string& name,
                                           std::uint32_t n_spheres);

}  // namespace jostle
