#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/cells/cell_axis.hpp"
#include "engine/bed/vec3.hpp"

namespace jostle::inline engine {

/// Spheres in cells at least `cutoff` wide, so that all spheres within the cutoff of a point are in
/// its cell or a neighbouring one. Holds the positions that it received: build it anew, or relocate
/// spheres, after they have moved. A periodic direction with room for fewer than three cells gets a
/// single one (all pairs), so that no image is met twice.
class CellGrid {
 public:
  /// The grid over positions 0 .. n - 1, `position(i)` in diameters and wrapped.
  /// cutoff > 0, diameters. Cells are widened where space is so empty that they would outnumber
  /// the spheres by far.
  template <class Position>
  void build(const Boundary& boundary, double cutoff, std::uint32_t n, Position&& position) {
    set_shape(boundary, cutoff, n, position);
    heads_.assign(static_cast<std::size_t>(axes_[0].count) * axes_[1].count * axes_[2].count, none);
    next_.resize(n);
    cell_of_.resize(n);
    for (std::uint32_t i = n; i-- > 0;) link(i, cell_at(position(i)));
  }

  /// Sphere i, of the grid, is now at `r`.
  void relocate(std::uint32_t i, Vec3 r) {
    const std::uint32_t cell = cell_at(r);
    if (cell == cell_of_[i]) return;
    std::uint32_t* place = &heads_[cell_of_[i]];
    while (*place != i) place = &next_[*place];
    *place = next_[i];
    link(i, cell);
  }

  /// Calls visit(j) for every sphere in the cell of `r` and the cells around it.
  template <class Visit>
  void for_each_near(Vec3 r, Visit&& visit) const {
    const std::array<double, 3> coordinates = {r.x, r.y, r.z};
    std::array<std::array<int, 3>, 3> line;
    std::array<int, 3> length;
    for (int k = 0; k < 3; ++k)
      length[k] = neighbours(axes_[k].own_cell(coordinates[k]), axes_[k], line[k]);
    for_each_in(line, length, visit);
  }

  /// Like visit(), for the cells that come within `reach` of `r`: few, if it is far less than
  /// the cutoff.
  template <class Visit>
  void for_each_within(Vec3 r, double reach, Visit&& visit) const {
    std::array<std::array<int, 3>, 3> line;
    std::array<int, 3> length;
    const std::array<double, 3> coordinates = {r.x, r.y, r.z};
    for (int k = 0; k < 3; ++k) {
      const CellAxis& axis = axes_[k];
      const int home = axis.own_cell(coordinates[k]);
      const bool inside = (coordinates[k] - reach) * axis.per_length >= home &&
                          (coordinates[k] + reach) * axis.per_length < home + 1;
      line[k][0] = home;
      length[k] = inside ? 1 : neighbours(home, axis, line[k]);
    }
    for_each_in(line, length, visit);
  }

  /// Calls visit(j) once for every sphere in the cells that come within `reach` of `r`, whatever
  /// the cutoff, and for some in cells a little farther away.
  template <class Visit>
  void for_each_in_reach(Vec3 r, double reach, Visit&& visit) const {
    const std::array<CellSpan, 3> spans = {span(axes_[0], r.x, reach), span(axes_[1], r.y, reach),
                                           span(axes_[2], r.z, reach)};
    for (int a = 0; a < spans[2].length; ++a) {
      for (int b = 0; b < spans[1].length; ++b) {
        for (int c = 0; c < spans[0].length; ++c) {
          const std::size_t cell =
              cell_number(spans[0].cell(c), spans[1].cell(b), spans[2].cell(a));
          for (std::uint32_t j = heads_[cell]; j != none; j = next_[j]) visit(j);
        }
      }
    }
  }

  std::size_t bytes() const {
    return sizeof(std::uint32_t) * (heads_.capacity() + next_.capacity() + cell_of_.capacity());
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff;

  // Consecutive cells of an axis, beyond whose end the first comes again.
  struct CellSpan {
    int first, length, count;
    int cell(int k) const { return first + k < count ? first + k : first + k - count; }
  };
  static CellSpan span(const CellAxis& axis, double coordinate, double reach) {
    const double cells = std::min(std::ceil(reach * axis.per_length), 1e9);
    const int beyond = std::min(static_cast<int>(cells), axis.count);
    const int home = axis.own_cell(coordinate);
    if (axis.period == 0) {
      const int low = std::max(0, home - beyond), high = std::min(axis.count - 1, home + beyond);
      return {low, high - low + 1, axis.count};
    }
    if (2 * beyond + 1 >= axis.count) return {0, axis.count, axis.count};
    return {home >= beyond ? home - beyond : home - beyond + axis.count, 2 * beyond + 1,
            axis.count};
  }

  template <class Visit>
  void for_each_in(const std::array<std::array<int, 3>, 3>& line, const std::array<int, 3>& length,
                   Visit& visit) const {
    for (int a = 0; a < length[2]; ++a) {
      for (int b = 0; b < length[1]; ++b) {
        for (int c = 0; c < length[0]; ++c) {
          const std::size_t cell = cell_number(line[0][c], line[1][b], line[2][a]);
          for (std::uint32_t j = heads_[cell]; j != none; j = next_[j]) visit(j);
        }
      }
    }
  }

  void link(std::uint32_t i, std::uint32_t cell) {
    next_[i] = heads_[cell];
    heads_[cell] = i;
    cell_of_[i] = cell;
  }

  template <class Position>
  void set_shape(const Boundary& boundary, double cutoff, std::uint32_t n, Position& position) {
    double top = 1;
    for (std::uint32_t i = 0; i < n; ++i) top = std::max(top, position(i).z);
    const double height = boundary.periodic_z ? boundary.height : top;
    const Vec3 periods = boundary.periods();
    double side = cutoff;
    do {
      axes_ = {CellAxis::divide(0, boundary.width_x, periods.x, side),
               CellAxis::divide(0, boundary.width_y, periods.y, side),
               CellAxis::divide(0, height, periods.z, side)};
      double cells = 1;
      for (CellAxis& axis : axes_) {
        if (axis.period != 0 && axis.count < 3) axis.set_count(1, axis.period);
        cells *= axis.count;
      }
      if (cells <= most_cells(n)) break;
      side *= 1.5;
    } while (true);
  }

  std::size_t cell_number(int ix, int iy, int iz) const {
    return (static_cast<std::size_t>(iz) * axes_[1].count + iy) * axes_[0].count + ix;
  }
  std::uint32_t cell_at(Vec3 r) const {
    return static_cast<std::uint32_t>(
        cell_number(axes_[0].own_cell(r.x), axes_[1].own_cell(r.y), axes_[2].own_cell(r.z)));
  }
  // The cells next to `home` and itself; returns how many.
  static int neighbours(int home, const CellAxis& axis, std::array<int, 3>& line) {
    const int count = axis.count;
    if (axis.period != 0) {
      if (count == 1) {
        line[0] = 0;
        return 1;
      }
      line = {(home + count - 1) % count, home, (home + 1) % count};
      return 3;
    }
    int length = 0;
    for (int k = std::max(0, home - 1); k <= std::min(count - 1, home + 1); ++k) {
      line[length++] = k;
    }
    return length;
  }

  std::array<CellAxis, 3> axes_{};
  std::vector<std::uint32_t> heads_;    // [n_cells], first sphere of each, or none
  std::vector<std::uint32_t> next_;     // [n], the next sphere of the same cell, or none
  std::vector<std::uint32_t> cell_of_;  // [n]
};

}  // namespace jostle::inline engine
