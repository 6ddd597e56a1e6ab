#pragma once

#include <cstdint>

#if defined(__SSE2__) && !defined(JOSTLE_PORTABLE)
#define JOSTLE_INTRINSICS
#include <immintrin.h>
#endif

// Vectors of doubles as wide as the instruction set has them, and the operations on them that need
// intrinsics. Compiled once for every instruction set, each time into a namespace of its own
// (JOSTLE_KERNELS). `portable` has what takes the place of intrinsics where there are none: the
// same bits, by the compiler's vectors of 16 bytes alone.
namespace jostle::inline engine::JOSTLE_KERNELS {

#if defined(JOSTLE_INTRINSICS) && defined(__AVX512F__)
using Lanes = double __attribute__((vector_size(64)));
#elif defined(JOSTLE_INTRINSICS) && defined(__AVX2__)
using Lanes = double __attribute__((vector_size(32)));
#else
using Lanes = double __attribute__((vector_size(16)));
#endif
using LaneBits = std::int64_t __attribute__((vector_size(sizeof(Lanes))));

constexpr std::uint32_t n_lanes = sizeof(Lanes) / sizeof(double);

#define JOSTLE_INLINE [[gnu::always_inline]] inline

namespace portable {

using Two = double __attribute__((vector_size(16)));
using TwoBits = std::int64_t __attribute__((vector_size(16)));

JOSTLE_INLINE bool any_set(TwoBits mask) {
  return (mask[0] | mask[1]) < 0;
}
JOSTLE_INLINE Two square_roots(Two x) {
  return Two{__builtin_sqrt(x[0]), __builtin_sqrt(x[1])};
}
JOSTLE_INLINE Two lesser_of(Two a, Two b) {
  return a < b ? a : b;
}
JOSTLE_INLINE Two greater_of(Two a, Two b) {
  return a > b ? a : b;
}
JOSTLE_INLINE void transpose(Two& p, Two& q) {
  const Two a = p, b = q;
  p = Two{a[0], b[0]};
  q = Two{a[1], b[1]};
}

}  // namespace portable

// any_set: of a mask, whose lanes are 0 or -1. lesser_of, greater_of: a < b ? a : b and a > b ? a :
// b, which is what the instructions do.
#if !defined(JOSTLE_INTRINSICS)
using portable::any_set, portable::square_roots, portable::lesser_of, portable::greater_of;
using portable::transpose;
#elif defined(__AVX512F__)
JOSTLE_INLINE bool any_set(LaneBits mask) {
  return _mm512_movepi64_mask((__m512i)mask) != 0;
}
JOSTLE_INLINE Lanes square_roots(Lanes x) {
  return (Lanes)_mm512_sqrt_pd((__m512d)x);
}
JOSTLE_INLINE Lanes lesser_of(Lanes a, Lanes b) {
  return (Lanes)_mm512_min_pd((__m512d)a, (__m512d)b);
}
JOSTLE_INLINE Lanes greater_of(Lanes a, Lanes b) {
  return (Lanes)_mm512_max_pd((__m512d)a, (__m512d)b);
}
#elif defined(__AVX2__)
JOSTLE_INLINE bool any_set(LaneBits mask) {
  return _mm256_movemask_pd((__m256d)mask) != 0;
}
JOSTLE_INLINE Lanes square_roots(Lanes x) {
  return (Lanes)_mm256_sqrt_pd((__m256d)x);
}
JOSTLE_INLINE Lanes lesser_of(Lanes a, Lanes b) {
  return (Lanes)_mm256_min_pd((__m256d)a, (__m256d)b);
}
JOSTLE_INLINE Lanes greater_of(Lanes a, Lanes b) {
  return (Lanes)_mm256_max_pd((__m256d)a, (__m256d)b);
}
#else
JOSTLE_INLINE bool any_set(LaneBits mask) {
  return _mm_movemask_pd((__m128d)mask) != 0;
}
JOSTLE_INLINE Lanes square_roots(Lanes x) {
  return (Lanes)_mm_sqrt_pd((__m128d)x);
}
JOSTLE_INLINE Lanes lesser_of(Lanes a, Lanes b) {
  return (Lanes)_mm_min_pd((__m128d)a, (__m128d)b);
}
JOSTLE_INLINE Lanes greater_of(Lanes a, Lanes b) {
  return (Lanes)_mm_max_pd((__m128d)a, (__m128d)b);
}
JOSTLE_INLINE void transpose(Lanes& p, Lanes& q) {
  const __m128d a = (__m128d)p, b = (__m128d)q;
  p = (Lanes)_mm_unpacklo_pd(a, b);
  q = (Lanes)_mm_unpackhi_pd(a, b);
}
#endif

// Turns rows [n_lanes][8] into columns [8][n_lanes], both given as eight Lanes, and back.
#if defined(JOSTLE_INTRINSICS) && defined(__AVX512F__)
JOSTLE_INLINE void transpose(Lanes (&m)[8]) {
  const __m512i low_pairs = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i high_pairs = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  __m512d a[8], b[8];
  for (int k = 0; k < 8; k += 2) {
    a[k] = _mm512_unpacklo_pd((__m512d)m[k], (__m512d)m[k + 1]);
    a[k + 1] = _mm512_unpackhi_pd((__m512d)m[k], (__m512d)m[k + 1]);
  }
  for (int k = 0; k < 8; k += 4) {
    for (int l = k; l < k + 2; ++l) {
      b[l] = _mm512_permutex2var_pd(a[l], low_pairs, a[l + 2]);
      b[l + 2] = _mm512_permutex2var_pd(a[l], high_pairs, a[l + 2]);
    }
  }
  for (int k = 0; k < 4; ++k) {
    m[k] = (Lanes)_mm512_shuffle_f64x2(b[k], b[k + 4], 0x44);
    m[k + 4] = (Lanes)_mm512_shuffle_f64x2(b[k], b[k + 4], 0xee);
  }
}
JOSTLE_INLINE void rows_to_columns(Lanes (&m)[8]) {
  transpose(m);
}
JOSTLE_INLINE void columns_to_rows(Lanes (&m)[8]) {
  transpose(m);
}
#elif defined(JOSTLE_INTRINSICS) && defined(__AVX2__)
JOSTLE_INLINE void transpose(Lanes& p, Lanes& q, Lanes& r, Lanes& s) {
  const __m256d a = _mm256_unpacklo_pd((__m256d)p, (__m256d)q);
  const __m256d b = _mm256_unpackhi_pd((__m256d)p, (__m256d)q);
  const __m256d c = _mm256_unpacklo_pd((__m256d)r, (__m256d)s);
  const __m256d d = _mm256_unpackhi_pd((__m256d)r, (__m256d)s);
  p = (Lanes)_mm256_permute2f128_pd(a, c, 0x20);
  q = (Lanes)_mm256_permute2f128_pd(b, d, 0x20);
  r = (Lanes)_mm256_permute2f128_pd(a, c, 0x31);
  s = (Lanes)_mm256_permute2f128_pd(b, d, 0x31);
}
JOSTLE_INLINE void rows_to_columns(Lanes (&m)[8]) {
  transpose(m[0], m[2], m[4], m[6]);  // the lower halves of four rows
  transpose(m[1], m[3], m[5], m[7]);
  const Lanes rows[8] = {m[0], m[2], m[4], m[6], m[1], m[3], m[5], m[7]};
  for (int k = 0; k < 8; ++k) m[k] = rows[k];
}
JOSTLE_INLINE void columns_to_rows(Lanes (&m)[8]) {
  transpose(m[0], m[1], m[2], m[3]);
  transpose(m[4], m[5], m[6], m[7]);
  const Lanes rows[8] = {m[0], m[4], m[1], m[5], m[2], m[6], m[3], m[7]};
  for (int k = 0; k < 8; ++k) m[k] = rows[k];
}
#else
JOSTLE_INLINE void rows_to_columns(Lanes (&m)[8]) {
  for (int k = 0; k < 4; ++k) transpose(m[k], m[k + 4]);
  const Lanes columns[8] = {m[0], m[4], m[1], m[5], m[2], m[6], m[3], m[7]};
  for (int k = 0; k < 8; ++k) m[k] = columns[k];
}
JOSTLE_INLINE void columns_to_rows(Lanes (&m)[8]) {
  for (int k = 0; k < 8; k += 2) transpose(m[k], m[k + 1]);
  const Lanes rows[8] = {m[0], m[2], m[4], m[6], m[1], m[3], m[5], m[7]};
  for (int k = 0; k < 8; ++k) m[k] = rows[k];
}
#endif

#undef JOSTLE_INLINE
#undef JOSTLE_INTRINSICS

}  // namespace jostle::inline engine::JOSTLE_KERNELS
