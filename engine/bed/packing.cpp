#include "engine/bed/packing.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/bed/boundary.hpp"
#include "engine/bed/cell_grid.hpp"

namespace jostle::inline engine {

namespace {

// Keeps the deepest of the overlaps shown to it.
struct Deepest {
  Overlap found;
  void see(double depth, long first, long second) {
    if (depth > found.depth) found = {depth, first, second};
  }
};

void see_pair(const Boundary& boundary, const std::vector<Vec3>& centres, std::size_t i,
              std::size_t j, Deepest& deepest) {
  const double squared = norm_squared(separation(boundary, centres[i], centres[j]));
  if (squared < 1) {
    deepest.see(1 - std::sqrt(squared), static_cast<long>(i), static_cast<long>(j));
  }
}

}  // namespace

double mean_height(const Packing& packing) {
  assert(!packing.centres.empty());
  double sum = 0;
  for (const Vec3& centre : packing.centres) sum += centre.z;
  return sum / static_cast<double>(packing.centres.size());
}

double top_height(const Packing& packing) {
  double top = 0;
  for (const Vec3& centre : packing.centres) top = std::max(top, centre.z);
  return top;
}

Overlap deepest_overlap_brute_force(const Packing& packing) {
  Deepest deepest;
  const Boundary boundary(packing.container);
  const std::vector<Vec3>& centres = packing.centres;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    deepest.see(boundary_depth(boundary, centres[i]), static_cast<long>(i), -1);
    for (std::size_t j = i + 1; j < centres.size(); ++j) {
      see_pair(boundary, centres, i, j, deepest);
    }
  }
  return deepest.found;
}

Overlap deepest_overlap(const Packing& packing) {
  Deepest deepest;
  const Boundary boundary(packing.container);
  const std::vector<Vec3>& centres = packing.centres;
  CellGrid grid;
  grid.build(boundary, 1.0, static_cast<std::uint32_t>(centres.size()),
             [&](std::uint32_t i) { return centres[i]; });
  for (std::size_t i = 0; i < centres.size(); ++i) {
    deepest.see(boundary_depth(boundary, centres[i]), static_cast<long>(i), -1);
    grid.for_each_near(centres[i], [&](std::uint32_t j) {
      if (j > i) see_pair(boundary, centres, i, j, deepest);
    });
  }
  return deepest.found;
}

double overlap_bound(const Packing& packing) {
  const double top = top_height(packing);
  const double ulp = std::nextafter(top, std::numeric_limits<double>::infinity()) - top;
  return std::max(1e-12, 4 * ulp);
}

}  // namespace jostle::inline engine
