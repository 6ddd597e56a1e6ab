#include "engine/starts/starts.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "engine/starts/parts.hpp"

namespace jostle::inline engine {

namespace {

struct Builder {
  const Container& container;
  std::uint32_t n_spheres;
  RandomStream& random;
  const StopAsked& stop;
  Packing* before_fitting;

  std::vector<Vec3> operator()(const SteepestDescentPour&) const {
    return pour(container, n_spheres, random, stop);
  }
  std::vector<Vec3> operator()(const FittedPour&) const {
    const PeriodicBox sides{width_x(container), width_y(container)};
    std::vector<Vec3> poured = pour(sides, n_spheres, random, stop);
    if (before_fitting != nullptr) *before_fitting = {sides, poured};
    return fit_pour(container, std::move(poured), random, stop);
  }
  std::vector<Vec3> operator()(const RandomSettle& start) const {
    return scatter(start, container, n_spheres, random);
  }
  std::vector<Vec3> operator()(const Crystal& start) const {
    return build_crystal(start, container, n_spheres);
  }
  std::vector<Vec3> operator()(const Grow& start) const {
    return grow(start, std::get<FullyPeriodicBox>(container), n_spheres, random, stop);
  }
  std::vector<Vec3> operator()(const GivenPacking& start) const {
    return check_given(start, container, n_spheres);
  }
};

/// Whether spheres may move before tap 0.
struct MayMove {
  bool operator()(const SteepestDescentPour&) const { return false; }
  bool operator()(const FittedPour&) const { return true; }
  bool operator()(const RandomSettle&) const { return true; }
  bool operator()(const Crystal&) const { return false; }
  bool operator()(const Grow&) const { return false; }
  bool operator()(const GivenPacking&) const { return false; }
};

struct StartFault {
  const Container& container;

  using Fault = std::optional<std::string>;
  Fault needs_gravity() const {
    if (has_gravity(container)) return std::nullopt;
    return "a fully_periodic container has neither floor nor gravity: start it with grow, with a "
           "crystal or from a file";
  }
  Fault operator()(const SteepestDescentPour&) const { return needs_gravity(); }
  Fault operator()(const RandomSettle&) const { return needs_gravity(); }
  Fault operator()(const FittedPour&) const {
    if (const auto fault = needs_gravity()) return fault;
    const Boundary boundary(container);
    if (!boundary.planes_x() && !boundary.planes_y()) {
      return "a fitted pour is fitted between walls: it needs the sides \"walls\" (elsewhere take "
             "\"steepest_descent\")";
    }
    const auto fault = width_fault(PeriodicBox{width_x(container), width_y(container)});
    if (!fault) return std::nullopt;
    return "the pour before the fitting needs periodic sides, and their " + *fault +
           " (widen the box or take \"steepest_descent\")";
  }
  Fault operator()(const Crystal& crystal) const {
    const Boundary boundary(container);
    if (boundary.periodic_x || boundary.periodic_y || !crystal.stretch) return std::nullopt;
    return "stretch spaces rows out to a period, and there is none between walls: leave it out or "
           "use periodic sides";
  }
  Fault operator()(const Grow&) const {
    if (!has_gravity(container)) return std::nullopt;
    return "spheres grow in a fully_periodic container only: elsewhere pour them";
  }
  Fault operator()(const GivenPacking&) const { return std::nullopt; }
};

}  // namespace

std::optional<std::string> start_fault(const Start& start, const Container& container) {
  return std::visit(StartFault{container}, start);
}

std::optional<std::string> n_spheres_fault(const Start& start, const Container& container,
                                           std::uint32_t n_spheres) {
  if (n_spheres == 0) return "no spheres are asked for: ask for at least one";
  const auto* box = std::get_if<FullyPeriodicBox>(&container);
  if (box == nullptr || !std::holds_alternative<Grow>(start)) return std::nullopt;
  const double volume = box->width_x * box->width_y * box->height;
  const double fraction = n_spheres * sphere_volume / volume;
  if (fraction <= densest_growth) return std::nullopt;
  char text[160];
  std::snprintf(text, sizeof text,
                "%u spheres fill %.4f of the box: growing without order ends at %g, that is %.0f "
                "spheres",
                n_spheres, fraction, densest_growth,
                std::floor(densest_growth * volume / sphere_volume));
  return text;
}

std::optional<std::string> settling_fault(const Start& start) {
  if (std::visit(MayMove{}, start)) return std::nullopt;
  return "this start is at rest from the beginning: only random_settle and a fitted pour can be "
         "relaxed before tap 0";
}

Packing make_start(const Start& start, const Container& container, std::uint32_t n_spheres,
                   RandomStream& random, const StopAsked& stop, Packing* before_fitting) {
  for (const auto& fault : {width_fault(container), start_fault(start, container),
                            n_spheres_fault(start, container, n_spheres)}) {
    if (fault) throw StartError("start: " + *fault);
  }
  const Builder build{container, n_spheres, random, stop, before_fitting};
  return {container, std::visit(build, start)};
}

}  // namespace jostle::inline engine
