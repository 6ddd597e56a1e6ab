#include "engine/discrete_element/kernel/contact_law.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

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
  Meeting<double> meeting;
  meeting.normal = {0, 0, 1};
  meeting.overlap = overlap;
  meeting.arm = {0, 0, 0.5 * (1 - overlap)};
  meeting.velocity = {speed, 0, 0};
  meeting.spin = {0, 0, 0};
  return meeting;
}

/// T after so much displacement along x, in many steps.
double sheared(Law& law, double overlap, double displacement) {
  const int steps = 20'000;
  const double speed = displacement / (steps * constants.time_step);
  for (int k = 0; k < steps; ++k) law(pressed(overlap, speed), constants);
  return -law.tangential.x;  // the force on the first sphere holds it back
}

void shear_aside(Law& law, double overlap, double displacement) {
  Meeting<double> meeting = pressed(overlap, 0);
  meeting.velocity.y = displacement / constants.time_step;
  law(meeting, constants);
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

// A path dissipates the area that it encloses: never negative, and for a whole contact 1/2 K1 (1 -
// e^2) x (greatest overlap)^2 for any path.
TEST_CASE("the latched spring loses the area of its loop, whatever path it takes") {
  for (const std::vector<double>& turns :
       {std::vector{0.003}, std::vector{0.001, 0.0008, 0.003}, std::vector{0.003, 0.0029, 0.00295},
        std::vector{0.001, 0.0002, 0.002, 0.0001, 0.0015, 0.0012, 0.003, 0.00059, 0.001}}) {
    WaltonBraunLaw<double, false> law{};
    constexpr int parts = 4000;
    double overlap_now = 0, work = 0, force_before = 0, lost = 0, greatest = 0;
    const auto go_to = [&](double high) {
      const double low = overlap_now;
      for (int k = 1; k <= parts; ++k) {
        overlap_now = low + (high - low) * k / parts;
        const auto act = law(pressed(overlap_now, 0), constants);
        work += 0.5 * (force_before + act.force.z) * (high - low) / parts;  // on the spring
        force_before = act.force.z;
        lost += act.dissipated_normally;
        CHECK(act.force.z >= 0);
        CHECK(act.force.z <= constants.stiffness * std::max(0.0, overlap_now) * (1 + 1e-12));
      }
      greatest = std::max(greatest, high);
    };
    for (const double turn : turns) {
      go_to(turn);
      CHECK(work > 0);
    }
    go_to(-1e-9);
    const double area = 0.5 * constants.stiffness * constants.latched * greatest * greatest;
    CHECK(work == Approx(area).epsilon(1e-3));
    CHECK(lost == Approx(area).epsilon(1e-9));
  }
}

// K_T = K0 u^(1/3) integrates to u^(2/3) falling along a line: T of a displacement in closed form.
TEST_CASE("the tangential force follows Mindlin & Deresiewicz' curve at a constant normal force") {
  Law law{};
  const double overlap = 0.002, limit = constants.friction * 4e4 * overlap;  // mu N
  const double k0 = constants.tangential;
  const double loaded = 0.8 * 1.5 * limit / k0;  // relative to gross sliding
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
  const double reloaded = 0.3 * loaded;
  const double end = sheared(law, overlap, reloaded);
  const double room = limit - turned_back;
  CHECK(end == Approx(limit - curve(room, reloaded)).epsilon(2e-3));
  // And until it slides.
  CHECK(sheared(law, overlap, 3 * loaded) == Approx(limit));
}

// A force that passes zero at one side, however near, has not reversed: along the path it equals
// that on the straight one.
TEST_CASE("a path a little to one side of a straight one has nearly its tangential force") {
  const double overlap = 0.002, limit = constants.friction * 4e4 * overlap;
  const double loaded = 0.8 * 1.5 * limit / constants.tangential;
  for (const std::vector<double>& path :
       {std::vector{1.0, -1.8}, std::vector{1.0, -1.8, 1.6}, std::vector{1.0, -0.3, 0.4},
        std::vector{0.6, -1.0, 0.2, -0.1}}) {
    const auto end = [&](double slip) {
      Law law{};
      double force = 0;
      for (const double part : path) {
        force = sheared(law, overlap, part * loaded);
        shear_aside(law, overlap, slip * loaded);
      }
      return force;
    };
    const double straight = end(0);
    for (const double slip : {1e-2, 1e-3, 1e-4, 1e-6}) {
      CAPTURE(path, slip);
      CHECK(std::abs(end(slip) - straight) < (3 * slip + 1e-3) * limit);
      CHECK(std::abs(end(-slip) - straight) < (3 * slip + 1e-3) * limit);
    }
  }
}

// N changes along the path: Walton & Braun's increment with T* that follows mu N, as an equation of
// the displacement, against a Runge-Kutta method that knows nothing of steps or vectors.
TEST_CASE("the tangential force follows its equation while the normal force grows and falls") {
  const double k0 = constants.tangential, k1 = constants.stiffness, mu = constants.friction;
  struct Leg {
    double displacement, overlap_from, overlap_to;
  };
  // Along K1 all the while: the overlap grows; or it stays on the line of K2 below its greatest.
  for (const std::vector<Leg>& path :
       {std::vector<Leg>{{4e-4, 0.001, 0.003}},
        std::vector<Leg>{{3e-4, 0.001, 0.002}, {-4e-4, 0.002, 0.003}},
        std::vector<Leg>{{5e-4, 0.002, 0.002}, {-2e-4, 0.002, 0.0018}, {3e-4, 0.0018, 0.002}}}) {
    Law law{};
    double force = 0, at_reversal = 0, direction = 1, greatest = 0;  // T, T* / (mu N), sign
    for (const Leg& leg : path) {
      constexpr int steps = 40'000;
      const auto normal = [&](double overlap) {
        const double a0 = constants.latched * std::max(greatest, overlap);
        return std::min(k1 * overlap, constants.unloading * (overlap - a0));
      };
      const double overlap_rate = (leg.overlap_to - leg.overlap_from) / steps;
      const double towards = leg.displacement > 0 ? 1 : -1;
      if (towards != direction) at_reversal = force / (mu * normal(leg.overlap_from));
      direction = towards;
      // K_T = K0 ((mu N -+ T) / (mu N -+ T*))^(1/3).
      const auto slope = [&](double overlap, double t) {
        const double limit = mu * normal(overlap);
        const double left = (limit - direction * t) / (limit * (1 - direction * at_reversal));
        return k0 * std::cbrt(std::clamp(left, 0.0, 1.0));
      };
      const double ds = leg.displacement / steps;
      for (int k = 0; k < steps; ++k) {
        const double overlap = leg.overlap_from + overlap_rate * k;
        greatest = std::max(greatest, overlap);
        const double s1 = slope(overlap, force);
        const double s2 = slope(overlap + 0.5 * overlap_rate, force + 0.5 * ds * s1);
        const double s3 = slope(overlap + 0.5 * overlap_rate, force + 0.5 * ds * s2);
        const double s4 = slope(overlap + overlap_rate, force + ds * s3);
        force += ds * (s1 + 2 * s2 + 2 * s3 + s4) / 6;
        const double limit = mu * normal(overlap + overlap_rate);
        force = std::clamp(force, -limit, limit);
        law(pressed(overlap + overlap_rate, ds / constants.time_step), constants);
      }
      greatest = std::max(greatest, leg.overlap_to);
      CAPTURE(leg.displacement, leg.overlap_from, leg.overlap_to);
      CHECK(-law.tangential.x == Approx(force).epsilon(3e-3));
      CHECK(std::abs(law.tangential.y) + std::abs(law.tangential.z) < 1e-12);
    }
  }
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
  const double previous = std::sqrt(dot(law.tangential, law.tangential));
  const double turn = 1e-3;  // radians a step
  Meeting<double> meeting = pressed(0.002, 0);
  const LawConstants slow = [] {
    LawConstants changed = constants;
    changed.time_step = 1;
    return changed;
  }();
  // About x: the normal turns in y-z, and the surfaces with it, so nothing slides.
  for (int k = 1; k <= 1571; ++k) {
    meeting.normal = {0, -std::sin(turn * k), std::cos(turn * k)};
    meeting.arm = scaled(0.499, meeting.normal);
    meeting.spin = {2 * turn, 0, 0};
    meeting.velocity = cross(Vector3<double>{turn, 0, 0}, scaled(0.998, meeting.normal));
    law(meeting, slow);
  }
  CHECK(std::sqrt(dot(law.tangential, law.tangential)) == Approx(previous).epsilon(1e-9));
  CHECK(std::abs(dot(law.tangential, meeting.normal)) < 1e-12 * previous);
  // About its own normal: the force turns with the spheres.
  const Vector3<double> start = law.tangential;
  meeting.velocity = {0, 0, 0};
  meeting.spin = scaled(2 * turn, meeting.normal);
  for (int k = 0; k < 1571; ++k) law(meeting, slow);
  const double cosine = dot(law.tangential, start) / (previous * previous);
  CHECK(std::abs(cosine - std::cos(1.571)) < 2e-3);
  CHECK(std::sqrt(dot(law.tangential, law.tangential)) == Approx(previous).epsilon(1e-9));
}

TEST_CASE("a tangential force too small to be squared stays a number") {
  for (const double tiny : {1e-135, 1e-145, 1e-155, 1e-160, 1e-200, 1e-310}) {
    CAPTURE(tiny);
    Meeting<double> meeting = pressed(0.002, 0);
    meeting.spin = {1, 1, 1};
    Law latched{};
    latched.tangential = {tiny, 0, tiny};
    LinearLaw<double, true> linear{{tiny, 0, tiny}};
    for (int k = 0; k < 3; ++k) {
      CHECK(std::isfinite(dot(latched(meeting, constants).force, meeting.normal)));
      CHECK(std::isfinite(dot(linear(meeting, constants).force, meeting.normal)));
      CHECK(std::isfinite(dot(latched.tangential, latched.tangential)));
      CHECK(std::isfinite(dot(linear.spring, linear.spring)));
    }
  }
}

TEST_CASE("the cube root is good to 1e-13") {
  for (double x = 1e-30; x <= 1; x *= 1.37)
    CHECK(cube_root_of(x) == Approx(std::cbrt(x)).epsilon(1e-13));
}
