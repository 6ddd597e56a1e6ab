#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/bed/packing.hpp"
#include "structure/voids/voronoi.hpp"

namespace jostle::inline structure {

/// Four centres on a sphere that holds no other centre: what meets at a Voronoi vertex.
struct DelaunayTetrahedron {
  std::array<std::uint32_t, 4> spheres{};  // ascending
  Vec3 centroid;                           // wrapped
  double volume = 0;                       // diameters cubed
};

/// The Delaunay tetrahedra of the centres, dual to the Voronoi vertices that neither floor, lid nor
/// sides cut, in ascending order of their spheres. More than four centres may lie on one sphere, as
/// in crystals: so that there are tetrahedra all the same, centres are then moved by up to 1e-6
/// diameters, always alike; such a sphere's centres come as several tetrahedra, some of them nearly
/// flat. Throws std::invalid_argument for periodic widths under 4 diameters.
std::vector<DelaunayTetrahedron> delaunay_tetrahedra(const Packing& packing);

/// Like the function of a packing, from existing cells.
std::vector<DelaunayTetrahedron> delaunay_tetrahedra(const Packing& packing,
                                                     const VoronoiCells& cells);

}  // namespace jostle::inline structure
