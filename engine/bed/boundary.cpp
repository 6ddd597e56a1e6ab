#include "engine/bed/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace jostle::inline engine {

namespace {

double into_period(double x, double width) {
  if (x >= 0 && x < width) return x;
  return wrap_coordinate(x - std::floor(x / width) * width, width);
}

}  // namespace

Boundary::Boundary(const Container& container) {
  std::visit([this](const auto& box) { static_cast<ContainerShape&>(*this) = box.shape(); },
             container);
  const Vec3 extent = jostle::extent(container);
  width_x = extent.x;
  width_y = extent.y;
  if (periodic_z) height = extent.z;
}

double Face::recession(Vec3 r, Vec3 v) const {
  if (!is_tube) return dot(inward, v);
  const double x = r.x - place, y = r.y - place;
  const double from_axis = std::sqrt(x * x + y * y);
  return from_axis > 0 ? -((x * v.x + y * v.y) / from_axis) : 0;
}

Faces::Faces(const Boundary& boundary) {
  if (boundary.has_floor()) add({"floor", {0, 0, 1}});
  if (boundary.planes_x()) {
    add({"x_min", {1, 0, 0}});
    add({"x_max", {-1, 0, 0}, boundary.width_x});
  }
  if (boundary.planes_y()) {
    add({"y_min", {0, 1, 0}});
    add({"y_max", {0, -1, 0}, boundary.width_y});
  }
  if (boundary.tube) add({"tube", {}, boundary.axis(), true});
}

double footprint_area(const Boundary& boundary, double from_sides) {
  if (boundary.tube) {
    const double across = std::max(0.0, boundary.width_x - 2 * from_sides);
    return 0.25 * std::numbers::pi * (across * across);
  }
  const auto inner = [&](double width, bool planes) {
    return planes ? std::max(0.0, width - 2 * from_sides) : width;
  };
  return inner(boundary.width_x, boundary.planes_x()) *
         inner(boundary.width_y, boundary.planes_y());
}

bool in_footprint(const Boundary& boundary, Vec3 r, double from_sides) {
  if (boundary.tube) {
    const double reach = boundary.axis() - from_sides;
    const double x = r.x - boundary.axis(), y = r.y - boundary.axis();
    return reach >= 0 && x * x + y * y <= reach * reach;
  }
  const auto inside = [&](double coordinate, double width) {
    return coordinate >= from_sides && coordinate <= width - from_sides;
  };
  return (!boundary.planes_x() || inside(r.x, boundary.width_x)) &&
         (!boundary.planes_y() || inside(r.y, boundary.width_y));
}

Vec3 into_periods(const Boundary& boundary, Vec3 r) {
  if (boundary.periodic_x) r.x = into_period(r.x, boundary.width_x);
  if (boundary.periodic_y) r.y = into_period(r.y, boundary.width_y);
  if (boundary.periodic_z) r.z = into_period(r.z, boundary.height);
  return r;
}

double boundary_depth(const Boundary& boundary, Vec3 r) {
  const auto beyond = [](double coordinate, double width) {
    return std::max(sphere_radius - coordinate, coordinate - (width - sphere_radius));
  };
  if (boundary.tube) {
    const double dx = r.x - boundary.axis(), dy = r.y - boundary.axis();
    return std::max(sphere_radius - r.z,
                    std::sqrt(dx * dx + dy * dy) - (boundary.axis() - sphere_radius));
  }
  double depth = boundary.has_floor() ? sphere_radius - r.z : 0;
  if (boundary.planes_x()) depth = std::max(depth, beyond(r.x, boundary.width_x));
  if (boundary.planes_y()) depth = std::max(depth, beyond(r.y, boundary.width_y));
  return depth;
}

std::vector<std::string> wall_names(const Container& container) {
  std::vector<std::string> names;
  for (const Face& face : Faces(Boundary(container))) names.emplace_back(face.name);
  return names;
}

}  // namespace jostle::inline engine
