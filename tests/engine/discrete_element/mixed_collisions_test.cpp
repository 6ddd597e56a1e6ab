// Collisions of two spheres of different size and density, against closed forms.
#include <catch2/catch.hpp>
#include <numbers>

#include "engine/discrete_element/kernel/contact_law.hpp"
#include "tests/engine/discrete_element/grain_cases.hpp"

using namespace jostle;
using namespace jostle::grain_cases;

namespace {

const PeriodicBox box{40, 40};

struct Pair {
  double diameters[2], densities[2];

  std::shared_ptr<const Sizes> sizes() const {
    return sizes_of({diameters[0], diameters[1]}, {densities[0], densities[1]});
  }
};
// The last are equal spheres, of another size than 1.
const std::vector<Pair> pairs = {
    {{1, 0.5}, {1, 1}}, {{0.4, 4}, {1, 1}}, {{1.4, 1}, {0.5, 3}}, {{2, 2}, {1, 1}}};

// No axis, nor a plane between axes; and across it.
const Vec3 direction = {2.0 / 3, 1.0 / 3, 2.0 / 3};
const Vec3 across = {1 / std::numbers::sqrt2, 0, -1 / std::numbers::sqrt2};

/// Two bodies: spheres, or one sphere and the floor, with what their closed forms need.
struct Bodies {
  Pair pair;
  bool on_floor = false;

  double radius(int i) const { return 0.5 * pair.diameters[i]; }
  double mass(int i) const { return pair.densities[i] * std::pow(pair.diameters[i], 3); }
  double reduced_mass() const {
    return on_floor ? mass(0) : mass(0) * mass(1) / (mass(0) + mass(1));
  }
  LightestMasses lightest() const { return {reduced_mass(), reduced_mass()}; }
};

/// For the first sphere relative to the other body: velocity of the centres along their line and
/// across it, of the surfaces across it; and its spin about the third direction.
struct Relative {
  double normal, across, slip, spin;
};

Relative relative_of(const std::vector<GrainState>& grains, const Bodies& bodies) {
  const Vec3 normal = bodies.on_floor ? Vec3{0, 0, 1} : -1.0 * direction;
  const Vec3 plane = bodies.on_floor ? Vec3{1, 0, 0} : across;
  Vec3 velocity = grains[0].velocity, scaled_spin = grains[0].spin;
  if (!bodies.on_floor) {
    velocity = velocity - grains[1].velocity;
    scaled_spin = scaled_spin + grains[1].spin;
  }
  const Vec3 surfaces = velocity - cross(scaled_spin, normal);
  return {dot(velocity, normal), dot(velocity, plane), dot(surfaces, plane),
          dot(grains[0].spin, cross(normal, plane)) / bodies.radius(0)};
}

/// They meet at this speed, and slide on each other at another by their spins alone: their normal
/// hardly turns.
struct Impact {
  Relative approach, departure;
};
Impact impact(const Bodies& bodies, const ContactLaw& law, double normal, double slip,
              double finer) {
  const ReducedSettings units = settings(law, 0, finer, bodies.lightest());
  const double gap = 0.3 * normal * units.time_step;
  std::vector<GrainState> grains;
  if (bodies.on_floor) {
    grains = {
        grain({0.1, 0.1, bodies.radius(0) + gap}, {0.5 * slip, 0, -normal}, {0, -0.5 * slip, 0})};
  } else {
    // The second half of the slip by spins, one of which is larger.
    const double distance = bodies.radius(0) + bodies.radius(1) + gap;
    const Vec3 turn = slip * cross(direction, across);
    grains = {grain({0.1, 0.1, 3}, normal * direction, 0.7 * turn),
              grain(Vec3{0.1, 0.1, 3} + distance * direction, {}, 0.3 * turn)};
  }
  std::vector<double> diameters{bodies.pair.diameters[0]}, densities{bodies.pair.densities[0]};
  if (!bodies.on_floor) {
    diameters.push_back(bodies.pair.diameters[1]);
    densities.push_back(bodies.pair.densities[1]);
  }
  GrainLoop loop =
      loop_of(box, units, grains, best_instruction_set(), sizes_of(diameters, densities));
  Impact impact;
  impact.approach = relative_of(loop.grains(), bodies);
  loop.run(static_cast<std::uint64_t>(1.2 * units.contact_time / units.time_step));
  impact.departure = relative_of(loop.grains(), bodies);
  return impact;
}

std::vector<Bodies> all_bodies() {
  std::vector<Bodies> bodies;
  for (const Pair& pair : pairs) {
    bodies.push_back({pair, false});
    bodies.push_back({pair, true});
  }
  return bodies;
}

}  // namespace

