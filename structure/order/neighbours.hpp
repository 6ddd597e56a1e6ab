#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bed/cells/cell_axis.hpp"
#include "engine/bed/packing.hpp"

// Pairs of near centres, in any container. Lengths in diameters.
namespace jostle::inline structure {

/// Finds the centres within a cut of a centre. Along periodic directions every image is a centre of
/// its own, also where the box is narrower than the cut.
class NeighbourFinder {
 public:
  /// For wrapped centres; cut > 0. Copies what it needs of the packing.
  NeighbourFinder(const Packing& packing, double cut);

  /// Calls visit(j, way, distance squared) for every centre at most `cut` away from centre i but
  /// itself. `way` leads from i to that centre or image. Where the box is narrow, i has images of
  /// its own as neighbours.
  template <class Visit>
  void visit_neighbours(std::uint32_t i, Visit&& visit) const {
    const std::uint32_t own_place = place_of_[i];
    const Vec3 r = centres_[own_place];
    const CellAxis::Range z_cells = z_.range(r.z - reach_, r.z + reach_);
    for (long k = z_cells.first; k <= z_cells.last; ++k) {
      const CellAxis::Image layer = z_.image(k);
      const double layer_gap = z_.gap(k, r.z), lateral2 = reach_ * reach_ - layer_gap * layer_gap;
      if (lateral2 < 0) continue;
      const double half_y = std::sqrt(lateral2);
      const CellAxis::Range y_cells = y_.range(r.y - half_y, r.y + half_y);
      for (long j = y_cells.first; j <= y_cells.last; ++j) {
        const CellAxis::Image row = y_.image(j);
        const double row_gap = y_.gap(j, r.y), row2 = lateral2 - row_gap * row_gap;
        if (row2 < 0) continue;
        const std::size_t begin = (static_cast<std::size_t>(layer.cell) * y_.count + row.cell) *
                                  static_cast<std::size_t>(x_.count);
        const double half_x = std::sqrt(row2);
        const CellAxis::Range x_cells = x_.range(r.x - half_x, r.x + half_x);
        for (long first = x_cells.first; first <= x_cells.last;) {
          const CellAxis::Image cell = x_.image(first);
          const long n = std::min(x_cells.last - first + 1, long{x_.count} - cell.cell);
          const Vec3 shift{cell.shift, row.shift, layer.shift};
          visit_places(starts_[begin + cell.cell], starts_[begin + cell.cell + n], r, shift,
                       shift == Vec3{} ? own_place : none, visit);
          first += n;
        }
      }
    }
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(place_of_.size()); }

 private:
  static constexpr std::uint32_t none = 0xffffffff;

  template <class Visit>
  void visit_places(std::uint32_t begin, std::uint32_t end, Vec3 start, Vec3 shift,
                    std::uint32_t own_place, Visit& visit) const {
    for (std::uint32_t place = begin; place != end; ++place) {
      const Vec3 way = (centres_[place] - start) + shift;
      const double distance_squared = norm_squared(way);
      if (distance_squared <= cut_squared_ && place != own_place) {
        visit(spheres_[place], way, distance_squared);
      }
    }
  }

  double cut_squared_;
  double reach_;  // a little more than the cut, for the rounding of cells' bounds
  CellAxis x_, y_, z_;
  std::vector<std::uint32_t> starts_;    // [n_cells + 1], into the places
  std::vector<Vec3> centres_;            // [n], by place: cell after cell
  std::vector<std::uint32_t> spheres_;   // [n], by place
  std::vector<std::uint32_t> place_of_;  // [n], by sphere
};

struct Neighbour {
  std::uint32_t sphere = 0;
  Vec3 way;  // from the sphere to this neighbour, its nearest or another image
  double distance_squared = 0;
};

/// The neighbours of all spheres, one sphere after another, the nearest first.
struct NeighbourTable {
  std::vector<std::uint32_t> first;  // [n + 1]
  std::vector<Neighbour> neighbours;

  std::size_t size() const { return first.size() - 1; }
  std::span<const Neighbour> neighbours_of(std::size_t i) const {
    return {neighbours.data() + first[i], neighbours.data() + first[i + 1]};
  }
};

/// All centres at most `cut` away.
NeighbourTable neighbours_within(const Packing& packing, double cut);

/// The square of the distance at which two spheres touch, s_ij = R_i + R_j; 1 for equal spheres.
inline double contact_squared(const Packing& packing, std::size_t i, std::size_t j) {
  if (!packing.sizes) return 1;
  const double contact = packing.radius(i) + packing.radius(j);
  return contact * contact;
}

/// The distance within which all pairs at most `cut` times s_ij apart are found.
inline double reach_of_cut(const Packing& packing, double cut) {
  return packing.sizes ? cut * 2 * packing.largest_radius() : cut;
}

/// All spheres at most `cut` times s_ij away. In a mixture `distance_squared` is in squares of
/// s_ij, `way` in diameters; for equal spheres this is neighbours_within().
NeighbourTable neighbours_within_contacts(const Packing& packing, double cut);

/// The `count` nearest of the other spheres, fewer only where there are no more. A sphere's own
/// images are none of them, and of another sphere the nearest image is one; farther images only
/// within 1.5, where they touch or nearly do. Equally distant ones are in the order of their index.
NeighbourTable nearest_neighbours(const Packing& packing, std::uint32_t count = 12);

/// Throws std::invalid_argument where lengths cannot be in diameters: two centres are less than 0.5
/// s_ij apart, or no two of 100 or more are less than 1.5 s_ij apart; s_ij is 1 for equal spheres.
/// Centres wrapped, in the container.
void require_diameters(const Packing& packing);

}  // namespace jostle::inline structure
