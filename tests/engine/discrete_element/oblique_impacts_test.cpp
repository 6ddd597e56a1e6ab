// Impacts at an angle: friction's impulses, energy at grazing incidence, and how they converge.
#include <catch2/catch.hpp>
#include <numbers>

#include "tests/engine/discrete_element/grain_cases.hpp"

using namespace jostle;
using namespace jostle::grain_cases;

namespace {

const PeriodicBox box{20, 20};

struct Oblique {
  double normal, tangential, spin;  // relative velocities after, of the centres; spin of the first
  // Change of the normal velocity, added up by its size: of a force that pulls, too.
  double pressed;
};

/// The first sphere comes at an angle upon the floor, or upon a second one that rests.
Oblique oblique(const ContactLaw& law, double normal, double tangential, double finer, bool pair) {
  const ReducedSettings units = settings(law, 0, finer);
  const double gap = 0.3 * normal * units.time_step;
  std::vector<GrainState> grains = {
      grain({5, 5, (pair ? 6 : 0.5) + gap}, {tangential, 0, -normal})};
  if (pair) grains.push_back(grain({5, 5, 5}));
  GrainLoop loop = loop_of(box, units, grains);
  Oblique impact{-normal, tangential, 0, 0};
  const double steps = 4 * units.contact_time / units.time_step;
  for (int k = 0; k < steps; ++k) {
    loop.run(1);
    const auto state_after = loop.grains();
    const Vec3 velocity =
        pair ? state_after[0].velocity - state_after[1].velocity : state_after[0].velocity;
    const double pressed = impact.pressed + std::abs(velocity.z - impact.normal);
    impact = {velocity.z, velocity.x, state_after[0].spin.y, pressed};
  }
  return impact;
}

}  // namespace

// Rigid bodies that slide all the while: v_n' = e v_n, v_t' = v_t - mu (1 + e) v_n, omega' = 2.5 mu
// (1 + e) v_n / r on a plane; of two spheres each takes half the spin. I = m d^2 / 10.
TEST_CASE("an oblique impact that slides throughout has the impulses of rigid spheres") {
  const double normal = 0.002;  // slow, so that the normal hardly turns
  for (const double e : {0.3, 0.9, 0.98}) {
    for (const double mu : {0.02, 0.1, 0.3}) {
      const double tangential = 3 * 3.5 * mu * (1 + e) * normal;
      for (const ContactLaw& law :
           {ContactLaw{WaltonBraun{.restitution = e, .friction = mu}},
            ContactLaw{LinearSpringDashpot{.restitution = e, .friction = mu}}}) {
        for (const bool pair : {false, true}) {
          for (const double finer : {1.0, 4.0}) {
            CAPTURE(law.index(), e, mu, pair, finer);
            const Oblique state_after = oblique(law, normal, tangential, finer, pair);
            const double lost = tangential - state_after.tangential, share = pair ? 2.5 : 5;
            // Strong dashpots are off by more: their force begins and ends with a jump.
            const double in_e = law.index() == 1 && e < 0.9 ? 2 : 1;
            CHECK(std::abs(state_after.normal / normal - e) < in_e * (finer > 1 ? 1e-3 : 5e-3));
            // Coulomb's law, of the normal impulse as it is.
            CHECK(lost == Approx(mu * state_after.pressed).epsilon(1e-3));
            CHECK(state_after.spin == Approx(share * mu * state_after.pressed).epsilon(1e-3));
            // The damped spring pulls at the end of the contact: there friction goes by the force's
            // size, and the impulse is no longer (1 + e) v_n. At e = 0.9 that is 2e-3 of it.
            if (finer == 1 || (law.index() == 1 && e < 0.98)) continue;
            const double rigid = mu * (1 + e) * normal;
            CHECK(lost == Approx(rigid).epsilon(1e-3));
            CHECK(state_after.spin == Approx(share * rigid).epsilon(1e-3));
          }
        }
      }
    }
  }
}

// LAMMPS once gained a third of the kinetic energy there (Vyas et al. 2025).
TEST_CASE("no grazing impact gains energy") {
  for (const double degrees : {5.0, 30.0, 45.0, 60.0, 70.0, 75.0, 80.0, 85.0, 88.0}) {
    for (const double mu : {0.1, 0.3, 1.0, 10.0}) {
      for (const double e : {0.5, 0.9, 1.0}) {
        CAPTURE(degrees, mu, e);
        const double angle = degrees * std::numbers::pi / 180;
        const ReducedSettings units = settings(WaltonBraun{.restitution = e, .friction = mu});
        const double normal = 2 * std::cos(angle);
        GrainLoop loop = loop_of(box, units,
                                 {grain({5, 5, 0.5 + 0.3 * normal * units.time_step},
                                        {2 * std::sin(angle), 0, -normal})});
        const double previous = loop.kinetic_energy();
        run_contact(loop, units);
        CHECK(loop.kinetic_energy() < previous * (1 + 2e-3));
      }
    }
  }
}

