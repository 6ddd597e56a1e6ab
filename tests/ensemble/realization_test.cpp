#include "ensemble/realization.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "bits.hpp"
#include "engine/bed/slab.hpp"
#include "engine/monte_carlo/state.hpp"
#include "engine/starts/starts.hpp"
#include "small_plans.hpp"
#include "structure/snapshot_statistics.hpp"

using namespace jostle;

namespace {

MonteCarloState engine_of(const RealizationState& state) {
  return monte_carlo_state(state.engine);
}

void keep(RecordedRealization& record, Slice slice) {
  if (slice.row) record.rows.push_back(std::move(*slice.row));
  if (slice.snapshot) record.snapshots.push_back(std::move(*slice.snapshot));
}

RecordedRealization straight(const Plan& plan, std::uint32_t index = 0) {
  RecordedRealization record;
  Realization realization(plan, index);
  while (!realization.finished()) keep(record, realization.advance(1'000'000));
  record.state = realization.state();
  return record;
}

// Slices of random lengths; after every third or so the state is stored and taken up by another.
RecordedRealization interrupted(const Plan& plan, RandomStream& random) {
  RecordedRealization record;
  auto realization = std::make_unique<Realization>(plan, 0);
  while (!realization->finished()) {
    keep(record, realization->advance(random.integer_below(20 * plan.n_spheres)));
    if (random.integer_below(3) == 0) {
      realization = std::make_unique<Realization>(plan, 0, realization->state());
    }
  }
  record.state = realization->state();
  return record;
}

}  // namespace

TEST_CASE("A realization interrupted anywhere continues bit for bit") {
  RandomStream random(stream_key(7, 0, 0, Purpose::start));
  for (const auto& [name, plan] : various_plans()) {
    CAPTURE(name);
    const RecordedRealization undisturbed = straight(plan);
    REQUIRE(undisturbed.rows.size() == total_taps(plan) + 1);
    const bool skipped = engine_of(*undisturbed.state).sampler.candidate > 0;
    CHECK(skipped == (monte_carlo(plan).relax.sampler == Sampler::rejection_free));
    for (int repeat = 0; repeat < 3; ++repeat) {
      CHECK(bits(interrupted(plan, random)) == bits(undisturbed));
    }
  }
}

