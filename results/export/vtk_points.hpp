#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "results/export/particle_columns.hpp"

// VTK's XML formats, as ParaView opens them. https://docs.vtk.org/en/latest/vtk_file_formats/
namespace jostle::inline results {

/// A .vtp file: PolyData with a vertex a sphere and an array a column, the tap as TimeValue; arrays
/// in base64, little-endian, to the last bit.
std::string vtk_points_text(const ExportedFrame& frame);

/// A .pvd file: .vtp files of several taps as a series in time. `files` [n_frames]: tap, and name
/// relative to the .pvd file.
std::string vtk_collection_text(std::span<const std::pair<std::uint64_t, std::string>> files);

}  // namespace jostle::inline results
