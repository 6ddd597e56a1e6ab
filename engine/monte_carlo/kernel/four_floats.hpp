#pragma once

#include <cstdint>

#if defined(__SSE2__) && !defined(JOSTLE_PORTABLE)
#define JOSTLE_INTRINSICS
#include <emmintrin.h>
#endif

// Vectors of four floats, and the operations on them that need intrinsics. All is inlined: sources
// of different instruction sets include it. `portable` has what takes the place of intrinsics where
// there are none, with the same bits.
namespace jostle::inline engine {

using FourFloats = float __attribute__((vector_size(16)));
/// The result of comparing four: 0 or -1 each.
using FourMask = std::int32_t __attribute__((vector_size(16)));

#define JOSTLE_INLINE [[gnu::always_inline]] inline

namespace portable {

JOSTLE_INLINE bool any_of_four(FourMask mask) {
  using Halves = std::int64_t __attribute__((vector_size(16)));
  const auto halves = (Halves)mask;
  return (halves[0] | halves[1]) != 0;
}

/// One bit each, that of the first is the lowest.
JOSTLE_INLINE unsigned bits_of_four(FourMask mask) {
  const FourMask bits = mask & FourMask{1, 2, 4, 8};
  return static_cast<unsigned>(bits[0] | bits[1] | bits[2] | bits[3]);
}

/// Rows become columns.
JOSTLE_INLINE void transpose(FourFloats& a, FourFloats& b, FourFloats& c, FourFloats& d) {
  const FourFloats ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const FourFloats ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const FourFloats cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const FourFloats cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

}  // namespace portable

#ifdef JOSTLE_INTRINSICS
JOSTLE_INLINE bool any_of_four(FourMask mask) {
  return _mm_movemask_ps((__m128)mask) != 0;
}
JOSTLE_INLINE unsigned bits_of_four(FourMask mask) {
  return static_cast<unsigned>(_mm_movemask_ps((__m128)mask));
}
JOSTLE_INLINE void transpose(FourFloats& a, FourFloats& b, FourFloats& c, FourFloats& d) {
  __m128 p = (__m128)a, q = (__m128)b, r = (__m128)c, s = (__m128)d;
  _MM_TRANSPOSE4_PS(p, q, r, s);
  a = (FourFloats)p, b = (FourFloats)q, c = (FourFloats)r, d = (FourFloats)s;
}
#else
using portable::any_of_four, portable::bits_of_four, portable::transpose;
#endif

#undef JOSTLE_INLINE
#undef JOSTLE_INTRINSICS

}  // namespace jostle::inline engine
