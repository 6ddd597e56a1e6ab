#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/bed/window.hpp"
#include "engine/fields.hpp"
#include "structure/density/layers.hpp"
#include "structure/measurement.hpp"
#include "structure/order/structure_factor.hpp"
#include "structure/region.hpp"
#include "structure/voids/bernal_holes.hpp"

// The structure of a packing, part by part: docs/reference/structure.md defines each quantity.
// Lengths in diameters.
namespace jostle::inline structure {

inline constexpr Range bin_width_range =
    closed_range(0.001, 10);  // bin width range of heights and distances, diameters

/// Packing fraction against height, and how it thins out upwards.
struct ProfileSettings {
  double bin_width = 0.1;
  double smoothing =
      2 * sphere_radius;  // smoothing length of the profile and the gradient; 0 for none
  std::optional<HeightWindow> gradient = std::nullopt;  // absent: as gradient_range() has it
  bool operator==(const ProfileSettings&) const = default;

  static constexpr Description description{"profile",
                                           "Packing fraction against height, its gradient, eq. 7"};
  template <class Self = ProfileSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("bin_width", &Self::bin_width, Number{bin_width_range, "diameters"},
              "Width of a bin"),
        field("smoothing", &Self::smoothing, Number{closed_range(0, 10)},
              "Boxcar of the smoothed profile and the gradient, diameters; 0 for none"),
        field("gradient", &Self::gradient, height_bounds,
              "Heights of the gradient; absent: 2.5 to 11 between walls, to 13 with periodic "
              "sides")};
  }
};

/// Packing fraction from side to side and from the walls inwards.
struct SidesSettings {
  double bin_width = 0.1;
  std::optional<HeightWindow> heights = std::nullopt;  // absent: as transverse_window() has it
  double reach = 7 * sphere_radius;                    // depth of "lateral" from a wall
  bool operator==(const SidesSettings&) const = default;

  static constexpr Description description{
      "sides", "Packing fraction from side to side, from the walls, from the axis"};
  template <class Self = SidesSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("bin_width", &Self::bin_width, Number{bin_width_range, "diameters"},
              "Width of a bin"),
        field("reach", &Self::reach, Number{left_open_range(0, 1e6), "diameters"},
              "Depth of the lateral region, from a wall"),
        field("heights", &Self::heights, height_bounds, "Low and high; absent: 2 to 0.8 of 2<Z>")};
  }
};

/// Centres against height, and layers that grow from the floor.
struct LayersSettings {
  double bin_width = 0.1;
  LayerRule rule{};
  bool operator==(const LayersSettings&) const = default;

  static constexpr Description description{"layers", "n(z) and the layers grown from the floor"};
  template <class Self = LayersSettings>
  static constexpr auto fields() {
    return std::tuple{field("bin_width", &Self::bin_width, Number{bin_width_range, "diameters"},
                            "Width of bins of n(z)"),
                      inlined(&Self::rule)};
  }
};

struct CoordinationSettings {
  double cut = 1.05;  // distance up to which neighbours of a sphere are counted
  double largest_cut = 1.5, step = 0.01;
  bool operator==(const CoordinationSettings&) const = default;

  static constexpr Description description{"coordination",
                                           "Neighbours within a cut, and against the cut"};
  template <class Self = CoordinationSettings>
  static constexpr auto fields() {
    return std::tuple{field("cut", &Self::cut, Number{closed_range(1, 3), "diameters"},
                            "Distance of the centres of neighbours, at most"),
                      field("largest_cut", &Self::largest_cut,
                            Number{closed_range(1, 3), "diameters"}, "Range of the curve above 1"),
                      field("step", &Self::step, Number{closed_range(0.001, 1), "diameters"},
                            "Step of the curve of neighbours against the cut")};
  }
};

struct PairsSettings {
  std::optional<double> r_max = std::nullopt;  // default: widest_pairs() of the container
  double bin_width = 0.02;
  bool operator==(const PairsSettings&) const = default;

  static constexpr Description description{"pair_correlation",
                                           "g(r), corrected for floor, surface and sides"};
  template <class Self = PairsSettings>
  static constexpr auto fields() {
    return std::tuple{field("bin_width", &Self::bin_width,
                            Number{closed_range(0.001, 1), "diameters"}, "Width of a bin"),
                      field("r_max", &Self::r_max, Number{closed_range(1, 20)},
                            "Diameters. Default: 4, at most half a period")};
  }
};

/// Bond order and crystalline spheres.
struct OrderSettings {
  double bin_width = 1;  // bin width of heights
  bool operator==(const OrderSettings&) const = default;

  static constexpr Description description{
      "order", "q4, q6, w6; fcc, hcp and disordered spheres, by height"};
  template <class Self = OrderSettings>
  static constexpr auto fields() {
    return std::tuple{field("bin_width", &Self::bin_width,
                            Number{closed_range(0.1, 1000), "diameters"}, "Bin width of heights")};
  }
};

/// Gaps between neighbours, contacts, rattlers.
struct GapsSettings {
  double largest = 0.5;     // gap that is counted
  double tolerance = 1e-3;  // gap of a contact, of the single values
  /// For a sphere that is no rattler; absent: as least_contacts_of() has it.
  std::optional<std::uint64_t> least_contacts = std::nullopt;
  HeightWindow window{0.01, 0.2};  // gaps whose exponent is sought
  bool operator==(const GapsSettings&) const = default;

