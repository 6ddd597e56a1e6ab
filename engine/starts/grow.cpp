#include <algorithm>
#include <cmath>
#include <string>

#include "engine/starts/moving_spheres.hpp"
#include "engine/starts/parts.hpp"

namespace jostle::inline engine {

namespace {

// Spheres in a fully periodic box, each with a growth of its own: the share of its diameter that it
// has reached, at most 1.
class GrowingSpheres {
 public:
  GrowingSpheres(const FullyPeriodicBox& box, Packing packing)
      : spheres_(box, std::move(packing)), growths_(spheres_.centres().size(), 0) {}

  // One random step of a sphere, taken if it opens no overlap; then it grows into the room it has,
  // up to `limit`.
  void step_and_grow(std::uint32_t sphere, double max_step, double limit, RandomStream& random) {
    const double dx = max_step * (1 - 2 * random.uniform());
    const double dy = max_step * (1 - 2 * random.uniform());
    const double dz = max_step * (1 - 2 * random.uniform());
    const Vec3 start = spheres_.centres()[sphere];
    const Vec3 end = wrapped(spheres_.box(), {start.x + dx, start.y + dy, start.z + dz});
    const double free_room = spheres_.in_reach(sphere, end) ? room(sphere, end) : 0;
    if (free_room >= growths_[sphere]) {
      spheres_.move(sphere, end);
      ++accepted_;
      grow(sphere, std::min(free_room, limit));
    } else if (growths_[sphere] < limit) {
      grow(sphere, std::min(room(sphere, start), limit));
    }
  }

  void renew_lists() { spheres_.renew(); }
  std::uint32_t full_grown() const { return full_grown_; }
  double least_growth() const { return *std::min_element(growths_.begin(), growths_.end()); }
  double shortest_diameter() const { return spheres_.shortest_diameter(); }
  std::uint64_t accepted() const { return accepted_; }
  const std::vector<Vec3>& centres() const { return spheres_.centres(); }

 private:
  // The largest growth, up to 1, that a sphere could have at r.
  double room(std::uint32_t sphere, Vec3 r) const {
    double largest = 1;
    const double own = spheres_.diameter(sphere);
    for (const std::uint32_t neighbour : spheres_.near(sphere)) {
      const double squared = spheres_.squared_distance(r, neighbour);
      const double diameter = growths_[neighbour] * spheres_.diameter(neighbour);
      const double full = 0.5 * (own + diameter);
      if (squared >= full * full) continue;
      largest = std::min(largest, (2 * std::sqrt(squared) - diameter) / own);
      if (largest < growths_[sphere]) break;
    }
    return largest;
  }

  void grow(std::uint32_t sphere, double growth) {
    if (growth <= growths_[sphere]) return;
    growths_[sphere] = growth;
    if (growth == 1) ++full_grown_;
  }

  MovingSpheres<FullyPeriodicBox> spheres_;
  std::vector<double> growths_;
  std::uint32_t full_grown_ = 0;
  std::uint64_t accepted_ = 0;
};

// The largest growth allowed while the smallest is `least`: unequal growths are fast but jam early,
// nearly equal ones are slow and reach the densities asked for.
double growth_limit(double least) {
  constexpr double first = 0.1;  // growth that every sphere may reach at once
  const double spread = std::clamp(0.05 * (1 - least), 0.001, 0.05);
  return std::clamp((1 + spread) * least, first, 1.0);
}

}  // namespace

std::optional<std::string> Grow::container_fault(const Container& container) const {
  if (!has_gravity(container)) return std::nullopt;
  return "spheres grow in a fully_periodic container only: elsewhere pour them";
}

std::vector<Vec3> Grow::place(const Placing& placing) const {
  const auto& box = std::get<FullyPeriodicBox>(placing.container);
  const std::uint32_t n_spheres = placing.spheres.n;
  RandomStream& random = placing.random;
  std::vector<Vec3> points;
  for (std::uint32_t sphere = 0; sphere < n_spheres; ++sphere) {
    const double x = box.width_x * random.uniform(), y = box.width_y * random.uniform();
    points.push_back(wrapped(box, {x, y, box.height * random.uniform()}));
  }
  Packing packing{box, std::move(points), placing.spheres.sizes};
  const double fraction = solid_volume(packing) / (box.width_x * box.width_y * box.height);
  GrowingSpheres spheres(box, std::move(packing));
  constexpr std::uint64_t renewal = 20;  // sweeps
  const double longest_step = 0.1 * spheres.shortest_diameter();
  const double shortest_step = 1e-4 * spheres.shortest_diameter();
  double max_step = longest_step;
  for (std::uint64_t sweep = 0; sweep < max_sweeps && spheres.full_grown() < n_spheres; ++sweep) {
    throw_if_stopped(placing.stop);
    const double limit = growth_limit(spheres.least_growth());
    if (sweep % renewal == 0) spheres.renew_lists();
    const std::uint64_t accepted = spheres.accepted();
    for (std::uint32_t trial = 0; trial < n_spheres; ++trial) {
      spheres.step_and_grow(static_cast<std::uint32_t>(random.integer_below(n_spheres)), max_step,
                            limit, random);
    }
    const bool rarely = 10 * (spheres.accepted() - accepted) < 3 * std::uint64_t{n_spheres};
    max_step = std::clamp(max_step * (rarely ? 0.95 : 1.05), shortest_step, longest_step);
  }
  if (spheres.full_grown() < n_spheres) {
    throw StartError("grow: " + std::to_string(n_spheres - spheres.full_grown()) + " of " +
                     std::to_string(n_spheres) + " spheres did not reach " +
                     (placing.spheres.sizes ? "their diameter" : "diameter 1") + " in " +
                     std::to_string(max_sweeps) +
                     " sweeps; raise max_sweeps or lower the packing fraction (" +
                     std::to_string(fraction) + ")");
  }
  return spheres.centres();
}

}  // namespace jostle::inline engine