// Walton & Braun 1986: e = sqrt(K1 / K2). Dashpots: 2 |ln e| sqrt(k m / (pi^2 + ln^2 e)).
TEST_CASE("every pair of sizes, and each sphere on the floor, parts with the restitution") {
  for (const Bodies& bodies : all_bodies()) {
    for (const double e : {0.1, 0.5, 0.9, 1.0}) {
      for (const ContactLaw& law :
           {ContactLaw{WaltonBraun{.restitution = e, .friction = 0}},
            ContactLaw{LinearSpringDashpot{.restitution = e, .friction = 0}}}) {
        CAPTURE(bodies.pair.diameters, bodies.pair.densities, bodies.on_floor, e, law.index());
        const double speed = 1e-3;
        const auto ratio = [&](double finer) {
          return impact(bodies, law, speed, 0, finer).departure.normal / speed;
        };
        CHECK(std::abs(ratio(1) - e) < 5e-3);
        CHECK(std::abs(ratio(4) - e) < 1e-3);
      }
    }
  }
}

// Rigid bodies that slide all the while: impulses m (1 + e) v_n and mu times that, m the reduced
// mass; each sphere takes 5/2 of the latter over its mass and radius as spin.
TEST_CASE("an oblique impact of unequal spheres that slides has the impulses of rigid bodies") {
  constexpr double normal = 2e-4, slip = 30 * normal;
  for (const Bodies& bodies : all_bodies()) {
    for (const ContactLaw& law :
         {ContactLaw{WaltonBraun{.restitution = 0.9, .friction = 0.1}},
          ContactLaw{LinearSpringDashpot{.restitution = 1, .friction = 0.1}}}) {
      CAPTURE(bodies.pair.diameters, bodies.pair.densities, bodies.on_floor, law.index());
      // Latched springs take up friction from zero anew while their normal turns: second order.
      const double e = law.index() == 0 ? 0.9 : 1, finer = law.index() == 0 ? 800 : 100;
      const Impact found = impact(bodies, law, normal, slip, finer);
      REQUIRE(found.approach.slip == Approx(slip).epsilon(1e-6));
      const double m = bodies.reduced_mass(), rubbed = 0.1 * m * (1 + e) * normal;
      const double lost = found.approach.across - found.departure.across;
      const double slip_lost = found.approach.slip - found.departure.slip;
      CHECK(std::abs(found.departure.normal - e * normal) / normal < 1e-6);
      CHECK(std::abs(lost - rubbed / m) / normal < 1e-6);
      CHECK(std::abs(slip_lost - 3.5 * rubbed / m) / normal < 2e-6);
      const double turned = 2.5 * rubbed / (bodies.mass(0) * bodies.radius(0));
      const double at_rim =
          bodies.radius(0) * (found.departure.spin - found.approach.spin - turned);
      CHECK(std::abs(at_rim) / normal < 2e-6);
    }
  }
}

// Elastic springs, the tangential one 2/7 of the normal: slip and approach swing back together, for
// what slides has 2/7 of the reduced mass whatever the sizes.
TEST_CASE("an elastic oblique impact of unequal spheres that sticks turns the slip round") {
  constexpr double normal = 2e-4, slip = normal, finer = 100;
  for (const Bodies& bodies : all_bodies()) {
    CAPTURE(bodies.pair.diameters, bodies.pair.densities, bodies.on_floor);
    const LinearSpringDashpot law{.restitution = 1, .friction = 5};
    const Impact found = impact(bodies, law, normal, slip, finer);
    const double m = bodies.reduced_mass(), impulse = 2.0 / 3.5 * m * slip;
    CHECK(std::abs(found.departure.normal - normal) / normal < 1e-6);
    CHECK(std::abs(found.departure.slip + slip) / normal < 2e-6);
    CHECK(std::abs(found.approach.across - found.departure.across - impulse / m) / normal < 1e-6);
    const double turned = 2.5 * impulse / (bodies.mass(0) * bodies.radius(0));
    const double at_rim = bodies.radius(0) * (found.departure.spin - found.approach.spin - turned);
    CHECK(std::abs(at_rim) / normal < 2e-6);
  }
}

