#include "engine/bed/elementary.hpp"

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

}  // namespace

TEST_CASE("sine and cosine are good to 2 ulp between -pi/4 and pi/4") {
  double worst = 0;
  for (int k = -400'000; k <= 400'000; ++k) {
    const double x = std::numbers::pi / 4 * k / 400'000;
    const SineCosine own = sine_cosine(x);
    worst = std::max(worst, ulps(own.sine, std::sin(static_cast<long double>(x))));
    worst = std::max(worst, ulps(own.cosine, std::cos(static_cast<long double>(x))));
  }
  CHECK(worst <= 2);
  CHECK(sine_cosine(0).sine == 0);
  CHECK(sine_cosine(0).cosine == 1);
}

TEST_CASE("an angle doubled twice keeps its direction and its length") {
  double worst = 0, worst_length = 0;
  for (int k = -400'000; k <= 400'000; ++k) {
    const double x = std::numbers::pi / 4 * k / 400'000;
    const SineCosine own = doubled(doubled(sine_cosine(x)));
    const auto angle = 4 * static_cast<long double>(x);
    worst = std::max({worst, std::abs(own.sine - static_cast<double>(std::sin(angle))),
                      std::abs(own.cosine - static_cast<double>(std::cos(angle)))});
    worst_length =
        std::max(worst_length, std::abs(own.sine * own.sine + own.cosine * own.cosine - 1));
  }
  CHECK(worst < 2e-15);  // the first quarter is good to 2 ulp, each doubling may double it
  CHECK(worst_length < 4e-15);
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

TEST_CASE("the natural logarithm is good to 2 ulp") {
  double worst = 0;
  for (double x = 0x1p-60; x < 1e6; x *= 1.0000737) {
    worst = std::max(worst, ulps(natural_log(x), std::log(static_cast<long double>(x))));
  }
  for (double argument = 1e-16; argument < 0.5; argument *= 1.0031) {
    const double x = 1 - argument;
    if (x < 1) worst = std::max(worst, ulps(natural_log(x), std::log(static_cast<long double>(x))));
  }
  CHECK(worst <= 2);
  CHECK(natural_log(1) == 0);
}

TEST_CASE("the cube root is good to 2 ulp") {
  double worst = 0;
  for (double x = 0x1p-60; x < 1; x *= 1.0000737) {
    worst = std::max(worst, ulps(cube_root(x), std::cbrt(static_cast<long double>(x))));
  }
  CHECK(worst <= 2);
  CHECK(cube_root(1) == 1);
}
