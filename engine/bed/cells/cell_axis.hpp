#pragma once

#include <algorithm>
#include <cmath>

#include "engine/bed/boundary.hpp"

namespace jostle::inline engine {

/// Cells of equal width along one direction of a container, from which every search for neighbours
/// is made: CellGrid (spheres that move), SphereCells (beds that grow), NeighbourFinder (packings
/// that are looked at). Beyond the box of a periodic direction cells go on as images. Diameters.
struct CellAxis {
  double origin = 0, side = 1, per_length = 1;
  double period = 0;  // 0: not periodic
  int count = 1;

  /// Cells at least `least_side` wide, one at least, over [origin, origin + length).
  static CellAxis divide(double origin, double length, double period, double least_side) {
    CellAxis axis{.origin = origin, .period = period};
    axis.set_count(static_cast<int>(std::clamp(std::floor(length / least_side), 1.0, 1e9)), length);
    return axis;
  }
  void set_count(int cells, double length) {
    count = cells;
    side = length / count;
    per_length = count / length;
  }

  /// The cell of x, or of its image beyond the box.
  long cell(double x) const { return static_cast<long>(std::floor((x - origin) * per_length)); }
  /// The cell of the box nearest to x.
  int own_cell(double x) const {
    return std::clamp(static_cast<int>((x - origin) * per_length), 0, count - 1);
  }

  struct Range {
    long first, last;
  };
  /// The cells that meet [low, high]; images, too, where the direction is periodic.
  Range range(double low, double high) const {
    if (period != 0) return {cell(low), cell(high)};
    return {std::clamp(cell(low), 0L, count - 1L), std::clamp(cell(high), 0L, count - 1L)};
  }

  struct Image {
    long cell;
    double shift;  // from the cell to this image of it
  };
  Image image(long k) const {
    if (k >= 0 && k < count) return {k, 0};
    const long turn = k >= 0 ? k / count : -((count - 1 - k) / count);
    return {k - turn * count, static_cast<double>(turn) * period};
  }

  /// How far x is from cell k: 0 inside.
  double gap(long k, double x) const {
    const double low = origin + static_cast<double>(k) * side;
    return std::max(0.0, std::max(low - x, x - (low + side)));
  }
};

/// Beyond so many cells they would outnumber n spheres by far: searches widen them.
inline double most_cells(std::size_t n) {
  return 1000 + 8.0 * static_cast<double>(n);
}

}  // namespace jostle::inline engine
