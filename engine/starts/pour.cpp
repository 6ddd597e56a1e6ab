#include <string>

#include "engine/bed/boundary.hpp"
#include "engine/starts/parts.hpp"
#include "engine/starts/pour_bed.hpp"
#include "engine/starts/pour_descent.hpp"

namespace jostle::inline engine {

namespace {

Vec3 draw_drop(const PourBed& bed, RandomStream& random) {
  // A tube takes pi / 4 of the draws: a thousand misses in a row are beyond chance.
  for (int draw = 0; draw < 1000; ++draw) {
    const double share_x = random.uniform(), share_y = random.uniform();
    if (const auto p = bed.above(share_x, share_y)) return *p;
  }
  throw StartError("steepest-descent pour: no place to drop a sphere from; widen the container");
}

}  // namespace

Vec3 pour_one(const PourBed& bed, std::uint32_t sphere, RandomStream& random, PourTally* tally) {
  constexpr int max_redraws = 1000;
  for (int draw = 0; draw < max_redraws; ++draw) {
    if (const auto rest = descend(bed, draw_drop(bed, random))) return *rest;
    if (tally != nullptr) ++tally->redrawn;
  }
  throw StartError("steepest-descent pour: sphere " + std::to_string(sphere) +
                   " found no place to rest in " + std::to_string(max_redraws) +
                   " drops; change the seed or the width by a little");
}

std::vector<Vec3> pour(const Container& container, std::uint32_t n_spheres, RandomStream& random,
                       const StopAsked& stop, PourTally* tally) {
  PourBed bed(container, n_spheres);
  for (std::uint32_t sphere = 0; sphere < n_spheres; ++sphere) {
    throw_if_stopped(stop);
    bed.add(pour_one(bed, sphere, random, tally));
  }
  return bed.centres();
}

}  // namespace jostle::inline engine
