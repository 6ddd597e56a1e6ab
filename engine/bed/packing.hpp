#pragma once

#include <memory>
#include <vector>

#include "engine/bed/container.hpp"
#include "engine/bed/sizes.hpp"
#include "engine/bed/vec3.hpp"

namespace jostle::inline engine {

/// Hard spheres in a container.
struct Packing {
  Container container;
  std::vector<Vec3> centres;                     // [n_spheres], diameters
  std::shared_ptr<const Sizes> sizes = nullptr;  // null: all of diameter 1 and mass 1

  double radius(std::size_t sphere) const { return sizes ? sizes->radius(sphere) : sphere_radius; }
  double mass(std::size_t sphere) const { return sizes ? sizes->mass(sphere) : 1; }
  double smallest_radius() const { return sizes ? sizes->smallest_radius() : sphere_radius; }
  double largest_radius() const { return sizes ? sizes->largest_radius() : sphere_radius; }
};

/// Throws std::invalid_argument where the packing has sizes, which `feature` (a plural, "taps")
/// does not take: the only place that rejects mixtures.
void require_equal_spheres(const Packing& packing, const char* feature);

/// <Z>, the mean height of the centres, diameters, each weighted by the volume of its sphere; of
/// equal spheres the mean potential energy per sphere in units of m g d. Summed in order of the
/// spheres. Requires at least one sphere.
double mean_height(const Packing& packing);

/// 2 <Z>, diameters: the height of the bed if its packing fraction is the same at all heights.
double bed_height(const Packing& packing);

/// Mean heights of the centres of the kinds of a mixture that have spheres, in their order,
/// diameters; each centre weighted by the volume of its sphere. Empty where there are fewer than
/// two such kinds.
std::vector<double> kind_heights(const Packing& packing);

/// The volume of all spheres, diameters cubed.
double solid_volume(const Packing& packing);

/// Greatest height of a centre, diameters; 0 for an empty packing.
double top_height(const Packing& packing);

/// Greatest height that a sphere reaches, diameters; 0 for an empty packing.
double surface_height(const Packing& packing);

/// The deepest overlap in a packing, over all pairs, the floor and the walls.
struct Overlap {
  double depth = 0;  // diameters; 0 where nothing overlaps
  long first = -1;   // index of a sphere, -1 where nothing overlaps
  long second = -1;  // index of the other sphere, -1 for the floor or a wall
};

/// Compares every pair (O(n^2), no neighbour search): the independent check of the engine.
Overlap deepest_overlap_brute_force(const Packing& packing);

/// Like the loop over all pairs, by cells, O(n), for large packings.
Overlap deepest_overlap(const Packing& packing);

/// How deep an overlap rounding alone may leave after a tap: max(1e-12, 4 ulp of the top height).
double overlap_bound(const Packing& packing);

}  // namespace jostle::inline engine
