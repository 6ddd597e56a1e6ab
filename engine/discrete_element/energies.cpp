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

// Of Walton & Braun's spring: how far it is stretched beyond what stays, on the line of K2.
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
  double elastic = 0, latched = 0;
};

// What a contact stores and has latched; one that a displacement has opened until it is erased.
HeldByContact held(GrainLaw law, const LawConstants& constants, double overlap,
                   const ContactHistory& history) {
  HeldByContact out;
  if (is_linear(law)) {
    out.elastic = 0.5 * constants.stiffness * squared(std::max(0.0, overlap));
  } else {
    out.elastic = 0.5 * constants.unloading * squared(stretch(constants, overlap, history));
    out.latched =
        0.5 * constants.stiffness * constants.latched * squared(std::max(history[0], overlap));
  }
  if (law == GrainLaw::linear || law == GrainLaw::walton_braun)
    out.elastic += 0.5 / constants.tangential * squared(shear_force(law, history));
  return out;
}

}  // namespace

double GrainLoop::overlap_of(const KeptPair& pair) const {
  const Vec3 periods = boundary_.periods();
  const Vec3 shift = {pair.turns[0] * periods.x, pair.turns[1] * periods.y, 0};
  const auto centre = [&](std::uint32_t number) {
    const Row& row = rows_[place_of_[number]];
    return Vec3{row.of[0], row.of[1], row.of[2]};
  };
  return 1 - std::sqrt(norm_squared(centre(pair.first) - centre(pair.second) - shift));
}

double GrainLoop::overlap_of(const KeptSide& side) const {
  const Row& row = rows_[place_of_[side.sphere]];
  const double x = row.of[0], y = row.of[1];
  if (side.side == 0) return sphere_radius - (row.of[2] - floor_.height);
  if (boundary_.sides == Sides::cylinder)
    return sphere_radius - (boundary_.axis() - std::sqrt(squared(x - boundary_.axis()) +
                                                         squared(y - boundary_.axis())));
  const double distances[] = {x, boundary_.width_x - x, y, boundary_.width_y - y};
  return sphere_radius - distances[side.side - 1];
}

Energies GrainLoop::energies() {
  if (!near_lists_hold()) renew_lists();
  Energies sum;
  sum.kinetic = kinetic_energy();
  sum.floor_work = floor_work_;
  for (const std::uint32_t at : place_of_) {
    sum.potential += settings_.gravity * rows_[at].of[2];
    sum.friction += dissipated_[2 * at];
    sum.latched += dissipated_[2 * at + 1];
  }
  const auto add = [&](const HeldByContact& one) {
    sum.elastic += one.elastic;
    sum.latched += one.latched;
  };
  for (const KeptPair& pair : lists_.near_pairs())
    add(held(settings_.law, settings_.spheres, overlap_of(pair), pair.history));
  for (const KeptSide& side : lists_.near_sides())
    add(held(settings_.law, side.side == 0 ? settings_.floor : settings_.sides, overlap_of(side),
             side.history));
  return sum;
}

ContactCensus GrainLoop::census() {
  if (!near_lists_hold()) renew_lists();
  ContactCensus census;
  double sliding = 0, pairs = 0;
  for (const KeptPair& pair : lists_.near_pairs()) {
    const double overlap = overlap_of(pair);
    const double force = normal_force(settings_.law, settings_.spheres, overlap, pair.history);
    if (!(force > 0)) continue;
    census.contacts += 2;
    census.mean_overlap += overlap;
    ++pairs;
    const double limit = settings_.spheres.friction * force;
    // The force was that of the positions a step before.
    sliding += shear_force(settings_.law, pair.history) >= 0.999 * limit;
  }
  for (const KeptSide& side : lists_.near_sides()) {
    const LawConstants& law = side.side == 0 ? settings_.floor : settings_.sides;
    census.contacts += normal_force(settings_.law, law, overlap_of(side), side.history) > 0;
  }
  census.contacts /= static_cast<double>(n_spheres());
  if (pairs > 0) {
    census.mean_overlap /= pairs;
    census.sliding = settings_.spheres.friction > 0 ? sliding / pairs : 0;
  }
  return census;
}

}  // namespace jostle::inline engine
