#include "tests/hard_cases/cases.hpp"

using namespace jostle;

namespace {

Plan plan_of(const Tap& tap, std::uint64_t taps) {
  Plan plan;
  plan.seed = 20260103;
  plan.container = PeriodicBox{4, 4};
  plan.n_spheres = 60;
  plan.start = SteepestDescentPour{};
  plan.protocol = {{tap, taps}};
  monte_carlo(plan).relax.stop = {.rule = MeanHeightStop{.eta = 1e-4, .every_sweeps = 10},
                                  .max_sweeps = 2000};
  plan.observables = {MeanHeight{}, BottomFraction{}, CorrectedFraction{}, BulkFraction{}};
  return plan;
}

}  // namespace

TEST_CASE("taps from nothing to ten times the height") {
  for (const Tap& tap : {Tap{Dilate{0}}, Tap{Dilate{1e-16}}, Tap{Dilate{1e-8}}, Tap{Dilate{10}},
                         Tap{DilateFloorHeld{1e-16}}, Tap{DilateFloorHeld{10}}, Tap{Lift{1e-12}},
                         Tap{Lift{100}}, Tap{Shake{0, 1e-9, 0}}, Tap{Shake{10, 1.9, 3}}}) {
    for (const Move& move : {Move{PolarMove{}}, Move{MetropolisMove{0.2}}}) {
      for (const Sampler sampler : {Sampler::exhaustive, Sampler::rejection_free}) {
        CAPTURE(tap.index(), move.index(), int(sampler));
        Plan plan = plan_of(tap, 4);
        monte_carlo(plan).relax.move = move;
        monte_carlo(plan).relax.sampler = sampler;
        for (const TapRow& row : run_plan_twice(plan).rows) {
          for (const double value : row.observables) CHECK(std::isfinite(value));
        }
      }
    }
  }
}

TEST_CASE("a bed that rises for ever ends with words, before its heights are infinite") {
  for (const Sampler sampler : {Sampler::exhaustive, Sampler::rejection_free}) {
    Plan plan = plan_of(Dilate{0.8}, 2000);
    monte_carlo(plan).relax.sampler = sampler;
    monte_carlo(plan).relax.stop = {.rule = SweepsStop{.sweeps = 1}};
    Realization realization(plan, 0);
    double highest = 0;
    const auto to_its_end = [&] {
      while (!realization.finished()) {
        const Slice slice = realization.advance(1'000'000);
        if (slice.row) highest = std::max(highest, slice.row->observables[0]);
      }
    };
    CHECK_THROWS_WITH(to_its_end(), Catch::Contains("taps lift it further than it comes down"));
    CHECK(highest > 1e299);
    CHECK(std::isfinite(highest));
  }
}

TEST_CASE("taps of 0 never raise the bed") {
  const RecordedRealization record = run_plan(plan_of(Dilate{0}, 30));
  for (std::size_t t = 1; t < record.rows.size(); ++t) {
    CHECK(record.rows[t].observables[0] <= record.rows[t - 1].observables[0]);
  }
}

TEST_CASE("<Z> is that of the spheres after every one of a million taps", "[slow]") {
  Plan plan = plan_of(Dilate{0.02}, 1'000'000);
  plan.n_spheres = 6;
  plan.container = PeriodicBox{2.5, 2.5};
  monte_carlo(plan).relax.stop = {.rule = SweepsStop{.sweeps = 10}};
  plan.observables = {MeanHeight{}};
  Realization realization(plan, 0);
  double worst = 0, highest = 0;
  while (!realization.finished()) {
    const Slice slice = realization.advance(1'000'000);
    if (!slice.row) continue;
    long double sum = 0;
    const RealizationState state = realization.state();
    for (const Vec3& r : state.centres) sum += r.z;
    const auto exact = static_cast<double>(sum / plan.n_spheres);
    worst = std::max(worst, std::abs(slice.row->observables[0] - exact) / exact);
    highest = std::max(highest, exact);
    if (slice.row->tap % 1000 == 0) {
      const Packing packing{plan.container, state.centres};
      REQUIRE(deepest_overlap_brute_force(packing).depth <= overlap_bound(packing));
    }
  }
  CHECK(worst <= 1e-13);
  CHECK(highest < 10);
}
