#pragma once

#include "engine/bed/random.hpp"

namespace jostle {

/// Close to normal, of mean 0 and variance 1: the sum of twelve uniform numbers.
inline double noise(RandomStream& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

/// The stream of a test's synthetic numbers.
inline RandomStream test_stream(std::uint64_t seed) {
  return RandomStream(stream_key(seed, 1, 0, Purpose::resampling));
}

}  // namespace jostle
