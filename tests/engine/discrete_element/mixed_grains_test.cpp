// Beds of spheres of several sizes, moved by discrete elements.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <tuple>

#include "engine/bed/boundary.hpp"
#include "engine/engines.hpp"
#include "tests/engine/discrete_element/grain_cases.hpp"
#include "tests/engine/sample_packings.hpp"

using namespace jostle;
using namespace jostle::grain_cases;

namespace {

const std::vector<ContactLaw> laws = {WaltonBraun{.friction = 0.3}, WaltonBraun{.friction = 0},
                                      LinearSpringDashpot{.friction = 0.3},
                                      LinearSpringDashpot{.friction = 0}};

bool is_same(const std::vector<GrainState>& a, const std::vector<GrainState>& b, double spins = 1) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(a[i].centre == b[i].centre && a[i].velocity == b[i].velocity &&
          spins * a[i].spin == b[i].spin && a[i].seen_velocity == b[i].seen_velocity &&
          spins * a[i].seen_spin == b[i].seen_spin))
      return false;
  }
  return a.size() == b.size();
}

/// A mixture of masses that differ by more than sizes do.
Packing mixed_column(const Container& container, std::uint32_t n, double smallest, double ratio,
                     double height, std::uint64_t seed) {
  const std::vector<double> diameters = graded_diameters(n, smallest, ratio);
  Packing bed = random_mixture(container, diameters, height, seed);
  std::vector<double> densities;
  for (std::uint32_t i = 0; i < n; ++i) densities.push_back(i % 3 == 0 ? 2.5 : 0.8);
  bed.sizes = grain_cases::sizes_of(diameters, densities);
  return bed;
}

struct Acting {
  std::vector<Vec3> force, torque;
  double greatest = 1;
};

// Weights and contacts, by Newton and Euler.
Acting acting_on(const Packing& packing, const BedMechanics& bed, bool radius_arm) {
  const auto n = static_cast<std::uint32_t>(packing.centres.size());
  Acting sum{{}, std::vector<Vec3>(n)};
  for (std::uint32_t i = 0; i < n; ++i) sum.force.push_back({0, 0, -packing.mass(i)});
  for (const Contact& contact : bed.contacts) {
    const bool pair = contact.second < n;
    const Vec3 acting = contact.normal_force * contact.normal + contact.tangential_force;
    const double reach =
        packing.radius(contact.first) + (pair ? packing.radius(contact.second) : 0);
    const double share = radius_arm ? 1 : (reach - contact.overlap) / reach;
    const auto torque = [&](std::uint32_t i) {
      return cross(acting, packing.radius(i) * share * contact.normal);
    };
    sum.force[contact.first] = sum.force[contact.first] + acting;
    sum.torque[contact.first] = sum.torque[contact.first] + torque(contact.first);
    sum.greatest = std::max(sum.greatest, length(acting));
    if (!pair) continue;
    sum.force[contact.second] = sum.force[contact.second] - acting;
    sum.torque[contact.second] = sum.torque[contact.second] + torque(contact.second);
  }
  return sum;
}

// How many pairs touch, by all pairs and images; all that do are among the contacts, or have a
// latched spring without force.
int count_touching(const Packing& packing, const BedMechanics& bed,
                   const std::vector<KeptPair>& kept) {
  const Boundary boundary(packing.container);
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> latched;
  for (const KeptPair& pair : kept) latched[{pair.first, pair.second}] = pair.history[0];
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> found;
  for (const Contact& contact : bed.contacts)
    found[{contact.first, contact.second}] = contact.overlap;
  const auto n = static_cast<std::uint32_t>(packing.centres.size());
  int touching = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = i + 1; j < n; ++j) {
      const Vec3 branch = separation(boundary, packing.centres[i], packing.centres[j]);
      const double overlap = packing.radius(i) + packing.radius(j) - length(branch);
      if (!(overlap > 1e-12)) continue;
      const auto found_pair = found.find({i, j});
      if (found_pair == found.end()) {
        CHECK(overlap < latched[{i, j}]);
        continue;
      }
      ++touching;
      CHECK(found_pair->second == Approx(overlap).margin(1e-12));
    }
  }
  return touching;
}

}  // namespace

