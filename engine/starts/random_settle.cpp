#include <algorithm>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/cells/sphere_cells.hpp"
#include "engine/starts/parts.hpp"

namespace jostle::inline engine {

namespace {

/// Spheres that were placed, the largest first, in one set of cells per factor of two in size.
class PlacedSpheres {
 public:
  PlacedSpheres(Packing& packing, double height)
      : packing_(packing), boundary_(packing.container), height_(height) {}

  bool fits(std::uint32_t sphere, Vec3 r) const {
    const double radius = packing_.radius(sphere);
    if (!clear_of_boundaries(boundary_, r, radius)) return false;
    return std::ranges::none_of(classes_, [&](const SizeClass& c) {
      const double reach = radius + c.largest_radius + 1e-9;
      return c.cells.any_near(r, reach, [&](std::uint32_t place, Vec3) {
        const std::uint32_t neighbour = c.spheres[place];
        return overlaps(boundary_, r, packing_.centres[neighbour],
                        radius + packing_.radius(neighbour));
      });
    });
  }

  void place(std::uint32_t sphere, Vec3 r) {
    const double radius = packing_.radius(sphere);
    if (classes_.empty() || radius <= 0.5 * classes_.back().largest_radius) {
      const auto n = static_cast<std::uint32_t>(packing_.centres.size());
      classes_.push_back({radius, SphereCells(packing_.container, n, height_, 2 * radius), {}});
    }
    packing_.centres[sphere] = r;
    classes_.back().cells.insert(r);
    classes_.back().spheres.push_back(sphere);
  }

 private:
  struct SizeClass {
    double largest_radius;
    SphereCells cells;
    std::vector<std::uint32_t> spheres;  // by their place in the cells
  };

  Packing& packing_;
  Boundary boundary_;
  double height_;
  std::vector<SizeClass> classes_;
};

std::vector<std::uint32_t> largest_first(const StartSpheres& spheres) {
  std::vector<std::uint32_t> order(spheres.n);
  std::iota(order.begin(), order.end(), 0u);
  if (spheres.sizes)
    std::ranges::stable_sort(order, std::greater{},
                             [&](std::uint32_t i) { return spheres.sizes->radius(i); });
  return order;
}

}  // namespace

// The largest spheres are placed first, when there is most room.
std::optional<std::string> RandomSettle::container_fault(const Container& container) const {
  return gravity_fault(container);
}

std::vector<Vec3> RandomSettle::place(const Placing& placing) const {
  const Container& container = placing.container;
  const StartSpheres& spheres = placing.spheres;
  RandomStream& random = placing.random;
  constexpr int max_draws =
      2'000'000;  // most draws for one sphere; at 0.36 the last take 70 000 each
  const Boundary boundary(container);
  if (!(dilute_fraction > 0 && dilute_fraction <= densest_dilution)) {
    throw StartError("random settle: dilute_fraction is " + std::to_string(dilute_fraction) +
                     ", but non-overlapping random places are found only above 0 and up to " +
                     std::to_string(densest_dilution));
  }
  if (!(drop_height >= 0 && drop_height <= highest_drop)) {
    throw StartError("random settle: drop_height is " + std::to_string(drop_height) +
                     ", but a column's foot is 0 to " + std::to_string(highest_drop) +
                     " diameters above the floor");
  }
  Packing packing{container, std::vector<Vec3>(spheres.n), spheres.sizes};
  const double height = solid_volume(packing) / (footprint_area(container) * dilute_fraction);
  PlacedSpheres placed_spheres(packing, drop_height + height);
  for (const std::uint32_t sphere : largest_first(spheres)) {
    const double radius = packing.radius(sphere);
    const double margin_x = boundary.periodic_x ? 0 : radius;
    const double margin_y = boundary.periodic_y ? 0 : radius;
    bool placed = false;
    for (int draw = 0; draw < max_draws && !placed; ++draw) {
      const double x = margin_x + random.uniform() * (boundary.width_x - 2 * margin_x);
      const double y = margin_y + random.uniform() * (boundary.width_y - 2 * margin_y);
      const double z = radius + drop_height + random.uniform() * height;
      const Vec3 p = wrapped(boundary, {x, y, z});
      placed = placed_spheres.fits(sphere, p);
      if (placed) placed_spheres.place(sphere, p);
    }
    if (!placed) {
      throw StartError("random settle: no free place for sphere " + std::to_string(sphere) +
                       " of " + std::to_string(spheres.n) + " in " + std::to_string(max_draws) +
                       " draws, the container is too narrow for this packing fraction; lower "
                       "dilute_fraction (now " +
                       std::to_string(dilute_fraction) + ")");
    }
  }
  return packing.centres;
}

}  // namespace jostle::inline engine
