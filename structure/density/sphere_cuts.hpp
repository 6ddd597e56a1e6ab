#pragma once

#include "engine/bed/container.hpp"
#include "engine/bed/vec3.hpp"

// Volumes that planes and tubes cut from a sphere of diameter 1. Lengths in diameters.
namespace jostle::inline structure {

/// Volume of a sphere centred at the origin beyond two perpendicular planes: x > a, y > b.
/// Closed form, to rounding (about 1e-16).
double sphere_volume_beyond(double a, double b);

/// The volume beyond three perpendicular planes: x > corner.x, y > corner.y, z > corner.z.
double sphere_volume_beyond(Vec3 corner);

/// Volume of a sphere centred at the origin in the box from `low` to `high`, which may reach beyond
/// it. Closed form, to rounding. Requires low <= high in every direction.
double sphere_volume_in_box(Vec3 low, Vec3 high);

/// Area of a disc around the origin between two parallel lines. Requires low <= high, radius >= 0.
double disc_area_in_strip(double radius, double low, double high);

/// Volume of a sphere that a tube of radius `tube`, its axis at the distance `offset` from the
/// sphere's centre, shares with it between two heights beside the centre. The area that circle and
/// circle share is exact; over the height Gauss quadrature, to 1e-9. Requires tube >= 0, offset >=
/// 0, low <= high.
double sphere_volume_in_tube(double offset, double tube, double low, double high);

}  // namespace jostle::inline structure