TEST_CASE("grains with sizes of diameter 1 move as equal ones, bit for bit") {
  for (const Container& container :
       {Container{PeriodicBox{4, 4}}, Container{WalledBox{4, 4}}, Container{Cylinder{4.5}},
        Container{PeriodicBox{2.05, 6}}, Container{Plates{4, 3.5}}}) {
    Packing equal = dilute_column(container, 60, 5), forced = equal;
    forced.sizes = std::make_shared<const Sizes>(std::vector<double>(60, 1.0));
    for (const ContactLaw& law : laws) {
      const ReducedSettings units = settings(law, 1);
      CHECK(settings_for(law, forced).time_step == units.time_step);
      GrainLoop expected = loop_for(equal, units);
      expected.run(6000);
      expected.begin_motion({0.4, 0.35, 1});
      expected.run(4000);
      const Energies energies = expected.energies();
      for (const InstructionSet set : instruction_sets()) {
        CAPTURE(container.index(), law.index(), name(set));
        GrainLoop loop = loop_for(forced, units, set);
        loop.run(6000);
        loop.begin_motion({0.4, 0.35, 1});
        loop.run(4000);
        CHECK(is_same(expected.state().grains, loop.state().grains, 0.5));
        CHECK(loop.greatest_overlap() == expected.greatest_overlap());
        CHECK(loop.census().mean_overlap == expected.census().mean_overlap);
        CHECK(loop.census().contacts == expected.census().contacts);
        CHECK(loop.kinetic_energy() == Approx(expected.kinetic_energy()).epsilon(1e-12));
        const Energies found = loop.energies();
        CHECK(found.held() == Approx(energies.held()).epsilon(1e-12));
        CHECK(found.elastic == Approx(energies.elastic).epsilon(1e-12));
        CHECK(found.latched == Approx(energies.latched).epsilon(1e-12));
        CHECK(found.friction == Approx(energies.friction).epsilon(1e-12));
        CHECK(found.floor_work == Approx(energies.floor_work).epsilon(1e-12));
        const BedMechanics mechanics = loop.mechanics(), wanted = expected.mechanics();
        CHECK(mechanics.contacts == wanted.contacts);
        CHECK(mechanics.velocities == wanted.velocities);
        CHECK(mechanics.spins == wanted.spins);
      }
    }
  }
}

TEST_CASE("a mixture continues from any step of a tap as if it had not been stopped") {
  for (const Container& container : {Container{PeriodicBox{6.2, 6.4}}, Container{WalledBox{4, 4}},
                                     Container{Cylinder{4.5}}, Container{Plates{6.2, 3.5}}}) {
    const Packing start = mixed_column(container, 40, 0.6, 5, 9, 3);
    for (const ContactLaw& law : laws) {
      CAPTURE(container.index(), law.index());
      const ReducedSettings units = settings_for(law, start);
      GrainLoop straight = loop_for(start, units);
      straight.run(8000);
      straight.begin_motion({0.4, 0.35, 1});
      for (const std::uint64_t steps : {1u, 399u, 3000u}) {
        const GrainLoop::State saved = straight.state();
        GrainLoop resumed(container, units, best_instruction_set(), start.sizes);
        resumed.restore(saved);
        straight.run(steps);
        resumed.run(steps);
        CHECK(is_same(resumed.state().grains, straight.state().grains));
        CHECK(resumed.energies().friction == straight.energies().friction);
        CHECK(resumed.energies().latched == straight.energies().latched);
        CHECK(resumed.energies().floor_work == straight.energies().floor_work);
        CHECK(resumed.greatest_overlap() == straight.greatest_overlap());
      }
      CHECK(straight.greatest_overlap() > 0);
      CHECK(straight.is_sound());
    }
  }
}

