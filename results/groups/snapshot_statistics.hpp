#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "results/content/record.hpp"
#include "results/content/study.hpp"
#include "results/hdf5/handle.hpp"

namespace jostle::inline results {

/// Snapshots of a point without the data of every sphere.
struct SnapshotStatistics {
  std::vector<double> coordination;  // [n_taps, n_realizations], NaN where there is none
  std::vector<std::optional<BedForces>> forces;  // [n_taps, n_realizations]
  /// height_profiles[which] of a snapshot tap, by its place among them, and a realization; empty
  /// where there is none. Asked for twice, in the order of taps.
  std::function<std::vector<double>(std::size_t index, std::size_t tap, std::uint32_t realization)>
      profile;
};

/// Writes /snapshots/<point>.
void write_snapshot_statistics(hid_t group, const StudyPoint& point, std::uint32_t n_realizations,
                               const SnapshotStatistics& statistics);

/// The forces of the snapshots of a point, [n_taps, n_realizations], in the order of its group;
/// empty where none were kept. Throws Hdf5Error.
std::vector<std::optional<BedForces>> read_bed_forces(hid_t group, const StudyPoint& point,
                                                      std::uint32_t n_realizations);

}  // namespace jostle::inline results
