#include "engine/dynamics.hpp"

#include <catch2/catch.hpp>

#include "bits.hpp"
#include "ensemble/realization.hpp"
#include "ensemble/run.hpp"
#include "sinking.hpp"
#include "small_plans.hpp"

using namespace jostle;

namespace {

constexpr RealizationId first{0, 0};

void append(MemorySink& sink, const Slice& slice) {
  if (slice.row) sink.append(first, *slice.row);
  if (slice.snapshot) sink.snapshot(first, *slice.snapshot);
}

// In slices of so many units; with `kills`, every third slice is followed by a new process.
RecordedRealization sunk(std::uint64_t units, bool kills) {
  const Plan plan = sinking_plan();
  MemorySink sink;
  auto realization = std::make_unique<Realization>(plan, 0, sinking(plan, 0), sink.begin(first));
  for (int slices = 1; !realization->finished(); ++slices) {
    append(sink, realization->advance(units));
    if (!kills || slices % 3 != 0) continue;
    sink.checkpoint(first, realization->state(), {});
    realization = std::make_unique<Realization>(plan, 0, sinking(plan, 0), sink.begin(first));
  }
  sink.end(first, realization->state(), {});
  return sink.records().at(first);
}

}  // namespace

TEST_CASE("A realization runs by mechanics that are not Monte Carlo, with columns of their own") {
  const RecordedRealization record = sunk(1'000'000, false);
  REQUIRE(record.rows.size() == 7);
  for (const TapRow& row : record.rows) {
    REQUIRE(row.diagnostics.size() == Sinking::columns().size());
    CHECK(row.diagnostics[0] > 1);  // a gap shrinks by a factor e a step: 14 steps, more or less
    CHECK(row.diagnostics[0] < 100);
    CHECK(row.diagnostics[1] == 0);
    // At rest the file of spheres is closed on the floor.
    CHECK(row.observables[0] == Approx(4).margin(1e-6));
  }
  CHECK(record.rows[1].observables != record.rows[2].observables);
  CHECK(record.snapshots.size() == 2);
}

TEST_CASE("Mechanics of any kind are sliced, stored and resumed bit for bit") {
  const Bits straight = bits(sunk(1'000'000, false));
  for (const std::uint64_t units : {1, 2, 7, 50}) {
    CAPTURE(units);
    CHECK(bits(sunk(units, false)) == straight);
    CHECK(bits(sunk(units, true)) == straight);
  }
}

TEST_CASE("A state of another engine is refused, and what is stored of the realization stays") {
  const Plan plan = small_plan();
  Realization monte_carlo(plan, 0);
  monte_carlo.advance(100);
  Plan toy = sinking_plan();
  toy.observables = plan.observables;
  CHECK_THROWS_AS(Realization(toy, 0, sinking(toy, 0), monte_carlo.state()), StateError);

  Realization second(toy, 0, sinking(toy, 0));
  second.advance(3);
  CHECK_THROWS_WITH(
      Realization(plan, 0, second.state()),
      Catch::Contains("another engine") && Catch::Contains("resume with the version"));

  MemorySink sink;
  sink.checkpoint(first, second.state(), {});
  Progress progress;
  CHECK_THROWS_AS(run_ensemble(std::span(&plan, 1), {first}, {}, sink, progress), StateError);
  const RecordedRealization& record = sink.records().at(first);
  CHECK_FALSE(record.outcome);
  CHECK(record.checkpoints == 1);
}
