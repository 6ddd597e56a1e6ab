#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "structure/density/profile_parts.hpp"
#include "structure/density/profiles.hpp"
#include "structure/density/sphere_cuts.hpp"

namespace jostle::inline structure {

namespace {

// The footprint of a box as the profile along one axis sees it.
struct Footprint {
  double width, depth;  // along the axis, and across it
  bool periodic;
};

Footprint footprint(const Packing& packing, Axis axis) {
  require_floor(packing);
  const Boundary boundary(packing.container);
  if (boundary.tube) {
    throw std::invalid_argument(
        "profile: a cylinder has no sides along x and y; take its radial profile");
  }
  const double x = boundary.width_x, y = boundary.width_y;
  return {axis == Axis::x ? x : y, axis == Axis::x ? y : x,
          axis == Axis::x ? boundary.periodic_x : boundary.periodic_y};
}

Boundary walls_of(const Packing& packing) {
  const Boundary boundary(packing.container);
  if (!boundary.planes_x() && !boundary.planes_y()) {
    throw std::invalid_argument("profile: distances to the nearest wall need plane walls");
  }
  return boundary;
}

// Calls act(place) for the sphere along the axis and, where it reaches through a seam, its image.
template <class Act>
void for_each_image(double place, double own_radius, const Footprint& box, Act&& act) {
  act(place);
  if (!box.periodic) return;
  if (place < own_radius) act(place + box.width);
  if (place > box.width - own_radius) act(place - box.width);
}

double coordinate(Vec3 centre, Axis axis) {
  return axis == Axis::x ? centre.x : centre.y;
}

}  // namespace

Profile transverse_profile(const Packing& packing, Axis axis, std::span<const double> edges,
                           HeightWindow window) {
  const Footprint box = footprint(packing, axis);
  require_window(window);
  const double section = box.depth * (window.high - window.low);
  Profile profile =
      empty_profile(edges, 0, box.width, [&](double place) { return section * place; });
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3 centre = packing.centres[i];
    const double own_radius = packing.radius(i), d = 2 * own_radius;
    const double low = (window.low - centre.z) / d, high = (window.high - centre.z) / d;
    if (low >= sphere_radius || high <= -sphere_radius) continue;
    for_each_image(coordinate(centre, axis), own_radius, box, [&](double place) {
      share_out(profile, place - own_radius, place + own_radius, [&](double edge) {
        // By symmetry the part below the edge is the part beyond its mirror image.
        const double mirrored = (place - edge) / d;
        return d * d * d *
               (sphere_volume_beyond(mirrored, low) - sphere_volume_beyond(mirrored, high));
      });
    });
  }
  divide_by_volumes(profile);
  return profile;
}

Profile mean_transverse_profile(const Packing& packing, std::span<const double> edges,
                                HeightWindow window) {
  if (width_x(packing.container) != width_y(packing.container)) {
    throw std::invalid_argument(
        "profile: the mean over x and y needs a square footprint; take each by itself");
  }
  Profile profile = transverse_profile(packing, Axis::x, edges, window);
  const Profile second = transverse_profile(packing, Axis::y, edges, window);
  for (std::size_t k = 0; k < profile.size(); ++k) {
    profile.values[k] = 0.5 * (profile.values[k] + second.values[k]);
  }
  return profile;
}

std::vector<double> transverse_cuts(const Packing& packing, Axis axis,
                                    std::span<const double> places, HeightWindow window) {
  const Footprint box = footprint(packing, axis);
  require_window(window);
  std::vector<double> fractions;
  fractions.reserve(places.size());
  for (const double place : places) {
    double area = 0;
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
      const Vec3 centre = packing.centres[i];
      const double own_radius = packing.radius(i);
      for_each_image(coordinate(centre, axis), own_radius, box, [&](double image) {
        const double squared = own_radius * own_radius - (image - place) * (image - place);
        if (squared <= 0) return;
        area +=
            disc_area_in_strip(std::sqrt(squared), window.low - centre.z, window.high - centre.z);
      });
    }
    fractions.push_back(area / (box.depth * (window.high - window.low)));
  }
  return fractions;
}

Profile wall_profile(const Packing& packing, std::span<const double> edges, HeightWindow window) {
  const Boundary box = walls_of(packing);
  require_window(window);
  constexpr double beyond =
      1;  // in its diameters from a sphere's middle: contains all of it, also at a seam
  const bool x = box.planes_x(), y = box.planes_y();
  const double deepest = 0.5 * (x && y ? std::min(box.width_x, box.width_y)
                                : x    ? box.width_x
                                       : box.width_y);
  const double depth = window.high - window.low;
  Profile profile = empty_profile(edges, 0, deepest, [&](double distance) {
    return depth * (box.width_x * box.width_y - footprint_area(box, distance));
  });
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3 centre = packing.centres[i];
    const double own_radius = packing.radius(i), d = 2 * own_radius, cube = d * d * d;
    const double low = (window.low - centre.z) / d, high = (window.high - centre.z) / d;
    if (low >= sphere_radius || high <= -sphere_radius) continue;
    const double whole = cube * sphere_volume_in_slab(0, low, high);
    const double distance = std::min(x ? std::min(centre.x, box.width_x - centre.x) : deepest,
                                     y ? std::min(centre.y, box.width_y - centre.y) : deepest);
    share_out(profile, distance - own_radius, distance + own_radius, [&](double edge) {
      const double right = box.width_x - edge, back = box.width_y - edge;
      if ((x && right <= edge) || (y && back <= edge)) return whole;
      return whole - cube * sphere_volume_in_box({x ? (edge - centre.x) / d : -beyond,
                                                  y ? (edge - centre.y) / d : -beyond, low},
                                                 {x ? (right - centre.x) / d : beyond,
                                                  y ? (back - centre.y) / d : beyond, high});
    });
  }
  divide_by_volumes(profile);
  return profile;
}

}  // namespace jostle::inline structure
