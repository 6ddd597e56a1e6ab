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
  BedMechanics mechanics;
  next.add_contacts(mechanics.contacts);
  next.add_velocities(mechanics);
  return mechanics;
}

void GrainLoop::add_contacts(std::vector<Contact>& contacts) {
  const auto n = static_cast<std::uint32_t>(n_spheres());
  const ContactArrays pairs = lists_.pairs(), floor = lists_.floor(), sides = lists_.sides();
  for (std::size_t index = 0; index < lists_.n_near(); ++index) {
    const std::uint32_t a = pairs.first[index], b = pairs.second[index];
    const Vec3 shift = {pairs.shift[0][index], pairs.shift[1][index], 0};
    const Vec3 branch = centre_of(rows_[a]) - centre_of(rows_[b]) - shift;
    const double distance = std::sqrt(norm_squared(branch));
    Contact contact{.first = numbers_[a],
                    .second = numbers_[b],
                    .overlap = radius_of(numbers_[a]) + radius_of(numbers_[b]) - distance,
                    .normal = (1 / distance) * branch};
    set_force(contact, force_of(pairs.action[index]), kernels_.has_spin);
    if (has_force(contact)) contacts.push_back(contact);
  }
  const auto add_walls = [&](const ContactArrays& near_walls, auto&& number_of) {
    // The padding of the last block belongs to no sphere.
    for (std::size_t index = 0; index < near_walls.n && near_walls.first[index] < n; ++index) {
      Contact contact{
          .first = numbers_[near_walls.first[index]],
          .second = n + number_of(index),
          .overlap = radius_of(numbers_[near_walls.first[index]]) - near_walls.side[3][index],
          .normal = {near_walls.side[0][index], near_walls.side[1][index],
                     near_walls.side[2][index]}};
      set_force(contact, force_of(near_walls.action[index]), kernels_.has_spin);
      if (has_force(contact)) contacts.push_back(contact);
    }
  };
  add_walls(floor, [](std::size_t) { return 0u; });
  add_walls(sides, [&](std::size_t index) { return lists_.side_numbers()[index]; });
  std::ranges::sort(contacts, {}, [](const Contact& contact) {
    return std::tuple(contact.first, contact.second);
  });
}

// Sums as the kernels do, in the order of each sphere's slots.
void GrainLoop::add_velocities(BedMechanics& mechanics) {
  const SphereArrays all = spheres();
  const std::vector<GrainState> grains_before = grains();
  const double half_step = 0.5 * settings_.time_step;
  mechanics.velocities.resize(n_spheres());
  if (kernels_.has_spin) mechanics.spins.resize(n_spheres());
  for (std::uint32_t index = 0; index < n_spheres(); ++index) {
    const std::uint32_t number = numbers_[index];
    const double per_mass = 1 / mass_of(number);
    Vec3 force = {0, 0, -settings_.gravity * mass_of(number)}, torque;
    for (std::uint32_t s = all.begin[index]; s < all.begin[index + 1]; ++s) {
      const ActionRow& action = all.action[all.slot[s] >> 1];
      const double sign = (all.slot[s] & 1) != 0 ? -1 : 1;
      force = force + sign * force_of(action);
      torque = torque + Vec3{action.torque_x, action.torque_y, action.torque_z};
    }
    mechanics.velocities[number] = grains_before[number].velocity + half_step * per_mass * force;
    if (!kernels_.has_spin) continue;
    if (!sizes_) {
      mechanics.spins[number] =
          grains_before[number].spin + (1 / sphere_inertia) * half_step * torque;
    } else {  // radius x spin, turned by torque / radius
      const Vec3 scaled = grains_before[number].spin + 2.5 * half_step * per_mass * torque;
      mechanics.spins[number] = (1 / radius_of(number)) * scaled;
    }
  }
}

}  // namespace jostle::inline engine
