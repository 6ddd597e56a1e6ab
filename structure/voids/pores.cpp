#include "structure/voids/pores.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "engine/bed/boundary.hpp"
#include "engine/bed/cells/cell_grid.hpp"
#include "engine/bed/slab.hpp"
#include "engine/numbers.hpp"
#include "structure/density/sphere_cuts.hpp"
#include "structure/order/accessible.hpp"

namespace jostle::inline structure {
namespace {

double xi_of(const Pore& pore) {
  return pore.radius / sphere_radius;
}

// A vertex from one of the cells that have it.
struct Sighting {
  Vec3 centre;  // wrapped
  double radius;
  std::uint32_t cell;
  const VoronoiVertex* vertex;
};

// Every vertex from every cell that has it: at degenerate ones the cells that meet do not all see
// one another, and only together they name all the spheres around it.
std::vector<Sighting> sightings(const Packing& packing, const VoronoiCells& cells) {
  const Boundary boundary(packing.container);
  std::vector<Sighting> found;
  found.reserve(cells.vertices.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    for (const VoronoiVertex& vertex : cells.vertices_of(i)) {
      if (vertex.on_boundary) continue;
      const Vec3 r = vertex.position;
      const double radius = std::sqrt(norm_squared(r - packing.centres[i])) - sphere_radius;
      found.push_back({wrapped(boundary, r), radius, i, &vertex});
    }
  }
  return found;
}

// `owners` is room to work in.
Pore merged(const Boundary& boundary, const VoronoiCells& cells, const std::vector<Sighting>& found,
            const std::vector<std::uint32_t>& cluster, std::vector<std::uint32_t>& owners) {
  const Vec3 first = found[cluster.front()].centre;
  Vec3 shift;
  double radius = 0;
  owners.clear();
  for (const std::uint32_t k : cluster) {
    shift = shift + separation(boundary, found[k].centre, first);
    radius += found[k].radius;
    const auto second_owners = cells.owners_of(*found[k].vertex);
    owners.insert(owners.end(), second_owners.begin(), second_owners.end());
    owners.push_back(found[k].cell);
  }
  std::ranges::sort(owners);
  const double part = 1.0 / static_cast<double>(cluster.size());
  return {wrapped(boundary, first + part * shift),
          part * radius,
          {owners.begin(), std::ranges::unique(owners).begin()}};
}

double squared_distance(const Boundary& boundary, Vec3 a, Vec3 b) {
  return norm_squared(separation(boundary, a, b));
}

// Volume of a region that a sphere of radius R around `r` fills.
double filled_by(const Boundary& boundary, const Region& region, Vec3 r) {
  const bool x = boundary.planes_x(), y = boundary.planes_y();
  if (x || y) {
    constexpr double beyond =
        1;  // distance from a sphere's middle that contains all of it, also at a seam
    const Vec3 low{x ? region.from_sides : r.x - beyond, y ? region.from_sides : r.y - beyond,
                   region.low};
    const Vec3 high{x ? boundary.width_x - region.from_sides : r.x + beyond,
                    y ? boundary.width_y - region.from_sides : r.y + beyond, region.high};
    return sphere_volume_in_box(low - r, high - r);
  }
  if (boundary.tube) {
    const double axis = boundary.axis(), dx = r.x - axis, dy = r.y - axis;
    return sphere_volume_in_tube(std::sqrt(dx * dx + dy * dy), axis - region.from_sides,
                                 region.low - r.z, region.high - r.z);
  }
  if (!boundary.periodic_z) return sphere_volume_in_slab(r.z, region.low, region.high);
  double filled = 0;
  for (const double z : {r.z - boundary.height, r.z, r.z + boundary.height}) {
    filled += sphere_volume_in_slab(z, region.low, region.high);
  }
  return filled;
}

// The part of the region that spheres of radius sigma R around the centres fill, sigma <= 1: as
// spheres of radius R do where all lengths are divided by sigma.
double filled_part(const Packing& packing, const Region& region, double sigma) {
  if (sigma == 0) return 0;
  const double factor = 1 / sigma;
  const Region larger{factor * region.low, factor * region.high, factor * region.from_sides};
  Boundary room(packing.container);
  room.width_x *= factor;
  room.width_y *= factor;
  room.height *= factor;
  double filled = 0;
  for (const Vec3& r : packing.centres) filled += filled_by(room, larger, factor * r);
  return filled * sigma * sigma * sigma / region.volume(packing.container);
}

Vec3 random_point(const Container& container, const Region& region, RandomStream& random) {
  const Boundary boundary(container);
  const double off_x = boundary.periodic_x ? 0 : region.from_sides;
  const double off_y = boundary.periodic_y ? 0 : region.from_sides;
  while (true) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Vec3 r{off_x + (boundary.width_x - 2 * off_x) * x,
                 off_y + (boundary.width_y - 2 * off_y) * y,
                 region.low + (region.high - region.low) * z};
    if (region.contains(container, r)) return r;
  }
}

// The random spheres of one radius: how many lie where centres may be, and how many of them are
// empty.
struct RandomSpheres {
  double radius;
  std::uint64_t counted = 0, empty = 0;
};

void draw_spheres(const Packing& packing, const Region& region, std::uint64_t points, StreamKey key,
                  std::vector<RandomSpheres>& of_radius) {
  if (of_radius.empty()) return;
  const Boundary boundary(packing.container);
  const AccessibleFootprint footprint(packing);
  const HeightWindow heights = accessible_heights(packing);
  CellGrid grid;
  grid.build(boundary, std::ranges::max(of_radius, {}, &RandomSpheres::radius).radius,
             static_cast<std::uint32_t>(packing.centres.size()),
             [&](std::uint32_t i) { return packing.centres[i]; });
  RandomStream random(key);
  for (std::uint64_t p = 0; p < points; ++p) {
    const Vec3 r = random_point(packing.container, region, random);
    const double room =
        std::min({footprint.depth(r.x, r.y), r.z - heights.low, heights.high - r.z});
    double nearest = infinite;
    grid.for_each_near(r, [&](std::uint32_t i) {
      nearest = std::min(nearest, squared_distance(boundary, r, packing.centres[i]));
    });
    for (RandomSpheres& spheres : of_radius) {
      if (room < spheres.radius) continue;
      ++spheres.counted;
      spheres.empty += nearest >= spheres.radius * spheres.radius ? 1 : 0;
    }
  }
}

}  // namespace

