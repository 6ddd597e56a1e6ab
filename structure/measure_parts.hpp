#pragma once

#include <cmath>
#include <string>
#include <type_traits>

#include "structure/measure.hpp"
#include "structure/voids/voronoi.hpp"

// The parts of measure().
namespace jostle::inline structure {

/// Common data of the parts: the packing, the region, and cells that are made once.
struct MeasuredPacking {
  const Packing& packing;
  Region region;
  StreamKey points;
  std::optional<VoronoiCells> cells{};

  const VoronoiCells& voronoi() {
    if (!cells) cells = voronoi_cells(packing);
    return *cells;
  }
  bool in_region(std::size_t i) const {
    return region.contains(packing.container, packing.centres[i]);
  }
};

/// Parts that are defined for spheres of several sizes.
template <class Settings>
constexpr bool takes_sizes =
    std::is_same_v<Settings, ProfileSettings> || std::is_same_v<Settings, SidesSettings> ||
    std::is_same_v<Settings, CoordinationSettings> || std::is_same_v<Settings, GapsSettings> ||
    std::is_same_v<Settings, PairsSettings> || std::is_same_v<Settings, VoronoiSettings>;

Measurement measure_part(MeasuredPacking& measured, const ProfileSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const SidesSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const LayersSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const CoordinationSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const PairsSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const OrderSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const GapsSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const StructureFactorSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const VoronoiSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const ClustersSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const PoresSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const VoidSettings& settings);
Measurement measure_part(MeasuredPacking& measured, const HolesSettings& settings);

/// Pairs of a mixture by their kinds, counted from the first sphere of each.
class KindPairs {
 public:
  explicit KindPairs(const MeasuredPacking& measured);
  /// Sphere `j` is a partner of sphere `i`; add(j, i) counts it the other way round.
  void add(std::size_t i, std::size_t j);
  /// Adds the places "pair" and "kind", the mean numbers of partners over the region's spheres and
  /// over all, and the number of spheres of each kind. Over all, N_i n_ij = N_j n_ji.
  void write(std::string_view of_region, std::string_view of_all, std::string_view region_meaning,
             std::string_view all_meaning, Measurement& measurement) const;

 private:
  const MeasuredPacking& measured_;
  std::vector<double> in_region_, all_;           // [n_kinds^2], first kind by second
  std::vector<double> spheres_, region_spheres_;  // [n_kinds]
};

/// A deviation, or 0 where it is rounding noise beside the size of what deviates.
inline double zero_within_rounding(double deviation, double size) {
  constexpr double rounding = 1e-10;
  return std::abs(deviation) <= rounding * std::abs(size) ? 0 : deviation;
}

/// k + 1/2 times `width`, or k times it, k = 0 .. n - 1.
std::vector<double> middles_of_bins(std::size_t n, double width);
std::vector<double> whole_numbers(std::size_t n);

/// Packing fraction between the heights of a region, from side to side; of all of a fully periodic
/// box.
double fraction_of(const Packing& packing, const Region& region);

/// Each count over their sum, [n_counts].
std::vector<double> shares(std::span<const std::uint64_t> counts);

}  // namespace jostle::inline structure
