#include "structure/density/sphere_cuts.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <utility>
#include <vector>

#include "engine/bed/random.hpp"
#include "engine/bed/slab.hpp"

using namespace jostle;

namespace {

// Tanh-sinh quadrature, which does not mind what happens at the ends.
double integral(double lower, double upper, const std::function<double(double)>& function) {
  constexpr double step = 1.0 / 16;
  double sum = 0;
  for (int k = -56; k <= 56; ++k) {
    const double s = 0.5 * std::numbers::pi * std::sinh(k * step);
    // The distance from the nearer end, without cancellation.
    const double from_end = (upper - lower) / (1 + std::exp(2 * std::abs(s)));
    const double x = s < 0 ? lower + from_end : upper - from_end;
    const double weight = 0.5 * std::numbers::pi * std::cosh(k * step) / std::cosh(s);
    sum += weight / std::cosh(s) * function(x);
  }
  return upper > lower ? sum * step * (upper - lower) / 2 : 0;
}

double disc_radius(double z) {
  return std::sqrt(std::max(0.0, 0.25 - z * z));
}

// The sphere cut by the planes x = a and y = b, from discs cut by one line.
double volume_by_segments(double a, double b) {
  const double end = std::clamp(std::sqrt(std::max(0.0, 0.25 - b * b)), -0.5, 0.5);
  const auto area = [&](double x) { return disc_area_in_strip(disc_radius(x), b, 1); };
  // Where the disc passes the line y = b the area is not smooth: the ends of the parts.
  const double first = std::max(a, -0.5), second = std::max(a, -end), third = std::max(a, end);
  return integral(first, std::max(first, second), area) + integral(second, third, area) +
         integral(third, std::max(third, 0.5), area);
}

double uniform(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

// Areas that a disc and a tube share, whatever their places, and the volume below them.
double volume_by_lenses(double d, double s, double low, double high) {
  const auto area = [&](double z) {
    const double r = disc_radius(z);
    if (d >= r + s) return 0.0;
    if (d <= std::abs(r - s)) return std::numbers::pi * std::min(r, s) * std::min(r, s);
    const double at_r = std::acos(std::clamp((d * d + r * r - s * s) / (2 * d * r), -1.0, 1.0));
    const double at_s = std::acos(std::clamp((d * d + s * s - r * r) / (2 * d * s), -1.0, 1.0));
    return r * r * (at_r - 0.5 * std::sin(2 * at_r)) + s * s * (at_s - 0.5 * std::sin(2 * at_s));
  };
  std::vector<double> ends = {low, high, 0, -0.5, 0.5};
  for (const double r : {std::abs(s - d), s + d}) {
    ends.push_back(disc_radius(std::min(r, 0.5)));
    ends.push_back(-ends.back());
  }
  const double bottom = std::max(low, -0.5), top = std::min(high, 0.5);
  if (bottom >= top) return 0;
  for (double& end : ends) end = std::clamp(end, bottom, top);
  std::ranges::sort(ends);
  double volume = 0;
  for (std::size_t i = 1; i < ends.size(); ++i) volume += integral(ends[i - 1], ends[i], area);
  return volume;
}

}  // namespace

TEST_CASE("A corner of two planes cuts off what the discs' segments add up to") {
  RandomStream random(stream_key(31, 0, 0, Purpose::start));
  for (int i = 0; i < 2000; ++i) {
    const double a = uniform(random, -0.6, 0.6), b = uniform(random, -0.6, 0.6);
    CAPTURE(a, b);
    CHECK(sphere_volume_beyond(a, b) == Approx(volume_by_segments(a, b)).margin(2e-14).epsilon(0));
  }
}

TEST_CASE("Planes that cut special parts off") {
  CHECK(sphere_volume_beyond(0, 0) == Approx(sphere_volume / 4).epsilon(1e-15));
  CHECK(sphere_volume_beyond({0, 0, 0}) == Approx(sphere_volume / 8).epsilon(1e-15));
  CHECK(sphere_volume_beyond(-1, -1) == Approx(sphere_volume).epsilon(1e-15));
  CHECK(sphere_volume_beyond({-1, -0.5, -2}) == Approx(sphere_volume).epsilon(1e-15));
  for (const double side : {0.5, 0.7, 1e9}) {
    CHECK(std::abs(sphere_volume_beyond(side, -1)) < 1e-16);
    CHECK(std::abs(sphere_volume_beyond({-1, 0.1, side})) < 1e-16);
  }
  // Planes that meet outside the sphere: each cuts a cap of its own off.
  const double cap = sphere_volume_in_slab(0, 0.4, 0.5);
  CHECK(sphere_volume_beyond(-0.4, -0.4) == Approx(sphere_volume - 2 * cap).epsilon(1e-15));
  CHECK(sphere_volume_beyond({-0.4, -0.4, 0}) == Approx(sphere_volume / 2 - cap).epsilon(1e-15));
  CHECK(sphere_volume_beyond(0.4, -0.4) == Approx(cap).epsilon(1e-13));
  CHECK(std::abs(sphere_volume_beyond(0.4, 0.4)) < 1e-16);
  // The cube of the same centre, of half its width.
  const double cube = sphere_volume_in_box({-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25});
  CHECK(cube == Approx(0.125).epsilon(1e-14));
}

TEST_CASE("A box holds what the corners of the planes between add up to") {
  // Three planes against two: over z the discs are cut by x = a and y = b.
  RandomStream random(stream_key(32, 0, 0, Purpose::start));
  for (int i = 0; i < 2000; ++i) {
    const Vec3 low{uniform(random, -0.7, 0.6), uniform(random, -0.7, 0.6),
                   uniform(random, -0.7, 0.6)};
    const Vec3 high{uniform(random, low.x, 0.7), uniform(random, low.y, 0.7),
                    uniform(random, low.z, 0.7)};
    CAPTURE(low.x, low.y, low.z, high.x, high.y, high.z);
    const double whole = sphere_volume_in_box(low, high);
    // Cut anywhere, the parts are positive and add up to it.
    const double plane = uniform(random, low.z, high.z);
    const double lower = sphere_volume_in_box(low, {high.x, high.y, plane});
    const double upper = sphere_volume_in_box({low.x, low.y, plane}, high);
    CHECK(lower + upper == Approx(whole).margin(1e-15).epsilon(0));
    CHECK(std::min(lower, upper) > -1e-15);
    // Any order and reflection of the axes gives the same.
    const double mirrored =
        sphere_volume_in_box({-high.y, low.z, -high.x}, {-low.y, high.z, -low.x});
    CHECK(mirrored == Approx(whole).margin(1e-15).epsilon(0));
  }
}

TEST_CASE("A corner of three planes cuts off what its sections add up to") {
  RandomStream random(stream_key(33, 0, 0, Purpose::start));
  for (int i = 0; i < 200; ++i) {
    const double a = uniform(random, -0.5, 0.5), b = uniform(random, -0.5, 0.5),
                 c = uniform(random, -0.5, 0.5);
    CAPTURE(a, b, c);
    // d/dc of the volume is the area of the disc at z = c beyond x = a and y = b: sample it by
    // chords.
    const auto area = [&](double z) {
      const double r = disc_radius(z);
      const auto chord = [&](double x) {
        const double half = std::sqrt(std::max(0.0, r * r - x * x));
        return std::max(0.0, half - std::max(b, -half));
      };
      const double turn = std::sqrt(std::max(0.0, r * r - b * b));
      double sum = 0, lower = std::max(a, -r);
      for (const double end : {-turn, turn, r}) {
        const double upper = std::max(lower, std::min(end, r));
        sum += integral(lower, upper, chord);
        lower = upper;
      }
      return sum;
    };
    double sum = 0, lower = c;
    std::vector<double> ends = {disc_radius(a), disc_radius(b),
                                std::sqrt(std::max(0.0, 0.25 - a * a - b * b)), 0.5};
    for (std::size_t k = 0; k < 3; ++k) ends.push_back(-ends[k]);
    std::ranges::sort(ends);
    for (const double end : ends) {
      const double upper = std::max(lower, end);
      sum += integral(lower, upper, area);
      lower = upper;
    }
    CHECK(sphere_volume_beyond({a, b, c}) == Approx(sum).margin(1e-12).epsilon(0));
  }
}

TEST_CASE("A strip of a disc") {
  CHECK(disc_area_in_strip(0.5, -1, 1) == Approx(std::numbers::pi / 4).epsilon(1e-15));
  CHECK(disc_area_in_strip(0.5, 0, 3) == Approx(std::numbers::pi / 8).epsilon(1e-15));
  CHECK(disc_area_in_strip(0, -1, 1) == 0);
  CHECK(disc_area_in_strip(2, 1, 2) ==
        Approx(4 * std::numbers::pi / 3 - std::sqrt(3.0)).epsilon(1e-14));
}

TEST_CASE("A tube takes what the circles share") {
  RandomStream random(stream_key(34, 0, 0, Purpose::start));
  for (int i = 0; i < 3000; ++i) {
    const double d = uniform(random, 0, 3), s = std::max(0.0, d + uniform(random, -0.6, 0.6));
    const bool whole = i % 2 == 0;
    const double low = whole ? -1 : uniform(random, -0.6, 0.6);
    const double high = whole ? 1 : uniform(random, low, 0.6);
    CAPTURE(d, s, low, high);
    CHECK(sphere_volume_in_tube(d, s, low, high) ==
          Approx(volume_by_lenses(d, s, low, high)).margin(1e-9).epsilon(0));
  }
  // Nearly touching, nearly concentric, nearly through the centre.
  for (const double x : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2}) {
    for (const auto& [d, s] : std::initializer_list<std::pair<double, double>>{{0.3 + x, 0.3},
                                                                               {2 + x, 2},
                                                                               {2, 2 + x},
                                                                               {1, 0.5 + x},
                                                                               {1, 1.5 - x},
                                                                               {x, 0.4},
                                                                               {0.2, 0.3 + x},
                                                                               {0.2, 0.3 - x},
                                                                               {0.3, x},
                                                                               {x, 2 * x}}) {
      CAPTURE(d, s);
      CHECK(sphere_volume_in_tube(d, s, -1, 1) ==
            Approx(volume_by_lenses(d, s, -1, 1)).margin(1e-9).epsilon(0));
    }
  }
}

TEST_CASE("The volume around a bore along the axis depends on its length alone") {
  const double half = 0.3, bore = std::sqrt(0.25 - half * half);
  CHECK(sphere_volume - sphere_volume_in_tube(0, bore, -1, 1) ==
        Approx(4.0 / 3 * std::numbers::pi * half * half * half).epsilon(1e-13));
}
