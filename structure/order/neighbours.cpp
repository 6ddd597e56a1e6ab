#include "structure/order/neighbours.hpp"

#include <cassert>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "engine/bed/boundary.hpp"

namespace jostle::inline structure {
namespace {

constexpr double first_nearest_cut = 1.5;

bool nearer(const Neighbour& a, const Neighbour& b) {
  if (a.distance_squared != b.distance_squared) return a.distance_squared < b.distance_squared;
  return a.sphere < b.sphere;
}

// Beyond it no further centre is found, nor a nearest image.
double farthest_reach(const Packing& packing) {
  const Boundary boundary(packing.container);
  return boundary.width_x + boundary.width_y +
         (boundary.periodic_z ? boundary.height : top_height(packing));
}

}  // namespace

NeighbourFinder::NeighbourFinder(const Packing& packing, double cut)
    : cut_squared_(cut * cut), reach_(cut * (1 + 1e-9) + 1e-9) {
  assert(cut > 0);
  const std::vector<Vec3>& centres = packing.centres;
  const auto n = static_cast<std::uint32_t>(centres.size());
  const Boundary boundary(packing.container);
  const Vec3 period = boundary.periods();
  double low = 0, height = period.z;
  if (period.z == 0 && n > 0) {
    const auto [lowest, highest] = std::minmax_element(
        centres.begin(), centres.end(), [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
    low = lowest->z;
    height = highest->z - low;
  }
  height = std::max(height, 1e-3);
  // Small cells exclude most spheres beyond the cut, if each still holds about a sphere.
  double side = std::max(0.8, cut / 3);
  do {
    x_ = CellAxis::divide(0, boundary.width_x, period.x, side);
    y_ = CellAxis::divide(0, boundary.width_y, period.y, side);
    z_ = CellAxis::divide(low, height, period.z, side);
    side *= 1.5;
  } while (1.0 * x_.count * y_.count * z_.count > most_cells(n));

  std::vector<std::size_t> cell_of(n);
  starts_.assign(static_cast<std::size_t>(x_.count) * y_.count * z_.count + 1, 0);
  for (std::uint32_t i = 0; i < n; ++i) {
    const Vec3 r = centres[i];
    cell_of[i] =
        (static_cast<std::size_t>(z_.own_cell(r.z)) * y_.count + y_.own_cell(r.y)) * x_.count +
        x_.own_cell(r.x);
    ++starts_[cell_of[i] + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  centres_.resize(n);
  spheres_.resize(n);
  place_of_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t place = next[cell_of[i]]++;
    centres_[place] = centres[i];
    spheres_[place] = i;
    place_of_[i] = place;
  }
}

NeighbourTable neighbours_within(const Packing& packing, double cut) {
  const NeighbourFinder finder(packing, cut);
  NeighbourTable table;
  table.first.reserve(packing.centres.size() + 1);
  table.first.push_back(0);
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    finder.visit_neighbours(i, [&](std::uint32_t j, Vec3 way, double distance_squared) {
      table.neighbours.push_back({j, way, distance_squared});
    });
    std::sort(table.neighbours.begin() + table.first.back(), table.neighbours.end(), nearer);
    table.first.push_back(static_cast<std::uint32_t>(table.neighbours.size()));
  }
  return table;
}

NeighbourTable neighbours_within_contacts(const Packing& packing, double cut) {
  if (!packing.sizes) return neighbours_within(packing, cut);
  const NeighbourFinder finder(packing, reach_of_cut(packing, cut));
  NeighbourTable table;
  table.first.push_back(0);
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    finder.visit_neighbours(i, [&](std::uint32_t j, Vec3 way, double distance_squared) {
      const double scaled = distance_squared / contact_squared(packing, i, j);
      if (scaled <= cut * cut) table.neighbours.push_back({j, way, scaled});
    });
    std::sort(table.neighbours.begin() + table.first.back(), table.neighbours.end(), nearer);
    table.first.push_back(static_cast<std::uint32_t>(table.neighbours.size()));
  }
  return table;
}

namespace {

/// Leaves out images of centre i, and images beyond 1.5 of a centre that has a nearer one: they
/// repeat what is there, and few spheres would be surrounded by the lattice of the periods.
void keep_centres(std::uint32_t i, std::vector<Neighbour>& near) {
  constexpr double adjacent_squared = first_nearest_cut * first_nearest_cut;
  std::erase_if(near, [&](const Neighbour& neighbour) { return neighbour.sphere == i; });
  std::ranges::sort(near, nearer);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < near.size(); ++k) {
    const bool adjacent = near[k].distance_squared <= adjacent_squared;
    const auto is_same = [&](const Neighbour& neighbour) {
      return neighbour.sphere == near[k].sphere;
    };
    if (adjacent ||
        std::none_of(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(kept), is_same)) {
      near[kept++] = near[k];
    }
  }
  near.resize(kept);
}

/// Beyond so many periods centres are looked at one by one: a search within a distance would meet
/// hundreds of images of each.
constexpr double most_periods = 4;

/// The images that keep_centres() leaves of all images of all centres.
void add_nearest_images(const Packing& packing, const Boundary& boundary,
                        const NeighbourFinder& adjacent, std::uint32_t i,
                        std::vector<Neighbour>& near) {
  std::vector<bool> is_adjacent(packing.centres.size());
  adjacent.visit_neighbours(i, [&](std::uint32_t j, Vec3 way, double distance_squared) {
    near.push_back({j, way, distance_squared});
    is_adjacent[j] = true;
  });
  for (std::uint32_t j = 0; j < packing.centres.size(); ++j) {
    if (j == i || is_adjacent[j]) continue;
    const Vec3 way = separation(boundary, packing.centres[j], packing.centres[i]);
    near.push_back({j, way, norm_squared(way)});
  }
}

}  // namespace

NeighbourTable nearest_neighbours(const Packing& packing, std::uint32_t count) {
  const auto n = static_cast<std::uint32_t>(packing.centres.size());
  std::vector<Neighbour> found(static_cast<std::size_t>(n) * count);
  std::vector<std::uint32_t> lengths(n, 0), waiting(n);
  std::iota(waiting.begin(), waiting.end(), 0U);
  const double farthest = farthest_reach(packing);
  std::vector<Neighbour> near;
  const Boundary boundary(packing.container);
  const NeighbourFinder adjacent(packing, first_nearest_cut);
  const Vec3 periods = boundary.periods();
  const double longest_period = std::max({periods.x, periods.y, periods.z});
  // Periods are wider than 2: within the first cut centre i meets no image of its own.
  for (double cut = first_nearest_cut; !waiting.empty() && count > 0; cut *= 1.4) {
    const NeighbourFinder finder(packing, cut);
    std::vector<std::uint32_t> short_of;
    for (const std::uint32_t i : waiting) {
      near.clear();
      const bool meets_all = longest_period > 0 && cut > most_periods * longest_period;
      if (meets_all) {
        add_nearest_images(packing, boundary, adjacent, i, near);
      } else {
        finder.visit_neighbours(i, [&](std::uint32_t j, Vec3 way, double distance_squared) {
          near.push_back({j, way, distance_squared});
        });
        if (cut > first_nearest_cut) keep_centres(i, near);
      }
      if (near.size() < count && cut < farthest && !meets_all) {
        short_of.push_back(i);
        continue;
      }
      lengths[i] = std::min(count, static_cast<std::uint32_t>(near.size()));
      std::partial_sort(near.begin(), near.begin() + lengths[i], near.end(), nearer);
      std::copy_n(near.begin(), lengths[i], found.begin() + static_cast<std::ptrdiff_t>(i) * count);
    }
    waiting.swap(short_of);
  }
  NeighbourTable table;
  table.first = {0};
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto row = found.begin() + static_cast<std::ptrdiff_t>(i) * count;
    table.neighbours.insert(table.neighbours.end(), row, row + lengths[i]);
    table.first.push_back(static_cast<std::uint32_t>(table.neighbours.size()));
  }
  return table;
}

