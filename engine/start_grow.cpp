#include <algorithm>
#include <cmath>
#include <string>

#include "engine/geometry.hpp"
#include "engine/sphere_cells.hpp"
#include "engine/start_parts.hpp"

namespace jostle {

namespace {

// Spheres of unequal diameters, at most 1, in a fully periodic box.
class GrowingSpheres {
 public:
  GrowingSpheres(const FullyPeriodicBox& box, std::uint32_t n_spheres, RandomStream& random)
      : box_(box), cells_(box, n_spheres, box.height), diameters_(n_spheres, 0) {
    for (std::uint32_t sphere = 0; sphere < n_spheres; ++sphere) {
      const double x = box.width_x * random.uniform(), y = box.width_y * random.uniform();
      cells_.insert(wrapped(box, {x, y, box.height * random.uniform()}));
    }
  }

  // One random step of a sphere, taken if it opens no overlap; then it grows into the room it has,
  // up to `limit`.
  void step_and_grow(std::uint32_t sphere, double max_step, double limit, RandomStream& random) {
    const double dx = max_step * (1 - 2 * random.uniform());
    const double dy = max_step * (1 - 2 * random.uniform());
    const double dz = max_step * (1 - 2 * random.uniform());
    const Vec3 from = cells_.centres()[sphere];
    const Vec3 to = wrapped(box_, {from.x + dx, from.y + dy, from.z + dz});
    const double there = room(sphere, to);
    if (there >= diameters_[sphere]) {
      cells_.move(sphere, to);
      ++accepted_;
      grow(sphere, std::min(there, limit));
    } else if (diameters_[sphere] < limit) {
      grow(sphere, std::min(room(sphere, from), limit));
    }
  }

  std::uint32_t full_grown() const { return full_grown_; }
  double least_diameter() const { return *std::min_element(diameters_.begin(), diameters_.end()); }
  std::uint64_t accepted() const { return accepted_; }
  const std::vector<Vec3>& centres() const { return cells_.centres(); }

 private:
  // The largest diameter, up to 1, that a sphere could have at r.
  double room(std::uint32_t sphere, Vec3 r) const {
    double largest = 1;
    cells_.any_near(r, 1, [&](std::uint32_t other, Vec3) {
      if (other == sphere) return false;
      const double squared = norm_squared(separation(box_, r, cells_.centres()[other]));
      const double full = 0.5 * (1 + diameters_[other]);
      if (squared >= full * full) return false;
      largest = std::min(largest, 2 * std::sqrt(squared) - diameters_[other]);
      return largest < diameters_[sphere];
    });
    return largest;
  }

  void grow(std::uint32_t sphere, double diameter) {
    if (diameter <= diameters_[sphere]) return;
    diameters_[sphere] = diameter;
    if (diameter == 1) ++full_grown_;
  }

  FullyPeriodicBox box_;
  SphereCells cells_;
  std::vector<double> diameters_;
  std::uint32_t full_grown_ = 0;
  std::uint64_t accepted_ = 0;
};

}  // namespace

std::vector<Vec3> grow(const Grow& start, const FullyPeriodicBox& box, std::uint32_t n_spheres,
                       RandomStream& random) {
  constexpr double most_fraction = 0.64;
  constexpr double spread = 1.1;  // a sphere grows to at most this times the smallest
  const double volume = box.width_x * box.width_y * box.height;
  const double fraction = n_spheres * sphere_volume / volume;
  if (fraction > most_fraction) {
    throw StartError("grow: " + std::to_string(n_spheres) + " spheres would fill " +
                     std::to_string(fraction) +
                     " of the box, and random packings end at 0.64; enlarge the box, take fewer "
                     "spheres, or use a crystal");
  }
  GrowingSpheres spheres(box, n_spheres, random);
  double max_step = 0.5;
  for (std::uint64_t sweep = 0; sweep < start.max_sweeps && spheres.full_grown() < n_spheres;
       ++sweep) {
    const double limit = std::min(1.0, std::max(0.1, spread * spheres.least_diameter()));
    const std::uint64_t accepted = spheres.accepted();
    for (std::uint32_t trial = 0; trial < n_spheres; ++trial) {
      spheres.step_and_grow(static_cast<std::uint32_t>(random.below(n_spheres)), max_step, limit,
                            random);
    }
    const bool rarely = 10 * (spheres.accepted() - accepted) < 3 * std::uint64_t{n_spheres};
    max_step = std::clamp(max_step * (rarely ? 0.95 : 1.05), 1e-4, 0.5);
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

}  // namespace jostle
