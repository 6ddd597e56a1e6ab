#include "engine/bed/packing.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/bed/cell_grid.hpp"
#include "engine/bed/geometry.hpp"

namespace jostle {

namespace {

double boundary_depth(const PeriodicBox&, Vec3 r) {
  return sphere_radius - r.z;
}
double boundary_depth(const FullyPeriodicBox&, Vec3) {
  return 0;
}
double boundary_depth(const WalledBox& box, Vec3 r) {
  return std::max({sphere_radius - r.z, sphere_radius - r.x, r.x - (box.width_x - sphere_radius),
                   sphere_radius - r.y, r.y - (box.width_y - sphere_radius)});
}
double boundary_depth(const Cylinder& tube, Vec3 r) {
  const double axis = 0.5 * tube.diameter;
  const double dx = r.x - axis, dy = r.y - axis;
  return std::max(sphere_radius - r.z, std::sqrt(dx * dx + dy * dy) - (axis - sphere_radius));
}

// Keeps the deepest of the overlaps shown to it.
struct Deepest {
  Overlap found;
  void see(double depth, long first, long second) {
    if (depth > found.depth) found = {depth, first, second};
  }
};

template <class Box>
void see_pair(const Box& box, const std::vector<Vec3>& centres, std::size_t i, std::size_t j,
              Deepest& deepest) {
  const double squared = norm_squared(separation(box, centres[i], centres[j]));
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
  const std::vector<Vec3>& centres = packing.centres;
  std::visit(
      [&](const auto& box) {
        for (std::size_t i = 0; i < centres.size(); ++i) {
          deepest.see(boundary_depth(box, centres[i]), static_cast<long>(i), -1);
          for (std::size_t j = i + 1; j < centres.size(); ++j) {
            see_pair(box, centres, i, j, deepest);
          }
        }
      },
      packing.container);
  return deepest.found;
}

Overlap deepest_overlap(const Packing& packing) {
  Deepest deepest;
  const std::vector<Vec3>& centres = packing.centres;
  CellGrid grid;
  grid.build(packing.container, 1.0, static_cast<std::uint32_t>(centres.size()),
             [&](std::uint32_t i) { return centres[i]; });
  std::visit(
      [&](const auto& box) {
        for (std::size_t i = 0; i < centres.size(); ++i) {
          deepest.see(boundary_depth(box, centres[i]), static_cast<long>(i), -1);
          grid.for_each_near(centres[i], [&](std::uint32_t j) {
            if (j > i) see_pair(box, centres, i, j, deepest);
          });
        }
      },
      packing.container);
  return deepest.found;
}

double overlap_bound(const Packing& packing) {
  const double top = top_height(packing);
  const double ulp = std::nextafter(top, std::numeric_limits<double>::infinity()) - top;
  return std::max(1e-12, 4 * ulp);
}

}  // namespace jostle
