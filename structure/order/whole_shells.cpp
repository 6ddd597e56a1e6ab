#include "structure/order/whole_shells.hpp"

#include <algorithm>

#include "engine/numbers.hpp"

namespace jostle::inline structure {
namespace {

constexpr double rounding = 1e-9;

std::size_t count_from(const std::vector<double>& ascending, double least) {
  return static_cast<std::size_t>(ascending.end() - std::ranges::lower_bound(ascending, least));
}

}  // namespace

double narrowest_period(const Boundary& boundary) {
  const Vec3 periods = boundary.periods();
  double narrowest = infinite;
  for (const double period : {periods.x, periods.y, periods.z}) {
    if (period > 0) narrowest = std::min(narrowest, period);
  }
  return narrowest;
}

WholeShells::WholeShells(const Packing& packing, const AccessibleFootprint& footprint,
                         HeightWindow central, HeightWindow accessible)
    : footprint_(footprint),
      accessible_(accessible),
      periodic_z_(Boundary(packing.container).periodic_z),
      half_period_(0.5 * narrowest_period(Boundary(packing.container))),
      widest_(footprint.depth(0.5 * width_x(packing.container), 0.5 * width_y(packing.container))) {
  for (const Vec3& r : packing.centres) {
    if (r.z < central.low || r.z > central.high) continue;
    rooms_.push_back(room(r));
    upright_rooms_.push_back(upright_room(r.z));
  }
  std::ranges::sort(rooms_);
  std::ranges::sort(upright_rooms_);
}

double WholeShells::upright_room(double z) const {
  const double room = periodic_z_ ? infinite : std::min(z - accessible_.low, accessible_.high - z);
  return room + rounding;
}

double WholeShells::room(Vec3 centre) const {
  return std::min(footprint_.depth(centre.x, centre.y) + rounding, upright_room(centre.z));
}

std::size_t WholeShells::count(double r) const {
  return count_from(rooms_, r);
}

std::size_t WholeShells::count_upright(double r) const {
  return count_from(upright_rooms_, r);
}

bool WholeShells::exceeds_sides(double r) const {
  return r > widest_ + rounding;
}

bool WholeShells::exceeds_half_period(double high) const {
  return high > half_period_ + rounding;
}

}  // namespace jostle::inline structure
