#include "engine/dynamics.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "engine/discrete_element/state.hpp"
#include "engine/engines.hpp"
#include "tests/engine/discrete_element/grain_cases.hpp"

using namespace jostle;
using namespace jostle::grain_cases;

namespace {

std::unique_ptr<Dynamics> grains(const DiscreteElement& settings) {
  return make_dynamics(EngineSettings{settings}, {});
}

std::vector<double> settled_values(Dynamics& dynamics, std::uint64_t slice) {
  while (dynamics.advance(slice) == DynamicsStatus::running) {
  }
  return dynamics.diagnostics();
}

double value(const std::vector<double>& values, const std::string& name) {
  const auto all = columns(EngineSettings{DiscreteElement{}});
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].name == name) return values.at(i);
  throw std::logic_error("no such column: " + name);
}

}  // namespace

TEST_CASE("grains come to rest and are tapped, the same however they are sliced and stored") {
  const Container box = PeriodicBox{4, 4};
  const Packing start = dilute_column(box, 100, 8);
  const DiscreteElement settings;
  const std::vector<Tap> taps = {HalfSine{}, Lift{0.1}, Vibration{0.05, 40, 3}, Dilate{0.02}};
  RandomStream random(stream_key(1, 0, 0, Purpose::tap));

  const auto straight = grains(settings);
  straight->load(start);
  straight->settle(RandomSettle{});
  auto stopped = grains(settings);
  stopped->load(start);
  stopped->settle(RandomSettle{});
  // Saved and restored after every slice of an odd number of steps.
  const auto go_on = [&] {
    DynamicsStatus status;
    do {
      status = stopped->advance(100 * 1777);
      Packing bed;
      stopped->store(bed);
      const std::vector<std::byte> state = stopped->save();
      stopped = grains(settings);
      stopped->load(bed);
      stopped->restore(state);
    } while (status == DynamicsStatus::running);
  };
  auto values = settled_values(*straight, 1'000'000);
  CHECK(value(values, "capped") == 0);
  CHECK(value(values, "kinetic_energy") < QuietRest{}.kinetic_energy);
  CHECK(value(values, "contacts") > 3);
  go_on();
  for (const Tap& tap : taps) {
    CAPTURE(tap.index());
    CHECK(stopped->diagnostics() == values);
    Packing a, b;
    straight->store(a);
    stopped->store(b);
    CHECK(a.centres == b.centres);
    straight->tap(tap, random);
    stopped->tap(tap, random);
    values = settled_values(*straight, 123'400);
    go_on();
    CHECK(value(values, "input_energy") > 0);
    CHECK(std::abs(value(values, "ledger_error")) < 2e-3);
  }
  CHECK(straight->effort().units % 100 == 0);
}

TEST_CASE("a shake of grains counts the offsets without room") {
  auto shaken = grains({});
  shaken->load(dilute_column(PeriodicBox{4, 4}, 50, 1));
  shaken->settle(RandomSettle{});
  CHECK(value(settled_values(*shaken, 1'000'000), "dropped_offsets") == 0);
  RandomStream random(stream_key(1, 0, 0, Purpose::tap));
  shaken->tap(Shake{.lambda = 0, .lateral_radius = 1, .retries = 0}, random);
  CHECK(value(settled_values(*shaken, 1'000'000), "dropped_offsets") > 0.5);
  shaken->tap(HalfSine{}, random);
  CHECK(value(settled_values(*shaken, 1'000'000), "dropped_offsets") == 0);
}

TEST_CASE("a tap of a fixed time ends then, a restless one at the cap") {
  const Container box = PeriodicBox{4, 4};
  DiscreteElement settings;
  settings.rest = TimedRest{0.25};
  auto timed = grains(settings);
  timed->load(dilute_column(box, 50, 1));
  timed->settle(RandomSettle{});
  CHECK(value(settled_values(*timed, 1'000'000), "seconds") == Approx(0.25).margin(0.002));
  RandomStream random(stream_key(1, 0, 0, Purpose::tap));
  timed->tap(HalfSine{0.4, 10}, random);
  CHECK(value(settled_values(*timed, 1'000'000), "seconds") == Approx(0.30).margin(0.002));

  settings.rest = QuietRest{1e-12, 1};
  settings.most_seconds = 0.5;
  auto restless = grains(settings);
  restless->load(dilute_column(box, 50, 1));
  restless->settle(RandomSettle{});
  const auto values = settled_values(*restless, 1'000'000);
  CHECK(value(values, "capped") == 1);
  CHECK(value(values, "seconds") == Approx(0.5).margin(0.002));
}

TEST_CASE("Monte Carlo refuses a floor that moves, grains a container without one") {
  CHECK(engine_tap_fault(EngineSettings{MonteCarlo{}}, HalfSine{}));
  CHECK_FALSE(engine_tap_fault(EngineSettings{MonteCarlo{}}, Lift{}));
  CHECK_FALSE(engine_tap_fault(EngineSettings{DiscreteElement{}}, Vibration{}));
  CHECK(engine_tap_fault(EngineSettings{DiscreteElement{}}, HalfSine{0.001, 1e5}));  // unresolved
  CHECK(engine_fault(DiscreteElement{}, FullyPeriodicBox{}));
  CHECK_FALSE(engine_fault(DiscreteElement{}, Cylinder{}));
  DiscreteElement mixed;
  mixed.floor = LinearSpringDashpot{};
  CHECK(engine_fault(mixed, PeriodicBox{}));
  Packing bed{PeriodicBox{4, 4}, {{1, 1, 1}}};
  RandomStream random(stream_key(1, 0, 0, Purpose::tap));
  CHECK_THROWS_AS(excite(bed, HalfSine{}, random), std::invalid_argument);
}

TEST_CASE("a state of other bytes, of another engine or another bed is refused") {
  const Container box = PeriodicBox{4, 4};
  auto dynamics = grains({});
  dynamics->load(dilute_column(box, 20, 1));
  dynamics->settle(RandomSettle{});
  dynamics->advance(20'000);
  const std::vector<std::byte> state = dynamics->save();
  auto second = grains({});
  second->load(dilute_column(box, 21, 1));
  CHECK_THROWS_AS(second->restore(state), StateError);
  second->load(dilute_column(box, 20, 1));
  CHECK_NOTHROW(second->restore(state));
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{3}, state.size() / 2, state.size() - 1})
    CHECK_THROWS_AS(second->restore(std::span(state).first(length)), StateError);
  std::vector<std::byte> forged = state;
  forged.push_back(std::byte{0});
  CHECK_THROWS_AS(second->restore(forged), StateError);
  // Every number in turn that is none, or too large for any list.
  const auto refused = [&](auto change) {
    GrainDynamicsState changed = grain_state(state);
    change(changed);
    CHECK_THROWS_AS(second->restore(bytes_of(changed)), StateError);
  };
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const double x : {none, 1e300, -1e9}) {
    refused([&](GrainDynamicsState& changed) { changed.loop.grains.back().centre.x = x; });
    refused([&](GrainDynamicsState& changed) { changed.loop.grains.front().centre.z = x; });
  }
  refused([&](GrainDynamicsState& changed) { changed.loop.grains.back().seen_spin.y = none; });
  refused([&](GrainDynamicsState& changed) { changed.loop.motion.amplitude = none; });
  refused([&](GrainDynamicsState& changed) { changed.loop.motion.frequency = 0; });
  refused(
      [&](GrainDynamicsState& changed) { changed.loop.motion.half_periods = ~std::uint64_t{0}; });
  refused([&](GrainDynamicsState& changed) { changed.start_energies.kinetic = none; });
  refused([&](GrainDynamicsState& changed) { changed.loop.floor_work = none; });
  refused([&](GrainDynamicsState& changed) { changed.loop.pairs = {{5, 5, {}, {}}}; });
  refused([&](GrainDynamicsState& changed) { changed.loop.pairs = {{5, 20, {}, {}}}; });
  refused([&](GrainDynamicsState& changed) { changed.loop.sides = {{20, 0, {}}}; });
  refused([&](GrainDynamicsState& changed) { changed.loop.sides = {{0, 5, {}}}; });
}

