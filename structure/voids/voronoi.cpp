#include "structure/voids/voronoi.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <voro++/voro++.hh>

#include "engine/bed/boundary.hpp"

namespace jostle::inline structure {
namespace {

// The container, with a lid where its top is open.
Boundary closed_boundary(const Packing& packing, std::optional<double> lid) {
  Boundary boundary(packing.container);
  if (boundary.periodic_z) return boundary;
  const double top = top_height(packing);
  boundary.height = lid.value_or(surface_height(packing));
  if (boundary.height <= top) throw std::invalid_argument("the lid must lie above every centre");
  return boundary;
}

int n_blocks(double length, double per_length) {
  return std::clamp(static_cast<int>(length * per_length), 1, 1 << 12);
}

// Takes cells from voro++ in ascending order of their spheres.
class CellReader {
 public:
  CellReader(std::size_t n, double unit) : unit_(unit) {
    found_.faces.reserve(16 * n);  // enough for any random packing
    found_.vertices.reserve(28 * n);
    found_.owners.reserve(84 * n);
    found_.first_face.push_back(0);
    found_.first_vertex.push_back(0);
  }

  void read(voro::voronoicell_neighbor& cell, Vec3 centre) {
    cell.neighbors(neighbours_);
    cell.face_vertices(face_vertices_);
    cell.vertices(positions_);
    const double volume = read_faces();
    read_vertices(centre);
    end_cell(volume);
  }

  // Spheres up to `n` for which voro++ has no cell.
  void skip_to(std::size_t n) {
    while (found_.size() < n) end_cell(0);
  }

  VoronoiCells cells() && { return std::move(found_); }

 private:
  // Returns the volume, a pyramid on every face.
  double read_faces() {
    double volume = 0;
    std::size_t index = 0;
    for (const int neighbour : neighbours_) {
      const auto n_corners = static_cast<std::size_t>(face_vertices_[index++]);
      const Vec3 first = corner(face_vertices_[index]);
      Vec3 normal;  // length is twice the area
      for (std::size_t k = index + 2; k < index + n_corners; ++k)
        normal = normal +
                 cross(corner(face_vertices_[k - 1]) - first, corner(face_vertices_[k]) - first);
      index += n_corners;
      found_.faces.push_back(
          {neighbour < 0 ? container_side : static_cast<std::uint32_t>(neighbour),
           0.5 * std::sqrt(norm_squared(normal))});
      volume += std::abs(dot(first, normal)) / 6;
    }
    return volume;
  }

  // Seen from the centre, diameters.
  Vec3 corner(int v) const {
    const double* position = &positions_[3 * static_cast<std::size_t>(v)];
    return unit_ * Vec3{position[0], position[1], position[2]};
  }

  void read_vertices(Vec3 centre) {
    const std::size_t first = found_.vertices.size();
    const int n_corners = static_cast<int>(positions_.size() / 3);
    for (int v = 0; v < n_corners; ++v)
      found_.vertices.push_back({centre + corner(v), 0, 0, false});
    for_each_corner([&](std::size_t v, int neighbour) {
      VoronoiVertex& vertex = found_.vertices[first + v];
      vertex.on_boundary |= neighbour < 0;
      vertex.n_owners += neighbour >= 0;
    });
    auto n_owners = static_cast<std::uint32_t>(found_.owners.size());
    for (std::size_t v = first; v < found_.vertices.size(); ++v) {
      found_.vertices[v].first = n_owners;
      n_owners += std::exchange(found_.vertices[v].n_owners, 0);
    }
    found_.owners.resize(n_owners);
    for_each_corner([&](std::size_t v, int neighbour) {
      if (neighbour < 0) return;
      VoronoiVertex& vertex = found_.vertices[first + v];
      found_.owners[vertex.first + vertex.n_owners++] = static_cast<std::uint32_t>(neighbour);
    });
  }

  // Calls visit(vertex, neighbour) for every corner of every face.
  template <class Visit>
  void for_each_corner(Visit visit) const {
    std::size_t index = 0;
    for (const int neighbour : neighbours_) {
      for (int left = face_vertices_[index++]; left > 0; --left)
        visit(static_cast<std::size_t>(face_vertices_[index++]), neighbour);
    }
  }

