#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/bed/packing.hpp"

// Voronoi cells of the centres, by voro++ (Rycroft 2009, doi:10.1063/1.3215722). Spheres of several
// sizes have radical cells (Gellatly & Finney 1982, doi:10.1016/0022-3093(82)90093-X): the face of
// two spheres is the plane from which the tangents to both are equally long. Lengths in diameters.
namespace jostle::inline structure {

/// Neighbour of a cell beyond a face that is no sphere: a side of the container.
inline constexpr std::uint32_t container_side = 0xffffffff;

struct VoronoiFace {
  std::uint32_t neighbour = container_side;  // or the index of a sphere
  double area = 0;                           // diameters squared
};

/// A corner of a cell, and the spheres that meet there besides the cell's own.
struct VoronoiVertex {
  Vec3 position;               // beside the cell's centre: not wrapped
  std::uint32_t first = 0;     // first entries in `owners`
  std::uint32_t n_owners = 0;  // 3, or more where cells are degenerate
  bool on_boundary = false;    // a face of the vertex is cut by floor, lid or sides
};

/// The cells of all spheres, one after another.
struct VoronoiCells {
  std::vector<double> volumes;    // [n], diameters cubed
  std::vector<double> spheres;    // [n], diameters cubed: the spheres' own volumes
  std::vector<double> surfaces;   // [n], diameters squared
  std::vector<std::uint8_t> cut;  // [n], 1 where floor, lid or sides are a face
  std::vector<std::uint32_t> first_face, first_vertex;  // [n + 1]
  std::vector<VoronoiFace> faces;
  std::vector<VoronoiVertex> vertices;
  std::vector<std::uint32_t> owners;  // owners of all vertices
  /// Cells with a face that is larger or smaller from the other side: 0, unless voro++ cannot make
  /// out a nearly degenerate packing at any of three scales.
  std::uint32_t inconsistent = 0;

  std::size_t size() const { return volumes.size(); }
  std::span<const VoronoiFace> faces_of(std::uint32_t i) const {
    return {faces.data() + first_face[i], faces.data() + first_face[i + 1]};
  }
  std::span<const VoronoiVertex> vertices_of(std::uint32_t i) const {
    return {vertices.data() + first_vertex[i], vertices.data() + first_vertex[i + 1]};
  }
  std::span<const std::uint32_t> owners_of(const VoronoiVertex& vertex) const {
    return {owners.data() + vertex.first, vertex.n_owners};
  }
};

/// The cells of a packing of at least one sphere. Under gravity a lid at height `lid`, by default
/// at the greatest height that a sphere reaches, closes the cells at the top. Cells at the curved
/// wall of a cylinder are cut by the plane that touches it nearest to the sphere: they reach beyond
/// it, and their volumes sum to more than the tube's. Throws std::invalid_argument for a lid below
/// a centre.
VoronoiCells voronoi_cells(const Packing& packing, std::optional<double> lid = std::nullopt);

/// Faces of cell i of at least `least_area` times its surface. Exact crystals are degenerate: any
/// noise splits their corners into tiny faces, 12 becoming 14, unless those are left out.
std::uint32_t n_faces(const VoronoiCells& cells, std::uint32_t i, double least_area = 0);

/// Volume of the sphere over that of its cell, [n].
std::vector<double> local_fractions(const VoronoiCells& cells);

/// Volume of a cell without its sphere, in units of that sphere's, [n]. Rosato et al. 2010, fig. 9.
std::vector<double> free_volumes(const VoronoiCells& cells);

}  // namespace jostle::inline structure
