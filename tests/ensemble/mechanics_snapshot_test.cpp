#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "bits.hpp"
#include "ensemble/realization.hpp"

using namespace jostle;

namespace {

Plan grains_plan() {
  Plan plan;
  plan.seed = 2010;
  plan.container = WalledBox{3.5, 4};
  plan.n_spheres = 50;
  plan.start = RandomSettle{0.2};
  plan.protocol = {{HalfSine{0.4413, 7.5}, 2}, {Lift{.gamma = 0.1}, 1}};
  DiscreteElement grains;
  grains.spheres = WaltonBraun{.stiffness = 1e4};
  plan.engine = grains;
  plan.observables = {MeanHeight{}, BulkFraction{}};
  plan.snapshots.taps = {0, 1, 3};
  return plan;
}

Plan keeping_all(Plan plan) {
  Snapshots& kept = plan.snapshots;
  kept.velocities = kept.contacts = kept.granular_temperature = kept.forces = true;
  kept.driven_temperature = true;
  return plan;
}

// In slices of so many units; stored and taken up by another after each where asked.
RecordedRealization run(const Plan& plan, std::uint64_t units, bool interrupted = false) {
  RecordedRealization record;
  auto realization = std::make_unique<Realization>(plan, 0);
  while (!realization->finished()) {
    Slice slice = realization->advance(units);
    if (slice.row) record.rows.push_back(std::move(*slice.row));
    if (slice.snapshot) record.snapshots.push_back(std::move(*slice.snapshot));
    if (interrupted) realization = std::make_unique<Realization>(plan, 0, realization->state());
  }
  record.state = realization->state();
  return record;
}

}  // namespace

TEST_CASE("Snapshots keep what moves and acts in a bed of grains") {
  const Plan plan = keeping_all(grains_plan());
  const RecordedRealization record = run(plan, 1'000'000);
  REQUIRE(record.snapshots.size() == 3);
  for (const SnapshotRecord& one : record.snapshots) {
    CAPTURE(one.tap);
    const Packing packing{plan.container, one.centres};
    CHECK(one.velocities.size() == plan.n_spheres);
    CHECK(one.spins.size() == plan.n_spheres);
    CHECK(one.contacts.size() > plan.n_spheres);
    CHECK(one.forces == bed_forces(packing, one.contacts));
    CHECK(one.forces->walls.size() == 5);
    const GranularTemperature temperature = granular_temperature(packing, one.velocities, 0.1);
    CHECK(one.temperature_lateral.size() == temperature.lateral.size());
    // Tap 1 alone moves the floor: tap 0 is the start, tap 3 a lift.
    CHECK(one.driven_fraction.empty() == (one.tap != 1));
    CHECK(one.driven_lateral.size() == one.driven_vertical.size());
    CHECK(one.driven_lateral.size() <= one.driven_fraction.size());
    // The contacts are those of the stored positions, with those that have opened left out.
    for (const Contact& contact : one.contacts) {
      if (contact.second >= plan.n_spheres) continue;
      const Vec3 between = one.centres[contact.first] - one.centres[contact.second];
      CHECK(1 - std::sqrt(norm_squared(between)) == Approx(contact.overlap).margin(1e-14));
    }
    // The bed is nearly at rest: 2 kinetic energies of 5e-5 m g d each, in s.
    double energy = 0;
    for (const Vec3& velocity : one.velocities) energy += norm_squared(velocity) / plan.n_spheres;
    CHECK(energy < 2 * 5e-5 * 9.81 / 0.02);
  }
}

TEST_CASE("Rows do not depend on what snapshots keep, nor snapshots on interruptions") {
  const Plan plan = grains_plan(), keeping = keeping_all(plan);
  const RecordedRealization without = run(plan, 1'000'000), with = run(keeping, 1'000'000);
  CHECK(without.snapshots[0].velocities.empty());
  CHECK_FALSE(without.snapshots[0].forces);
  RecordedRealization same_kept = with;
  for (SnapshotRecord& one : same_kept.snapshots)
    one = {one.tap, one.centres, one.coordination, one.height_histogram};
  CHECK(bits(same_kept) == bits(without));
  CHECK(bits(run(keeping, 33'333, true)) == bits(with));
}

TEST_CASE("Snapshots of Monte Carlo keep nothing that moves or acts") {
  Plan plan = keeping_all(grains_plan());
  plan.engine = MonteCarlo{};
  plan.protocol = {{Lift{.gamma = 0.1}, 1}};
  plan.snapshots.taps = {1};
  const SnapshotRecord record = run(plan, 1'000'000).snapshots.at(0);
  CHECK(record.velocities.empty());
  CHECK(record.contacts.empty());
  CHECK_FALSE(record.forces);
}
