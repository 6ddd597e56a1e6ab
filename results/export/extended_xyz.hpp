#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/bed/packing.hpp"
#include "results/export/particle_columns.hpp"

namespace jostle::inline results {

/// Reads one frame of an extended XYZ file, counted from 0; the last if none is named. Centres are
/// inside the container's periods, from its corner. Throws ResultsError, also where another frame
/// has a fault.
Packing read_extended_xyz(const std::string& path, std::optional<std::uint64_t> frame);

/// Reads all frames, one at least. Throws ResultsError.
std::vector<Packing> read_extended_xyz_frames(const std::string& path);

/// Frames with their columns and taps, that read back to the same bits.
std::string extended_xyz_text(std::span<const ExportedFrame> frames);

}  // namespace jostle::inline results