// The linear law at the angles where LAMMPS gained.
TEST_CASE("no grazing impact on springs and dashpots gains energy, nor one of two spheres") {
  for (const double degrees : {70.0, 75.0, 80.0, 85.0}) {
    for (const double mu : {0.1, 0.3, 1.0}) {
      for (const ContactLaw& law : {ContactLaw{WaltonBraun{.friction = mu}},
                                    ContactLaw{LinearSpringDashpot{.friction = mu}}}) {
        CAPTURE(degrees, mu, law.index());
        const double angle = degrees * std::numbers::pi / 180, speed = 2;
        const Vec3 velocity = {speed * std::sin(angle), 0, -speed * std::cos(angle)};
        const ReducedSettings units = settings(law);
        const double gap = 0.3 * speed * std::cos(angle) * units.time_step;
        GrainLoop floor = loop_of(box, units, {grain({5, 5, 0.5 + gap}, velocity)});
        GrainLoop pair = loop_of(box, units, {grain({5, 5, 6 + gap}, velocity), grain({5, 5, 5})});
        for (GrainLoop* loop : {&floor, &pair}) {
          const double previous = loop->kinetic_energy();
          run_contact(*loop, units);
          CHECK(loop->kinetic_energy() < previous);
        }
      }
    }
  }
}

// Without dashpots nothing hides what the step makes or loses.
TEST_CASE("no grazing impact on elastic springs gains more than the error of the step") {
  constexpr int phases = 7;
  for (const double degrees : {70.0, 75.0, 80.0, 85.0}) {
    for (const double mu : {0.1, 0.3, 1.0}) {
      const double angle = degrees * std::numbers::pi / 180, speed = 2;
      const Vec3 velocity = {speed * std::sin(angle), 0, -speed * std::cos(angle)};
      const ReducedSettings units = settings(LinearSpringDashpot{.restitution = 1, .friction = mu});
      for (int k = 0; k < phases; ++k) {
        CAPTURE(degrees, mu, k);
        const double gap = k / double(phases) * speed * std::cos(angle) * units.time_step;
        GrainLoop loop = loop_of(box, units, {grain({5, 5, 0.5 + gap}, velocity)});
        const double previous = loop.kinetic_energy();
        run_contact(loop, units);
        CHECK(loop.kinetic_energy() < previous * (1 + 1e-4));
      }
    }
  }
}

TEST_CASE("two spheres of opposite spin part as mirror images, none made to slide backwards") {
  for (const ContactLaw& law : {ContactLaw{WaltonBraun{.friction = 0.3}},
                                ContactLaw{LinearSpringDashpot{.friction = 0.3}}}) {
    for (const double spin : {0.1, 1.0, 10.0, 100.0}) {
      CAPTURE(law.index(), spin);
      const ReducedSettings units = settings(law);
      // Opposite spins, equal surface velocities: nothing rubs, and spins stay.
      GrainLoop rolling = loop_of(box, units,
                                  {grain({5, 5, 6.001}, {0, 0, -0.5}, {0, spin, 0}),
                                   grain({5, 5, 5}, {0, 0, 0.5}, {0, -spin, 0})});
      run_contact(rolling, units);
      const auto rolled = rolling.state().grains;
      REQUIRE(rolled[0].velocity.z > 0.3);
      CHECK(rolled[0].spin.y == spin);
      CHECK(rolled[1].spin.y == -spin);
      CHECK(rolled[0].velocity.x == 0);
      // Equal spins: surfaces rub at spin x d.
      GrainLoop rubbing = loop_of(box, units,
                                  {grain({5, 5, 6.001}, {0, 0, -0.5}, {0, spin, 0}),
                                   grain({5, 5, 5}, {0, 0, 0.5}, {0, spin, 0})});
      run_contact(rubbing, units);
      const auto rubbed = rubbing.state().grains;
      CHECK(rubbed[0].velocity.x == Approx(-rubbed[1].velocity.x).epsilon(1e-12));
      CHECK(rubbed[0].velocity.z == Approx(-rubbed[1].velocity.z).epsilon(1e-12));
      CHECK(rubbed[0].spin.y == Approx(rubbed[1].spin.y).epsilon(1e-12));
      CHECK(rubbed[0].spin.y < spin);
      // Contacts that slide throughout still slide in one direction; sticking ones swing back by
      // less.
      const double previous =
          -spin;  // velocity of the upper surface along x, less that of the lower
      const double following =
          rubbed[0].velocity.x - rubbed[1].velocity.x - 0.5 * (rubbed[0].spin.y + rubbed[1].spin.y);
      CHECK(std::abs(following) < std::abs(previous));
      if (spin >= 10) CHECK(following * previous > 0);  // 3.5 mu (1 + e) v_n = 2
    }
  }
}

