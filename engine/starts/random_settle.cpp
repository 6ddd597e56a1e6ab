#include <algorithm>
#include <string>

#include "engine/bed/boundary.hpp"
#include "engine/bed/sphere_cells.hpp"
#include "engine/starts/parts.hpp"

namespace jostle::inline engine {

std::vector<Vec3> scatter(const RandomSettle& settle, const Container& container,
                          std::uint32_t n_spheres, RandomStream& random) {
  constexpr int max_draws = 2'000'000;  // of one sphere; at 0.36 the last take 70 000 each
  const Boundary boundary(container);
  if (!(settle.dilute_fraction > 0 && settle.dilute_fraction <= densest_dilution)) {
    throw StartError("random settle: dilute_fraction is " + std::to_string(settle.dilute_fraction) +
                     ", but non-overlapping random places are found only above 0 and up to " +
                     std::to_string(densest_dilution));
  }
  if (!(settle.drop_height >= 0 && settle.drop_height <= highest_drop)) {
    throw StartError("random settle: drop_height is " + std::to_string(settle.drop_height) +
                     ", but a column's foot is 0 to " + std::to_string(highest_drop) +
                     " diameters above the floor");
  }
  const double height =
      n_spheres * sphere_volume / (footprint_area(container) * settle.dilute_fraction);
  const double margin_x = boundary.margin_x(), margin_y = boundary.margin_y();
  const double room_x = boundary.width_x - 2 * margin_x, room_y = boundary.width_y - 2 * margin_y;
  SphereCells cells(container, n_spheres, settle.drop_height + height);
  const auto fits = [&](Vec3 p) {
    return clear_of_boundaries(boundary, p) &&
           !cells.any_near(p, 1 + 1e-9, [&](std::uint32_t other, Vec3) {
             return overlaps(boundary, p, cells.centres()[other]);
           });
  };
  for (std::uint32_t sphere = 0; sphere < n_spheres; ++sphere) {
    bool placed = false;
    for (int draw = 0; draw < max_draws && !placed; ++draw) {
      const double x = margin_x + random.uniform() * room_x;
      const double y = margin_y + random.uniform() * room_y;
      const double z = sphere_radius + settle.drop_height + random.uniform() * height;
      const Vec3 p = wrapped(boundary, {x, y, z});
      placed = fits(p);
      if (placed) cells.insert(p);
    }
    if (!placed) {
      throw StartError("random settle: no free place for sphere " + std::to_string(sphere) +
                       " of " + std::to_string(n_spheres) + " in " + std::to_string(max_draws) +
                       " draws, the container is too narrow for this solids fraction; lower "
                       "dilute_fraction (now " +
                       std::to_string(settle.dilute_fraction) + ")");
    }
  }
  return cells.centres();
}

}  // namespace jostle::inline engine