TEST_CASE("The sampler of the plan is the one that relaxes, and its state is kept") {
  Plan plan = small_plan();
  monte_carlo(plan).relax.stop = {.rule = SweepsStop{.sweeps = 2000}};
  CHECK(engine_of(*straight(plan).state).sampler == SamplerState{});
  monte_carlo(plan).relax.sampler = Sampler::rejection_free;
  Realization realization(plan, 0);
  while (realization.state().rows == 0) realization.advance(1'000);
  realization.advance(1500 * plan.n_spheres);
  const RealizationState state = realization.state();
  CHECK(state.relaxing);
  const MonteCarloState engine = engine_of(state);
  CHECK(engine.sampler.active);
  CHECK(engine.sampler.candidate > 0);
  CHECK(engine.sampler.pending >= engine.move.next_trial);
}

TEST_CASE("Taps leave no overlap in any container") {
  for (const auto& [name, plan] : various_plans()) {
    CAPTURE(name);
    const Packing packing{plan.container, straight(plan).state->centres};
    REQUIRE(packing.centres.size() == plan.n_spheres);
    CHECK(deepest_overlap_brute_force(packing).depth <= overlap_bound(packing));
  }
}

TEST_CASE("A realization records its start, every tap and the snapshots asked for") {
  const Plan plan = small_plan();
  const RecordedRealization record = straight(plan);
  REQUIRE(record.rows.size() == 6);
  for (std::size_t t = 0; t < 6; ++t) CHECK(record.rows[t].tap == t);

  const TapRow& start = record.rows[0];
  CHECK(diagnostic(start, "sweeps") == 0);
  CHECK(std::isnan(diagnostic(start, "acceptance")));
  CHECK(diagnostic(start, "capped") == 0);

  REQUIRE(record.snapshots.size() == 3);
  const SnapshotRecord& last = record.snapshots[2];
  CHECK(record.snapshots[1].tap == 2);
  CHECK(last.tap == 5);
  const Packing packing{plan.container, last.centres};
  CHECK(last.coordination == coordination(packing, 1.05));
  CHECK(last.height_histogram == height_histogram(packing, 0.1));
  const Packing first{plan.container, record.snapshots[0].centres};
  CHECK(record.rows[5].observables == Observer(plan.observables, first)(packing));
  CHECK(record.rows[0].observables == Observer(plan.observables, first)(first));
}

TEST_CASE("A bed whose spheres have left each other has no height histogram") {
  Plan plan = small_plan();
  plan.protocol = {{Dilate{10}, 5}};
  plan.snapshots.taps = {0, 5};
  monte_carlo(plan).relax.stop = {.rule = SweepsStop{.sweeps = 1}};
  const RecordedRealization record = straight(plan);
  REQUIRE(record.snapshots.size() == 2);
  CHECK(record.snapshots[0].height_histogram.size() < 1000);
  CHECK(record.snapshots[1].height_histogram.empty());
  CHECK(record.snapshots[1].centres.size() == plan.n_spheres);
}

TEST_CASE("A start that settles is recorded once it has") {
  Plan plan = small_plan();
  plan.protocol.clear();
  plan.start = RandomSettle{};
  monte_carlo(plan).relax.stop = {.rule = SweepsStop{.sweeps = 37}};
  const RecordedRealization record = straight(plan);
  REQUIRE(record.rows.size() == 1);
  CHECK(diagnostic(record.rows[0], "sweeps") == 37);
  CHECK(diagnostic(record.rows[0], "acceptance") > 0);
  CHECK(engine_of(*record.state).move.next_trial == 37 * 60);
}

TEST_CASE("A start can settle in a way of its own, and taps then begin as after any other start") {
  Plan plan = small_plan();
  plan.start = RandomSettle{};
  plan.streams = Streams::matched;
  monte_carlo(plan).relax_start = Relaxation{.move = MetropolisMove{.max_step = 0.2},
                                             .stop = {.rule = SweepsStop{.sweeps = 300}}};
  plan.snapshots.taps = {0, 1};
  const RecordedRealization record = straight(plan);
  CHECK(diagnostic(record.rows[0], "sweeps") == 300);
  Plan slower = plan;
  slower.point_id = 5;
  monte_carlo(slower).relax.stop = {.rule = SweepsStop{.sweeps = 11}};
  const RecordedRealization second = straight(slower);
  CHECK(second.snapshots[0].centres == record.snapshots[0].centres);
  CHECK(diagnostic(second.rows[1], "sweeps") == 11);

  // Equal taps from the bed at its end.
  Plan given = plan;
  given.start =
      GivenPacking{std::make_shared<const std::vector<Vec3>>(record.snapshots[0].centres)};
  monte_carlo(given).relax_start.reset();
  CHECK(straight(given).snapshots[1].centres == record.snapshots[1].centres);
}

TEST_CASE(
    "A start relaxed by the rule of the taps hands its step on, whether the rule is named or not") {
  Plan plan = small_plan();
  plan.start = RandomSettle{};
  monte_carlo(plan).relax = {
      .move =
          MetropolisMove{.max_step = 0.2,
                         .adaptation = StepAdaptation{.every_trials = 50, .reset_each_tap = false}},
      .stop = {.rule = SweepsStop{.sweeps = 300}}};
  Plan named = plan;
  monte_carlo(named).relax_start = monte_carlo(plan).relax;
  const RecordedRealization first = straight(plan), second = straight(named);
  REQUIRE(first.rows.size() == second.rows.size());
  CHECK(engine_of(*first.state).move.step < 0.2);
  CHECK(bits(first) == bits(second));
}

TEST_CASE("While a start settles, quantiles are those of the bed to come, then those of the bed") {
  Plan plan = small_plan();
  plan.start = RandomSettle{};
  monte_carlo(plan).relax.stop.rule = BulkFractionStop{.every_trials = 600};
  Realization realization(plan, 0);
  realization.advance(60);
  REQUIRE(realization.state().rows == 0);
  const double depth = 60 * sphere_volume / (0.57 * 4 * 4);
  const HeightWindow to_come = engine_of(realization.state()).stop_window;
  CHECK(to_come.low == Approx(0.2 * depth));
  CHECK(to_come.high == Approx(0.8 * depth));

  while (realization.state().rows == 0) realization.advance(1'000'000);
  const RealizationState settled = realization.state();
  const Packing bed{plan.container, settled.centres};
  CHECK(engine_of(settled).stop_window == resolve(QuantileWindow{}, bed));
  REQUIRE(settled.observable_windows.size() == 4);
  CHECK(settled.observable_windows[3] == resolve(QuantileWindow{}, bed));

  while (!realization.finished()) realization.advance(1'000'000);
  CHECK(engine_of(realization.state()).stop_window == engine_of(settled).stop_window);
}

TEST_CASE("A relaxation that meets no rule is capped, and recorded as capped") {
  Plan plan = small_plan();
  plan.protocol = {{Dilate{}, 2}};
  monte_carlo(plan).relax.stop = {.rule = MeanHeightStop{.eta = 0}, .max_sweeps = 250};
  const RecordedRealization record = straight(plan);
  for (std::size_t t = 1; t <= 2; ++t) {
    CHECK(diagnostic(record.rows[t], "capped") == 1);
    CHECK(diagnostic(record.rows[t], "sweeps") == 250);
  }
  monte_carlo(plan).relax.stop.rule = SweepsStop{.sweeps = 30};
  CHECK(diagnostic(straight(plan).rows[2], "capped") == 0);
}

TEST_CASE("More taps at the end of a finished realization continue it") {
  Plan plan = small_plan();
  plan.snapshots.taps.clear();
  plan.protocol = {{Dilate{}, 4}};
  const RecordedRealization whole = straight(plan);

  plan.protocol[0].count = 2;
  RecordedRealization record = straight(plan);
  plan.protocol[0].count = 4;
  Realization realization(plan, 0, record.state);
  while (!realization.finished()) keep(record, realization.advance(1'000'000));
  record.state = realization.state();
  CHECK(bits(record) == bits(whole));
}

TEST_CASE(
    "Realizations, seeds and sweep points draw their own numbers, matched points share them") {
  Plan plan = small_plan();
  plan.protocol = {{Shake{}, 1}};
  plan.snapshots.taps = {0, 1};
  const auto start_of = [](const Plan& p, std::uint32_t index) {
    return straight(p, index).snapshots[0].centres;
  };
  Plan other_point = plan;
  other_point.point_id = 77;
  CHECK(start_of(plan, 0) == start_of(plan, 0));
  CHECK(start_of(plan, 0) != start_of(plan, 1));
  CHECK(start_of(plan, 0) != start_of(other_point, 0));

  plan.streams = other_point.streams = Streams::matched;
  CHECK(start_of(plan, 0) == start_of(other_point, 0));
  CHECK(start_of(plan, 0) != start_of(other_point, 1));
  CHECK(straight(plan).snapshots[1].centres != straight(other_point).snapshots[1].centres);

  // Without trials the taps alone are seen: they are the same at matched points.
  monte_carlo(plan).relax.stop =
      monte_carlo(other_point).relax.stop = {.rule = SweepsStop{.sweeps = 0}};
  CHECK(straight(plan).snapshots[1].centres == straight(other_point).snapshots[1].centres);
  other_point.streams = Streams::independent;
  CHECK(straight(plan).snapshots[1].centres != straight(other_point).snapshots[1].centres);
}

TEST_CASE("Matched points begin from the same bed also where the start is relaxed") {
  Plan plan = small_plan();
  plan.start = RandomSettle{};
  plan.snapshots.taps = {0, 1};
  plan.streams = Streams::matched;
  Plan other_point = plan;
  other_point.point_id = 77;
  const RecordedRealization first = straight(plan), second = straight(other_point);
  CHECK(diagnostic(first.rows[0], "sweeps") > 0);
  CHECK(first.snapshots[0].centres == second.snapshots[0].centres);
  CHECK(first.snapshots[1].centres != second.snapshots[1].centres);
}

TEST_CASE("A shake records the share of lateral offsets that found no room") {
  Plan plan = small_plan();
  plan.protocol = {{Shake{.lambda = 0.05, .lateral_radius = 0.1, .retries = 0}, 2}, {Lift{}, 1}};
  const RecordedRealization record = straight(plan);
  CHECK(diagnostic(record.rows[0], "dropped_offsets") == 0);
  for (const std::size_t tap : {1, 2}) {
    // In a bed dilated by 5 % some of these offsets end in another sphere, others do not.
    CHECK(diagnostic(record.rows[tap], "dropped_offsets") > 0);
    CHECK(diagnostic(record.rows[tap], "dropped_offsets") < 1);
  }
  CHECK(diagnostic(record.rows[3], "dropped_offsets") == 0);
}

TEST_CASE("An impossible start has a reason") {
  Plan plan = small_plan();
  plan.container = PeriodicBox{4.1, 4.3};
  plan.start = Crystal{};
  Realization realization(plan, 0);
  CHECK_THROWS_AS(realization.advance(1000), StartError);
}

TEST_CASE("The Metropolis step begins anew at each tap if the move requests it, else continues") {
  Plan plan = small_plan();
  plan.protocol = {{Dilate{}, 3}};
  monte_carlo(plan).relax.stop = {.rule = SweepsStop{.sweeps = 10}};
  // Halved twice in the 600 trials of a tap, whatever is accepted.
  StepAdaptation adaptation{.factor = 0.5, .every_trials = 300, .threshold = 1};
  monte_carlo(plan).relax.move = MetropolisMove{.max_step = 0.2, .adaptation = adaptation};
  CHECK(engine_of(*straight(plan).state).move.step == Approx(0.2 * 0.25));
  adaptation.reset_each_tap = false;
  monte_carlo(plan).relax.move = MetropolisMove{.max_step = 0.2, .adaptation = adaptation};
  CHECK(engine_of(*straight(plan).state).move.step == Approx(0.2 * 0.25 * 0.25 * 0.25));
}
