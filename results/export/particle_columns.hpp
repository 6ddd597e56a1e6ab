#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "engine/bed/packing.hpp"

namespace jostle::inline results {

/// One number a sphere, under the name that viewers show.
struct ParticleColumn {
  std::string name;                                                      // snake_case
  std::variant<std::vector<double>, std::vector<std::uint32_t>> values;  // [n_spheres]
};

/// A vector a sphere, under the names that each format knows it by.
struct VectorColumn {
  const char *name, *xyz_name;
  std::array<const char*, 3> components;  // components in LAMMPS' order
  std::vector<Vec3> values;               // [n_spheres]
};

/// A packing as it leaves for other programs.
struct ExportedFrame {
  std::uint64_t tap = 0;
  Packing packing;
  std::vector<ParticleColumn> columns;
  std::vector<VectorColumn> vectors{};
};

/// Returns x, y, z of every vector, one after the other.
std::vector<double> components_of(const std::vector<Vec3>& vectors);

/// A sphere of a mixture has `radius`, `kind` (its number), `mass`, `coordination` (centres within
/// 1.05 times the sum of the two radii) and `voronoi_volume` (of its radical cell). An equal sphere
/// has `radius` and `voronoi_volume` (diameters and their cubes; cells end at floor, walls, and
/// half a diameter above the highest centre), `coordination` (centres within 1.05 diameters), `q6`
/// of the 12 nearest neighbours, and `structure_type` (0 disordered, 1 fcc, 2 hcp, as OVITO numbers
/// them). Throws std::invalid_argument for a centre outside the container.
std::vector<ParticleColumn> particle_columns(const Packing& packing);

/// The value of sphere i: numbers in the fewest digits that read back to the same bits.
std::string cell_text(const ParticleColumn& column, std::size_t i);
/// The three of a vector, each after a blank.
std::string cell_text(const VectorColumn& column, std::size_t i);

}  // namespace jostle::inline results
