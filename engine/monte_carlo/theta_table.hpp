#pragma once

#include <cstdint>
#include <vector>

#include "engine/monte_carlo/moves.hpp"

// The inverse of the law of theta, so that a trial costs the same whatever the law: theta against
// v, the probability of a larger angle. Nodes are spaced evenly inside every octave of v, from
// 2^-33 to 1, so that the table follows long and vanishing tails; between nodes it is linear. The
// law so drawn differs from the exact one by less than 1e-5 in cumulative probability (tested).
namespace jostle::inline engine {

namespace theta_table {
inline constexpr int octaves = 33;
inline constexpr int log2_nodes_per_octave = 8;
inline constexpr int size = (octaves << log2_nodes_per_octave) + 1;
/// A node's index is the exponent and the leading fraction bits of the double v, less those of
/// 2^-33.
inline constexpr int shift = 52 - log2_nodes_per_octave;
inline constexpr std::uint64_t first = static_cast<std::uint64_t>(1023 - octaves)
                                       << log2_nodes_per_octave;
}  // namespace theta_table

/// The table of a polar move, [theta_table::size]: theta / 2, radians, descending from the largest
/// angle to 0. Requires theta0 > 0.
std::vector<double> make_theta_table(const PolarMove& move);

}  // namespace jostle::inline engine
