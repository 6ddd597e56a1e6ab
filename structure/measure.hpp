#pragma once

#include <optional>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/bed/window.hpp"
#include "structure/density/layers.hpp"
#include "structure/measurement.hpp"
#include "structure/order/structure_factor.hpp"
#include "structure/region.hpp"
#include "structure/voids/bernal_holes.hpp"

// The structure of a packing, part by part: docs/structure.md says what each quantity means.
// Lengths in diameters.
namespace jostle::inline structure {

/// Packing fraction against height, and how it thins out upwards.
struct ProfileSettings {
  double bin_width = 0.1;
  double smoothing = 2 * sphere_radius;  // of the smoothed profile and the gradient; 0 for none
  std::optional<HeightWindow> gradient = std::nullopt;  // absent: as gradient_range() has it
  bool operator==(const ProfileSettings&) const = default;
};

/// Packing fraction from side to side and from the walls inwards.
struct SidesSettings {
  double bin_width = 0.1;
  std::optional<HeightWindow> heights = std::nullopt;  // absent: as transverse_window() has it
  double reach = 7 * sphere_radius;                    // of "lateral"
  bool operator==(const SidesSettings&) const = default;
};

/// Centres against height, and layers that grow from the floor.
struct LayersSettings {
  double bin_width = 0.1;
  LayerRule rule{};
  bool operator==(const LayersSettings&) const = default;
};

struct CoordinationSettings {
  double cut = 1.05;  // of the neighbours that are counted sphere by sphere
  double largest_cut = 1.5, step = 0.01;
  bool operator==(const CoordinationSettings&) const = default;
};

struct PairsSettings {
  std::optional<double> r_max = std::nullopt;  // default: widest_pairs() of the container
  double bin_width = 0.02;
  bool operator==(const PairsSettings&) const = default;
};

/// Bond order and crystalline spheres.
struct OrderSettings {
  double bin_width = 1;  // of heights
  bool operator==(const OrderSettings&) const = default;
};

/// Gaps between neighbours, contacts, rattlers.
struct GapsSettings {
  double largest = 0.5;     // gap that is counted
  double tolerance = 1e-3;  // gap of a contact, of the single values
  /// Of a sphere that is no rattler; absent: as least_contacts_of() has it.
  std::optional<std::uint64_t> least_contacts = std::nullopt;
  HeightWindow window{0.01, 0.2};  // gaps whose exponent is sought
  bool operator==(const GapsSettings&) const = default;
};

struct VoronoiSettings {
  double least_area = 1e-3;  // of a face that counts, in surfaces of its cell
  double bin_width = 0.02;   // of free volumes, in volumes of a sphere
  bool cut_cells = false;    // whether cells that floor, sides or lid cut are counted too
  bool operator==(const VoronoiSettings&) const = default;
};

/// Volumes of clusters of cells.
struct ClustersSettings {
  std::uint64_t largest = 64;  // cells
  bool operator==(const ClustersSettings&) const = default;
};

struct PoresSettings {
  double bin_width = 0.02, largest = 1.5;  // of xi
  double merge = 1e-6;                     // diameters
  double tolerance = 0.02;                 // of tetrahedral and octahedral sites, in xi
  double tail_from = 0.15;                 // of v: where the exponential tail begins
  bool operator==(const PoresSettings&) const = default;
};

/// P0(sigma).
struct VoidSettings {
  double largest = 2, step = 0.05;  // of sigma
  std::uint64_t points = 100'000;   // a packing
  bool operator==(const VoidSettings&) const = default;
};

struct HolesSettings {
  BondLengths bonds{};
  bool operator==(const HolesSettings&) const = default;
};

/// What is measured: the parts that have settings, nothing else.
struct StructureSettings {
  /// Where spheres, cells, pores and holes are counted; absent: as bulk_of() has it.
  std::optional<Region> region = std::nullopt;
  std::optional<ProfileSettings> profile = std::nullopt;
  std::optional<SidesSettings> sides = std::nullopt;
  std::optional<LayersSettings> layers = std::nullopt;
  std::optional<CoordinationSettings> coordination = std::nullopt;
  std::optional<PairsSettings> pair_correlation = std::nullopt;
  std::optional<OrderSettings> order = std::nullopt;
  std::optional<GapsSettings> gaps = std::nullopt;
  std::optional<StructureFactorSettings> structure_factor = std::nullopt;
  std::optional<VoronoiSettings> voronoi = std::nullopt;
  std::optional<ClustersSettings> clusters = std::nullopt;
  std::optional<PoresSettings> pores = std::nullopt;
  std::optional<VoidSettings> void_probability = std::nullopt;
  std::optional<HolesSettings> holes = std::nullopt;
  bool operator==(const StructureSettings&) const = default;
  bool empty() const { return *this == StructureSettings{}; }
};

/// Free volume of the least cell that unit spheres can have, a regular dodecahedron around one, in
/// volumes of a sphere.
inline constexpr double least_free_volume = 0.325034379180265;

/// Every part, with its defaults.
StructureSettings all_structure();

/// Philippe & Bideau's region, 2 R to 20 R high and 2 R away from walls, but never above 2 R below
/// 2<Z>; all of a fully periodic box.
Region bulk_of(const Packing& packing);

/// Each part that has settings, in their order. `points` draws the random points of P0. A part that
/// the container does not have is refused: it says why and holds nothing. Throws
/// std::invalid_argument for two centres less than half a diameter apart, which no packing of
/// spheres of diameter 1 has.
std::vector<Measurement> measure(const Packing& packing, const StructureSettings& settings,
                                 StreamKey points);

}  // namespace jostle::inline structure
