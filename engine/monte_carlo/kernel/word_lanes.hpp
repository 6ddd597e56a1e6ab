#pragma once

#include <cstdint>

#if defined(__SSE2__) && !defined(JOSTLE_PORTABLE)
#define JOSTLE_INTRINSICS
#include <immintrin.h>
#endif

// Philox words side by side, and their product, which needs intrinsics. Compiled once for every
// instruction set, each time into a namespace of its own (JOSTLE_KERNELS). `portable` has what
// takes the place of intrinsics where there are none, with the same bits.
namespace jostle::inline engine::JOSTLE_KERNELS {

// One word a 64-bit lane, in its lower half; the upper half is never looked at.
#if defined(JOSTLE_INTRINSICS) && defined(__AVX512F__)
using WordLanes = std::uint64_t __attribute__((vector_size(64)));
#elif defined(JOSTLE_INTRINSICS) && defined(__AVX2__)
using WordLanes = std::uint64_t __attribute__((vector_size(32)));
#else
using WordLanes = std::uint64_t __attribute__((vector_size(16)));
#endif

constexpr std::uint32_t n_lanes = sizeof(WordLanes) / sizeof(std::uint64_t);

namespace portable {

using TwoWords = std::uint64_t __attribute__((vector_size(16)));

[[gnu::always_inline]] inline TwoWords product_of_lower_halves(TwoWords a, TwoWords b) {
  constexpr std::uint64_t half = 0xffffffffu;
  return TwoWords{(a[0] & half) * (b[0] & half), (a[1] & half) * (b[1] & half)};
}

}  // namespace portable

#if !defined(JOSTLE_INTRINSICS)
using portable::product_of_lower_halves;
#else
[[gnu::always_inline]] inline WordLanes product_of_lower_halves(WordLanes a, WordLanes b) {
#if defined(__AVX512F__)
  return (WordLanes)_mm512_mul_epu32((__m512i)a, (__m512i)b);
#elif defined(__AVX2__)
  return (WordLanes)_mm256_mul_epu32((__m256i)a, (__m256i)b);
#else
  return (WordLanes)_mm_mul_epu32((__m128i)a, (__m128i)b);
#endif
}
#endif

#undef JOSTLE_INTRINSICS

}  // namespace jostle::inline engine::JOSTLE_KERNELS
