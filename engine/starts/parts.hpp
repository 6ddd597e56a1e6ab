#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/starts/pour_bed.hpp"
#include "engine/starts/starts.hpp"

// Functions that several starts call.
namespace jostle::inline engine {

/// Work of a pour. A drop whose path is degenerate is drawn anew.
struct PourTally {
  std::uint64_t redrawn = 0;
};

/// Throws StartStopped once a stop is asked for.
inline void throw_if_stopped(const StopAsked& stop) {
  if (stop && stop()) throw StartStopped();
}

/// Why a start that needs floor and gravity cannot fill the container; nothing if it has both.
std::optional<std::string> gravity_fault(const Container& container);

/// Pours the spheres in the order of pour_sequence(): placed ones from their places, each other one
/// from a random place. Throws StartError where a placed sphere does not fit between the sides.
std::vector<Vec3> pour(const Placing& placing, PourTally* tally = nullptr);
/// Where the next sphere comes to rest on the bed. `sphere` names it where it finds no place.
Vec3 pour_one(const PourBed& bed, std::uint32_t sphere, RandomStream& random,
              PourTally* tally = nullptr);

}  // namespace jostle::inline engine
