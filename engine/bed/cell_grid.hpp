#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"

namespace jostle {

/// Spheres in cells at least `cutoff` wide, so that whatever lies within the cutoff of a point lies
/// in its cell or a neighbouring one. Holds the positions it was told of: build it anew, or
/// relocate spheres, after they have moved. A periodic direction with room for fewer than three
/// cells gets a single one (all pairs), so that no image is met twice.
class CellGrid {
 public:
  /// The grid over positions 0 .. n - 1, `position(i)` in diameters and wrapped.
  /// cutoff > 0, diameters. Cells are widened where space is so empty that they would outnumber
  /// the spheres by far.
  template <class Position>
  void build(const Container& container, double cutoff, std::uint32_t n, Position&& position) {
    set_shape(container, cutoff, n, position);
    heads_.assign(static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2], none);
    next_.resize(n);
    cell_of_.resize(n);
    for (std::uint32_t i = n; i-- > 0;) link(i, cell_at(position(i)));
  }

  /// Sphere i, of the grid, now stands at `r`.
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
    const std::array<int, 3> home = {index(r.x, 0), index(r.y, 1), index(r.z, 2)};
    std::array<std::array<int, 3>, 3> line;
    std::array<int, 3> length;
    for (int axis = 0; axis < 3; ++axis) length[axis] = neighbours(home[axis], axis, line[axis]);
    for_each_in(line, length, visit);
  }

  /// The same for those of the cells that come within `reach` of `r`: few, if it is far less than
  /// the cutoff.
  template <class Visit>
  void for_each_within(Vec3 r, double reach, Visit&& visit) const {
    std::array<std::array<int, 3>, 3> line;
    std::array<int, 3> length;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = axis == 0 ? r.x : axis == 1 ? r.y : r.z;
      const int home = index(x, axis);
      const bool inside =
          (x - reach) * per_length_[axis] >= home && (x + reach) * per_length_[axis] < home + 1;
      line[axis][0] = home;
      length[axis] = inside ? 1 : neighbours(home, axis, line[axis]);
    }
    for_each_in(line, length, visit);
  }

  std::size_t bytes() const {
    return sizeof(std::uint32_t) * (heads_.capacity() + next_.capacity() + cell_of_.capacity());
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff;

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
  void set_shape(const Container& container, double cutoff, std::uint32_t n, Position& position) {
    const auto* bulk = std::get_if<FullyPeriodicBox>(&container);
    periodic_ = {bulk || std::holds_alternative<PeriodicBox>(container),
                 bulk || std::holds_alternative<PeriodicBox>(container), bulk != nullptr};
    double top = 1;
    for (std::uint32_t i = 0; i < n; ++i) top = std::max(top, position(i).z);
    const std::array<double, 3> widths = {width_x(container), width_y(container),
                                          bulk ? bulk->height : top};
    double side = cutoff;
    do {
      double cells = 1;
      for (int axis = 0; axis < 3; ++axis) {
        const double fitting = std::max(1.0, std::floor(widths[axis] / side));
        counts_[axis] = static_cast<int>(std::min(fitting, 1e9));
        if (periodic_[axis] && counts_[axis] < 3) counts_[axis] = 1;
        per_length_[axis] = counts_[axis] / widths[axis];
        cells *= counts_[axis];
      }
      if (cells <= 1000 + 8.0 * n) break;
      side *= 1.5;
    } while (true);
  }

  int index(double x, int axis) const {
    return std::clamp(static_cast<int>(x * per_length_[axis]), 0, counts_[axis] - 1);
  }
  std::size_t cell_number(int ix, int iy, int iz) const {
    return (static_cast<std::size_t>(iz) * counts_[1] + iy) * counts_[0] + ix;
  }
  std::uint32_t cell_at(Vec3 r) const {
    return static_cast<std::uint32_t>(cell_number(index(r.x, 0), index(r.y, 1), index(r.z, 2)));
  }
  int neighbours(int home, int axis, std::array<int, 3>& line) const {
    int length = 0;
    if (periodic_[axis]) {
      if (counts_[axis] == 1) {
        line[0] = 0;
        return 1;
      }
      line = {(home + counts_[axis] - 1) % counts_[axis], home, (home + 1) % counts_[axis]};
      return 3;
    }
    for (int k = std::max(0, home - 1); k <= std::min(counts_[axis] - 1, home + 1); ++k) {
      line[length++] = k;
    }
    return length;
  }

  std::array<bool, 3> periodic_{};
  std::array<int, 3> counts_{1, 1, 1};
  std::array<double, 3> per_length_{1, 1, 1};
  std::vector<std::uint32_t> heads_;    // [n_cells], first sphere of each, or none
  std::vector<std::uint32_t> next_;     // [n], the next sphere of the same cell, or none
  std::vector<std::uint32_t> cell_of_;  // [n]
};

}  // namespace jostle