// Lists of a ratio of 10, across periodic sides too.
TEST_CASE("contacts of a mixture are all pairs that touch, with the forces of the next step") {
  const Container container =
      GENERATE(Container{PeriodicBox{6.1, 6.3}}, Container{WalledBox{4.6, 5}},
               Container{Cylinder{5}}, Container{Plates{6.1, 3.2}});
  const ContactLaw law =
      GENERATE(ContactLaw{WaltonBraun{.stiffness = 2e3, .restitution = 0.7, .friction = 0.3}},
               ContactLaw{WaltonBraun{.stiffness = 2e3, .restitution = 0.7, .friction = 0}},
               ContactLaw{LinearSpringDashpot{.stiffness = 2e3, .restitution = 0.5}},
               ContactLaw{LinearSpringDashpot{.stiffness = 2e3, .friction = 0}});
  constexpr std::uint32_t n = 90;
  const Packing start = mixed_column(container, n, 0.3, 10, 30, 5);
  const ReducedSettings units = settings_for(law, start);
  GrainLoop loop = loop_for(start, units);
  int touching = 0;
  for (const double time : {6.0, 3.0}) {
    loop.run(steps_of(time, units));
    CAPTURE(container.index(), law.index(), time);
    const BedMechanics bed = loop.mechanics();
    Packing packing;
    loop.store(packing);
    REQUIRE(packing.sizes == start.sizes);
    touching += count_touching(packing, bed, loop.state().pairs);
    const Acting sums = acting_on(packing, bed, std::holds_alternative<LinearSpringDashpot>(law));
    const auto state_before = loop.grains();
    loop.run(1);
    const auto state_after = loop.grains();
    double force_error = 0, torque_error = 0, velocity_error = 0, spin_error = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      const double m = packing.mass(i), r = packing.radius(i);
      const Vec3 gained =
          (m / units.time_step) * (state_after[i].velocity - state_before[i].velocity);
      const Vec3 turned =
          (0.4 * m * r / units.time_step) * (state_after[i].spin - state_before[i].spin);
      force_error = std::max(force_error, length(gained - sums.force[i]));
      torque_error = std::max(torque_error, length(turned - sums.torque[i]));
      const Vec3 middle = 0.5 * (state_after[i].velocity + state_before[i].velocity);
      velocity_error = std::max(velocity_error, length(middle - bed.velocities[i]));
      if (bed.spins.empty()) continue;
      const Vec3 mean_spin = (0.5 / r) * (state_after[i].spin + state_before[i].spin);
      spin_error = std::max(spin_error, length(mean_spin - bed.spins[i]));
    }
    CHECK(force_error < 1e-8 * sums.greatest);
    CHECK(torque_error < 1e-8 * sums.greatest);
    CHECK(velocity_error < 1e-12);
    CHECK(spin_error < 1e-11);
  }
  CHECK(touching > 10);
}

TEST_CASE("the ledger of a mixture's tap closes, and better as the step shrinks") {
  const PeriodicBox box{6.2, 6.2};
  const Packing start = mixed_column(box, 60, 0.7, 4, 12, 3);
  const auto missing = [&](const ContactLaw& law, double finer) {
    const ReducedSettings units = settings_for(law, start, finer);
    GrainLoop loop = loop_for(start, units);
    loop.run(steps_of(10, units));
    const Energies energies_before = loop.energies();
    loop.begin_motion({0.4413, 7.5 * units.seconds, 1});
    loop.run(steps_of(6, units));
    const Energies energies_after = loop.energies();
    const double dissipated = energies_after.dissipated() - energies_before.dissipated();
    const double came = energies_after.floor_work - energies_before.floor_work +
                        energies_before.held() - energies_after.held();
    REQUIRE(energies_after.floor_work > energies_before.floor_work + loop.mass() / 4);
    REQUIRE(dissipated > loop.mass() / 4);
    return std::abs(came - dissipated) / dissipated;
  };
  const WaltonBraun latched{};
  const double coarse = missing(latched, 1), fine = missing(latched, 4);
  CAPTURE(coarse, fine);
  CHECK(coarse < 1e-3);
  CHECK(fine < coarse / 3);
  CHECK(missing(LinearSpringDashpot{}, 1) < 2e-3);
}

