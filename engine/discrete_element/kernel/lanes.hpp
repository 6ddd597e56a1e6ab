#pragma once

#include <cstdint>

#include "engine/discrete_element/kernel/lane_operations.hpp"
#include "engine/discrete_element/kernel/vector3.hpp"

// Numbers for as many contacts as vectors have room for. Only sources that are compiled once for
// every instruction set include it; it differs between them, so it is in the namespace of each
// (JOSTLE_KERNELS).
namespace jostle::inline engine::JOSTLE_KERNELS {

[[gnu::always_inline]] inline Lanes lanes_at(const double* source) {
  return *reinterpret_cast<const Lanes*>(source);
}
[[gnu::always_inline]] inline Lanes& lanes_at(double* source) {
  return *reinterpret_cast<Lanes*>(source);
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
    for (Lanes& lanes : part) lanes = Lanes{} + value;
  }
  JOSTLE_INLINE static Wide load(const double* source) {
    Wide wide;
    for (std::uint32_t p = 0; p < n_parts; ++p) wide.part[p] = lanes_at(source + p * n_lanes);
    return wide;
  }
  JOSTLE_INLINE void store(double* destination) const {
    for (std::uint32_t p = 0; p < n_parts; ++p) lanes_at(destination + p * n_lanes) = part[p];
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
  return any_set(any);
}

JOSTLE_INLINE Wide square_root(Wide x) {
  for (Lanes& lanes : x.part) lanes = square_roots(lanes);
  return x;
}

// Like the function for one number.
JOSTLE_INLINE Wide inverse_cube_root_guess(Wide x) {
  for (Lanes& lanes : x.part) {
    const LaneBits high = (LaneBits)lanes >> 32;
    lanes = (Lanes)((inverse_cube_root_bits - ((high * 0x55555556) >> 32)) << 32);
  }
  return x;
}

JOSTLE_INLINE Wide lesser(const Wide& a, const Wide& b) {
  Wide c;
  for (std::uint32_t p = 0; p < n_parts; ++p) c.part[p] = lesser_of(a.part[p], b.part[p]);
  return c;
}
JOSTLE_INLINE Wide greater(const Wide& a, const Wide& b) {
  Wide c;
  for (std::uint32_t p = 0; p < n_parts; ++p) c.part[p] = greater_of(a.part[p], b.part[p]);
  return c;
}

#undef JOSTLE_INLINE

}  // namespace jostle::inline engine::JOSTLE_KERNELS
