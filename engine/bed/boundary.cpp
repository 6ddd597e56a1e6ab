#include "engine/bed/boundary.hpp"

#include <algorithm>
#include <cmath>

namespace jostle::inline engine {

namespace {

struct Fill {
  Boundary& boundary;

  void operator()(const PeriodicBox& box) const {
    boundary.periodic_x = boundary.periodic_y = true;
    boundary.width_x = box.width_x;
    boundary.width_y = box.width_y;
  }
  void operator()(const WalledBox& box) const {
    boundary.sides = Sides::walls;
    boundary.width_x = box.width_x;
    boundary.width_y = box.width_y;
  }
  void operator()(const Cylinder& tube) const {
    boundary.sides = Sides::cylinder;
    boundary.width_x = boundary.width_y = tube.diameter;
  }
  void operator()(const FullyPeriodicBox& box) const {
    boundary.periodic_x = boundary.periodic_y = boundary.periodic_z = true;
    boundary.floor = false;
    boundary.width_x = box.width_x;
    boundary.width_y = box.width_y;
    boundary.height = box.height;
  }
};

double into_period(double x, double width) {
  if (x >= 0 && x < width) return x;
  return wrap_coordinate(x - std::floor(x / width) * width, width);
}

}  // namespace

Vec3 into_periods(const Boundary& boundary, Vec3 r) {
  if (boundary.periodic_x) r.x = into_period(r.x, boundary.width_x);
  if (boundary.periodic_y) r.y = into_period(r.y, boundary.width_y);
  if (boundary.periodic_z) r.z = into_period(r.z, boundary.height);
  return r;
}

Boundary::Boundary(const Container& container) {
  std::visit(Fill{*this}, container);
}

bool clear_of_boundaries(const Boundary& boundary, Vec3 r) {
  if (boundary.floor && !(r.z >= sphere_radius)) return false;
  switch (boundary.sides) {
    case Sides::none:
      return true;
    case Sides::walls:
      return r.x >= sphere_radius && r.x <= boundary.width_x - sphere_radius &&
             r.y >= sphere_radius && r.y <= boundary.width_y - sphere_radius;
    case Sides::cylinder:
      break;
  }
  const double dx = r.x - boundary.axis(), dy = r.y - boundary.axis();
  const double reach = boundary.axis() - sphere_radius;
  return dx * dx + dy * dy <= reach * reach;
}

double boundary_depth(const Boundary& boundary, Vec3 r) {
  const double below = boundary.floor ? sphere_radius - r.z : 0;
  switch (boundary.sides) {
    case Sides::none:
      return below;
    case Sides::walls:
      return std::max({below, sphere_radius - r.x, r.x - (boundary.width_x - sphere_radius),
                       sphere_radius - r.y, r.y - (boundary.width_y - sphere_radius)});
    case Sides::cylinder:
      break;
  }
  const double dx = r.x - boundary.axis(), dy = r.y - boundary.axis();
  return std::max(below, std::sqrt(dx * dx + dy * dy) - (boundary.axis() - sphere_radius));
}

}  // namespace jostle::inline engine
