#include "engine/bed/philox.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

using namespace jostle;

TEST_CASE("a block is Philox4x32-10 as published") {
  // Known answers of Random123 (tests/kat_vectors: philox4x32 10).
  CHECK(philox_block(StreamKey{0}, 0) ==
        std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
}

TEST_CASE("keys differ in every one of their four parts") {
  std::set<StreamKey> keys;
  for (std::uint64_t seed : {0, 1, 2}) {
    for (std::uint64_t point : {0, 1, 2}) {
      for (std::uint64_t realization : {0, 1, 2}) {
        for (const Purpose purpose : {Purpose::start, Purpose::tap, Purpose::trials}) {
          keys.insert(stream_key(seed, point, realization, purpose));
        }
      }
    }
  }
  CHECK(keys.size() == 81);
}

TEST_CASE("a key is the documented chain of SplitMix64 steps") {
  // By hand: h = mix(mix(mix(mix(0 ^ 1) ^ 2) ^ 3) ^ 3) in Python with 64-bit masks.
  CHECK(stream_key(1, 2, 3, Purpose::trials) == StreamKey{0x4621364dd0a66f0f});
}

TEST_CASE("a stream continues from its position") {
  RandomStream stream(stream_key(7, 0, 0, Purpose::start));
  for (int k = 0; k < 5; ++k) stream.uniform();
  RandomStream resumed(stream_key(7, 0, 0, Purpose::start), stream.position());
  for (int k = 0; k < 9; ++k) CHECK(stream.uniform() == resumed.uniform());
}

TEST_CASE("uniform numbers are uniform") {
  RandomStream stream(stream_key(11, 0, 0, Purpose::start));
  constexpr int n = 200'000;
  double sum = 0, sum_of_squares = 0;
  int fives = 0;
  for (int k = 0; k < n; ++k) {
    const double u = stream.uniform();
    REQUIRE((u > 0 && u < 1));
    sum += u;
    sum_of_squares += u * u;
    fives += stream.integer_below(7) == 5;
  }
  // Standard errors: sqrt(1/12 n), sqrt(4/45 n), sqrt(6/49 n).
  CHECK(std::abs(sum / n - 0.5) < 3 * std::sqrt(1.0 / 12 / n));
  CHECK(std::abs(sum_of_squares / n - 1.0 / 3) < 3 * std::sqrt(4.0 / 45 / n));
  CHECK(std::abs(fives / double(n) - 1.0 / 7) < 3 * std::sqrt(6.0 / 49 / n));
}
