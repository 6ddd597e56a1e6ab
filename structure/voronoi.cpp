#include "structure/voronoi.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <voro++/voro++.hh>

namespace jostle {
namespace {

struct Extent {
  double width_x, width_y, height;
  bool periodic_sides, periodic_z;
};

Extent extent_of(const Packing& packing, std::optional<double> lid) {
  const Container& container = packing.container;
  Extent extent{width_x(container), width_y(container), 0,
                std::holds_alternative<PeriodicBox>(container), false};
  if (const auto* bulk = std::get_if<FullyPeriodicBox>(&container)) {
    extent.height = bulk->height;
    extent.periodic_sides = extent.periodic_z = true;
    return extent;
  }
  double top = 0;
  for (const Vec3& r : packing.centres) top = std::max(top, r.z);
  extent.height = lid.value_or(top + sphere_radius);
  if (extent.height <= top) throw std::invalid_argument("the lid must lie above every centre");
  return extent;
}

int n_blocks(double length, double per_length) {
  return std::clamp(static_cast<int>(length * per_length), 1, 1 << 12);
}

class CellReader {
 public:
  CellReader(std::size_t n, double unit) : found_(n), unit_(unit) {}

  void read(voro::voronoicell_neighbor& cell, int i, const std::vector<Vec3>& centres) {
    const Vec3 centre = centres[static_cast<std::size_t>(i)];
    cell.neighbors(neighbours_);
    cell.face_areas(areas_);
    cell.face_vertices(face_vertices_);
    cell.vertices(positions_);
    Cell& mine = found_[static_cast<std::size_t>(i)];
    mine.volume = unit_ * unit_ * unit_ * cell.volume();
    mine.corners.resize(positions_.size() / 3);
    for (std::size_t v = 0; v < mine.corners.size(); ++v) {
      mine.corners[v].position =
          centre + unit_ * Vec3{positions_[3 * v], positions_[3 * v + 1], positions_[3 * v + 2]};
    }
    std::size_t at = 0;
    for (std::size_t f = 0; f < neighbours_.size(); ++f) {
      const std::uint32_t neighbour =
          neighbours_[f] < 0 ? boundary : static_cast<std::uint32_t>(neighbours_[f]);
      mine.faces.push_back({neighbour, unit_ * unit_ * areas_[f]});
      const int n_corners = face_vertices_[at++];
      for (int k = 0; k < n_corners; ++k) {
        Corner& corner = mine.corners[static_cast<std::size_t>(face_vertices_[at++])];
        if (neighbour == boundary) {
          corner.on_boundary = true;
        } else {
          corner.owners.push_back(neighbour);
        }
      }
    }
  }

  VoronoiCells cells() const {
    VoronoiCells all;
    all.first_face = all.first_vertex = {0};
    for (const Cell& cell : found_) {
      double surface = 0;
      bool cut = false;
      for (const VoronoiFace& face : cell.faces) {
        surface += face.area;
        cut = cut || face.neighbour == boundary;
      }
      all.volumes.push_back(cell.volume);
      all.surfaces.push_back(surface);
      all.cut.push_back(cut);
      all.faces.insert(all.faces.end(), cell.faces.begin(), cell.faces.end());
      for (const Corner& corner : cell.corners) {
        all.vertices.push_back({corner.position, static_cast<std::uint32_t>(all.owners.size()),
                                static_cast<std::uint32_t>(corner.owners.size()),
                                corner.on_boundary});
        all.owners.insert(all.owners.end(), corner.owners.begin(), corner.owners.end());
      }
      all.first_face.push_back(static_cast<std::uint32_t>(all.faces.size()));
      all.first_vertex.push_back(static_cast<std::uint32_t>(all.vertices.size()));
    }
    return all;
  }

 private:
  struct Corner {
    Vec3 position;
    std::vector<std::uint32_t> owners;
    bool on_boundary = false;
  };
  struct Cell {
    double volume = 0;
    std::vector<VoronoiFace> faces;
    std::vector<Corner> corners;
  };

