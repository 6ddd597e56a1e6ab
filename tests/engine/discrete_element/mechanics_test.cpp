#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "engine/bed/boundary.hpp"
#include "engine/discrete_element/reduced.hpp"
#include "engine/engines.hpp"
#include "engine/starts/starts.hpp"
#include "tests/engine/discrete_element/grain_cases.hpp"

using namespace jostle;
using namespace jostle::grain_cases;

namespace {

Vec3 force_on_first(const Contact& contact) {
  return contact.normal_force * contact.normal + contact.tangential_force;
}

// Force on every sphere, including weight.
struct Acting {
  std::vector<Vec3> force, torque;
};
Acting acting(const BedMechanics& bed, std::uint32_t n, bool arm_is_radius) {
  Acting sum{std::vector<Vec3>(n, Vec3{0, 0, -1}), std::vector<Vec3>(n)};
  for (const Contact& contact : bed.contacts) {
    const bool pair = contact.second < n;
    const Vec3 force = force_on_first(contact);
    const double half = pair ? 0.5 * (1 - contact.overlap) : 0.5 - contact.overlap;
    const Vec3 torque = cross(force, (arm_is_radius ? 0.5 : half) * contact.normal);
    sum.force[contact.first] = sum.force[contact.first] + force;
    sum.torque[contact.first] = sum.torque[contact.first] + torque;
    if (!pair) continue;
    sum.force[contact.second] = sum.force[contact.second] - force;
    sum.torque[contact.second] = sum.torque[contact.second] + torque;
  }
  return sum;
}

std::vector<GrainState> column_of(const Container& container, std::uint32_t n) {
  std::vector<GrainState> grains;
  for (const Vec3 centre : dilute_column(container, n, 5).centres) grains.push_back(grain(centre));
  return grains;
}

double largest(const std::vector<Vec3>& vectors) {
  double most = 0;
  for (const Vec3& vector : vectors) most = std::max(most, length(vector));
  return most;
}

bool is_same(const BedMechanics& a, const BedMechanics& b) {
  return a.velocities == b.velocities && a.spins == b.spins && a.contacts == b.contacts;
}

struct WallSums {
  double floor = 0, side_normal = 0, side_friction = 0;  // the last upwards
};
WallSums wall_sums(const BedMechanics& bed, std::uint32_t n) {
  WallSums sums;
  for (const Contact& contact : bed.contacts) {
    if (contact.second == n) sums.floor += contact.normal_force;
    if (contact.second <= n) continue;
    sums.side_normal += contact.normal_force;
    sums.side_friction += contact.tangential_force.z;
  }
  return sums;
}

}  // namespace

