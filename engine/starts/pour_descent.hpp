#pragma once

#include <optional>
#include <vector>

#include "engine/starts/pour_bed.hpp"

namespace jostle::inline engine {

/// Follows one sphere's centre down the steepest descent, from p to rest: it falls, rolls on one
/// sphere, then on two, along walls where it meets them, and stops where what it touches holds it
/// on every side, or on the floor. At each moment it moves along the projection of the downward
/// vertical on the directions that its contacts leave open. Philippe & Bideau 2001, sec. II.
/// Returns the resting centre, wrapped and not overlapping by more than 1e-12 diameters; nothing if
/// the path was degenerate or had too many turns. From an unstable balance (exactly on a ridge or a
/// top, as happens where two spheres and the wall they touch carry a third) it tips over.
std::optional<Vec3> descend(const PourBed& bed, Vec3 p);

/// A horizontal direction in which a centre that touches obstacles can move, given the unit vectors
/// out of them; nothing if they hold it on every side.
std::optional<Vec3> open_direction(const std::vector<Vec3>& outwards);

}  // namespace jostle::inline engine