TEST_CASE("stiff and strongly damped contacts are resolved, a step that is too long is found out") {
  const Container box = PeriodicBox{3, 3};
  for (const LinearSpringDashpot& law :
       {LinearSpringDashpot{3000, 0.05, 1, 2.0 / 7, 10}, LinearSpringDashpot{3000, 0.1, 1, 10, 1},
        LinearSpringDashpot{3000, 0.05, 100, 10, 0},
        LinearSpringDashpot{1e5, 0.4, 1, 2.0 / 7, 10}}) {
    CAPTURE(law.restitution, law.tangential_ratio, law.tangential_damping);
    DiscreteElement settings;
    settings.spheres = law;
    auto dynamics = grains(settings);
    dynamics->load(dilute_column(box, 24, 4));
    dynamics->settle(RandomSettle{});
    const auto values = settled_values(*dynamics, 1'000'000);
    CHECK(std::abs(value(values, "ledger_error")) < 0.05);
    CHECK(value(values, "friction_energy") > 0);
  }
  DiscreteElement coarse;
  coarse.steps_per_contact = 2.5;
  auto dynamics = grains(coarse);
  dynamics->load(dilute_column(box, 24, 4));
  dynamics->settle(RandomSettle{});
  CHECK_THROWS_WITH(settled_values(*dynamics, 1'000'000), Catch::Contains("energy ledger"));
}

