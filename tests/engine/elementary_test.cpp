#include "engine/elementary.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

using namespace jostle;

namespace {

// Distance from the exact value in units of its last place as a double.
double ulps(double value, long double exact) {
  const double nearest = std::abs(static_cast<double>(exact));
  const double ulp = std::nextafter(nearest, std::numeric_limits<double>::infinity()) - nearest;
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / ulp);
}

struct Exact {
  long double sine, cosine;
};

// Near an axis pi/2 itself must not be rounded: reduce in quarter turns, where that is exact.
Exact exact_sine_cosine(double quarter_turns) {
  constexpr long double half_pi = std::numbers::pi_v<long double> / 2;
  const double nearest = std::round(quarter_turns);
  const long double s = std::sin(half_pi * (quarter_turns - nearest));
  const long double c = std::cos(half_pi * (quarter_turns - nearest));
  switch (static_cast<int>(nearest) % 4) {
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    case 3:
      return {-c, s};
  }
  return {s, c};
}

}  // namespace

TEST_CASE("sine and cosine are good to 2 ulp on a full turn") {
  double worst = 0;
  for (int k = 1; k < 400'000; ++k) {
    const double quarter_turns = k * 1e-5 + 1.3e-7;
    if (quarter_turns > 4) break;
    const SineCosine own = sine_cosine(quarter_turns);
    const Exact exact = exact_sine_cosine(quarter_turns);
    worst = std::max(worst, ulps(own.sine, exact.sine));
    worst = std::max(worst, ulps(own.cosine, exact.cosine));
  }
  CHECK(worst <= 2);
}

TEST_CASE("sine and cosine are exact on the axes") {
  CHECK(sine_cosine(0).sine == 0);
  CHECK(sine_cosine(0).cosine == 1);
  CHECK(sine_cosine(1).sine == 1);
  CHECK(sine_cosine(1).cosine == 0);
  CHECK(sine_cosine(2).cosine == -1);
  CHECK(sine_cosine(3).sine == -1);
  CHECK(sine_cosine(4).cosine == 1);
}

TEST_CASE("the exponential of a negative number is good to 2 ulp") {
  double worst = 0;
  for (double x = 0; x > -700; x -= 0.000731 * (1 - 0.05 * x)) {
    worst = std::max(worst, ulps(exponential(x), std::exp(static_cast<long double>(x))));
  }
  CHECK(worst <= 2);
  CHECK(exponential(0) == 1);
  CHECK(exponential(-1e300) == 0);
  CHECK(exponential(-std::numeric_limits<double>::infinity()) == 0);
  CHECK(exponential(-1e-300) == 1);
}
