#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/bed/packing.hpp"
#include "structure/voids/voronoi.hpp"

namespace jostle::inline structure {

/// Volumes of clusters of n cells, over the cells that they are around.
struct ClusterVolumes {
  std::vector<std::uint32_t> cells;    // n, ascending: 1, 2, 3, 4, 6, 8, 12, 16, 24, ...
  std::vector<double> mean, variance;  // [n_sizes], sphere volumes, and squared
  /// Variance of the single cells that these clusters are of, each counted as often as it is in
  /// one: clusters of many cells keep farther from the boundaries. [n_sizes], sphere volumes
  /// squared.
  std::vector<double> of_members;
  /// Expected `variance` if volumes of cells were independent of each other, or dealt out anew
  /// among the cells, over n times the variance of one: 1 but for cells that clusters share.
  /// [n_sizes], NaN where all clusters are one and the same.
  std::vector<double> independent;
  std::vector<std::uint64_t> clusters;  // [n_sizes]
};

/// A cluster is a cell and those of the n - 1 centres nearest to its own (equally far ones in order
/// of their index), one around every cell that `is_counted` chooses, as far as all of its cells are
/// whole: those that reach a cell cut by floor, lid or sides, or a second image of one of theirs,
/// are left out. Sizes up to `largest`, or half of all spheres. Clusters share cells with their
/// neighbours; the variance is over their number less 1, NaN below two. Clusters of discs:
/// Lechenault et al. 2006, doi:10.1088/1742-5468/2006/07/P07009.
ClusterVolumes cluster_volumes(const Packing& packing, const VoronoiCells& cells,
                               std::uint32_t largest,
                               const std::function<bool(std::uint32_t)>& is_counted);

}  // namespace jostle::inline structure
