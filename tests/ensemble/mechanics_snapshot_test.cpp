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
  for (const SnapshotRecord& snapshot : record.snapshots) {
    CAPTURE(snapshot.tap);
    const Packing packing{plan.container, snapshot.centres};
    CHECK(snapshot.velocities.size() == plan.n_spheres);
    CHECK(snapshot.spins.size() == plan.n_spheres);
    CHECK(snapshot.contacts.size() > plan.n_spheres);
    CHECK(snapshot.forces == bed_forces(packing, snapshot.contacts));
    CHECK(snapshot.forces->walls.size() == 5);
    const GranularTemperature temperature = granular_temperature(packing, snapshot.velocities, 0.1);
    CHECK(snapshot.temperature_lateral.size() == temperature.lateral.size());
    // Tap 1 alone moves the floor: tap 0 is the start, tap 3 a lift.
    CHECK(snapshot.driven_fraction.empty() == (snapshot.tap != 1));
    CHECK(snapshot.driven_lateral.size() == snapshot.driven_vertical.size());
    CHECK(snapshot.driven_lateral.size() <= snapshot.driven_fraction.size());
    // The contacts are those of the stored positions, with those that have opened left out.
    for (const Contact& contact : snapshot.contacts) {
      if (contact.second >= plan.n_spheres) continue;
      const Vec3 branch = snapshot.centres[contact.first] - snapshot.centres[contact.second];
      CHECK(1 - std::sqrt(norm_squared(branch)) == Approx(contact.overlap).margin(1e-14));
    }
    // The bed is nearly at rest: 2 kinetic energies of 5e-5 m g d each, in s.
    double energy = 0;
    for (const Vec3& velocity : snapshot.velocities)
      energy += norm_squared(velocity) / plan.n_spheres;
    CHECK(energy < 2 * 5e-5 * 9.81 / 0.02);
  }
}

TEST_CASE("Rows do not depend on what snapshots keep, nor snapshots on interruptions") {
  const Plan plan = grains_plan(), keeping = keeping_all(plan);
  const RecordedRealization plain_run = run(plan, 1'000'000), keeping_run = run(keeping, 1'000'000);
  CHECK(plain_run.snapshots[0].velocities.empty());
  CHECK_FALSE(plain_run.snapshots[0].forces);
  RecordedRealization same_kept = keeping_run;
  for (SnapshotRecord& snapshot : same_kept.snapshots)
    snapshot = {snapshot.tap, snapshot.centres, snapshot.coordination, snapshot.height_histogram};
  CHECK(bits(same_kept) == bits(plain_run));
  CHECK(bits(run(keeping, 33'333, true)) == bits(keeping_run));
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
