#include "engine/bed/sphere_cells.hpp"

#include <algorithm>

namespace jostle {

SphereCells::Axis SphereCells::axis(double width, double side, bool periodic) {
  const double cells = std::max(1.0, std::floor(width / side));
  return {width, cells / width, static_cast<long>(cells), periodic};
}

SphereCells::SphereCells(const Container& container, std::uint32_t n_spheres, double height)
    : open_top_(has_gravity(container)) {
  const auto* fluid = std::get_if<FullyPeriodicBox>(&container);
  const bool periodic = fluid != nullptr || std::holds_alternative<PeriodicBox>(container);
  if (fluid != nullptr) height = fluid->height;
  const auto cells = [&](double side) {
    return std::max(1.0, width_x(container) / side) * std::max(1.0, width_y(container) / side) *
           std::max(1.0, height / side);
  };
  double side = 1;
  while (cells(side) > 1000 + 8.0 * n_spheres) side *= 1.5;
  x_ = axis(width_x(container), side, periodic);
  y_ = axis(width_y(container), side, periodic);
  z_ = fluid != nullptr ? axis(height, side, true) : Axis{0, 1 / side, 1, false};
  heads_.assign(static_cast<std::size_t>(x_.cells * y_.cells * z_.cells), -1);
}

long SphereCells::Axis::cell_of(double x) const {
  return std::clamp(raw_cell(x), 0L, cells - 1);
}

SphereCells::Range SphereCells::Axis::range(double low, double high) const {
  if (periodic) return {raw_cell(low), raw_cell(high)};
  return {std::clamp(raw_cell(low), 0L, cells - 1), std::clamp(raw_cell(high), 0L, cells - 1)};
}

SphereCells::Image SphereCells::Axis::image(long raw) const {
  if (!periodic || (raw >= 0 && raw < cells)) return {raw, 0};
  const long period = raw >= 0 ? raw / cells : -((cells - 1 - raw) / cells);
  return {raw - period * cells, static_cast<double>(period) * width};
}

std::size_t SphereCells::cell_of(Vec3 centre) const {
  return static_cast<std::size_t>(
      (z_.cell_of(centre.z) * y_.cells + y_.cell_of(centre.y)) * x_.cells + x_.cell_of(centre.x));
}

void SphereCells::make_room(double z) {
  if (!open_top_ || z_.raw_cell(z) < z_.cells) return;
  z_.cells = z_.raw_cell(z) + 1;
  heads_.resize(static_cast<std::size_t>(x_.cells * y_.cells * z_.cells), -1);
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
  const std::size_t from = cell_of(centres_[sphere]);
  centres_[sphere] = centre;
  if (cell_of(centre) == from) return;
  std::int32_t* place = &heads_[from];
  while (*place != static_cast<std::int32_t>(sphere)) {
    place = &next_[static_cast<std::size_t>(*place)];
  }
  *place = next_[sphere];
  link(sphere);
}

}  // namespace jostle
