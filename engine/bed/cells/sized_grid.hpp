#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/bed/cells/cell_grid.hpp"

namespace jostle::inline engine {

/// Spheres of one or several sizes in cell grids, one grid per factor of two in size: cells are as
/// narrow as the spheres in them allow (Krijgsman, Ogarko & Luding, Comput. Part. Mech. 1, 357,
/// 2014). Like a CellGrid it holds the positions that it received. Lengths in diameters.
class SizedGrid {
 public:
  /// Builds the grids over spheres 0 .. n - 1: `position(i)` wrapped, `radius(i)` > 0. A search
  /// finds the spheres whose surfaces are up to `skin` away.
  template <class Position, class Radius>
  void build(const Boundary& boundary, double skin, std::uint32_t n, Position&& position,
             Radius&& radius) {
    skin_ = skin;
    classes_.clear();
    class_of_.resize(n);
    place_of_.resize(n);
    double largest = 0;
    for (std::uint32_t i = 0; i < n; ++i) largest = std::max(largest, radius(i));
    for (std::uint32_t i = 0; i < n; ++i) {
      std::uint32_t number = 0;
      for (double r = 0.5 * largest; radius(i) <= r; r *= 0.5) ++number;
      if (classes_.size() <= number) classes_.resize(number + 1);
      SizeClass& own = classes_[number];
      class_of_[i] = number;
      place_of_[i] = static_cast<std::uint32_t>(own.spheres.size());
      own.spheres.push_back(i);
      own.largest_radius = std::max(own.largest_radius, radius(i));
    }
    // A little wider than a pair reaches, so that a search meets the 27 cells around and no more.
    constexpr double wider = 1 + 1e-9;
    for (SizeClass& c : classes_) {
      if (c.spheres.empty()) continue;
      c.grid.build(boundary, wider * (2 * c.largest_radius + skin),
                   static_cast<std::uint32_t>(c.spheres.size()),
                   [&](std::uint32_t k) { return position(c.spheres[k]); });
    }
  }

  /// Sphere i, of the grids, is now at `r`.
  void relocate(std::uint32_t i, Vec3 r) { classes_[class_of_[i]].grid.relocate(place_of_[i], r); }

  /// Calls visit(j) once for every sphere whose surface lies within the skin of that of a sphere of
  /// this radius at `r`, and for others near it.
  template <class Visit>
  void for_each_near(Vec3 r, double radius, Visit&& visit) const {
    for (const SizeClass& c : classes_) {
      if (c.spheres.empty()) continue;
      c.grid.for_each_in_reach(r, radius + c.largest_radius + skin_,
                               [&](std::uint32_t k) { visit(c.spheres[k]); });
    }
  }

  std::size_t bytes() const {
    std::size_t sum = sizeof(std::uint32_t) * (class_of_.capacity() + place_of_.capacity());
    for (const SizeClass& c : classes_)
      sum += sizeof c + c.grid.bytes() + sizeof(std::uint32_t) * c.spheres.capacity();
    return sum;
  }

 private:
  struct SizeClass {
    std::vector<std::uint32_t> spheres;
    double largest_radius = 0;
    CellGrid grid;
  };

  double skin_ = 0;
  std::vector<SizeClass> classes_;                  // from the largest spheres down
  std::vector<std::uint32_t> class_of_, place_of_;  // [n]
};

}  // namespace jostle::inline engine
