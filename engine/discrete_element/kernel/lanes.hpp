#pragma once

#include <immintrin.h>

#include <cstdint>

// As many doubles side by side as the instruction set has room for. Only sources that are compiled
// once for every instruction set include it; it differs between them, so it stands in the namespace
// of each (JOSTLE_KERNELS).
namespace jostle::inline engine::JOSTLE_KERNELS {

#if defined(__AVX512F__)
using Lanes = double __attribute__((vector_size(64)));
#elif defined(__AVX2__)
using Lanes = double __attribute__((vector_size(32)));
#else
using Lanes = double __attribute__((vector_size(16)));
#endif
using LaneBits = std::int64_t __attribute__((vector_size(sizeof(Lanes))));

constexpr std::uint32_t n_lanes = sizeof(Lanes) / sizeof(double);

[[gnu::always_inline]] inline Lanes lanes_at(const double* from) {
  return *reinterpret_cast<const Lanes*>(from);
}
[[gnu::always_inline]] inline Lanes& lanes_at(double* from) {
  return *reinterpret_cast<Lanes*>(from);
}

#define JOSTLE_INLINE [[gnu::always_inline]] inline

// A few vectors side by side: what one waits for, the processor computes of another meanwhile.
constexpr std::uint32_t n_parts = 2;
constexpr std::uint32_t wide_size = n_parts * n_lanes;

struct WideMask {
  LaneBits part[n_parts];
};

struct Wide {
  Lanes part[n_parts];

  JOSTLE_INLINE Wide() : part{} {}
  JOSTLE_INLINE Wide(double value) {
    for (Lanes& one : part) one = Lanes{} + value;
  }
  JOSTLE_INLINE static Wide at(const double* from) {
    Wide wide;
    for (std::uint32_t p = 0; p < n_parts; ++p) wide.part[p] = lanes_at(from + p * n_lanes);
    return wide;
  }
  JOSTLE_INLINE void store(double* to) const {
    for (std::uint32_t p = 0; p < n_parts; ++p) lanes_at(to + p * n_lanes) = part[p];
  }
};

#define JOSTLE_OPERATOR(op)                                                         \
  JOSTLE_INLINE Wide operator op(const Wide& a, const Wide& b) {                    \
    Wide c;                                                                         \
    for (std::uint32_t p = 0; p < n_parts; ++p) c.part[p] = a.part[p] op b.part[p]; \
    return c;                                                                       \
  }
JOSTLE_OPERATOR(+)
JOSTLE_OPERATOR(-)
JOSTLE_OPERATOR(*)
JOSTLE_OPERATOR(/)
#undef JOSTLE_OPERATOR

JOSTLE_INLINE WideMask operator>(const Wide& a, const Wide& b) {
  WideMask mask;
  for (std::uint32_t p = 0; p < n_parts; ++p) mask.part[p] = a.part[p] > b.part[p];
  return mask;
}
JOSTLE_INLINE WideMask operator<(const Wide& a, const Wide& b) {
  return b > a;
}

// Numbers where the mask is set, others where it is not. Both are computed.
JOSTLE_INLINE Wide select(const WideMask& mask, const Wide& yes, const Wide& no) {
  Wide chosen;
  for (std::uint32_t p = 0; p < n_parts; ++p)
    chosen.part[p] = mask.part[p] ? yes.part[p] : no.part[p];
  return chosen;
}

JOSTLE_INLINE bool any_of(const WideMask& mask) {
  LaneBits any = mask.part[0];
  for (std::uint32_t p = 1; p < n_parts; ++p) any |= mask.part[p];
#if defined(__AVX512F__)
  return _mm512_movepi64_mask((__m512i)any) != 0;
#elif defined(__AVX2__)
  return _mm256_movemask_pd((__m256d)any) != 0;
#else
  return _mm_movemask_pd((__m128d)any) != 0;
#endif
}

JOSTLE_INLINE Wide square_root(Wide x) {
  for (Lanes& one : x.part) {
#if defined(__AVX512F__)
    one = (Lanes)_mm512_sqrt_pd((__m512d)one);
#elif defined(__AVX2__)
    one = (Lanes)_mm256_sqrt_pd((__m256d)one);
#else
    one = (Lanes)_mm_sqrt_pd((__m128d)one);
#endif
  }
  return x;
}

// As that of one number.
JOSTLE_INLINE Wide inverse_cube_root_guess(Wide x) {
  for (Lanes& one : x.part) {
    const LaneBits high = (LaneBits)one >> 32;
    one = (Lanes)((inverse_cube_root_bits - ((high * 0x55555556) >> 32)) << 32);
  }
  return x;
}

// a < b ? a : b and a > b ? a : b, which is what the instructions do.
JOSTLE_INLINE Wide lesser(const Wide& a, const Wide& b) {
  Wide c;
  for (std::uint32_t p = 0; p < n_parts; ++p) {
#if defined(__AVX512F__)
    c.part[p] = (Lanes)_mm512_min_pd((__m512d)a.part[p], (__m512d)b.part[p]);
#elif defined(__AVX2__)
    c.part[p] = (Lanes)_mm256_min_pd((__m256d)a.part[p], (__m256d)b.part[p]);
#else
    c.part[p] = (Lanes)_mm_min_pd((__m128d)a.part[p], (__m128d)b.part[p]);
#endif
  }
  return c;
}
JOSTLE_INLINE Wide greater(const Wide& a, const Wide& b) {
  Wide c;
  for (std::uint32_t p = 0; p < n_parts; ++p) {
#if defined(__AVX512F__)
    c.part[p] = (Lanes)_mm512_max_pd((__m512d)a.part[p], (__m512d)b.part[p]);
#elif defined(__AVX2__)
    c.part[p] = (Lanes)_mm256_max_pd((__m256d)a.part[p], (__m256d)b.part[p]);
#else
    c.part[p] = (Lanes)_mm_max_pd((__m128d)a.part[p], (__m128d)b.part[p]);
#endif
  }
  return c;
}

// Turns rows [n_lanes][8] into columns [8][n_lanes], both given as eight Lanes, and back.
#if defined(__AVX512F__)
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
#elif defined(__AVX2__)
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
JOSTLE_INLINE void transpose(Lanes& p, Lanes& q) {
  const __m128d a = (__m128d)p, b = (__m128d)q;
  p = (Lanes)_mm_unpacklo_pd(a, b);
  q = (Lanes)_mm_unpackhi_pd(a, b);
}
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

}  // namespace jostle::inline engine::JOSTLE_KERNELS
