#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/fields.hpp"
#include "structure/voids/pores.hpp"

// The five canonical holes of J. D. Bernal (Proc. R. Soc. A 280, 299, 1964): polyhedra with edges
// of about one diameter and centres of spheres for corners, that fill the space between them.
namespace jostle::inline structure {

enum class HoleKind : std::uint8_t {
  tetrahedron,
  half_octahedron,  // a square pyramid; an octahedron is two
  trigonal_prism,
  tetragonal_dodecahedron,  // snub disphenoid
  archimedean_antiprism,    // square antiprism
  unclassified              // a single Delaunay tetrahedron that belongs to none of them
};

/// A kind of hole, and what Philippe & Bideau 2001, table I, print of it after Bernal's models. The
/// two columns agree for the volumes of regular holes, prism and antiprism without the
/// half-octahedra on their squares.
struct CanonicalHole {
  const char* name;
  std::uint32_t n_spheres;
  double volume;  // volume of the regular hole, diameters cubed
  double xi;      // radius / R of the sphere in the middle of the regular one
  double number_fraction, volume_fraction;
};
inline constexpr std::array<CanonicalHole, 5> canonical_holes = {
    {{"tetrahedron", 4, 0.11785113019775793, 0.225, 0.730, 0.484},
     {"half-octahedron", 5, 0.23570226039551584, 0.414, 0.203, 0.269},
     {"trigonal prism", 6, 0.43301270189221932, 0.528, 0.032, 0.078},
     {"tetragonal dodecahedron", 8, 0.85949364619130053, 0.353, 0.031, 0.148},
     {"archimedean antiprism", 8, 0.95699998183671660, 0.645, 0.004, 0.021}}};

struct BernalHole {
  HoleKind kind = HoleKind::unclassified;
  std::vector<std::uint32_t> spheres;  // its corners, ascending
  double volume = 0;                   // sum over its Delaunay tetrahedra, diameters cubed
  Vec3 centroid;                       // wrapped
};

/// Two spheres are bonded if their centres are closer than a length: `first` diameters, then `step`
/// more, up to `last`. The middle between the edge of a regular hole, 1, and the diagonal of its
/// squares, 2^(1/2), is 1.207; the shortest diagonal, a dodecahedron's, is 1.289.
struct BondLengths {
  double first = 1.2, last = 1.4, step = 0.05;
  bool operator==(const BondLengths&) const = default;

  template <class Self = BondLengths>
  static constexpr auto fields() {
    return std::tuple{
        field("first", &Self::first, Number{left_open_range(1, 2), "diameters"},
              "First bond length"),
        field("last", &Self::last, Number{left_open_range(1, 2), "diameters"}, "Last bond length"),
        field("step", &Self::step, Number{closed_range(0.001, 1), "diameters"},
              "Between bond lengths")};
  }
};

/// The holes of a packing, every Delaunay tetrahedron in exactly one. Our rule, as Bernal took his
/// holes out of models by hand: a hole is a set of spheres that are bonded to one another exactly
/// as the corners of a canonical one, so that all its bonds are shorter than all its diagonals, and
/// whose tetrahedra, none of them of another hole, fill it without a gap, in whatever way they cut
/// it. At every bond length, the shortest first, holes are taken in the order antiprism,
/// dodecahedron, prism, half-octahedron, tetrahedron, among equals the one whose longest bond falls
/// farthest below its shortest diagonal first, at a tie the one with the lowest spheres. Regular
/// holes therefore come before distorted ones, and large ones before those they could be cut into.
/// Volume that no bond length explains is unclassified: with the default lengths 23 % of the volume
/// of a bed poured by steepest descent. How the rest is shared out depends on them: compare
/// packings by one and the same rule. Requires 1 < first <= last and step > 0. Throws
/// std::invalid_argument for periodic widths under 4 diameters.
std::vector<BernalHole> bernal_holes(const Packing& packing, const BondLengths& lengths = {});

/// Like the function of a packing, with existing cells.
std::vector<BernalHole> bernal_holes(const Packing& packing, const VoronoiCells& cells,
                                     const BondLengths& lengths = {});

/// Holes whose centroids lie in a region: how many, and diameters cubed.
struct HoleTable {
  std::array<std::uint64_t, 5> counts{};  // by kind
  std::array<double, 5> volumes{};
  std::uint64_t unclassified = 0;  // tetrahedra
  double unclassified_volume = 0;

  /// For the classified holes, as table I; NaN where there is none.
  double number_fraction(HoleKind kind) const;
  double volume_fraction(HoleKind kind) const;
  /// Share of the whole volume.
  double unclassified_fraction() const;
  double volume() const;
};
HoleTable hole_table(std::span<const BernalHole> holes, const Container& container,
                     const Region& region);

}  // namespace jostle::inline structure
