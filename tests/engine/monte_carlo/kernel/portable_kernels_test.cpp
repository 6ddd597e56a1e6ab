#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "engine/monte_carlo/kernel/four_floats.hpp"

#define JOSTLE_KERNELS tested_lanes
#include "engine/discrete_element/kernel/lane_operations.hpp"
#undef JOSTLE_KERNELS
#define JOSTLE_KERNELS tested_words
#include "engine/monte_carlo/kernel/word_lanes.hpp"

// Compares the twins of intrinsics with what this build uses; where it uses the twins themselves,
// as with JOSTLE_PORTABLE, with the definition alone.
using namespace jostle;

namespace {

/// Bits of all kinds of numbers: of any exponent, zeros of both signs, infinities, subnormal ones
/// and some that are no number.
double any_double(std::mt19937_64& random) {
  constexpr std::uint64_t special[] = {
      0, 1, 0x8000000000000000, 0x7ff0000000000000, 0xfff0000000000000, 0x7ff8000000000001};
  const std::uint64_t bits = random() % 8 == 0 ? special[random() % std::size(special)] : random();
  double value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

template <class Vector>
bool same_bits(const Vector& a, const Vector& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

TEST_CASE("pairs of doubles: portable operations give the bits of the intrinsics") {
  namespace own = jostle::tested_lanes;
  namespace portable = jostle::tested_lanes::portable;
  static_assert(sizeof(own::Lanes) == 16, "tests are compiled for the baseline");
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const own::Lanes a = {any_double(random), any_double(random)};
    const own::Lanes b = {any_double(random), i % 4 == 0 ? a[1] : any_double(random)};
    REQUIRE(same_bits(portable::lesser_of(a, b), own::lesser_of(a, b)));
    REQUIRE(same_bits(portable::greater_of(a, b), own::greater_of(a, b)));
    const double lesser = a[1] < b[1] ? a[1] : b[1], found = portable::lesser_of(a, b)[1];
    REQUIRE(same_bits(lesser, found));
    const own::Lanes positive =
        (own::Lanes)((own::LaneBits)a & own::LaneBits{INT64_MAX, INT64_MAX});
    if (positive[0] == positive[0] && positive[1] == positive[1])
      REQUIRE(same_bits(portable::square_roots(positive), own::square_roots(positive)));
    for (const own::LaneBits mask :
         {own::LaneBits{0, 0}, own::LaneBits{-1, 0}, own::LaneBits{0, -1}, own::LaneBits{-1, -1}}) {
      REQUIRE(portable::any_set(mask) == own::any_set(mask));
      REQUIRE(portable::any_set(mask) == ((mask[0] | mask[1]) != 0));
    }
    own::Lanes p = a, q = b, r = a, s = b;
    own::transpose(p, q);
    portable::transpose(r, s);
    REQUIRE((same_bits(p, r) && same_bits(q, s)));
    REQUIRE(same_bits(p, own::Lanes{a[0], b[0]}));
  }
}

TEST_CASE("Philox words: the portable product gives the bits of the intrinsic") {
  namespace own = jostle::tested_words;
  std::mt19937_64 random(2);
  for (int i = 0; i < 20'000; ++i) {
    const own::WordLanes a = {random(), random()}, b = {random(), random()};
    const own::WordLanes product = own::portable::product_of_lower_halves(a, b);
    REQUIRE(same_bits(product, own::product_of_lower_halves(a, b)));
    REQUIRE(product[1] ==
            std::uint64_t{static_cast<std::uint32_t>(a[1])} * static_cast<std::uint32_t>(b[1]));
  }
}

TEST_CASE("four floats: portable operations give the bits of the intrinsics") {
  std::mt19937_64 random(3);
  for (int bits = 0; bits < 16; ++bits) {
    const auto lane = [bits](int k) { return bits >> k & 1 ? -1 : 0; };
    const FourMask mask = {lane(0), lane(1), lane(2), lane(3)};
    CHECK(portable::bits_of_four(mask) == static_cast<unsigned>(bits));
    CHECK(bits_of_four(mask) == static_cast<unsigned>(bits));
    CHECK(portable::any_of_four(mask) == (bits != 0));
    CHECK(any_of_four(mask) == (bits != 0));
  }
  for (int i = 0; i < 1000; ++i) {
    std::array<FourFloats, 4> own, twin;
    for (FourFloats& row : own) {
      const std::uint64_t words[2] = {random(), random()};
      std::memcpy(&row, words, sizeof row);
    }
    const std::array<FourFloats, 4> rows = twin = own;
    transpose(own[0], own[1], own[2], own[3]);
    portable::transpose(twin[0], twin[1], twin[2], twin[3]);
    REQUIRE(std::memcmp(&own, &twin, sizeof own) == 0);
    for (int k = 0; k < 4; ++k) {
      for (int l = 0; l < 4; ++l) {
        const float turned = own[k][l], given = rows[l][k];
        REQUIRE(std::memcmp(&turned, &given, sizeof given) == 0);
      }
    }
  }
}