  static constexpr Description description{
      "gaps",
      "Gaps between neighbours and their exponent, contacts, rattlers, "
      "against the gap that counts as a contact"};
  template <class Self = GapsSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("largest", &Self::largest, Number{closed_range(0.01, 2), "diameters"},
              "Gap that is counted"),
        field("tolerance", &Self::tolerance, Number{closed_range(0, 0.2)},
              "Gap up to which spheres touch, diameters: of the single values"),
        field("least_contacts", &Self::least_contacts, Whole{1, 12},
              "Contacts of a sphere that is not a rattler, at least. Default: 3 in beds, which "
              "have weight; "
              "4 in a fully periodic box, which has none"),
        field("window", &Self::window, Bounds{left_open_range(0, 1e6), closed_range(0, 1e6)},
              "Smallest and largest gap for the exponent, diameters, both above 0")};
  }
};

struct VoronoiSettings {
  double least_area = 1e-3;  // least area of a face that counts, in surfaces of its cell
  double bin_width = 0.02;   // bin width of free volumes, in volumes of a sphere
  bool cut_cells = false;    // true if cells that floor, sides or lid cut are counted too
  bool operator==(const VoronoiSettings&) const = default;

  static constexpr Description description{
      "voronoi", "Faces, volumes and free volumes of cells, local packing fractions"};
  template <class Self = VoronoiSettings>
  static constexpr auto fields() {
    return std::tuple{field("least_area", &Self::least_area, Number{closed_range(0, 0.1)},
                            "Least area of a counted face, in surfaces of its cell"),
                      field("bin_width", &Self::bin_width, Number{closed_range(0.001, 1)},
                            "Width of bins of free volumes, in volumes of a sphere"),
                      field("cut_cells", &Self::cut_cells, Flag{},
                            "Cells that are cut by floor, sides or lid are counted, too")};
  }
};

/// Volumes of clusters of cells.
struct ClustersSettings {
  std::uint64_t largest = 64;  // cells
  bool operator==(const ClustersSettings&) const = default;

  static constexpr Description description{
      "clusters", "Volumes of clusters of Voronoi cells against the number of their cells"};
  template <class Self = ClustersSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("largest", &Self::largest, Whole{1, 10'000}, "Cells of the largest cluster")};
  }
};

struct PoresSettings {
  double bin_width = 0.02, largest = 1.5;  // bin width of xi
  double merge = 1e-6;                     // diameters
  double tolerance = 0.02;                 // tolerance of tetrahedral and octahedral sites, in xi
  double tail_from = 0.15;                 // v at which the exponential tail begins
  bool spheres_inside = false;             // true if pores count by their spheres' centres
  bool operator==(const PoresSettings&) const = default;

  static constexpr Description description{
      "pores", "Sizes of pores, sites of close packing, the exponential tail"};
  template <class Self = PoresSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("bin_width", &Self::bin_width, Number{closed_range(0.001, 0.5)}, "Bin width of xi"),
        field("largest", &Self::largest, Number{closed_range(0.5, 10)}, "xi of the last bin"),
        field("merge", &Self::merge, Number{closed_range(0, 0.1), "diameters"},
              "Vertices so close are one pore"),
        field("tolerance", &Self::tolerance, Number{closed_range(0, 0.1)},
              "Tolerance of tetrahedral and octahedral sites, in xi"),
        field("tail_from", &Self::tail_from, Number{closed_range(0, 100)},
              "v at which the tail begins"),
        field(
            "spheres_inside", &Self::spheres_inside, Flag{},
            "Count a pore if the centres of all spheres that it touches lie in the region, as the "
            "counts of [PB] require; by default its own centre decides")};
  }
};

/// P0(sigma).
struct VoidSettings {
  double largest = 2, step = 0.05;  // largest sigma
  std::uint64_t points = 100'000;   // a packing
  bool operator==(const VoidSettings&) const = default;

  static constexpr Description description{"void_probability", "P0(sigma) beside Gotoh's"};
  template <class Self = VoidSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("largest", &Self::largest, Number{closed_range(0.1, 5)}, "sigma"),
        field("step", &Self::step, Number{closed_range(0.001, 1)}, "Step of sigma"),
        field("points", &Self::points, Whole{100, 1'000'000'000}, "Random points per packing")};
  }
};

struct HolesSettings {
  BondLengths bonds{};
  bool operator==(const HolesSettings&) const = default;

  static constexpr Description description{"holes", "Bernal's canonical holes"};
  template <class Self = HolesSettings>
  static constexpr auto fields() {
    return std::tuple{inlined(&Self::bonds)};
  }
};

/// The field of a part, which has the part's name.
template <class Part, class Settings>
constexpr auto measured(std::optional<Settings> Part::*member) {
  return field(Settings::description.name, member, Object<Settings>{}, Settings::description.text);
}

/// The measured parts: those that have settings.
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

  template <class Self = StructureSettings>
  static constexpr auto fields() {
    return std::tuple{
        field("region", &Self::region, Object<Region>{},
              "Where spheres, cells, pores and holes are counted; absent: heights 1 to 10 but at "
              "most 2<Z> - 1, 1 away from walls; all of a fully periodic box"),
        measured(&Self::profile),
        measured(&Self::sides),
        measured(&Self::layers),
        measured(&Self::coordination),
        measured(&Self::pair_correlation),
        measured(&Self::order),
        measured(&Self::gaps),
        measured(&Self::structure_factor),
        measured(&Self::voronoi),
        measured(&Self::clusters),
        measured(&Self::pores),
        measured(&Self::void_probability),
        measured(&Self::holes)};
  }
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

/// Names of the parts among these that are defined for equal spheres alone.
std::vector<std::string> parts_of_equal_spheres(const StructureSettings& settings);

/// Each part that has settings, in their order. `points` draws the random points of P0. A part that
/// the container does not have is refused: it holds the reason and no values. Throws
/// std::invalid_argument for two centres less than half a diameter apart, which no packing of
/// spheres of diameter 1 has.
std::vector<Measurement> measure(const Packing& packing, const StructureSettings& settings,
                                 StreamKey points);

}  // namespace jostle::inline structure
