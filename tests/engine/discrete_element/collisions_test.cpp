#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "tests/engine/discrete_element/grain_cases.hpp"
#include "tests/test_files.hpp"

using namespace jostle;
using namespace jostle::grain_cases;

namespace {

const PeriodicBox box{20, 20};

/// Two spheres that meet head-on along a direction that is no axis.
double speed_ratio(const ContactLaw& law, double speed, double finer) {
  const ReducedSettings units = settings(law, 0, finer);
  const Vec3 direction = {2.0 / 3, 1.0 / 3, 2.0 / 3};
  const double gap = 1 + 0.3 * speed * units.time_step;
  GrainLoop loop = loop_of(box, units,
                           {grain({5, 5, 5}, 0.5 * speed * direction),
                            grain(Vec3{5, 5, 5} + gap * direction, -0.5 * speed * direction)});
  run_contact(loop, units);
  const auto grains_after = loop.state().grains;
  return dot(grains_after[1].velocity - grains_after[0].velocity, direction) / speed;
}

}  // namespace

// Walton & Braun 1986: e = sqrt(K1 / K2) at every speed.
TEST_CASE("spheres part with the restitution that was asked for, at every speed") {
  for (const double e : {0.05, 0.1, 0.3, 0.5, 0.9, 1.0}) {
    for (const double speed : {0.003, 0.03, 0.3, 3.0}) {
      CAPTURE(e, speed);
      const WaltonBraun latched{.restitution = e, .friction = 0};
      CHECK(std::abs(speed_ratio(latched, speed, 1) - e) < 5e-3);
      CHECK(std::abs(speed_ratio(latched, speed, 4) - e) < 1e-3);
      const LinearSpringDashpot linear{.restitution = e, .friction = 0};
      CHECK(std::abs(speed_ratio(linear, speed, 1) - e) < 5e-3);
      CHECK(std::abs(speed_ratio(linear, speed, 4) - e) < 1e-3);
    }
  }
}

// The error of a head-on impact, over where in a step it begins, goes with the square of the step.
TEST_CASE("half the step makes a quarter of the error of a latched spring") {
  const double e = 0.9, speed = 0.5;
  const auto error = [&](double finer) {
    constexpr int phases = 24;
    double sum = 0;
    for (int k = 0; k < phases; ++k) {
      const ReducedSettings units =
          settings(WaltonBraun{.restitution = e, .friction = 0}, 0, finer);
      const double gap = (2 + k / double(phases)) * finer * units.time_step * speed;
      GrainLoop loop =
          loop_of(box, units, {grain({5, 5, 6 + gap}, {0, 0, -speed}), grain({5, 5, 5})});
      run_contact(loop, units);
      const auto grains_after = loop.state().grains;
      const double found = (grains_after[0].velocity.z - grains_after[1].velocity.z) / speed;
      sum += (found - e) * (found - e);
    }
    return std::sqrt(sum / phases);
  };
  const double whole = error(1), half = error(2), quarter = error(4), eighth = error(8);
  CAPTURE(whole, half, quarter, eighth);
  CHECK(whole < 1e-3);
  CHECK(whole / quarter > 8);
  CHECK(half / eighth > 8);
}

TEST_CASE("an impact keeps momentum and angular momentum to rounding") {
  const ReducedSettings units = settings(WaltonBraun{.friction = 0.4});
  GrainLoop loop = loop_of(box, units,
                           {grain({5, 5, 5}, {1, 0.3, -0.2}, {3, -2, 5}),
                            grain({5.8, 5.61, 5.0}, {-1, 0.1, 0.4}, {-1, 4, 2})});
  // Velocities are half a step before the positions; between impacts that changes neither sum.
  const auto sums = [&] {
    Vec3 momentum, angular;
    for (const GrainState& grain : loop.state().grains) {
      momentum = momentum + grain.velocity;
      angular = angular + cross(grain.centre, grain.velocity) + 0.1 * grain.spin;
    }
    return std::pair(momentum, angular);
  };
  const auto state_before = sums();
  const double energy = loop.kinetic_energy();
  run_contact(loop, units);
  const auto state_after = sums();
  REQUIRE(loop.kinetic_energy() < 0.99 * energy);
  CHECK(length(state_after.first - state_before.first) < 1e-13);
  // The force turns with the half step that the velocities lag: exact to the step, not beyond.
  CHECK(length(state_after.second - state_before.second) < 1e-11);
}

