#include "engine/discrete_element/kernel/contact_law.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace jostle;

namespace {

using Law = WaltonBraunLaw<double, true>;

constexpr LawConstants constants{.stiffness = 4e4,
                                 .unloading = 4e4 / 0.81,
                                 .latched = 1 - 0.81,
                                 .tangential = 3.2e4,
                                 .friction = 0.3,
                                 .time_step = 1e-6};

/// Two spheres pressed together along z, the first moving along x.
Meeting<double> pressed(double overlap, double speed) {
  Meeting<double> at;
  at.normal = {0, 0, 1};
  at.overlap = overlap;
  at.arm = {0, 0, 0.5 * (1 - overlap)};
  at.velocity = {speed, 0, 0};
  at.spin = {0, 0, 0};
  return at;
}

/// T after so much displacement along x, in many steps.
double sheared(Law& law, double overlap, double displacement) {
  const int steps = 20'000;
  const double speed = displacement / (steps * constants.time_step);
  for (int k = 0; k < steps; ++k) law(pressed(overlap, speed), constants);
  return -law.tangential.x;  // the force on the first sphere holds it back
}

}  // namespace

// Walton & Braun 1986, by hand: along K1, back along K2 to a0, again along K2, on along K1.
TEST_CASE("the latched spring loads, unloads and reloads along its lines") {
  WaltonBraunLaw<double, false> law{};
  const auto force = [&](double overlap) { return law(pressed(overlap, 0), constants).force.z; };
  CHECK(force(0.001) == Approx(40));
  CHECK(force(0.002) == Approx(80));
  const double a0 = 0.19 * 0.002;
  CHECK(force(0.001) == Approx(4e4 / 0.81 * (0.001 - a0)));
  CHECK(force(0.5 * a0) == 0);
  CHECK(force(0.0015) == Approx(4e4 / 0.81 * (0.0015 - a0)));
  CHECK(force(0.003) == Approx(120));
  // It opens: what was latched is lost, and nothing is remembered.
  CHECK(law(pressed(-1e-6, 0), constants).dissipated_normally ==
        Approx(0.5 * 4e4 * 0.19 * 0.003 * 0.003));
  CHECK(law.greatest == 0);
  CHECK(force(0.001) == Approx(40));
}

// K_T = K0 u^(1/3) integrates to u^(2/3) falling along a line: T of a displacement in closed form.
TEST_CASE("the tangential force follows Mindlin & Deresiewicz' curve at a constant normal force") {
  Law law{};
  const double overlap = 0.002, limit = constants.friction * 4e4 * overlap;  // mu N
  const double k0 = constants.tangential;
  const double loaded = 0.8 * 1.5 * limit / k0;  // of what gross sliding takes
  const auto curve = [&](double room, double displacement) {
    return room * std::pow(std::max(0.0, 1 - 2.0 / 3 * k0 * displacement / room), 1.5);
  };
  const double top = sheared(law, overlap, loaded);
  CHECK(top == Approx(limit - curve(limit, loaded)).epsilon(1e-3));
  // Back beyond zero: from T* on along mu N + T*.
  const double back = 0.6 * loaded;
  const double turned_back = sheared(law, overlap, -back);
  CHECK(turned_back == Approx(curve(limit + top, back) - limit).epsilon(2e-3));
  // Forward again, from the last reversal.
  const double again = 0.3 * loaded;
  const double end = sheared(law, overlap, again);
  const double room = limit - turned_back;
  CHECK(end == Approx(limit - curve(room, again)).epsilon(2e-3));
  // And until it slides.
  CHECK(sheared(law, overlap, 3 * loaded) == Approx(limit));
}

TEST_CASE("as the normal force falls the tangential one is cut to mu N") {
  Law law{};
  sheared(law, 0.002, 1);
  const double falls[] = {0.0018, 0.001, 0.0005};
  for (const double overlap : falls) {
    const auto act = law(pressed(overlap, 0), constants);
    CHECK(-law.tangential.x == Approx(constants.friction * act.force.z));
    CHECK(act.dissipated_by_friction > 0);
  }
  law(pressed(0.0001, 0), constants);  // within what is latched: no force at all
  CHECK(law.tangential.x == 0);
  // The reversal follows mu N: pressed again it takes up a force as if new.
  CHECK(std::isfinite(sheared(law, 0.001, 1e-4)));
}

TEST_CASE("the tangential force keeps its length and plane while the pair turns rigidly") {
  Law law{};
  sheared(law, 0.002, 1e-4);
  const double before = std::sqrt(dot(law.tangential, law.tangential));
  const double turn = 1e-3;  // radians a step
  Meeting<double> at = pressed(0.002, 0);
  const LawConstants slow = [] {
    LawConstants one = constants;
    one.time_step = 1;
    return one;
  }();
  // About x: the normal turns in y-z, and the surfaces with it, so nothing slides.
  for (int k = 1; k <= 1571; ++k) {
    at.normal = {0, -std::sin(turn * k), std::cos(turn * k)};
    at.arm = scaled(0.499, at.normal);
    at.spin = {2 * turn, 0, 0};
    at.velocity = cross(Vector3<double>{turn, 0, 0}, scaled(0.998, at.normal));
    law(at, slow);
  }
  CHECK(std::sqrt(dot(law.tangential, law.tangential)) == Approx(before).epsilon(1e-9));
  CHECK(std::abs(dot(law.tangential, at.normal)) < 1e-12 * before);
  // About its own normal: the force turns with the spheres.
  const Vector3<double> start = law.tangential;
  at.velocity = {0, 0, 0};
  at.spin = scaled(2 * turn, at.normal);
  for (int k = 0; k < 1571; ++k) law(at, slow);
  const double cosine = dot(law.tangential, start) / (before * before);
  CHECK(std::abs(cosine - std::cos(1.571)) < 2e-3);
  CHECK(std::sqrt(dot(law.tangential, law.tangential)) == Approx(before).epsilon(1e-9));
}

TEST_CASE("the cube root is good to 1e-13") {
  for (double x = 1e-30; x <= 1; x *= 1.37)
    CHECK(cube_root_of(x) == Approx(std::cbrt(x)).epsilon(1e-13));
}
