#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/bed/boundary.hpp"
#include "structure/density/profile_parts.hpp"
#include "structure/density/profiles.hpp"
#include "structure/density/sphere_cuts.hpp"

namespace jostle::inline structure {

namespace {

[[noreturn]] void refuse_reach(double reach) {
  throw std::invalid_argument("profile: walls less than twice " + std::to_string(reach) +
                              " diameters apart leave nothing central; take a smaller reach");
}

}  // namespace

Profile radial_profile(const Packing& packing, std::span<const double> edges, HeightWindow window) {
  const Boundary boundary(packing.container);
  if (!boundary.tube) {
    throw std::invalid_argument("profile: distances from the axis need a cylinder");
  }
  require_window(window);
  const double axis = boundary.axis(), depth = window.high - window.low;
  Profile profile = empty_profile(edges, 0, axis, [&](double distance) {
    return std::numbers::pi * distance * distance * depth;
  });
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3 centre = packing.centres[i];
    const double own_radius = packing.radius(i), d = 2 * own_radius;
    const double low = (window.low - centre.z) / d, high = (window.high - centre.z) / d;
    if (low >= sphere_radius || high <= -sphere_radius) continue;
    const double dx = centre.x - axis, dy = centre.y - axis;
    const double offset = std::sqrt(dx * dx + dy * dy);
    // A sphere over the axis reaches all around it, from 0.
    share_out(profile, offset - own_radius, offset + own_radius, [&](double edge) {
      return d * d * d * sphere_volume_in_tube(offset / d, std::max(0.0, edge) / d, low, high);
    });
  }
  divide_by_volumes(profile);
  return profile;
}

LateralCentral lateral_and_central(const Packing& packing, HeightWindow window, double reach) {
  const Boundary boundary(packing.container);
  if (boundary.tube) {
    const double wall = boundary.axis();
    if (!(wall > reach)) refuse_reach(reach);
    const double edges[] = {0, wall - reach, wall};
    const Profile profile = radial_profile(packing, edges, window);
    return {profile.values[1], profile.values[0]};
  }
  std::vector<Axis> axes;
  if (boundary.planes_x()) axes.push_back(Axis::x);
  if (boundary.planes_y()) axes.push_back(Axis::y);
  if (axes.empty())
    throw std::invalid_argument("profile: lateral and central fractions need walls");
  LateralCentral mean;
  const double part = 1.0 / static_cast<double>(axes.size());
  for (const Axis axis : axes) {
    const double width = axis == Axis::x ? boundary.width_x : boundary.width_y;
    if (!(width > 2 * reach)) refuse_reach(reach);
    const double edges[] = {0, reach, width - reach, width};
    const Profile profile = transverse_profile(packing, axis, edges, window);
    mean.lateral += 0.5 * part * (profile.values[0] + profile.values[2]);
    mean.central += part * profile.values[1];
  }
  return mean;
}

}  // namespace jostle::inline structure