TEST_CASE("an impact of unequal spheres keeps momentum and angular momentum to rounding") {
  for (const Pair& pair : pairs) {
    const Bodies bodies{pair};
    const auto sizes = pair.sizes();
    const ReducedSettings units =
        settings(WaltonBraun{.friction = 0.4}, 0, 1, lightest_masses(sizes->masses()));
    const double reach = bodies.radius(0) + bodies.radius(1);
    GrainLoop loop =
        loop_of(box, units,
                {grain({5, 5, 5}, {1, 0.3, -0.2}, {3, -2, 5}),
                 grain(Vec3{5, 5, 5} + reach * Vec3{0.8, 0.61, 0.0}, {-1, 0.1, 0.4}, {-1, 4, 2})},
                best_instruction_set(), sizes);
    const auto sums = [&] {
      Vec3 momentum, angular;
      const auto grains = loop.state().grains;
      for (int i = 0; i < 2; ++i) {
        const GrainState& grain = grains[i];
        const double m = bodies.mass(i);
        momentum = momentum + m * grain.velocity;
        angular = angular + m * cross(grain.centre, grain.velocity) +
                  0.4 * m * bodies.radius(i) * grain.spin;
      }
      return std::pair(momentum, angular);
    };
    const auto state_before = sums();
    const double energy = loop.kinetic_energy(), scale = bodies.mass(0) + bodies.mass(1);
    run_contact(loop, units);
    const auto state_after = sums();
    CAPTURE(pair.diameters, pair.densities);
    REQUIRE(loop.kinetic_energy() < 0.999 * energy);
    CHECK(length(state_after.first - state_before.first) < 1e-13 * scale);
    CHECK(length(state_after.second - state_before.second) < 1e-11 * scale);
  }
}

// A pair that turns as a whole about its normal takes its tangential force along, whatever the
// share of either sphere in the sum of radius x spin.
TEST_CASE("the tangential force of unequal spheres turns with a pair that turns rigidly") {
  const double a = 0.3, b = 1.2, turn = 1e-3;
  const LawConstants law{.stiffness = 4e4,
                         .unloading = 4e4 / 0.81,
                         .latched = 0.19,
                         .tangential = 3.2e4,
                         .friction = 0.3,
                         .time_step = 1};
  WaltonBraunLaw<double, true> contact{};
  contact.tangential = {1, 0, 0};
  SizedMeeting<double> meeting;
  meeting.normal = {0, 0, 1};
  meeting.overlap = 0.002;
  meeting.per_diameter = 1 / (a + b);
  meeting.mass_root = 1;
  meeting.arm = {0, 0, 1};
  meeting.velocity = {0, 0, 0};
  meeting.spin = {0, 0, (a + b) * turn};
  for (int k = 0; k < 1571; ++k) contact(meeting, law);
  CHECK(std::abs(contact.tangential.x - std::cos(1.571)) < 2e-3);
  CHECK(std::abs(contact.tangential.y - std::sin(1.571)) < 2e-3);
}

// The lightest pair makes the shortest contact; a sphere on the floor moves all of its mass.
TEST_CASE("the time step is that of the lightest pair, or of the lightest sphere at a side") {
  const double light[] = {4, 0.125, 1};
  const LightestMasses lightest = lightest_masses(light);
  CHECK(lightest.sphere == 0.125);
  CHECK(lightest.pair == Approx(0.125 / 1.125));
  const double alone[] = {8};
  CHECK(lightest_masses(alone).sphere == 8);
  CHECK(lightest_masses(std::vector<MixtureKind>{}).pair == 0.5);
  const std::vector<MixtureKind> kinds = {{"dust", 1, FixedDiameter{0.5}},
                                          {"sand", 9, UniformDiameter{0.8, 1}, 2},
                                          {"lead", 2, ListedDiameters{{0.5, 3}}, 8}};
  CHECK(lightest_masses(kinds).sphere == 0.125);
  CHECK(lightest_masses(kinds).pair == Approx(0.125 / 1.125));  // a sphere of 0.5 d and density 8
  // Drawn diameters may be the least: a scene is refused only where none of its beds can be run.
  CHECK(lightest_masses(std::vector<MixtureKind>{{"drawn", 9, UniformDiameter{0.5, 2}}}).sphere ==
        0.125);
  for (const ContactLaw& law : {ContactLaw{WaltonBraun{}}, ContactLaw{LinearSpringDashpot{}}}) {
    DiscreteElement engine;
    engine.spheres = law;
    const double whole = reduced(engine).time_step;
    CHECK(reduced(engine, {0.01, 0.005}).time_step == Approx(0.1 * whole).epsilon(1e-12));
    CHECK(reduced(engine, lightest).time_step ==
          Approx(std::sqrt(2 * 0.125 / 1.125) * whole).epsilon(1e-12));
    engine.floor = engine.spheres;
    std::visit([](auto& floor) { floor.stiffness = 1e8; }, *engine.floor);
    CHECK(reduced(engine, lightest).time_step ==
          Approx(std::sqrt(0.125) * reduced(engine).time_step).epsilon(1e-12));
  }
}
