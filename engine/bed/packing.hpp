#pragma once

#include <vector>

#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"

namespace jostle::inline engine {

/// Equal hard spheres of diameter 1 in a container.
struct Packing {
  Container container;
  std::vector<Vec3> centres;  // [n_spheres], diameters
};

/// <Z>, the mean height of the centres, diameters: the mean potential energy a sphere in units of
/// m g d. Summed in order of the spheres. Requires at least one sphere.
double mean_height(const Packing& packing);

/// Greatest height of a centre, diameters; 0 for an empty packing.
double top_height(const Packing& packing);

/// The deepest overlap in a packing, over all pairs, the floor and the walls.
struct Overlap {
  double depth = 0;  // diameters; 0 where nothing overlaps
  long first = -1;   // index of a sphere, -1 where nothing overlaps
  long second = -1;  // index of the other sphere, -1 for the floor or a wall
};

/// Compares every pair (O(n^2), no neighbour search): the independent check of the engine.
Overlap deepest_overlap_brute_force(const Packing& packing);

/// The same by cells, O(n), for packings too large for all pairs.
Overlap deepest_overlap(const Packing& packing);

/// How deep an overlap rounding alone may leave after a tap: max(1e-12, 4 ulp of the top height).
double overlap_bound(const Packing& packing);

}  // namespace jostle::inline engine