  std::vector<Cell> found_;
  double unit_;  // diameters
  std::vector<int> neighbours_, face_vertices_;
  std::vector<double> areas_, positions_;
};

// In units of which a diameter is `scale`, a power of two.
VoronoiCells cells_at_scale(const Packing& packing, const Extent& box, double scale) {
  const std::size_t n = packing.centres.size();
  constexpr double per_block = 2;  // centres: faster in deposits than the 5 to 6 voro++ advises
  const double per_length =
      std::cbrt(static_cast<double>(n) / (per_block * box.width_x * box.width_y * box.height));
  voro::container container(0, scale * box.width_x, 0, scale * box.width_y, 0, scale * box.height,
                            n_blocks(box.width_x, per_length), n_blocks(box.width_y, per_length),
                            n_blocks(box.height, per_length), box.periodic_sides,
                            box.periodic_sides, box.periodic_z, 8);
  std::optional<voro::wall_cylinder> tube;
  if (const auto* cylinder = std::get_if<Cylinder>(&packing.container)) {
    const double radius = 0.5 * scale * cylinder->diameter;
    tube.emplace(radius, radius, 0, 0, 0, 1, radius);
    container.add_wall(*tube);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 r = scale * packing.centres[i];
    container.put(static_cast<int>(i), r.x, r.y, r.z);
  }
  CellReader reader(n, 1 / scale);
  voro::voronoicell_neighbor cell;
  voro::c_loop_all loop(container);
  bool more = loop.start();
  while (more) {
    if (container.compute_cell(cell, loop)) reader.read(cell, loop.pid(), packing.centres);
    more = loop.inc();
  }
  return reader.cells();
}

// Cells with a face that is not as large from the other side. Faces of a cell with its own image
// or twice with one neighbour, in narrow periodic boxes, are summed.
std::uint32_t count_inconsistent(const VoronoiCells& cells) {
  constexpr double tolerance = 1e-6;  // of a cell's surface
  const auto area_towards = [&](std::uint32_t i, std::uint32_t j) {
    double area = 0;
    for (const VoronoiFace& face : cells.faces_of(i)) {
      if (face.neighbour == j) area += face.area;
    }
    return area;
  };
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    count += cells.volumes[i] <= 0 || std::ranges::any_of(cells.faces_of(i), [&](const auto& face) {
               const std::uint32_t j = face.neighbour;
               return j != boundary && std::abs(area_towards(i, j) - area_towards(j, i)) >
                                           tolerance * cells.surfaces[i];
             });
  }
  return count;
}

}  // namespace

VoronoiCells voronoi_cells(const Packing& packing, std::optional<double> lid) {
  // voro++ takes what lies within a fixed length of a plane as lying on it, and goes astray where
  // corners of nearly degenerate cells are about that far apart. In other units they are not.
  VoronoiCells best;
  for (const double scale : {1.0, 1.0 / 64, 64.0}) {
    VoronoiCells cells = cells_at_scale(packing, extent_of(packing, lid), scale);
    cells.inconsistent = count_inconsistent(cells);
    if (scale == 1 || cells.inconsistent < best.inconsistent) best = std::move(cells);
    if (best.inconsistent == 0) break;
  }
  return best;
}

std::uint32_t n_faces(const VoronoiCells& cells, std::uint32_t i, double least_area) {
  const double least = least_area * cells.surfaces[i];
  const auto faces = cells.faces_of(i);
  return static_cast<std::uint32_t>(
      std::ranges::count_if(faces, [&](const VoronoiFace& face) { return face.area >= least; }));
}

std::vector<double> local_fractions(const VoronoiCells& cells) {
  std::vector<double> fractions(cells.size());
  std::ranges::transform(cells.volumes, fractions.begin(),
                         [](double volume) { return sphere_volume / volume; });
  return fractions;
}

std::vector<double> free_volumes(const VoronoiCells& cells) {
  std::vector<double> volumes(cells.size());
  std::ranges::transform(cells.volumes, volumes.begin(),
                         [](double volume) { return volume / sphere_volume - 1; });
  return volumes;
}

}  // namespace jostle
