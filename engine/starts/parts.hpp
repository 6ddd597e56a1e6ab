#pragma once

#include <cstdint>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/starts/pour_bed.hpp"
#include "engine/starts/starts.hpp"

// One function for each start. All throw StartError as make_start does, which has asked before for
// the faults of the start, the container and the number of spheres.
namespace jostle::inline engine {

/// Work of a pour. A drop whose path is degenerate is drawn anew.
struct PourTally {
  std::uint64_t redrawn = 0;
};

/// Throws StartStopped once a stop is asked for.
inline void throw_if_stopped(const StopAsked& stop) {
  if (stop && stop()) throw StartStopped();
}

/// Pours the spheres in the order of pour_sequence(): placed ones from their places, each other one
/// from a random place. Throws StartError where a placed sphere does not fit between the sides.
std::vector<Vec3> pour(const Container& container, const StartSpheres& spheres,
                       RandomStream& random, const StopAsked& stop = {},
                       PourTally* tally = nullptr);
/// Where the next sphere comes to rest on the bed. `sphere` names it where it finds no place.
Vec3 pour_one(const PourBed& bed, std::uint32_t sphere, RandomStream& random,
              PourTally* tally = nullptr);
/// A pour with periodic sides, fitted between walls: centres that overlap a wall are taken out and
/// poured again in their order, the others are returned as they are.
std::vector<Vec3> fit_pour(const Container& container, std::vector<Vec3> poured,
                           RandomStream& random, const StopAsked& stop = {});
std::vector<Vec3> scatter(const RandomSettle& settle, const Container& container,
                          const StartSpheres& spheres, RandomStream& random);
std::vector<Vec3> build_crystal(const Crystal& crystal, const Container& container,
                                std::uint32_t n_spheres);
std::vector<Vec3> grow(const Grow& start, const FullyPeriodicBox& box, const StartSpheres& wanted,
                       RandomStream& random, const StopAsked& stop = {});
std::vector<Vec3> check_given(const GivenPacking& given, const Container& container,
                              const StartSpheres& spheres);

}  // namespace jostle::inline engine