std::vector<Pore> pores(const Packing& packing, const VoronoiCells& cells, double merge) {
  constexpr double rounding = 1e-9;  // between the cells that see one vertex
  merge = std::max(merge, rounding);
  const std::vector<Sighting> found = sightings(packing, cells);
  const auto n = static_cast<std::uint32_t>(found.size());
  const Boundary boundary(packing.container);
  CellGrid grid;
  grid.build(boundary, std::max(merge, 1e-3), n, [&](std::uint32_t k) { return found[k].centre; });
  std::vector<bool> taken(n, false);
  std::vector<Pore> all;
  std::vector<std::uint32_t> cluster, owners;
  for (std::uint32_t k = 0; k < n; ++k) {
    if (taken[k]) continue;
    cluster = {k};
    taken[k] = true;
    for (std::size_t index = 0; index < cluster.size(); ++index) {
      const Vec3 centre = found[cluster[index]].centre;
      grid.for_each_within(centre, merge, [&](std::uint32_t j) {
        if (taken[j]) return;
        if (squared_distance(boundary, centre, found[j].centre) > merge * merge) return;
        taken[j] = true;
        cluster.push_back(j);
      });
    }
    all.push_back(merged(boundary, cells, found, cluster, owners));
  }
  return all;
}

std::vector<Pore> pores_in(const std::vector<Pore>& all, const Container& container,
                           const Region& region) {
  std::vector<Pore> inside;
  std::ranges::copy_if(all, std::back_inserter(inside),
                       [&](const Pore& pore) { return region.contains(container, pore.centre); });
  return inside;
}

std::vector<Pore> pores_of_spheres_in(const std::vector<Pore>& all, const Packing& packing,
                                      const Region& region) {
  const auto is_inside = [&](std::uint32_t sphere) {
    return region.contains(packing.container, packing.centres[sphere]);
  };
  std::vector<Pore> inside;
  std::ranges::copy_if(all, std::back_inserter(inside), [&](const Pore& pore) {
    return std::ranges::all_of(pore.owners, is_inside);
  });
  return inside;
}

Site site_of(const Pore& pore, double tolerance) {
  const double tetrahedral = std::sqrt(1.5) - 1, octahedral = std::numbers::sqrt2 - 1;
  if (std::abs(xi_of(pore) - tetrahedral) <= tolerance) return Site::tetrahedral;
  if (std::abs(xi_of(pore) - octahedral) <= tolerance) return Site::octahedral;
  return Site::irregular;
}

PoreDistribution pore_distribution(std::span<const Pore> pores, double bin_width, double xi_max) {
  assert(bin_width > 0 && xi_max > 0);
  const auto n_bins = static_cast<std::size_t>(std::ceil(xi_max / bin_width));
  PoreDistribution density;
  density.rho_xi.assign(n_bins, 0);
  for (const Pore& pore : pores) {
    const double bin = xi_of(pore) / bin_width;
    if (bin >= 0 && bin < static_cast<double>(n_bins)) {
      density.rho_xi[static_cast<std::size_t>(bin)] += 1 / bin_width;
    }
  }
  for (std::size_t b = 0; b < n_bins; ++b) {
    const double xi = (static_cast<double>(b) + 0.5) * bin_width;
    density.xi.push_back(xi);
    density.rho_v.push_back(density.rho_xi[b] / (3 * xi * xi));
    density.v_rho_v.push_back(density.rho_xi[b] * xi / 3);
  }
  return density;
}

double mean_pore_volume(std::span<const Pore> pores) {
  double sum = 0;
  for (const Pore& pore : pores) sum += xi_of(pore) * xi_of(pore) * xi_of(pore);
  return sum / static_cast<double>(pores.size());
}

VoidProbability void_probability(const Packing& packing, const Region& region,
                                 std::span<const double> sigma, std::uint64_t points,
                                 StreamKey key) {
  VoidProbability result;
  result.sigma.assign(sigma.begin(), sigma.end());
  std::vector<RandomSpheres> larger;  // than the packing's
  for (const double s : sigma) {
    if (s > 1) larger.push_back({s * sphere_radius});
  }
  draw_spheres(packing, region, points, key, larger);
  auto drawn = larger.begin();
  for (const double s : sigma) {
    if (s <= 1) {
      result.probability.push_back(1 - filled_part(packing, region, s));
      result.error.push_back(0);
      continue;
    }
    const auto n = static_cast<double>(drawn->counted);
    const double p = n > 0 ? static_cast<double>(drawn->empty) / n : not_a_number;
    result.probability.push_back(p);
    result.error.push_back(std::sqrt(p * (1 - p) / n));
    ++drawn;
  }
  return result;
}

double gotoh_void_probability(double phi, double sigma) {
  const double cube = sigma * sigma * sigma;
  if (sigma <= 1) return 1 - phi * cube;
  const double exponent = phi / ((1 - phi) * (1 - phi)) *
                          (-(1 + 2 * phi) * cube + 4.5 * phi * sigma * sigma + 1 - 2.5 * phi);
  return (1 - phi) * std::exp(exponent);
}

}  // namespace jostle::inline structure