  void end_cell(double volume) {
    double surface = 0;
    bool cut = volume == 0;  // voro++ could not make it
    for (std::size_t f = found_.first_face.back(); f < found_.faces.size(); ++f) {
      surface += found_.faces[f].area;
      cut = cut || found_.faces[f].neighbour == container_side;
    }
    found_.volumes.push_back(volume);
    found_.surfaces.push_back(surface);
    found_.cut.push_back(cut);
    found_.first_face.push_back(static_cast<std::uint32_t>(found_.faces.size()));
    found_.first_vertex.push_back(static_cast<std::uint32_t>(found_.vertices.size()));
  }

  VoronoiCells found_;
  double unit_;                                  // diameters
  std::vector<int> neighbours_, face_vertices_;  // in the order of voro++, for one cell
  std::vector<double> positions_;
};

void put(voro::container& container, voro::particle_order& order, int i, Vec3 r,
         double /*radius*/) {
  container.put(order, i, r.x, r.y, r.z);
}
void put(voro::container_poly& container, voro::particle_order& order, int i, Vec3 r,
         double radius) {
  container.put(order, i, r.x, r.y, r.z, radius);
}

// In units of which a diameter is `scale`, a power of two.
template <class VoroContainer>
VoronoiCells cells_at_scale(const Packing& packing, const Boundary& box, double scale) {
  const std::size_t n = packing.centres.size();
  constexpr double per_block = 2;  // centres: faster in deposits than the 5 to 6 voro++ advises
  const double per_length =
      std::cbrt(static_cast<double>(n) / (per_block * box.width_x * box.width_y * box.height));
  VoroContainer container(0, scale * box.width_x, 0, scale * box.width_y, 0, scale * box.height,
                          n_blocks(box.width_x, per_length), n_blocks(box.width_y, per_length),
                          n_blocks(box.height, per_length), box.periodic_x, box.periodic_y,
                          box.periodic_z, 8);
  std::optional<voro::wall_cylinder> tube;
  if (box.tube) {
    const double radius = 0.5 * scale * box.width_x;
    tube.emplace(radius, radius, 0, 0, 0, 1, radius);
    container.add_wall(*tube);
  }
  voro::particle_order order(static_cast<int>(n));
  for (std::size_t i = 0; i < n; ++i)
    put(container, order, static_cast<int>(i), scale * packing.centres[i],
        scale * packing.radius(i));
  CellReader reader(n, 1 / scale);
  voro::voronoicell_neighbor cell;
  voro::c_loop_order loop(container, order);
  if (loop.start()) {
    do {
      const auto i = static_cast<std::size_t>(loop.pid());
      reader.skip_to(i);
      if (container.compute_cell(cell, loop)) reader.read(cell, packing.centres[i]);
    } while (loop.inc());
  }
  reader.skip_to(n);
  return std::move(reader).cells();
}

// Cells with a face that is not as large from the other side. Faces of a cell with its own image
// or twice with one neighbour, in narrow periodic boxes, are summed.
std::uint32_t count_inconsistent(const VoronoiCells& cells) {
  constexpr double tolerance = 1e-6;  // tolerance of a cell's surface
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
               return j != container_side && std::abs(area_towards(i, j) - area_towards(j, i)) >
                                                 tolerance * cells.surfaces[i];
             });
  }
  return count;
}

}  // namespace

VoronoiCells voronoi_cells(const Packing& packing, std::optional<double> lid) {
  // voro++ treats points within a fixed length of a plane as points on it, and goes astray where
  // corners of nearly degenerate cells are about that far apart. In other units they are not.
  VoronoiCells best;
  for (const double scale : {1.0, 1.0 / 64, 64.0}) {
    const Boundary box = closed_boundary(packing, lid);
    VoronoiCells cells = packing.sizes ? cells_at_scale<voro::container_poly>(packing, box, scale)
                                       : cells_at_scale<voro::container>(packing, box, scale);
    cells.inconsistent = count_inconsistent(cells);
    if (scale == 1 || cells.inconsistent < best.inconsistent) best = std::move(cells);
    if (best.inconsistent == 0) break;
  }
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const double diameter = 2 * packing.radius(i);
    best.spheres.push_back(sphere_volume * (diameter * diameter * diameter));
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
  std::ranges::transform(cells.spheres, cells.volumes, fractions.begin(),
                         [](double sphere, double volume) { return sphere / volume; });
  return fractions;
}

std::vector<double> free_volumes(const VoronoiCells& cells) {
  std::vector<double> volumes(cells.size());
  std::ranges::transform(cells.volumes, cells.spheres, volumes.begin(),
                         [](double volume, double sphere) { return volume / sphere - 1; });
  return volumes;
}

}  // namespace jostle::inline structure
