#include "engine/bed/packing.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "engine/bed/boundary.hpp"
#include "engine/bed/cells/sized_grid.hpp"

namespace jostle::inline engine {

namespace {

// Keeps the deepest of the overlaps shown to it.
struct Deepest {
  Overlap found;
  void see(double depth, long first, long second) {
    if (depth > found.depth) found = {depth, first, second};
  }
};

void see_pair(const Boundary& boundary, const Packing& packing, std::size_t i, std::size_t j,
              Deepest& deepest) {
  const double squared = norm_squared(separation(boundary, packing.centres[i], packing.centres[j]));
  const double touching = packing.radius(i) + packing.radius(j);
  if (squared < touching * touching) {
    deepest.see(touching - std::sqrt(squared), static_cast<long>(std::min(i, j)),
                static_cast<long>(std::max(i, j)));
  }
}

void see_boundaries(const Boundary& boundary, const Packing& packing, Deepest& deepest) {
  if (boundary.periodic_z && !boundary.has_walls()) return;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const double deeper = packing.radius(i) - sphere_radius;  // than a sphere of diameter 1
    deepest.see(boundary_depth(boundary, packing.centres[i]) + deeper, static_cast<long>(i), -1);
  }
}

}  // namespace

void require_equal_spheres(const Packing& packing, const char* feature) {
  if (!packing.sizes) return;
  throw std::invalid_argument(
      std::string(feature) + " require equal spheres of diameter 1, and this packing is a mixture");
}

double mean_height(const Packing& packing) {
  assert(!packing.centres.empty());
  double sum = 0;
  if (!packing.sizes) {
    for (const Vec3& centre : packing.centres) sum += centre.z;
    return sum / static_cast<double>(packing.centres.size());
  }
  double weights = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const double d = packing.sizes->diameter(i), weight = d * d * d;
    sum += weight * packing.centres[i].z;
    weights += weight;
  }
  return sum / weights;
}

std::vector<double> kind_heights(const Packing& packing) {
  if (!packing.sizes || packing.sizes->kinds().size() < 2) return {};
  struct Sums {
    double height = 0, weights = 0;
  };
  std::vector<Sums> sums(packing.sizes->kinds().size());
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    Sums& own = sums[packing.sizes->kind(i)];
    const double d = packing.sizes->diameter(i), weight = d * d * d;
    own.height += weight * packing.centres[i].z;
    own.weights += weight;
  }
  std::vector<double> heights;
  for (const Sums& kind : sums)
    if (kind.weights > 0) heights.push_back(kind.height / kind.weights);
  return heights.size() < 2 ? std::vector<double>{} : heights;
}

double bed_height(const Packing& packing) {
  return 2 * mean_height(packing);
}

double solid_volume(const Packing& packing) {
  if (!packing.sizes) return static_cast<double>(packing.centres.size()) * sphere_volume;
  double cubes = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const double d = packing.sizes->diameter(i);
    cubes += d * d * d;
  }
  return cubes * sphere_volume;
}

double top_height(const Packing& packing) {
  double top = 0;
  for (const Vec3& centre : packing.centres) top = std::max(top, centre.z);
  return top;
}

double surface_height(const Packing& packing) {
  double top = 0;
  for (std::size_t i = 0; i < packing.centres.size(); ++i)
    top = std::max(top, packing.centres[i].z + packing.radius(i));
  return top;
}

Overlap deepest_overlap_brute_force(const Packing& packing) {
  Deepest deepest;
  const Boundary boundary(packing.container);
  see_boundaries(boundary, packing, deepest);
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    for (std::size_t j = i + 1; j < packing.centres.size(); ++j) {
      see_pair(boundary, packing, i, j, deepest);
    }
  }
  return deepest.found;
}

Overlap deepest_overlap(const Packing& packing) {
  Deepest deepest;
  const Boundary boundary(packing.container);
  see_boundaries(boundary, packing, deepest);
  const auto n = static_cast<std::uint32_t>(packing.centres.size());
  SizedGrid grid;
  grid.build(
      boundary, 0, n, [&](std::uint32_t i) { return packing.centres[i]; },
      [&](std::uint32_t i) { return packing.radius(i); });
  for (std::uint32_t i = 0; i < n; ++i) {
    grid.for_each_near(packing.centres[i], packing.radius(i), [&](std::uint32_t j) {
      if (j > i) see_pair(boundary, packing, i, j, deepest);
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
