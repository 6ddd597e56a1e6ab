#include "structure/voids/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>

#include "engine/bed/boundary.hpp"
#include "engine/bed/random.hpp"

namespace jostle::inline structure {
namespace {

void require_wide(const Container& container) {
  constexpr double least = 4;
  const Vec3 periods = Boundary(container).periods();
  for (const double period : {periods.x, periods.y, periods.z}) {
    if (period == 0 || period >= least) continue;
    throw std::invalid_argument(
        "Delaunay tetrahedra need periodic widths of at least 4 diameters, so that a sphere meets "
        "none of its own images");
  }
}

// No five centres on a sphere.
Packing in_general_position(Packing packing) {
  constexpr double shift = 1e-6;
  RandomStream random(stream_key(0, 0, 0, Purpose::resampling));
  const Boundary boundary(packing.container);
  for (Vec3& r : packing.centres) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Vec3 moved = r + shift * Vec3{2 * x - 1, 2 * y - 1, 2 * z - 1};
    r = wrapped(boundary, moved);
  }
  return packing;
}

DelaunayTetrahedron tetrahedron(const Packing& packing, const std::array<std::uint32_t, 4>& spheres,
                                Vec3 vertex) {
  const Boundary boundary(packing.container);
  const Vec3 inside = wrapped(boundary, vertex);
  std::array<Vec3, 4> corners;  // seen from the vertex
  for (std::size_t k = 0; k < 4; ++k) {
    corners[k] = separation(boundary, packing.centres[spheres[k]], inside);
  }
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], c = corners[3] - corners[0];
  const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  return {spheres, wrapped(boundary, inside + middle), std::abs(dot(a, cross(b, c))) / 6};
}

// The spheres of a vertex of cell i, ascending, if it is the middle of a tetrahedron.
std::optional<std::array<std::uint32_t, 4>> spheres_at(const VoronoiCells& cells, std::uint32_t i,
                                                       const VoronoiVertex& vertex) {
  const auto owners = cells.owners_of(vertex);
  if (vertex.on_boundary || owners.size() != 3) return std::nullopt;
  std::array<std::uint32_t, 4> spheres = {i, owners[0], owners[1], owners[2]};
  std::ranges::sort(spheres);
  return spheres;
}

// Every tetrahedron is seen from its four cells: taken from the first.
std::vector<DelaunayTetrahedron> from_first_cells(const Packing& packing,
                                                  const VoronoiCells& cells) {
  std::vector<DelaunayTetrahedron> found;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const std::size_t first = found.size();
    for (const VoronoiVertex& vertex : cells.vertices_of(i)) {
      const auto spheres = spheres_at(cells, i, vertex);
      if (spheres && spheres->front() == i)
        found.push_back(tetrahedron(packing, *spheres, vertex.position));
    }
    const auto mine = std::ranges::subrange(found.begin() + first, found.end());
    std::ranges::sort(mine, {}, &DelaunayTetrahedron::spheres);
    const auto repeated = std::ranges::unique(mine, {}, &DelaunayTetrahedron::spheres);
    found.erase(repeated.begin(), repeated.end());
  }
  return found;
}

// True if each tetrahedron is seen from all of its four cells, and nothing else from any cell: not
// so where five centres are so near a common sphere that cells differ in what meets there.
bool all_agree(const VoronoiCells& cells, const std::vector<DelaunayTetrahedron>& found) {
  std::vector<std::size_t> first(cells.size() + 1, 0);  // those with a sphere as first
  for (const DelaunayTetrahedron& tetrahedron : found) ++first[tetrahedron.spheres.front() + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  const auto is_found = [&](const std::array<std::uint32_t, 4>& spheres) {
    const std::uint32_t least = spheres.front();
    const auto group = std::span(found).subspan(first[least], first[least + 1] - first[least]);
    return std::ranges::find(group, spheres, &DelaunayTetrahedron::spheres) != group.end();
  };
  std::size_t sightings = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    for (const VoronoiVertex& vertex : cells.vertices_of(i)) {
      if (vertex.on_boundary) continue;
      ++sightings;
      const auto spheres = spheres_at(cells, i, vertex);
      if (!spheres || !is_found(*spheres)) return false;
    }
  }
  return sightings == 4 * found.size();
}

}  // namespace

std::vector<DelaunayTetrahedron> delaunay_tetrahedra(const Packing& packing,
                                                     const VoronoiCells& cells) {
  require_wide(packing.container);
  auto found = from_first_cells(packing, cells);
  if (all_agree(cells, found)) return found;
  const Packing moved = in_general_position(packing);
  return from_first_cells(moved, voronoi_cells(moved));
}

std::vector<DelaunayTetrahedron> delaunay_tetrahedra(const Packing& packing) {
  require_wide(packing.container);
  return delaunay_tetrahedra(packing, voronoi_cells(packing));
}

}  // namespace jostle::inline structure