TEST_CASE("a collision is the same turned and boosted") {
  const ReducedSettings units = settings(WaltonBraun{.friction = 0.3});
  // A rotation that takes no axis into another: by quaternion (1, 2, 3, 4) / sqrt(30).
  const auto turn = [](Vec3 a) {
    const double w = 1 / std::sqrt(30.0);
    const Vec3 q = {2 * w, 3 * w, 4 * w};
    const Vec3 t = 2.0 * cross(q, a);
    return a + w * t + cross(q, t);
  };
  const Vec3 boost = {0.7, -1.1, 0.4}, middle = {10, 10, 10};
  const Vec3 r0 = {0, 0, 0.5}, r1 = {0.1, 0, -0.497}, v0 = {0.8, 0.2, -1}, v1 = {-0.3, 0, 0.9};
  const Vec3 w0 = {1, 2, -3}, w1 = {0.5, -1, 2};
  const double dt = units.time_step;
  GrainLoop plain = loop_of(box, units, {grain(middle + r0, v0, w0), grain(middle + r1, v1, w1)});
  GrainLoop moved = loop_of(box, units,
                            {grain(middle + turn(r0), turn(v0) + boost, turn(w0)),
                             grain(middle + turn(r1), turn(v1) + boost, turn(w1))});
  const auto steps = static_cast<std::uint64_t>(2 * units.contact_time / dt);
  plain.run(steps);
  moved.run(steps);
  const auto a = plain.state().grains, b = moved.state().grains;
  REQUIRE(length(a[0].velocity - v0) > 0.5);  // they met
  for (int i = 0; i < 2; ++i) {
    CHECK(length(turn(a[i].velocity) + boost - b[i].velocity) < 1e-9);
    CHECK(length(turn(a[i].spin) - b[i].spin) < 1e-8);
  }
}

// From t = 2 v0 / (7 mu g) on it rolls at 5/7 of its speed.
TEST_CASE("a sphere that slides on the floor comes to roll") {
  const double mu = 0.2, speed = 1;
  const ReducedSettings units = settings(WaltonBraun{.friction = mu}, 1);
  // Already pressed into the floor by its weight.
  const double sunk = 1 / units.floor.unloading;
  GrainLoop loop = loop_of(box, units, {grain({5, 5, 0.5 - sunk}, {speed, 0, 0})});
  const double rolls = 2 * speed / (7 * mu);
  loop.run(static_cast<std::uint64_t>(0.5 * rolls / units.time_step));
  const auto sliding = loop.state().grains[0];
  CHECK(sliding.velocity.x - 0.5 * sliding.spin.y > 0.3 * speed);
  loop.run(static_cast<std::uint64_t>(1.5 * rolls / units.time_step));
  const auto rolling = loop.state().grains[0];
  CHECK(rolling.velocity.x == Approx(5.0 / 7 * speed).epsilon(2e-3));
  CHECK(std::abs(rolling.velocity.x - 0.5 * rolling.spin.y) < 2e-3);
}

TEST_CASE("the ledger closes in the middle of an impact, to the second order of the step") {
  for (const double restitution : {1.0, 0.5}) {
    for (const ContactLaw& law :
         {ContactLaw{WaltonBraun{.restitution = restitution, .friction = 0.3}},
          ContactLaw{LinearSpringDashpot{.restitution = restitution, .friction = 0.3}}}) {
      const auto worst = [&](double finer) {
        const ReducedSettings units = settings(law, 0, finer);
        GrainLoop loop =
            loop_of(box, units,
                    {grain({5, 5, 5}, {0.4, 0.1, 1}), grain({5.1, 5, 6.0}, {0, 0, -1}, {3, 1, 2})});
        const double start = loop.energies().held();
        double missing = 0, deepest = 0;
        for (double time = 0; time < 2 * units.contact_time; time += units.time_step) {
          loop.run(1);
          const Energies now = loop.energies();
          missing = std::max(missing, std::abs(start - now.held() - now.dissipated()));
          deepest = std::max(deepest, now.elastic);
        }
        REQUIRE(deepest > 0.1 * start);
        return missing / start;
      };
      const double coarse = worst(1), fine = worst(4);
      CAPTURE(restitution, law.index(), coarse, fine);
      CHECK(coarse < 3e-3);
      CHECK(fine < coarse / 8);
    }
  }
}

