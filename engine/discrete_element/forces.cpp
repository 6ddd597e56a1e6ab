#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/discrete_element/grain_loop.hpp"

namespace jostle::inline engine {

namespace {

Vec3 force_of(const ActionRow& action) {
  return {action.force_x, action.force_y, action.force_z};
}

// Splits what acts on the first body.
void set_force(Contact& contact, const Vec3& force, bool friction) {
  contact.normal_force = dot(force, contact.normal);
  if (friction) contact.tangential_force = force - contact.normal_force * contact.normal;
}

bool has_force(const Contact& contact) {
  return contact.overlap > 0 && contact.normal_force != 0;
}

}  // namespace

BedMechanics GrainLoop::mechanics() const {
  GrainLoop next = *this;  // forces take up histories: this loop keeps its own
  next.find_forces();
  BedMechanics out;
  next.add_contacts(out.contacts);
  next.add_velocities(out);
  return out;
}

void GrainLoop::add_contacts(std::vector<Contact>& out) {
  const auto n = static_cast<std::uint32_t>(n_spheres());
  const ContactArrays pairs = lists_.pairs(), floor = lists_.floor(), sides = lists_.sides();
  for (std::size_t at = 0; at < lists_.n_near(); ++at) {
    const std::uint32_t a = pairs.first[at], b = pairs.second[at];
    const Vec3 shift = {pairs.shift[0][at], pairs.shift[1][at], 0};
    const Vec3 between = centre_of(rows_[a]) - centre_of(rows_[b]) - shift;
    const double distance = std::sqrt(norm_squared(between));
    Contact contact{.first = numbers_[a],
                    .second = numbers_[b],
                    .overlap = radius_of(numbers_[a]) + radius_of(numbers_[b]) - distance,
                    .normal = (1 / distance) * between};
    set_force(contact, force_of(pairs.action[at]), kernels_.has_spin);
    if (has_force(contact)) out.push_back(contact);
  }
  const auto add_walls = [&](const ContactArrays& with, auto&& number_of) {
    // The padding of the last block belongs to no sphere.
    for (std::size_t at = 0; at < with.n && with.first[at] < n; ++at) {
      Contact contact{.first = numbers_[with.first[at]],
                      .second = n + number_of(at),
                      .overlap = radius_of(numbers_[with.first[at]]) - with.side[3][at],
                      .normal = {with.side[0][at], with.side[1][at], with.side[2][at]}};
      set_force(contact, force_of(with.action[at]), kernels_.has_spin);
      if (has_force(contact)) out.push_back(contact);
    }
  };
  add_walls(floor, [](std::size_t) { return 0u; });
  add_walls(sides, [&](std::size_t at) { return lists_.side_numbers()[at]; });
  std::ranges::sort(out, {}, [](const Contact& one) { return std::tuple(one.first, one.second); });
}

// Sums as the kernels do, in the order of each sphere's slots.
void GrainLoop::add_velocities(BedMechanics& out) {
  const SphereArrays all = spheres();
  const std::vector<GrainState> before = grains();
  const double half_step = 0.5 * settings_.time_step;
  out.velocities.resize(n_spheres());
  if (kernels_.has_spin) out.spins.resize(n_spheres());
  for (std::uint32_t at = 0; at < n_spheres(); ++at) {
    const std::uint32_t number = numbers_[at];
    const double per_mass = 1 / mass_of(number);
    Vec3 force = {0, 0, -settings_.gravity * mass_of(number)}, torque;
    for (std::uint32_t s = all.begin[at]; s < all.begin[at + 1]; ++s) {
      const ActionRow& action = all.action[all.slot[s] >> 1];
      const double sign = (all.slot[s] & 1) != 0 ? -1 : 1;
      force = force + sign * force_of(action);
      torque = torque + Vec3{action.torque_x, action.torque_y, action.torque_z};
    }
    out.velocities[number] = before[number].velocity + half_step * per_mass * force;
    if (!kernels_.has_spin) continue;
    if (!sizes_) {
      out.spins[number] = before[number].spin + (1 / sphere_inertia) * half_step * torque;
    } else {  // radius x spin, turned by torque / radius
      const Vec3 scaled = before[number].spin + 2.5 * half_step * per_mass * torque;
      out.spins[number] = (1 / radius_of(number)) * scaled;
    }
  }
}

}  // namespace jostle::inline engine
