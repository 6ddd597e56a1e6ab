#include <algorithm>
#include <cmath>

#include "engine/discrete_element/grain_loop.hpp"

namespace jostle::inline engine {

namespace {

bool is_linear(GrainLaw law) {
  return law == GrainLaw::linear || law == GrainLaw::linear_smooth;
}

double squared(double x) {
  return x * x;
}

// For Walton & Braun's spring: its stretch beyond the permanent overlap, on the line of K2.
double stretch(const LawConstants& constants, double overlap, const ContactHistory& history) {
  return std::max(0.0, overlap - constants.latched * std::max(history[0], overlap));
}

// Without dashpots.
double normal_force(GrainLaw law, const LawConstants& constants, double overlap,
                    const ContactHistory& history) {
  if (!(overlap > 0)) return 0;
  if (is_linear(law)) return constants.stiffness * overlap;
  return constants.unloading * stretch(constants, overlap, history);
}

double shear_force(GrainLaw law, const ContactHistory& history) {
  const int k = is_linear(law) ? 0 : 1;
  return std::sqrt(squared(history[k]) + squared(history[k + 1]) + squared(history[k + 2]));
}

struct HeldByContact {
  double elastic = 0, latched = 0, friction = 0;
};

// A linear contact's tangential spring is cut so that spring and dashpot together pull with mu N,
// and is longer where they slide faster. It can give back what a spring of mu N holds: the rest,
// which the contacts' sums do not have yet, is friction's. One that a displacement has opened holds
// all until it is erased.
void add_shear(HeldByContact& stored, const LawConstants& constants, const Approach& approach,
               double force) {
  double given_back = force;
  if (approach.overlap > 0) {
    const double normal =
        constants.stiffness * approach.overlap - constants.damping * approach.speed;
    given_back = std::min(force, constants.friction * std::abs(normal));
  }
  stored.elastic += 0.5 / constants.tangential * squared(given_back);
  stored.friction += 0.5 / constants.tangential * (squared(force) - squared(given_back));
}

// Energy that a contact stores, has latched and has dissipated by friction beyond the counts of its
// steps; a contact opened by a displacement counts until it is erased.
HeldByContact held(GrainLaw law, const LawConstants& constants, const Approach& approach,
                   const ContactHistory& history) {
  HeldByContact stored;
  if (is_linear(law)) {
    stored.elastic = 0.5 * constants.stiffness * squared(std::max(0.0, approach.overlap));
  } else {
    stored.elastic =
        0.5 * constants.unloading * squared(stretch(constants, approach.overlap, history));
    stored.latched = 0.5 * constants.stiffness * constants.latched *
                     squared(std::max(history[0], approach.overlap));
  }
  const double shear = shear_force(law, history);
  if (law == GrainLaw::linear) add_shear(stored, constants, approach, shear);
  if (law == GrainLaw::walton_braun) stored.elastic += 0.5 / constants.tangential * squared(shear);
  return stored;
}

}  // namespace

Approach GrainLoop::approach_of(const KeptPair& pair) const {
  const SphereRow &first = rows_[place_of_[pair.first]], &second = rows_[place_of_[pair.second]];
  const Vec3 periods = boundary_.periods();
  const Vec3 shift = {pair.turns[0] * periods.x, pair.turns[1] * periods.y, 0};
  const Vec3 branch = centre_of(first) - centre_of(second) - shift;
  const double distance = std::sqrt(norm_squared(branch));
  return {radius_of(pair.first) + radius_of(pair.second) - distance,
          dot(velocity_of(first) - velocity_of(second), branch) / distance};
}

Approach GrainLoop::approach_of(const KeptSide& side) const {
  const SphereRow& row = rows_[place_of_[side.sphere]];
  const Vec3 r = centre_of(row), v = velocity_of(row);
  const double radius = radius_of(side.sphere);
  if (side.side == 0) return {radius - (r.z - floor_.height), v.z - floor_.velocity};
  const Face& face = lists_.faces()[side.side];
  return {radius - face.distance(r), face.recession(r, v)};
}

// Dashpots go with the root of the mass that moves.
LawConstants GrainLoop::constants_of(const KeptPair& pair) const {
  LawConstants constants = settings_.spheres;
  const double a = mass_of(pair.first), b = mass_of(pair.second);
  constants.damping *= std::sqrt(2 * a * b / (a + b));
  return constants;
}

LawConstants GrainLoop::constants_of(const KeptSide& side) const {
  LawConstants constants = side.side == 0 ? settings_.floor : settings_.sides;
  constants.damping *= std::sqrt(mass_of(side.sphere));
  return constants;
}

// Energies that contacts hold and have dissipated, by their histories and the counts of steps.
Energies GrainLoop::contact_energies() const {
  Energies sum;
  for (const std::uint32_t index : place_of_) {
    sum.friction += dissipated_[2 * index];
    sum.latched += dissipated_[2 * index + 1];
  }
  const auto add = [&](const HeldByContact& contact_energy) {
    sum.elastic += contact_energy.elastic;
    sum.latched += contact_energy.latched;
    sum.friction += contact_energy.friction;
  };
  for (const KeptPair& pair : lists_.near_pairs())
    add(held(settings_.law, constants_of(pair), approach_of(pair), pair.history));
  for (const KeptSide& side : lists_.near_sides())
    add(held(settings_.law, constants_of(side), approach_of(side), side.history));
  return sum;
}

// Values found with the forces refer to the time of the positions. Linear springs' histories and
// dashpots refer to half a step later: their mean with those of half a step before is.
Energies GrainLoop::energies() const {
  GrainLoop next = *this;  // forces take up histories: this loop keeps its own
  if (!next.near_lists_hold()) next.renew_lists();
  const Energies energies_before = next.contact_energies();
  next.find_forces();
  Energies now = next.contact_energies();
  const SphereArrays all = next.spheres();
  for (const std::uint32_t index : next.place_of_) {
    for (std::uint32_t s = all.begin[index]; s < all.begin[index + 1]; ++s) {
      const ActionRow& action = all.action[all.slot[s] >> 1];
      now.friction += action.dissipated_by_friction;
      now.latched += action.dissipated_normally;
    }
  }
  if (kernels_.sees_full_step) {
    now.elastic = 0.5 * (energies_before.elastic + now.elastic);
    now.friction = 0.5 * (energies_before.friction + now.friction);
    now.latched = 0.5 * (energies_before.latched + now.latched);
  }
  BedMechanics moving;
  next.add_velocities(moving);
  const auto n = static_cast<std::uint32_t>(n_spheres());
  for (std::uint32_t i = 0; i < n; ++i)
    now.kinetic += 0.5 * mass_of(i) * norm_squared(moving.velocities[i]);
  for (std::uint32_t i = 0; i < moving.spins.size(); ++i) {
    const double radii = 2 * radius_of(i);
    now.kinetic +=
        0.5 * sphere_inertia * mass_of(i) * radii * radii * norm_squared(moving.spins[i]);
  }
  for (std::uint32_t i = 0; i < n; ++i)
    now.potential += settings_.gravity * mass_of(i) * rows_[place_of_[i]].z;
  now.floor_work = next.floor_work_;
  return now;
}

ContactCensus GrainLoop::census() {
  if (!near_lists_hold()) renew_lists();
  ContactCensus census;
  double pairs = 0;
  for (const KeptPair& pair : lists_.near_pairs()) {
    const double overlap = approach_of(pair).overlap;
    const double force = normal_force(settings_.law, settings_.spheres, overlap, pair.history);
    if (!(force > 0)) continue;
    census.contacts += 2;
    census.mean_overlap += overlap / (2 * std::min(radius_of(pair.first), radius_of(pair.second)));
    ++pairs;
  }
  for (const KeptSide& side : lists_.near_sides()) {
    const LawConstants& law = side.side == 0 ? settings_.floor : settings_.sides;
    census.contacts +=
        normal_force(settings_.law, law, approach_of(side).overlap, side.history) > 0;
  }
  census.contacts /= static_cast<double>(n_spheres());
  if (pairs > 0) census.mean_overlap /= pairs;
  if (kernels_.has_spin) census.sliding = sliding_share();
  return census;
}

// Histories hold the tangential forces of a step before: mechanics() has both forces of one time.
double GrainLoop::sliding_share() const {
  constexpr double rounding = 1e-9;
  const double friction = settings_.spheres.friction;
  if (friction == 0) return 0;
  double pairs = 0, sliding = 0;
  for (const Contact& contact : mechanics().contacts) {
    if (contact.second >= n_spheres()) continue;
    const double limit = friction * std::abs(contact.normal_force);
    ++pairs;
    sliding += std::sqrt(norm_squared(contact.tangential_force)) >= (1 - rounding) * limit;
  }
  return pairs > 0 ? sliding / pairs : 0;
}

}  // namespace jostle::inline engine
