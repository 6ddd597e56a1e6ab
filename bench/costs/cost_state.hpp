#pragma once

#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/starts/starts.hpp"
#include "engine/taps.hpp"

namespace jostle::bench {

inline constexpr std::uint64_t cost_seed = 20010222;
inline constexpr std::uint32_t cost_spheres = 512;
inline constexpr Dilate cost_tap{0.02};
inline constexpr std::uint64_t cost_sweeps = 100;  // after a tap
inline const StreamKey cost_trials = stream_key(cost_seed, 0, 0, Purpose::trials);

/// A bed small enough to be poured under valgrind.
inline Packing poured_cost_bed(const Container& container) {
  RandomStream random(stream_key(cost_seed, 0, 0, Purpose::start));
  return make_start(SteepestDescentPour{}, container, cost_spheres, random);
}

/// This bed, tapped once.
inline Packing cost_bed(const Container& container) {
  RandomStream random(stream_key(cost_seed, 0, 0, Purpose::tap));
  Packing bed = poured_cost_bed(container);
  excite(bed, cost_tap, random);
  return bed;
}

}  // namespace jostle::bench