// Voronoi cells of centres that all but coincide are lost in rounding, and beds have contacts.
void require_diameters(const Packing& packing) {
  constexpr double least = 0.5, most = 1.5;
  constexpr std::uint32_t large_number = 100;
  const NeighbourFinder finder(packing, reach_of_cut(packing, most));
  bool any = finder.size() < large_number;
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    finder.visit_neighbours(i, [&](std::uint32_t j, Vec3, double distance_squared) {
      const double contact = contact_squared(packing, i, j);
      if (distance_squared > most * most * contact) return;
      any = true;
      if (distance_squared >= least * least * contact) return;
      throw std::invalid_argument(
          "spheres " + std::to_string(i) + " and " + std::to_string(j) + " are " +
          std::to_string(std::sqrt(distance_squared)) + " apart, and their " +
          (packing.sizes ? "radii sum to " + std::to_string(std::sqrt(contact)) : "diameter is 1") +
          ": lengths must be in diameters");
    });
  }
  if (!any) {
    throw std::invalid_argument(
        packing.sizes
            ? "no two spheres are less than 1.5 times the sum of their radii apart: lengths must "
              "be in diameters"
            : "no two spheres are less than 1.5 apart, and their diameter is 1: lengths must be in "
              "diameters");
  }
}

}  // namespace jostle::inline structure
