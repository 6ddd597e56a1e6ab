#include <algorithm>
#include <string>

#include "engine/moving_spheres.hpp"
#include "engine/start_parts.hpp"

namespace jostle {

namespace {

// How far a centre's sphere reaches into the four walls, diameters.
double wall_overlap(const WalledBox& box, Vec3 r) {
  const double low_x = sphere_radius - r.x, high_x = r.x - (box.width_x - sphere_radius);
  const double low_y = sphere_radius - r.y, high_y = r.y - (box.width_y - sphere_radius);
  return std::max(low_x, 0.0) + std::max(high_x, 0.0) + std::max(low_y, 0.0) +
         std::max(high_y, 0.0);
}

class WallFitter {
 public:
  WallFitter(const WalledBox& box, const std::vector<Vec3>& poured) : spheres_(box, poured) {
    for (const Vec3& centre : poured) overlapping_ += wall_overlap(box, centre) > 0 ? 1 : 0;
  }

  // One random step of a sphere, taken if it opens no overlap and deepens none with the walls.
  void try_step(std::uint32_t sphere, double max_step, RandomStream& random) {
    const Vec3 from = spheres_.centres()[sphere];
    const double dx = max_step * (1 - 2 * random.uniform());
    const double dy = max_step * (1 - 2 * random.uniform());
    const double dz = max_step * (1 - 2 * random.uniform());
    const Vec3 to = {from.x + dx, from.y + dy, from.z + dz};
    if (to.z < sphere_radius || !spheres_.in_reach(sphere, to)) return;
    const double before = wall_overlap(spheres_.box(), from);
    const double after = wall_overlap(spheres_.box(), to);
    if (after > before) return;
    for (const std::uint32_t other : spheres_.near(sphere)) {
      if (spheres_.squared_distance(to, other) < 1) return;
    }
    spheres_.move(sphere, to);
    if (before > 0 && after == 0) --overlapping_;
  }

  void renew_lists() { spheres_.renew(); }
  std::uint32_t overlapping() const { return overlapping_; }
  const std::vector<Vec3>& centres() const { return spheres_.centres(); }

 private:
  MovingSpheres<WalledBox> spheres_;
  std::uint32_t overlapping_ = 0;
};

}  // namespace

std::vector<Vec3> fit_pour(const FittedPour& fitted, const WalledBox& box, std::uint32_t n_spheres,
                           RandomStream& random, const StopAsked& stop) {
  const PeriodicBox sides{box.width_x, box.width_y};
  if (const auto fault = width_fault(sides)) {
    throw StartError("fitted pour: the pour before the fitting needs periodic sides, and their " +
                     *fault + "; widen the box or use a steepest-descent pour");
  }
  if (!(fitted.max_step > 0 && fitted.max_step <= 1)) {
    throw StartError("fitted pour: max_step is " + std::to_string(fitted.max_step) +
                     "; choose one in (0, 1] diameters");
  }
  WallFitter fitter(box, pour(sides, n_spheres, random, stop));
  constexpr std::uint64_t renewal = 50;  // sweeps
  for (std::uint64_t sweep = 0; sweep < fitted.max_sweeps && fitter.overlapping() > 0; ++sweep) {
    heed(stop);
    if (sweep % renewal == 0) fitter.renew_lists();
    for (std::uint32_t trial = 0; trial < n_spheres; ++trial) {
      fitter.try_step(static_cast<std::uint32_t>(random.below(n_spheres)), fitted.max_step, random);
    }
  }
  if (fitter.overlapping() > 0) {
    throw StartError("fitted pour: " + std::to_string(fitter.overlapping()) + " of " +
                     std::to_string(n_spheres) + " spheres still overlap the walls after " +
                     std::to_string(fitted.max_sweeps) +
                     " sweeps; raise max_sweeps, change max_step, or use a steepest-descent pour");
  }
  return fitter.centres();
}

}  // namespace jostle
