#include <cmath>
#include <stdexcept>
#include <string>

#include "engine/numbers.hpp"
#include "structure/measure_parts.hpp"
#include "structure/voids/clusters.hpp"

namespace jostle::inline structure {

namespace {

// Ratios of variances of fewer clusters are too low on average: between sides 3 to 4 apart a
// packing has two to seven whole cells.
constexpr std::uint64_t least_clusters = 10;

}  // namespace

Measurement measure_part(MeasuredPacking& measured, const ClustersSettings& settings) {
  const VoronoiCells& cells = measured.voronoi();
  const ClusterVolumes found =
      cluster_volumes(measured.packing, cells, static_cast<std::uint32_t>(settings.largest),
                      [&](std::uint32_t i) { return measured.in_region(i); });
  const std::uint64_t whole = found.clusters.empty() ? 0 : found.clusters.front();
  if (whole < 2) {
    throw std::invalid_argument("whole cells in the region: " + std::to_string(whole) +
                                "; a variance needs 2: use a larger region, a wider container or "
                                "more spheres");
  }
  std::vector<double> n, per_cell, relative, chi, independent, clusters;
  for (std::size_t k = 0; k < found.cells.size(); ++k) {
    n.push_back(found.cells[k]);
    independent.push_back(found.independent[k]);
    const auto varying = [&](double variance, double mean) {
      return std::pow(zero_within_rounding(std::sqrt(variance), mean), 2);
    };
    per_cell.push_back(varying(found.variance[k], found.mean[k]) / n.back() / independent.back());
    const double of_members = varying(found.of_members[k], found.mean[k] / n.back());
    const bool has_ratio = of_members > 0 && found.clusters[k] >= least_clusters;
    relative.push_back(has_ratio ? per_cell.back() / of_members : not_a_number);
    chi.push_back(per_cell.back() / (found.mean[k] / n.back() - 1 - least_free_volume));
    clusters.push_back(static_cast<double>(found.clusters[k]));
  }
  Measurement measurement;
  measurement.places = {{"cells", n, "1", "cells of a cluster"}};
  measurement.quantities = {
      {.name = "variance",
       .places = "cells",
       .values = per_cell,
       .units = "sphere volumes^2",
       .long_name = "variance of the volume of a cluster, divided by its number of cells and by "
                    "shared_cells; equal for all sizes where cells are independent",
       .source = "Lechenault et al. 2006, doi:10.1088/1742-5468/2006/07/P07009",
       .beyond = not_a_number,
       .with_change = true,
       .with_packings = true},
      {.name = "relative_variance",
       .places = "cells",
       .values = relative,
       .long_name =
           "variance of the volume of a cluster, divided by its number of cells, by shared_cells "
           "and by the variance of its single cells: 1 where cells are independent, no value where "
           "they do not vary, or of fewer than 10 clusters",
       .beyond = not_a_number},
      {.name = "shared_cells",
       .places = "cells",
       .values = independent,
       .long_name = "what the variance of these clusters is lowered by, because they share cells, "
                    "where cells are independent",
       .beyond = not_a_number},
      {.name = "chi",
       .places = "cells",
       .values = chi,
       .units = "sphere volumes",
       .long_name = "compactivity (mean - least) / k of cells and clusters: their variance divided "
                    "by mean less least",
       .source = "Aste & Di Matteo 2008, doi:10.1103/PhysRevE.77.021309",
       .beyond = not_a_number,
       .with_change = true,
       .with_packings = true},
      {.name = "n_clusters",
       .places = "cells",
       .values = clusters,
       .long_name = "clusters all of whose cells are whole"},
      {.name = "mean_volume",
       .values = {found.mean.front()},
       .units = "sphere volumes",
       .long_name = "mean volume of the whole cells of the region"}};
  return measurement;
}

}  // namespace jostle::inline structure
