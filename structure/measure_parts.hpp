#pragma once

#include <string>

#include "structure/measure.hpp"
#include "structure/voronoi.hpp"

// The parts of measure(), each with notes of what it was measured with.
namespace jostle {

inline constexpr const char* philippe_bideau = "Philippe & Bideau 2001";
inline constexpr const char* rosato_dybenko = "Rosato et al. 2010";

/// What parts share: the packing, the region, and cells that are made once.
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

Measurement measure_part(MeasuredPacking& in, const ProfileSettings& settings);
Measurement measure_part(MeasuredPacking& in, const SidesSettings& settings);
Measurement measure_part(MeasuredPacking& in, const LayersSettings& settings);
Measurement measure_part(MeasuredPacking& in, const CoordinationSettings& settings);
Measurement measure_part(MeasuredPacking& in, const PairsSettings& settings);
Measurement measure_part(MeasuredPacking& in, const OrderSettings& settings);
Measurement measure_part(MeasuredPacking& in, const VoronoiSettings& settings);
Measurement measure_part(MeasuredPacking& in, const PoresSettings& settings);
Measurement measure_part(MeasuredPacking& in, const VoidSettings& settings);
Measurement measure_part(MeasuredPacking& in, const HolesSettings& settings);

/// k + 1/2 times `width`, or k times it, k = 0 .. n - 1.
std::vector<double> middles_of_bins(std::size_t n, double width);
std::vector<double> whole_numbers(std::size_t n);

/// Parts of `total` per value 0 .. up to the greatest.
std::vector<double> shares(std::span<const std::uint64_t> counts);

}  // namespace jostle
