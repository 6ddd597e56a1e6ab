#pragma once

#include <cstdint>

#ifdef __FAST_MATH__
#error "compile without fast mathematics (-ffast-math, -Ofast): it changes results"
#endif

// Elementary functions as fixed sequences of IEEE operations, so that a trajectory is the same on
// every machine; the C library's own differ between machines. Each is good to 2 ulp (tested).
namespace jostle::inline engine {

struct SineCosine {
  double sine, cosine;
};

/// Sine and cosine of x on [-pi/4, pi/4], with the coefficients of fdlibm (Sun Microsystems 1993).
/// Branch-free, so that loops vectorise.
[[gnu::always_inline]] inline SineCosine sine_cosine(double x) {
  const double z = x * x;
  const double s =
      x + x * z *
              (-1.66666666666666324348e-01 +
               z * (8.33333333332248946124e-03 +
                    z * (-1.98412698298579493134e-04 +
                         z * (2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 +
                                                                z * 1.58969099521155010221e-10)))));
  const double c =
      1.0 - 0.5 * z +
      z * z *
          (4.16666666666666019037e-02 +
           z * (-1.38888888888741095749e-03 +
                z * (2.48015872894767294178e-05 +
                     z * (-2.75573143513906633035e-07 +
                          z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  return {s, c};
}

/// Sine and cosine of twice the angle; each doubling about doubles the error.
[[gnu::always_inline]] inline SineCosine doubled(SineCosine angle) {
  return {2 * angle.sine * angle.cosine, 1 - 2 * angle.sine * angle.sine};
}

/// exp(x) for x <= 0; 0 below -708. Taylor's series of degree 13 on |r| <= ln(2)/2.
[[gnu::always_inline]] inline double exponential(double x) {
  if (!(x >= -708.0)) return 0;
  const double k = static_cast<double>(static_cast<std::int64_t>(x * 1.44269504088896340736 - 0.5));
  const double r = (x - k * 6.93147180369123816490e-01) - k * 1.90821492927058770002e-10;
  double sum = 1.0 / 6227020800.0;
  sum = sum * r + 1.0 / 479001600.0;
  sum = sum * r + 1.0 / 39916800.0;
  sum = sum * r + 1.0 / 3628800.0;
  sum = sum * r + 1.0 / 362880.0;
  sum = sum * r + 1.0 / 40320.0;
  sum = sum * r + 1.0 / 5040.0;
  sum = sum * r + 1.0 / 720.0;
  sum = sum * r + 1.0 / 120.0;
  sum = sum * r + 1.0 / 24.0;
  sum = sum * r + 1.0 / 6.0;
  sum = sum * r + 0.5;
  sum = sum * r * r + r + 1.0;
  const auto exponent = static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + 1023) << 52;
  return sum * __builtin_bit_cast(double, exponent);
}

/// The cube root of x in [2^-60, 1]: Newton's method, from a guess good to 6 %.
[[gnu::always_inline]] inline double cube_root(double x) {
  const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, x);
  double root = __builtin_bit_cast(double, bits / 3 + 0x2a9f7893782da1ceu);
  for (int step = 0; step < 4; ++step) root -= (root - x / (root * root)) * (1.0 / 3);
  return root;
}

/// ln(x) for normal x > 0, by the method and coefficients of fdlibm (Sun Microsystems 1993).
/// Branch-free, so that loops vectorise.
[[gnu::always_inline]] inline double natural_log(double x) {
  // x = 2^k m with m in [sqrt(1/2), sqrt(2)).
  constexpr std::uint64_t root_half = 0x3fe6a09e00000000u, unit = 0x3ff0000000000000u;
  const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, x) + (unit - root_half);
  const double k = static_cast<double>(static_cast<std::int32_t>(bits >> 52) - 1023);
  const double f = __builtin_bit_cast(double, (bits & 0xfffffffffffffu) + root_half) - 1.0;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double even = w * (3.999999999940941908e-01 +
                           w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double odd = z * (6.666666666666735130e-01 +
                          w * (2.857142874366239149e-01 +
                               w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const double half_square = 0.5 * f * f;
  return k * 6.93147180369123816490e-01 -
         ((half_square - (s * (half_square + (even + odd)) + k * 1.90821492927058770002e-10)) - f);
}

}  // namespace jostle::inline engine