// The cube root of the tangential law has no slope where sliding begins, dashpots begin and end
// with a jump: first order.
TEST_CASE("half the step makes half the error of an impact that sticks") {
  for (const ContactLaw& law : {ContactLaw{WaltonBraun{.friction = 0.3}},
                                ContactLaw{LinearSpringDashpot{.friction = 0.3}}}) {
    const auto parted = [&](double finer, double begins) {
      const ReducedSettings units = settings(law, 0, finer);
      const double speed = 0.5, gap = (2 + begins) * finer * units.time_step * speed;
      const double across = law.index() == 0 ? 0.3 * speed : 3 * speed;
      GrainLoop loop =
          loop_of(box, units, {grain({5, 5, 6 + gap}, {across, 0, -speed}), grain({5, 5, 5})});
      run_contact(loop, units);
      return loop.state().grains[0];
    };
    constexpr int phases = 10;
    double whole = 0, quarter = 0;
    for (int k = 0; k < phases; ++k) {
      const double begins = k / double(phases);
      const GrainState exact = parted(64, begins);
      whole += norm_squared(parted(1, begins).velocity - exact.velocity);
      quarter += norm_squared(parted(4, begins).velocity - exact.velocity);
    }
    CAPTURE(law.index(), whole, quarter);
    CHECK(std::sqrt(whole / phases) < 5e-3);
    CHECK(std::sqrt(whole / quarter) > 2.5);
  }
}

// Spins about every axis turn the tangential force in its plane, past zero on one side of it. If
// each step detected a reversal by chance, such impacts would differ by 1e-2 at any step.
TEST_CASE("oblique impacts of spinning spheres converge to one result as the step is refined") {
  RandomStream random(stream_key(20261125, 0, 0, Purpose::start));
  const auto interval = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  const Vec3 direction = {2.0 / 3, 1.0 / 3, 2.0 / 3}, middle = {10, 10, 10};
  for (const double mu : {0.1, 0.3, 0.5}) {
    double coarse = 0, fine = 0, finest = 0;
    constexpr int impacts = 24;
    for (int k = 0; k < impacts; ++k) {
      const double normal = 0.5, begins = interval(0.1, 0.9);
      const double slip = std::exp(interval(-2.7, 0.7)) * 3.5 * mu * 1.9 * normal;
      const double angle = interval(0, 2 * std::numbers::pi);
      const auto any_spin = [&] {
        return 4 * slip * Vec3{interval(-1, 1), interval(-1, 1), interval(-5, 5)};
      };
      const Vec3 velocity = {slip * std::cos(angle), slip * std::sin(angle), -normal};
      const Vec3 spin = any_spin(), other_spin = any_spin();
      const auto state_after = [&](double finer) {
        const ReducedSettings units = settings(WaltonBraun{.friction = mu}, 0, finer);
        const double gap = begins * normal * units.time_step;
        const GrainState upper = grain({5, 5, 0.5 + gap}, velocity, spin);
        // Equal speed along the line of centres, for any speed across it.
        const Vec3 meets = velocity - (dot(velocity, direction) + normal) * direction;
        const GrainState second = grain(middle + (1 + gap) * direction, meets, spin);
        GrainLoop loop = k % 2 == 0 ? loop_of(box, units, {upper})
                                    : loop_of(box, units, {grain(middle, {}, other_spin), second});
        run_contact(loop, units);
        const auto grains = loop.state().grains;
        return std::pair(grains.back().velocity, grains.back().spin);
      };
      const auto exact = state_after(512);
      const auto error = [&](double finer) {
        const auto [v, w] = state_after(finer);
        return (norm_squared(v - exact.first) + 0.1 * norm_squared(w - exact.second)) /
               (normal * normal);
      };
      coarse += error(4);
      fine += error(16);
      const double last = error(64);
      finest += last;
      CAPTURE(mu, k, last);
      CHECK(std::sqrt(last) < 4e-3 * mu);
    }
    CAPTURE(mu, coarse, fine, finest);
    CHECK(std::sqrt(coarse / impacts) < 1.5e-2 * mu);
    CHECK(std::sqrt(coarse / fine) > 2);
    CHECK(std::sqrt(fine / finest) > 2.5);
  }
}
