#include <algorithm>
#include <cmath>
#include <string>

#include "engine/starts/moving_spheres.hpp"
#include "engine/starts/parts.hpp"

namespace jostle::inline engine {

namespace {

// Spheres of unequal diameters, at most 1, in a fully periodic box.
class GrowingSpheres {
 public:
  GrowingSpheres(const FullyPeriodicBox& box, std::vector<Vec3> centres)
      : spheres_(box, std::move(centres)), diameters_(spheres_.centres().size(), 0) {}

  // One random step of a sphere, taken if it opens no overlap; then it grows into the room it has,
  // up to `limit`.
  void step_and_grow(std::uint32_t sphere, double max_step, double limit, RandomStream& random) {
    const double dx = max_step * (1 - 2 * random.uniform());
    const double dy = max_step * (1 - 2 * random.uniform());
    const double dz = max_step * (1 - 2 * random.uniform());
    const Vec3 from = spheres_.centres()[sphere];
    const Vec3 to = wrapped(spheres_.box(), {from.x + dx, from.y + dy, from.z + dz});
    const double there = spheres_.in_reach(sphere, to) ? room(sphere, to) : 0;
    if (there >= diameters_[sphere]) {
      spheres_.move(sphere, to);
      ++accepted_;
      grow(sphere, std::min(there, limit));
    } else if (diameters_[sphere] < limit) {
      grow(sphere, std::min(room(sphere, from), limit));
    }
  }

  void renew_lists() { spheres_.renew(); }
  std::uint32_t full_grown() const { return full_grown_; }
  double least_diameter() const { return *std::min_element(diameters_.begin(), diameters_.end()); }
  std::uint64_t accepted() const { return accepted_; }
  const std::vector<Vec3>& centres() const { return spheres_.centres(); }

 private:
  // The largest diameter, up to 1, that a sphere could have at r.
  double room(std::uint32_t sphere, Vec3 r) const {
    double largest = 1;
    for (const std::uint32_t other : spheres_.near(sphere)) {
      const double squared = spheres_.squared_distance(r, other);
      const double full = 0.5 * (1 + diameters_[other]);
      if (squared >= full * full) continue;
      largest = std::min(largest, 2 * std::sqrt(squared) - diameters_[other]);
      if (largest < diameters_[sphere]) break;
    }
    return largest;
  }

  void grow(std::uint32_t sphere, double diameter) {
    if (diameter <= diameters_[sphere]) return;
    diameters_[sphere] = diameter;
    if (diameter == 1) ++full_grown_;
  }

  MovingSpheres<FullyPeriodicBox> spheres_;
  std::vector<double> diameters_;
  std::uint32_t full_grown_ = 0;
  std::uint64_t accepted_ = 0;
};

// The largest diameter allowed while the smallest is `least`: unequal spheres grow fast but jam
// early, nearly equal ones grow slowly and reach the densities asked for.
double growth_limit(double least) {
  constexpr double first = 0.1;  // diameter up to which every sphere may grow at once
  const double spread = std::clamp(0.05 * (1 - least), 0.001, 0.05);
  return std::clamp((1 + spread) * least, first, 1.0);
}

}  // namespace

std::vector<Vec3> grow(const Grow& start, const FullyPeriodicBox& box, std::uint32_t n_spheres,
                       RandomStream& random, const StopAsked& stop) {
  const double volume = box.width_x * box.width_y * box.height;
  const double fraction = n_spheres * sphere_volume / volume;
  std::vector<Vec3> points;
  for (std::uint32_t sphere = 0; sphere < n_spheres; ++sphere) {
    const double x = box.width_x * random.uniform(), y = box.width_y * random.uniform();
    points.push_back(wrapped(box, {x, y, box.height * random.uniform()}));
  }
  GrowingSpheres spheres(box, std::move(points));
  constexpr std::uint64_t renewal = 20;  // sweeps
  constexpr double longest_step = 0.1;
  double max_step = longest_step;
  for (std::uint64_t sweep = 0; sweep < start.max_sweeps && spheres.full_grown() < n_spheres;
       ++sweep) {
    throw_if_stopped(stop);
    const double limit = growth_limit(spheres.least_diameter());
    if (sweep % renewal == 0) spheres.renew_lists();
    const std::uint64_t accepted = spheres.accepted();
    for (std::uint32_t trial = 0; trial < n_spheres; ++trial) {
      spheres.step_and_grow(static_cast<std::uint32_t>(random.below(n_spheres)), max_step, limit,
                            random);
    }
    const bool rarely = 10 * (spheres.accepted() - accepted) < 3 * std::uint64_t{n_spheres};
    max_step = std::clamp(max_step * (rarely ? 0.95 : 1.05), 1e-4, longest_step);
  }
  if (spheres.full_grown() < n_spheres) {
    throw StartError("grow: " + std::to_string(n_spheres - spheres.full_grown()) + " of " +
                     std::to_string(n_spheres) + " spheres did not reach diameter 1 in " +
                     std::to_string(start.max_sweeps) +
                     " sweeps; raise max_sweeps or lower the solids fraction (" +
                     std::to_string(fraction) + ")");
  }
  return spheres.centres();
}

}  // namespace jostle::inline engine
