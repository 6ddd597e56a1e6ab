#include "structure/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/geometry.hpp"
#include "engine/random.hpp"
#include "structure/voronoi.hpp"

namespace jostle {
namespace {

void require_wide(const Container& container) {
  constexpr double least = 4;
  const auto* bulk = std::get_if<FullyPeriodicBox>(&container);
  if (bulk == nullptr && !std::holds_alternative<PeriodicBox>(container)) return;
  if (width_x(container) < least || width_y(container) < least ||
      (bulk != nullptr && bulk->height < least)) {
    throw std::invalid_argument(
        "Delaunay tetrahedra need periodic widths of at least 4 diameters, so that a sphere meets "
        "none of its own images");
  }
}

// No five centres on a sphere.
Packing in_general_position(Packing packing) {
  constexpr double shift = 1e-6;
  RandomStream random(stream_key(0, 0, 0, Purpose::resampling));
  for (Vec3& r : packing.centres) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Vec3 moved = r + shift * Vec3{2 * x - 1, 2 * y - 1, 2 * z - 1};
    r = std::visit([&](const auto& box) { return wrapped(box, moved); }, packing.container);
  }
  return packing;
}

DelaunayTetrahedron tetrahedron(const Packing& packing, const std::array<std::uint32_t, 4>& spheres,
                                Vec3 vertex) {
  std::array<Vec3, 4> corners;  // seen from the vertex
  const auto place = [&](const auto& box) {
    for (std::size_t k = 0; k < 4; ++k)
      corners[k] = separation(box, packing.centres[spheres[k]], wrapped(box, vertex));
  };
  std::visit(place, packing.container);
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], c = corners[3] - corners[0];
  const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  return {spheres,
          std::visit([&](const auto& box) { return wrapped(box, wrapped(box, vertex) + middle); },
                     packing.container),
          std::abs(dot(a, cross(b, c))) / 6};
}

}  // namespace

std::vector<DelaunayTetrahedron> delaunay_tetrahedra(const Packing& packing) {
  require_wide(packing.container);
  const Packing moved = in_general_position(packing);
  const VoronoiCells cells = voronoi_cells(moved);
  std::vector<DelaunayTetrahedron> found;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    for (const VoronoiVertex& vertex : cells.vertices_of(i)) {
      const auto owners = cells.owners_of(vertex);
      if (vertex.on_boundary || owners.size() != 3) continue;
      std::array<std::uint32_t, 4> spheres = {i, owners[0], owners[1], owners[2]};
      std::ranges::sort(spheres);
      // Every tetrahedron is seen from its four cells: taken from the first.
      if (spheres[0] == i) found.push_back(tetrahedron(moved, spheres, vertex.position));
    }
  }
  std::ranges::sort(found, {}, &DelaunayTetrahedron::spheres);
  const auto repeated = std::ranges::unique(found, {}, &DelaunayTetrahedron::spheres);
  found.erase(repeated.begin(), repeated.end());
  return found;
}

}  // namespace jostle
