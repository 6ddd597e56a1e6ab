#pragma once

#include <span>
#include <string>

#include "results/disk/publish.hpp"
#include "results/export/particle_columns.hpp"

namespace jostle::inline results {

/// An H5MD 1.1 file of one trajectory, /particles/trajectory, as readers of H5MD expect it:
/// position and every column with `step` and `time`, which are both the tap, and the box of every
/// frame as three vectors. No unit is named: lengths are in diameters.
/// https://h5md.nongnu.org/h5md.html Throws std::invalid_argument where frames have different
/// numbers of spheres, ResultsError.
void write_h5md(const std::string& path, std::span<const ExportedFrame> frames,
                ExistingFile existing = ExistingFile::replaced);

}  // namespace jostle::inline results
