#pragma once

#include <cstdint>
#include <vector>

#include "engine/bed/cells/cell_axis.hpp"
#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"

namespace jostle::inline engine {

/// Spheres sorted into cells at least one diameter wide, or `least_side`, for building a packing
/// sphere by sphere in any legal container. Along a periodic direction every image is met, also
/// where the box is so narrow that one sphere is met twice; upwards an open container grows as
/// spheres arrive.
class SphereCells {
 public:
  /// For about n_spheres up to about `height`: cells are widened where space is so empty that they
  /// would outnumber the spheres by far.
  SphereCells(const Container& container, std::uint32_t n_spheres, double height,
              double least_side = 1);

  /// Adds a centre (wrapped, z >= 0) and returns its index: 0, 1, 2, ...
  std::uint32_t insert(Vec3 centre);
  /// Moves a sphere; `centre` is wrapped, z >= 0.
  void move(std::uint32_t sphere, Vec3 centre);

  const std::vector<Vec3>& centres() const { return centres_; }

  /// Calls visit(index, image) for every sphere in the cells that meet the block [low, high], and
  /// for some just outside it, until a call returns true; returns whether one did. `image` is the
  /// sphere's periodic image in the frame of the block.
  template <class Visit>
  bool any_in(Vec3 low, Vec3 high, Visit&& visit) const {
    const CellAxis::Range x = x_.range(low.x, high.x), y = y_.range(low.y, high.y),
                          z = z_.range(low.z, high.z);
    for (long k = z.first; k <= z.last; ++k) {
      const CellAxis::Image layer = z_.image(k);
      for (long j = y.first; j <= y.last; ++j) {
        const CellAxis::Image row = y_.image(j);
        for (long i = x.first; i <= x.last; ++i) {
          const CellAxis::Image cell = x_.image(i);
          const Vec3 shift = {cell.shift, row.shift, layer.shift};
          const long index = (layer.cell * y_.count + row.cell) * x_.count + cell.cell;
          for (std::int32_t s = heads_[static_cast<std::size_t>(index)]; s >= 0;
               s = next_[static_cast<std::size_t>(s)]) {
            const auto sphere = static_cast<std::uint32_t>(s);
            if (visit(sphere, centres_[sphere] + shift)) return true;
          }
        }
      }
    }
    return false;
  }

  /// Like visit() of a block, for the cube of half-side `reach` around a point.
  template <class Visit>
  bool any_near(Vec3 point, double reach, Visit&& visit) const {
    const Vec3 half = {reach, reach, reach};
    return any_in(point - half, point + half, visit);
  }

 private:
  std::size_t cell_of(Vec3 centre) const;
  void make_room(double z);
  void link(std::uint32_t sphere);

  CellAxis x_, y_, z_;
  bool open_top_;
  std::vector<std::int32_t> heads_;  // [cells], first sphere or -1
  std::vector<std::int32_t> next_;   // [spheres], next in the same cell or -1
  std::vector<Vec3> centres_;        // [spheres]
};

}  // namespace jostle::inline engine
