#include "structure/forces.hpp"

#include <cassert>
#include <cmath>

#include "engine/bed/boundary.hpp"
#include "engine/numbers.hpp"
#include "structure/snapshot_statistics.hpp"

namespace jostle::inline structure {

namespace {

void add(ForceMoment& moment, double arm, const Contact& contact) {
  const Vec3 force = contact.normal_force * contact.normal + contact.tangential_force;
  const double arms[] = {arm * contact.normal.x, arm * contact.normal.y, arm * contact.normal.z};
  const double forces[] = {force.x, force.y, force.z};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) moment[3 * a + b] += arms[a] * forces[b];
}

double radius_of(const Sizes* sizes, std::uint32_t sphere) {
  return sizes != nullptr ? sizes->radius(sphere) : sphere_radius;
}

/// How far the bodies of a contact would be apart if they just touched: of two spheres their
/// centres, of a sphere and a wall its centre from the wall.
double reach_of(const Contact& contact, std::uint32_t n_spheres, const Sizes* sizes) {
  const bool is_wall = contact.second >= n_spheres;
  return radius_of(sizes, contact.first) + (is_wall ? 0 : radius_of(sizes, contact.second));
}

}  // namespace

BedForces bed_forces(const Packing& packing, std::span<const Contact> contacts) {
  const auto n = static_cast<std::uint32_t>(packing.centres.size());
  BedForces forces{{}, std::vector<WallForce>(wall_names(packing.container).size())};
  for (const Contact& contact : contacts) {
    add(forces.moment, reach_of(contact, n, packing.sizes.get()) - contact.overlap, contact);
    if (contact.second < n) continue;
    WallForce& wall = forces.walls.at(contact.second - n);
    wall.normal += contact.normal_force;
    wall.friction = wall.friction + contact.tangential_force;
  }
  return forces;
}

std::vector<ForceMoment> force_moments(std::span<const Contact> contacts, std::uint32_t n_spheres,
                                       const Sizes* sizes) {
  std::vector<ForceMoment> moments(n_spheres, ForceMoment{});
  for (const Contact& contact : contacts) {
    // On the other sphere acts the opposite force with the opposite arm: the same moment.
    const double reach = reach_of(contact, n_spheres, sizes);
    const double share = (reach - contact.overlap) / reach;  // share of each radius
    add(moments.at(contact.first), share * radius_of(sizes, contact.first), contact);
    if (contact.second < n_spheres)
      add(moments.at(contact.second), share * radius_of(sizes, contact.second), contact);
  }
  return moments;
}

GranularTemperature granular_temperature(const Packing& packing, std::span<const Vec3> velocities,
                                         double bin_width) {
  assert(velocities.size() == packing.centres.size());
  struct Bin {
    double n = 0;
    Vec3 mean;
    double lateral = 0, vertical = 0;
  };
  std::vector<Bin> bins(n_height_bins(packing, bin_width));
  const auto bin_of = [&](std::size_t i) -> Bin& {
    return bins[static_cast<std::size_t>(packing.centres[i].z / bin_width)];
  };
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    Bin& bin = bin_of(i);
    bin.n += 1;
    bin.mean = bin.mean + velocities[i];
  }
  for (Bin& bin : bins)
    if (bin.n > 0) bin.mean = (1 / bin.n) * bin.mean;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    Bin& bin = bin_of(i);
    const Vec3 centre = velocities[i] - bin.mean;
    bin.lateral += 0.5 * (centre.x * centre.x + centre.y * centre.y);
    bin.vertical += centre.z * centre.z;
  }
  while (!bins.empty() && bins.back().n < 2) bins.pop_back();
  GranularTemperature temperature;
  for (const Bin& bin : bins) {
    temperature.lateral.push_back(bin.n < 2 ? not_a_number : bin.lateral / (bin.n - 1));
    temperature.vertical.push_back(bin.n < 2 ? not_a_number : bin.vertical / (bin.n - 1));
  }
  return temperature;
}

}  // namespace jostle::inline structure
