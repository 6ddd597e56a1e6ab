#pragma once

#include <cstdint>

// Numbers and vectors of the contact laws (contact_law.hpp), for one contact: N = double.
// lanes.hpp has the same functions for N = Wide.
namespace jostle::inline engine {

#define JOSTLE_INLINE [[gnu::always_inline]] inline

// The upper half of 1.33 times the bits of 1: what a guess of x^(-1/3) takes a third of x's from.
inline constexpr std::int64_t inverse_cube_root_bits = 0x553ef0ff;

// The functions of Wide for one number.
JOSTLE_INLINE double select(bool mask, double yes, double no) {
  return mask ? yes : no;
}
JOSTLE_INLINE bool any_of(bool mask) {
  return mask;
}
JOSTLE_INLINE double lesser(double a, double b) {
  return a < b ? a : b;
}
JOSTLE_INLINE double greater(double a, double b) {
  return a > b ? a : b;
}
JOSTLE_INLINE double square_root(double x) {
  return __builtin_sqrt(x);
}
/// Less a third of the exponent, and of what follows it: within 5 % of x^(-1/3), x > 0.
JOSTLE_INLINE double inverse_cube_root_guess(double x) {
  const std::int64_t high = __builtin_bit_cast(std::int64_t, x) >> 32;
  return __builtin_bit_cast(double, (inverse_cube_root_bits - ((high * 0x55555556) >> 32)) << 32);
}

template <class N>
struct Vector3 {
  N x, y, z;
};

template <class N>
JOSTLE_INLINE Vector3<N> operator+(const Vector3<N>& a, const Vector3<N>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class N>
JOSTLE_INLINE Vector3<N> operator-(const Vector3<N>& a, const Vector3<N>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class N>
JOSTLE_INLINE Vector3<N> scaled(const N& s, const Vector3<N>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class N>
JOSTLE_INLINE N dot(const Vector3<N>& a, const Vector3<N>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N>
JOSTLE_INLINE Vector3<N> cross(const Vector3<N>& a, const Vector3<N>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The vector where the mask is set, else 0.
template <class Mask, class N>
JOSTLE_INLINE Vector3<N> masked(const Mask& mask, const Vector3<N>& a) {
  const N zero{};
  return {select(mask, a.x, zero), select(mask, a.y, zero), select(mask, a.z, zero)};
}

/// (1 + u)^(-1/2) to 0.3 u^4, for u near 0.
template <class N>
JOSTLE_INLINE N inverse_root_by_series(const N& u) {
  return 1.0 - u * (0.5 - u * (0.375 - u * 0.3125));
}

/// The cube root of x in [1e-300, 1] to 1e-14: Householder's method of the fourth order for
/// x^(-1/3), which needs no division.
template <class N>
JOSTLE_INLINE N cube_root_of(const N& x) {
  N inverse = inverse_cube_root_guess(x);
  for (int step = 0; step < 2; ++step) {
    const N miss = 1.0 - x * inverse * inverse * inverse;
    inverse = inverse + inverse * miss * (1.0 / 3.0 + miss * (2.0 / 9.0 + miss * (14.0 / 81.0)));
  }
  return x * inverse * inverse;
}

#undef JOSTLE_INLINE

}  // namespace jostle::inline engine