// Energy that comes from nowhere, as a step that is too long makes it: the bed is higher than the
// lift raised it. A tenth of what moved is the limit.
TEST_CASE(
    "a tap that gains energy from nowhere is stopped, one that gains less than a tenth is not") {
  for (const double share : {-0.2, -0.04, 0.04, 0.2}) {
    CAPTURE(share);
    constexpr double lift = 0.5;
    auto dynamics = grains({});
    dynamics->load(dilute_column(PeriodicBox{3, 3}, 40, 6));
    dynamics->settle(RandomSettle{});
    settled_values(*dynamics, 1'000'000);
    RandomStream random(stream_key(1, 0, 0, Purpose::tap));
    dynamics->tap(Lift{lift}, random);
    GrainDynamicsState state = grain_state(dynamics->save());
    for (GrainState& grain : state.loop.grains) grain.centre.z += share * lift;
    dynamics->restore(bytes_of(state));
    if (std::abs(share) > 0.1) {
      CHECK_THROWS_WITH(settled_values(*dynamics, 1'000'000), Catch::Contains("energy ledger"));
    } else {
      CHECK_NOTHROW(settled_values(*dynamics, 1'000'000));
    }
  }
}

// Nearly elastic spheres that are looked at in mid-contact, after taps that dissipate next to
// nothing.
TEST_CASE("no sound tap is taken for one of too long a step") {
  for (const double restitution : {0.95, 0.98, 1.0}) {
    for (const double friction : {0.1, 10.0}) {
      for (const ContactLaw& law :
           {ContactLaw{WaltonBraun{.restitution = restitution, .friction = friction}},
            ContactLaw{LinearSpringDashpot{.restitution = restitution, .friction = friction}}}) {
        for (const std::uint32_t n : {2u, 4u, 8u}) {
          CAPTURE(restitution, friction, law.index(), n);
          DiscreteElement settings;
          settings.spheres = law;
          settings.rest = TimedRest{0.05};
          auto dynamics = grains(settings);
          dynamics->load(dilute_column(PeriodicBox{2.1, 2.1}, n, 1));
          dynamics->settle(RandomSettle{});
          REQUIRE_NOTHROW(settled_values(*dynamics, 1'000'000));
          RandomStream random(stream_key(1, 0, 0, Purpose::tap));
          for (int tap = 0; tap < 12; ++tap) {
            dynamics->tap(tap % 2 == 0 ? Tap{Lift{0.5}} : Tap{HalfSine{0.4413, 7.5}}, random);
            REQUIRE_NOTHROW(settled_values(*dynamics, 1'000'000));
          }
        }
      }
    }
  }
}

TEST_CASE("spheres that start deep in each other end with a reason") {
  auto dynamics = grains({});
  for (const double distance : {0.3, 0.95}) {
    dynamics->load({WalledBox{4, 4}, {{2, 2, 1}, {2, 2, 1 + distance}}});
    CHECK_THROWS_WITH(dynamics->settle(RandomSettle{}), Catch::Contains("throw the bed apart"));
  }
  // A column of 800 presses its lowest sphere by their weight: no start is gentler.
  DiscreteElement engine;
  const double stiffness = reduced(engine).spheres.stiffness;
  Packing column{WalledBox{1.05, 1.05}, {}};
  double z = 0.5 - 800 / stiffness;
  for (int height = 799; height >= 0; --height) {
    column.centres.push_back({0.525, 0.525, z});
    z += 1 - height / stiffness;
  }
  dynamics->load(column);
  CHECK_NOTHROW(dynamics->settle(RandomSettle{}));
  DiscreteElement soft;
  soft.spheres = WaltonBraun{.stiffness = 100};
  dynamics = grains(soft);
  dynamics->load({WalledBox{4, 4}, {{2, 2, 1}, {2, 2, 1.75}}});
  dynamics->settle(RandomSettle{});
  CHECK_THROWS_WITH(settled_values(*dynamics, 1000),
                    Catch::Contains("overlaps another by more than a fifth"));
}