// 0.15 of a sphere of 2 d is 1.5 of one of 0.2 d.
TEST_CASE("an overlap is judged by the smaller of two spheres") {
  const Vec3 big = {6, 6, 6};
  const auto sound = [&](double small, double overlap) {
    const auto sizes = grain_cases::sizes_of({4, small}, {1, 1});
    const double distance = 2 + 0.5 * small - overlap;
    GrainLoop loop =
        loop_of(PeriodicBox{12, 12}, settings(WaltonBraun{}),
                {grain(big), grain(big + Vec3{0, 0, distance})}, best_instruction_set(), sizes);
    loop.run(1);
    CHECK(loop.greatest_overlap() == Approx(overlap / small).epsilon(1e-9));
    return loop.is_sound();
  };
  CHECK(sound(4, 0.7));
  CHECK_FALSE(sound(4, 0.9));
  CHECK(sound(0.4, 0.07));
  CHECK_FALSE(sound(0.4, 0.1));
}

TEST_CASE("a loop of grains takes beds of its own sizes alone") {
  const Packing bed = mixed_column(PeriodicBox{6.2, 6.4}, 20, 0.6, 5, 9, 3);
  Packing changed = bed, equal = bed;
  changed.sizes = std::make_shared<const Sizes>(std::vector<double>(20, 1.2));
  equal.sizes = nullptr;
  GrainLoop loop = loop_for(bed, settings_for(WaltonBraun{}, bed));
  CHECK_THROWS_AS(loop.load(changed), std::invalid_argument);
  CHECK_THROWS_AS(loop.load(equal), std::invalid_argument);
  changed.sizes = std::make_shared<const Sizes>(*bed.sizes);
  CHECK_NOTHROW(loop.load(changed));
}

// From a pour by steepest descent, tapped by a floor that moves and by a lift: stopped within the
// tap and restored from bytes, and settled at the end.
TEST_CASE("dynamics of a mixture settle, tap and go on from their bytes") {
  DiscreteElement engine;
  engine.spheres = WaltonBraun{.stiffness = 1e4};
  engine.rest = TimedRest{0.2};
  const Packing bed = mixed_column(PeriodicBox{6.2, 6.4}, 40, 0.8, 3, 9, 11);
  for (const Tap& tap : {Tap{HalfSine{0.3, 7.5}}, Tap{Lift{0.5}}, Tap{DilateFloorHeld{0.2}}}) {
    RandomStream random(stream_key(1, 0, 0, Purpose::tap));
    const auto straight = make_dynamics(EngineSettings{engine}, {});
    const auto resumed = make_dynamics(EngineSettings{engine}, {});
    straight->load(bed);
    straight->settle(RandomSettle{});
    while (straight->advance(1'000'000) == DynamicsStatus::running) {
    }
    Packing at_rest;
    straight->store(at_rest);
    REQUIRE(at_rest.sizes == bed.sizes);
    straight->tap(tap, random);
    straight->advance(40 * 700);
    const std::vector<std::byte> bytes = straight->save();
    Packing halfway;
    straight->store(halfway);
    resumed->load(halfway);
    resumed->restore(bytes);
    CHECK(resumed->save() == bytes);
    for (const auto& single : {straight.get(), resumed.get()})
      while (single->advance(1'000'000) == DynamicsStatus::running) {
      }
    Packing first, second;
    straight->store(first);
    resumed->store(second);
    CHECK(first.centres == second.centres);
    const auto values = straight->diagnostics(), remaining = resumed->diagnostics();
    REQUIRE(values.size() == columns(EngineSettings{engine}).size());
    for (std::size_t k = 0; k < values.size(); ++k) CHECK(values[k] == remaining[k]);
    CHECK(values[3] > 0);               // input_energy
    CHECK(std::abs(values[6]) < 5e-3);  // ledger_error
    CHECK(deepest_overlap(first).depth < 0.05);
  }
}
