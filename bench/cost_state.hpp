#pragma once

#include "engine/packing.hpp"
#include "engine/random.hpp"
#include "engine/starts.hpp"
#include "engine/taps.hpp"

namespace jostle::bench {

inline const StreamKey cost_trials = stream_key(20010222, 0, 0, Purpose::trials);

/// A bed small enough to be poured under valgrind, dilated by 0.02: 512 spheres.
inline Packing cost_bed(const Container& container) {
  RandomStream start_random(stream_key(20010222, 0, 0, Purpose::start));
  RandomStream tap_random(stream_key(20010222, 0, 0, Purpose::tap));
  Packing bed = make_start(SteepestDescentPour{}, container, 512, start_random);
  excite(bed, Dilate{0.02}, tap_random);
  return bed;
}

}  // namespace jostle::bench