TEST_CASE("contacts have the forces that the next step moves spheres by") {
  const Container container =
      GENERATE(Container{PeriodicBox{4, 4}}, Container{WalledBox{3.3, 4}}, Container{Cylinder{4}},
               Container{PeriodicBox{2.05, 3}}, Container{Plates{4, 3.3}});
  const ContactLaw law = GENERATE(ContactLaw{WaltonBraun{.stiffness = 1e4}},
                                  ContactLaw{LinearSpringDashpot{.stiffness = 1e4}},
                                  ContactLaw{WaltonBraun{.stiffness = 1e4, .friction = 0}},
                                  ContactLaw{LinearSpringDashpot{.stiffness = 1e4, .friction = 0}});
  const bool linear = std::holds_alternative<LinearSpringDashpot>(law);
  const bool friction =
      std::visit([](const auto& contact_law) { return contact_law.friction; }, law) > 0;
  constexpr std::uint32_t n = 60;
  const ReducedSettings units = settings(law, 1);
  GrainLoop loop = loop_of(container, units, column_of(container, n));
  GrainLoop separate = loop_of(container, units, column_of(container, n), InstructionSet::baseline);
  for (const double time : {0.3, 10.0, 0.2}) {
    const auto steps = static_cast<std::uint64_t>(time / units.time_step);
    loop.run(steps);
    separate.run(steps);
    const std::vector<GrainState> grains_before = loop.state().grains;
    const BedMechanics bed = loop.mechanics();
    CHECK(is_same(bed, separate.mechanics()));
    const GrainLoop::State kept = loop.state();
    GrainLoop restored(container, units);
    restored.restore(kept);
    CHECK(is_same(bed, restored.mechanics()));

    GrainLoop next = loop;
    next.run(1);
    const std::vector<GrainState> grains_after = next.state().grains;
    const Acting sums = acting(bed, n, linear);
    const double step = units.time_step;
    double force_error = 0, torque_error = 0, velocity_error = 0, spin_error = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      const Vec3 gained = (1 / step) * (grains_after[i].velocity - grains_before[i].velocity);
      const Vec3 turned = (0.1 / step) * (grains_after[i].spin - grains_before[i].spin);
      force_error = std::max(force_error, length(gained - sums.force[i]));
      torque_error = std::max(torque_error, length(turned - sums.torque[i]));
      const Vec3 middle = 0.5 * (grains_after[i].velocity + grains_before[i].velocity);
      velocity_error = std::max(velocity_error, length(middle - bed.velocities[i]));
      if (!friction) continue;
      const Vec3 mean_spin = 0.5 * (grains_after[i].spin + grains_before[i].spin);
      spin_error = std::max(spin_error, length(mean_spin - bed.spins[i]));
    }
    CAPTURE(container.index(), law.index(), time);
    CHECK(force_error < 1e-8 * (1 + largest(sums.force)));
    CHECK(torque_error < 1e-8 * (1 + largest(sums.torque)));
    CHECK(velocity_error < 1e-13 * (1 + largest(bed.velocities)));
    CHECK(spin_error < 1e-13 * (1 + largest(bed.spins)));
    CHECK(bed.spins.size() == (friction ? n : 0));
    CHECK((time == 0.3 || !bed.contacts.empty()));
    const bool sorted = std::ranges::is_sorted(bed.contacts, {}, [](const Contact& contact) {
      return std::tuple(contact.first, contact.second);
    });
    CHECK(sorted);
    for (const Contact& contact : bed.contacts) {
      CHECK(contact.first < contact.second);
      CHECK(contact.overlap > 0);
      CHECK(std::abs(length(contact.normal) - 1) < 1e-14);
      CHECK(std::abs(dot(contact.tangential_force, contact.normal)) < 1e-9);
      if (!friction) CHECK(contact.tangential_force == Vec3{});
      const double mu =
          std::visit([](const auto& contact_law) { return contact_law.friction; }, law);
      CHECK(length(contact.tangential_force) <=
            mu * std::abs(contact.normal_force) * (1 + 1e-9) + 1e-9);
    }
  }
}

TEST_CASE("looking at forces changes nothing that follows") {
  const Container container = PeriodicBox{4, 4};
  const ReducedSettings units = settings(WaltonBraun{}, 1);
  GrainLoop watched = loop_of(container, units, column_of(container, 80));
  GrainLoop alone = watched;
  for (int k = 0; k < 40; ++k) {
    watched.run(251);
    alone.run(251);
    watched.mechanics();
    watched.mechanics();
  }
  const GrainLoop::State a = watched.state(), b = alone.state();
  bool equal = a.pairs.size() == b.pairs.size() && a.sides.size() == b.sides.size();
  for (std::size_t i = 0; i < a.grains.size(); ++i)
    equal = equal && a.grains[i].centre == b.grains[i].centre &&
            a.grains[i].velocity == b.grains[i].velocity && a.grains[i].spin == b.grains[i].spin &&
            a.grains[i].friction == b.grains[i].friction;
  for (std::size_t k = 0; equal && k < a.pairs.size(); ++k)
    equal = a.pairs[k].history == b.pairs[k].history;
  CHECK(equal);
  CHECK(watched.pair_tests() == alone.pair_tests());
  CHECK(watched.greatest_overlap() == alone.greatest_overlap());
}

