#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "engine/bed/packing.hpp"
#include "engine/monte_carlo/moves.hpp"

// The packings that rates are quoted for, made by the program itself: the same bits everywhere.
namespace jostle::bench {

enum class StandardState {
  tapped_bed,  // poured, dilated by 0.02, relaxed by the polar move to eta 1e-5 per 100 sweeps
  lifted_bed,  // poured, lifted by 0.25, relaxed by Metropolis at zero temperature
  dense_60,    // disordered fluid squeezed to a packing fraction of 0.60; Metropolis, 0.1 d
  fluid_55,    // grown to 0.55, 200 sweeps of the same move
  fluid_45,    // the fluid at 0.45
};

inline constexpr std::array all_standard_states = {
    StandardState::tapped_bed, StandardState::lifted_bed, StandardState::dense_60,
    StandardState::fluid_55, StandardState::fluid_45};

std::string_view name(StandardState state);

/// A packing and the move whose trials are timed on it.
struct Case {
  Packing packing;
  Move move;
};

/// The state of `n_spheres` spheres, 4096 where a rate is quoted without a number. Beds keep their
/// depth, and above 16384 spheres a state is a smaller one repeated periodically (then n_spheres
/// must be a multiple of 4096 by a square, for a fluid by a cube), its spheres shuffled: no order
/// in memory is a gift.
Case standard_state(StandardState state, std::uint32_t n_spheres = 4096);

}  // namespace jostle::bench
