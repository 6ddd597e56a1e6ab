#pragma once

#include <cstddef>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/packing.hpp"
#include "engine/bed/window.hpp"
#include "structure/order/accessible.hpp"

namespace jostle::inline structure {

/// The shortest period of a box; infinite where it has none.
double narrowest_period(const Boundary& boundary);

/// Central spheres by the radius up to which their shells lie in the accessible region (minus
/// sampling: Ripley 1981, Spatial Statistics, sec. 8.1). Spheres crowd at sides and floor: numbers
/// of neighbours are unbiased only around spheres that need no part of a shell made up.
class WholeShells {
 public:
  /// `central`: heights of the central spheres; `accessible`: heights where centres may lie, which
  /// count for nothing in a box that is periodic upwards.
  WholeShells(const Packing& packing, const AccessibleFootprint& footprint, HeightWindow central,
              HeightWindow accessible);

  /// Radius up to which the shells of a centre are whole; infinite where nothing cuts them.
  double room(Vec3 centre) const;
  /// Number of central spheres whose shells are whole up to r.
  std::size_t count(double r) const;
  /// Number of central spheres whose shells neither floor nor surface cuts up to r.
  std::size_t count_upright(double r) const;
  /// Radius up to which shells have room between the sides; infinite without sides.
  double widest() const { return widest_; }
  /// True if a shell of this radius is whole nowhere between the sides.
  bool exceeds_sides(double r) const;
  /// True if a shell up to this radius exceeds half a period.
  bool exceeds_half_period(double high) const;

 private:
  double upright_room(double z) const;

  AccessibleFootprint footprint_;
  HeightWindow accessible_;
  bool periodic_z_;
  double half_period_, widest_;
  std::vector<double> rooms_, upright_rooms_;  // ascending
};

}  // namespace jostle::inline structure