// mu N times the way that the surfaces slide. Energy that the spring keeps while the dashpot pulls
// could not be returned by a contact of mu N.
TEST_CASE("a sphere that slides fast on springs and dashpots rubs away mu N times its way") {
  const double mu = 0.1, speed = 5;
  for (const double restitution : {0.9, 0.2}) {
    CAPTURE(restitution);
    const ReducedSettings units =
        settings(LinearSpringDashpot{.restitution = restitution, .friction = mu}, 1);
    const double sunk = 1 / units.floor.stiffness;
    GrainLoop loop = loop_of(box, units, {grain({5, 5, 0.5 - sunk}, {speed, 0, 0})});
    const double start = loop.energies().held();
    REQUIRE(units.floor.shear_damping * speed > 10 * mu);
    const double springs_hold =
        0.5 / units.floor.stiffness + 0.5 * mu * mu / units.floor.tangential;
    double way = 0, old_friction = 0;
    for (int look = 0; look < 400; ++look) {
      loop.run(5);
      const Energies now = loop.energies();
      const GrainState sphere = loop.state().grains[0];
      way += 5 * units.time_step * (sphere.velocity.x - 0.5 * sphere.spin.y);
      CHECK(now.friction > old_friction);
      CHECK(now.friction == Approx(mu * way).epsilon(0.01).margin(1e-4));
      CHECK(now.elastic < 1.05 * springs_hold);
      CHECK(std::abs(start - now.held() - now.dissipated()) < 1e-3 * mu * way + 1e-4);
      old_friction = now.friction;
    }
  }
}

// At every 20 000th of steps so short that either program's error is below the tolerance.
TEST_CASE("collisions go as those of LAMMPS, that stick and that slide") {
  constexpr double stiffness = 40559.36368294987, tangential = 11588.389623699963;
  constexpr double gamma_n = 19.093013324349467, gamma_t = 9.546506662174734, speed = 0.05;
  const double contact_time =
      std::numbers::pi / std::sqrt(2 * stiffness - 0.25 * gamma_n * gamma_n);
  ReducedSettings units;
  units.law = GrainLaw::linear;
  units.gravity = 0;
  units.time_step = contact_time / 200'000;
  const auto of_mass = [&](double mass) {  // reduced mass: LAMMPS' gamma is a rate
    LawConstants law;
    law.stiffness = stiffness;
    law.tangential = tangential;
    law.friction = 0.1;
    law.damping = mass * gamma_n;
    law.shear_damping = mass * gamma_t;
    law.time_step = units.time_step;
    return law;
  };
  units.spheres = of_mass(0.5);
  units.floor = units.sides = of_mass(1);
  constexpr double gap = 1.0000001;
  const Vec3 second = {5 + gap * 0.6, 5, 5 + gap * 0.8}, third = {5, 5, 0.5000001};
  const auto loop_from = [&](const std::vector<GrainState>& grains) {
    return loop_of(box, units, grains);
  };
  std::map<std::string, GrainLoop> loops;
  loops.emplace("# pair", loop_from({grain({5, 5, 5}, {speed, 0.2 * speed, 0.8 * speed}),
                                     grain(second, {-0.3 * speed, 0, -0.9 * speed})}));
  loops.emplace("# floor", loop_from({grain(third, {0.15 * speed, 0, -speed})}));
  loops.emplace("# sliding pair", loop_from({grain({5, 5, 5}, {7 * speed, 2 * speed, -4 * speed}),
                                             grain(second, {}, {0.8, -2, -0.6})}));
  loops.emplace("# sliding floor",
                loop_from({grain(third, {8 * speed, 2 * speed, -speed}, {0.5, 0, 0})}));

  std::ifstream trace(test_data("lammps_collisions.txt"));
  const auto largest = [](Vec3 a) {
    return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
  };
  GrainLoop* loop = nullptr;
  std::uint64_t done = 0;
  int compared = 0;
  for (std::string line; std::getline(trace, line);) {
    if (const auto found = loops.find(line); found != loops.end()) {
      loop = &found->second;
      done = 0;
    }
    if (line.starts_with("#")) continue;
    REQUIRE(loop != nullptr);
    std::istringstream numbers(line);
    std::uint64_t step = 0;
    numbers >> step;
    loop->run(step - std::exchange(done, step));
    CAPTURE(step);
    for (const GrainState& grain : loop->state().grains) {
      Vec3 centre, velocity, spin;
      for (Vec3* vector : {&centre, &velocity, &spin})
        numbers >> vector->x >> vector->y >> vector->z;
      CHECK(largest(grain.centre - centre) < 1e-9);
      CHECK(largest(grain.seen_velocity - velocity) < 1e-6 * speed);
      CHECK(0.5 * largest(grain.seen_spin - spin) < 1e-6 * speed);
      ++compared;
    }
  }
  CHECK(compared == 86);
}
