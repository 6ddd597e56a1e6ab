#include "engine/bed/cells/sphere_cells.hpp"

#include <algorithm>

namespace jostle::inline engine {

SphereCells::SphereCells(const Container& container, std::uint32_t n_spheres, double height,
                         double least_side)
    : open_top_(Boundary(container).has_floor()) {
  const Boundary boundary(container);
  if (!open_top_) height = boundary.height;
  const auto cells = [&](double side) {
    return std::max(1.0, boundary.width_x / side) * std::max(1.0, boundary.width_y / side) *
           std::max(1.0, height / side);
  };
  double side = least_side;
  while (cells(side) > most_cells(n_spheres)) side *= 1.5;
  const Vec3 periods = boundary.periods();
  x_ = CellAxis::divide(0, boundary.width_x, periods.x, side);
  y_ = CellAxis::divide(0, boundary.width_y, periods.y, side);
  z_ = CellAxis::divide(0, open_top_ ? side : height, periods.z, side);
  heads_.assign(static_cast<std::size_t>(x_.count) * y_.count * z_.count, -1);
}

std::size_t SphereCells::cell_of(Vec3 centre) const {
  return (static_cast<std::size_t>(z_.own_cell(centre.z)) * y_.count + y_.own_cell(centre.y)) *
             x_.count +
         x_.own_cell(centre.x);
}

void SphereCells::make_room(double z) {
  if (!open_top_ || z_.cell(z) < z_.count) return;
  z_.count = static_cast<int>(z_.cell(z)) + 1;  // more of the same width
  heads_.resize(static_cast<std::size_t>(x_.count) * y_.count * z_.count, -1);
}

void SphereCells::link(std::uint32_t sphere) {
  std::int32_t& head = heads_[cell_of(centres_[sphere])];
  next_[sphere] = head;
  head = static_cast<std::int32_t>(sphere);
}

std::uint32_t SphereCells::insert(Vec3 centre) {
  make_room(centre.z);
  const auto sphere = static_cast<std::uint32_t>(centres_.size());
  centres_.push_back(centre);
  next_.push_back(-1);
  link(sphere);
  return sphere;
}

void SphereCells::move(std::uint32_t sphere, Vec3 centre) {
  make_room(centre.z);
  const std::size_t old_cell = cell_of(centres_[sphere]);
  centres_[sphere] = centre;
  if (cell_of(centre) == old_cell) return;
  std::int32_t* place = &heads_[old_cell];
  while (*place != static_cast<std::int32_t>(sphere)) {
    place = &next_[static_cast<std::size_t>(*place)];
  }
  *place = next_[sphere];
  link(sphere);
}

}  // namespace jostle::inline engine