TEST_CASE("latched springs without friction press by K1 and K2 alone") {
  const ReducedSettings units = settings(WaltonBraun{.friction = 0});
  const double k1 = units.spheres.stiffness, k2 = units.spheres.unloading;
  const double latched = units.spheres.latched;
  // A chain on the floor: loading, and unloading from a greater overlap.
  const double on_floor = 3e-4, loading = 2e-4, unloading = 5e-5, greatest = 1e-4, parted = 1e-6;
  double z = 0.5 - on_floor;
  std::vector<GrainState> grains = {grain({2, 2, z})};
  for (const double overlap : {loading, unloading, parted})
    grains.push_back(grain({2, 2, z += 1 - overlap}));
  GrainLoop loop(PeriodicBox{4, 4}, units);
  GrainLoop::State state;
  state.grains = grains;
  state.pairs = {{.first = 1, .second = 2, .history = {greatest}},
                 {.first = 2, .second = 3, .history = {greatest}}};
  loop.restore(state);
  const BedMechanics bed = loop.mechanics();
  REQUIRE(bed.contacts.size() == 3);  // a contact that returned to a0 has no force
  CHECK(bed.contacts[0].first == 0);
  CHECK(bed.contacts[0].second == 1);
  CHECK(bed.contacts[0].overlap == Approx(loading).epsilon(1e-11));
  CHECK(bed.contacts[0].normal_force == Approx(k1 * loading).epsilon(1e-11));
  CHECK(bed.contacts[0].normal.z == -1);
  CHECK(bed.contacts[1].second == 4);
  CHECK(bed.contacts[1].normal_force == Approx(units.floor.stiffness * on_floor).epsilon(1e-11));
  CHECK(bed.contacts[1].normal == Vec3{0, 0, 1});
  CHECK(bed.contacts[2].normal_force ==
        Approx(k2 * (unloading - latched * greatest)).epsilon(1e-9));
}

TEST_CASE("the floor and rough sides carry the weight of a bed at rest") {
  const Container container = GENERATE(Container{PeriodicBox{4, 4}}, Container{WalledBox{4, 4}});
  constexpr std::uint32_t n = 100;
  // Dashpots bring a bed to rest where latched springs ring on.
  const LinearSpringDashpot law{.stiffness = 1e4, .restitution = 0.3, .friction = 0.3};
  const ReducedSettings units = settings(law, 1);
  GrainLoop loop = loop_of(container, units, column_of(container, n));
  loop.run(static_cast<std::uint64_t>(120 / units.time_step));
  REQUIRE(loop.kinetic_energy() / n < 1e-7);
  const BedMechanics bed = loop.mechanics();
  const WallSums walls = wall_sums(bed, n);
  CHECK(walls.floor + walls.side_friction == Approx(n).epsilon(1e-4));
  const Acting sums = acting(bed, n, true);
  double momentum = 0;
  for (const Vec3& force : sums.force) momentum += force.z;
  CHECK(momentum == Approx(walls.floor + walls.side_friction - n).margin(1e-9));
  CHECK(largest(sums.force) < 1e-3);
  CHECK(largest(sums.torque) < 1e-3);
}

TEST_CASE("rough walls of a tall duct carry weight, smooth ones none") {
  const Container duct = WalledBox{3.3, 3.3};
  constexpr std::uint32_t n = 150;
  RandomStream random(stream_key(3, 0, 0, Purpose::start));
  const Packing start = make_start(SteepestDescentPour{}, duct, n, random);
  // A bed without stress that becomes heavy by and by slides down its walls: one that falls as a
  // whole is wedged by the impact.
  const auto loaded = [&](double side_friction) {
    DiscreteElement engine;
    engine.spheres = LinearSpringDashpot{.stiffness = 1e4, .restitution = 0.3, .friction = 0.5};
    engine.sides =
        LinearSpringDashpot{.stiffness = 1e4, .restitution = 0.3, .friction = side_friction};
    ReducedSettings units = reduced(engine);
    std::vector<GrainState> grains;
    for (const Vec3 centre : start.centres) grains.push_back(grain(centre));
    GrainLoop loop = loop_of(duct, units, grains);
    constexpr int parts = 20;
    for (int part = 1; part <= parts; ++part) {
      units.gravity = static_cast<double>(part) / parts;
      GrainLoop heavier(duct, units);
      heavier.restore(loop.state());
      heavier.run(static_cast<std::uint64_t>((part < parts ? 1 : 10) / units.time_step));
      loop = std::move(heavier);
    }
    return wall_sums(loop.mechanics(), n);
  };
  const WallSums rough = loaded(0.5), smooth = loaded(0);
  CHECK(std::abs(smooth.side_friction) < 1e-9);
  CHECK(smooth.side_normal > 0);
  CHECK(smooth.floor == Approx(n).epsilon(0.02));
  CHECK(rough.side_friction > 0.2 * n);  // Janssen 1895
  CHECK(rough.side_friction <= 0.5 * rough.side_normal);
  CHECK(rough.floor + rough.side_friction == Approx(n).epsilon(0.02));
}

