#include <string>
#include <utility>

#include "engine/bed/geometry.hpp"
#include "engine/starts/parts.hpp"
#include "engine/starts/pour_bed.hpp"

namespace jostle::inline engine {

namespace {

/// Pours the centres that overlap a wall again, in their order. No other sphere moves, even if it
/// lost a support that straddled a wall.
std::vector<Vec3> fit_pour(const Container& container, std::vector<Vec3> poured,
                           RandomStream& random, const StopAsked& stop) {
  const auto n_spheres = static_cast<std::uint32_t>(poured.size());
  const Boundary boundary(container);
  PourBed bed(container, n_spheres);
  std::vector<std::uint32_t> misfits;
  for (std::uint32_t sphere = 0; sphere < n_spheres; ++sphere) {
    if (clear_of_boundaries(boundary, poured[sphere])) {
      bed.add(poured[sphere]);
    } else {
      misfits.push_back(sphere);
    }
  }
  for (const std::uint32_t sphere : misfits) {
    throw_if_stopped(stop);
    poured[sphere] = pour_one(bed, sphere, random);
    bed.add(poured[sphere]);
  }
  return poured;
}

}  // namespace

std::optional<std::string> FittedPour::container_fault(const Container& container) const {
  if (auto fault = gravity_fault(container)) return fault;
  const Boundary boundary(container);
  if (!boundary.planes_x() && !boundary.planes_y()) {
    return "a fitted pour is fitted between walls, and the sides \"" + name_of(container) +
           "\" have no plane walls: take \"steepest_descent\"";
  }
  const auto fault = width_fault(PeriodicBox{width_x(container), width_y(container)});
  if (!fault) return std::nullopt;
  return "the pour before the fitting needs periodic sides, and their " + *fault +
         " (widen the box or take \"steepest_descent\")";
}

std::vector<Vec3> FittedPour::place(const Placing& placing) const {
  const Container sides = PeriodicBox{width_x(placing.container), width_y(placing.container)};
  const StartSpheres equal_spheres{placing.spheres.n};
  std::vector<Vec3> poured = pour({sides, equal_spheres, placing.random, placing.stop});
  if (placing.before_fitting != nullptr) *placing.before_fitting = {sides, poured};
  return fit_pour(placing.container, std::move(poured), placing.random, placing.stop);
}

}  // namespace jostle::inline engine
