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
    if (const auto p = bed.drop_point_of_shares(share_x, share_y)) return *p;
  }
  throw StartError("steepest-descent pour: no place to drop a sphere from; widen the container");
}

Vec3 pour_placed(const PourBed& bed, const PlacedSphere& placed) {
  const auto refuse = [&](const std::string& reason) {
    throw StartError("steepest-descent pour: sphere " + std::to_string(placed.sphere) +
                     " has the place (" + std::to_string(placed.x) + ", " +
                     std::to_string(placed.y) + "), " + reason);
  };
  const auto start = bed.drop_point(placed.x, placed.y);
  if (!start) refuse("where it overlaps a side; move it inwards");
  const auto rest = descend(bed, *start);
  if (!rest) refuse("from where it finds no place to rest; change it by a little");
  return *rest;
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

std::vector<Vec3> pour(const Placing& placing, PourTally* tally) {
  const StartSpheres& spheres = placing.spheres;
  PourBed bed = spheres.sizes ? PourBed(placing.container, spheres.sizes)
                              : PourBed(placing.container, spheres.n);
  std::vector<Vec3> centres(spheres.n);
  std::size_t poured = 0;
  for (const std::uint32_t sphere : pour_sequence(spheres, placing.random)) {
    throw_if_stopped(placing.stop);
    bed.next(sphere);
    const std::size_t turn = poured++;
    centres[sphere] = turn < spheres.placed.size() ? pour_placed(bed, spheres.placed[turn])
                                                   : pour_one(bed, sphere, placing.random, tally);
    bed.add(centres[sphere]);
  }
  return centres;
}

std::optional<std::string> SteepestDescentPour::container_fault(const Container& container) const {
  return gravity_fault(container);
}

std::vector<Vec3> SteepestDescentPour::place(const Placing& placing) const {
  return pour(placing);
}

}  // namespace jostle::inline engine