TEST_CASE("velocities and spins of a bed are in diameters and radians a second") {
  DiscreteElement engine;
  const auto dynamics = make_dynamics(EngineSettings{engine}, {});
  dynamics->load({PeriodicBox{4, 4}, {{2, 2, 200.5}}});
  dynamics->settle(RandomSettle{});
  dynamics->advance(1000);
  const double seconds = dynamics->diagnostics()[0];
  const BedMechanics bed = dynamics->mechanics();
  REQUIRE(bed.velocities.size() == 1);
  CHECK(bed.contacts.empty());
  // It was at rest half a step before it began to fall.
  const double fallen = seconds + 0.5 * contact_times(engine).step_seconds;
  CHECK(bed.velocities[0].z == Approx(-engine.gravity / engine.diameter * fallen).epsilon(1e-9));
  CHECK(bed.spins == std::vector<Vec3>(1));
}

TEST_CASE("Monte Carlo has neither velocities nor forces") {
  const auto dynamics = make_dynamics(EngineSettings{MonteCarlo{}}, {});
  const BedMechanics bed = dynamics->mechanics();
  CHECK(bed.velocities.empty());
  CHECK(bed.contacts.empty());
}

TEST_CASE("spheres without friction do not slide, where the floor has friction") {
  ReducedSettings units = settings(WaltonBraun{.friction = 0});
  units.floor.friction = 0.3;
  GrainLoop loop = loop_of(PeriodicBox{20, 20}, units,
                           {grain({5, 5, 5}, {0, 3, -1}), grain({5, 5, 4.0}, {0, 0, 0})});
  loop.run(3);
  REQUIRE(loop.mechanics().contacts.size() == 1);
  CHECK(loop.census().sliding == 0);
}

// Forces grow and shrink from step to step, so that those of two steps have another ratio.
TEST_CASE("two spheres that slide on each other count as sliding from touch to parting") {
  const ContactLaw law = GENERATE(ContactLaw{WaltonBraun{.friction = 0.1}},
                                  ContactLaw{LinearSpringDashpot{.friction = 0.1}});
  const ReducedSettings units = settings(law);
  const double gap = 1.0000001, speed = 1;
  GrainLoop loop = loop_of(PeriodicBox{20, 20}, units,
                           {grain({5, 5, 5}, {0, 3 * speed, -speed}),
                            grain({5, 5, 5 - gap}, {0, 0, 0}), grain({1, 1, 9})});
  int touching = 0;
  for (int step = 0; step < 500; ++step) {
    loop.run(1);
    if (loop.mechanics().contacts.empty()) continue;
    ++touching;
    CHECK(loop.census().sliding == 1);
  }
  CHECK(touching > 20);
}

TEST_CASE("the share that slides is counted from the contacts' forces, without walls") {
  const ContactLaw law =
      GENERATE(ContactLaw{WaltonBraun{.stiffness = 1e4}}, ContactLaw{WaltonBraun{.friction = 0}},
               ContactLaw{LinearSpringDashpot{.stiffness = 1e4}});
  const double mu = std::visit([](const auto& contact_law) { return contact_law.friction; }, law);
  constexpr std::uint32_t n = 60;
  const ReducedSettings units = settings(law, 1);
  const Container container = WalledBox{3.3, 4};
  GrainLoop loop = loop_of(container, units, column_of(container, n));
  loop.run(static_cast<std::uint64_t>(10 / units.time_step));
  double pairs = 0, sliding = 0;
  for (const Contact& contact : loop.mechanics().contacts) {
    if (contact.second >= n) continue;
    ++pairs;
    if (mu > 0) sliding += length(contact.tangential_force) > 0.999999 * mu * contact.normal_force;
  }
  REQUIRE(pairs > 20);
  CHECK((mu == 0 || (sliding > 0 && sliding < pairs)));
  CHECK(loop.census().sliding == sliding / pairs);
}
