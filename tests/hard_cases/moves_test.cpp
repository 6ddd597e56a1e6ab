#include "engine/monte_carlo/relaxation.hpp"
#include "tests/engine/sample_packings.hpp"
#include "tests/hard_cases/cases.hpp"

using namespace jostle;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t endless = std::uint64_t{1} << 60;

Packing bed() {
  RandomStream random(stream_key(8, 0, 0, Purpose::start));
  Packing packing = make_start(SteepestDescentPour{}, PeriodicBox{4, 4}, 80, random);
  excite(packing, Dilate{0.05}, random);
  return packing;
}

RelaxationProgress relaxed(const Packing& start, const Stop& stop, const Move& move = PolarMove{},
                           HeightWindow window = {}) {
  const auto loop = make_trial_loop(start.container, move, hard_case_key);
  loop->load(start);
  RelaxationProgress progress;
  relax(*loop, stop, window, progress, endless);
  Packing end = start;
  loop->store(end);
  CHECK(deepest_overlap_brute_force(end).depth <= overlap_bound(end));
  CHECK(progress.trials <= stop.max_sweeps * start.centres.size());
  return progress;
}

}  // namespace

TEST_CASE("steps of 1e-9 and 2 diameters at every law of the angle") {
  for (const double step : {1e-9, 2.0}) {
    for (const double theta0 : {1e-6, 1e-3, 1e3}) {
      for (const ThetaLaw law : {ThetaLaw::gaussian, ThetaLaw::exponential, ThetaLaw::linear}) {
        CAPTURE(step, theta0, int(law));
        const Packing start = bed();
        for (const Sampler sampler : {Sampler::exhaustive, Sampler::rejection_free}) {
          const Packing end = run_trials(start, PolarMove{step, theta0, law}, 50'000, sampler);
          CHECK(mean_height(end) < mean_height(start));
          CHECK(mean_height(end) > mean_height(start) - 50'000 * step);
        }
      }
    }
  }
}

TEST_CASE("the smallest theta_0 falls straight down") {
  const Packing start{PeriodicBox{4, 4}, {{1, 1, 100}}};
  for (const ThetaLaw law : {ThetaLaw::gaussian, ThetaLaw::exponential, ThetaLaw::linear}) {
    const Packing end = run_trials(start, PolarMove{0.1, 1e-6, law}, 1000);
    const Vec3 way = separation(PeriodicBox{4, 4}, end.centres[0], start.centres[0]);
    CHECK(way.z < -40);
    CHECK(std::hypot(way.x, way.y) < 1e-4 * -way.z);
  }
}

TEST_CASE("beta of 0, 1e-6 and 1e300 are a gas, nearly one, and zero temperature") {
  const Packing start = bed();
  const auto rises = [&](double beta) {
    return mean_height(run_trials(start, MetropolisMove{0.2, beta}, 200'000)) - mean_height(start);
  };
  CHECK(rises(0) > 0);
  CHECK(rises(1e-6) > 0);
  CHECK(rises(1e300) < 0);
  // exp(-1e300 dz) is 0 for every rise, so the trajectory is that of beta = infinity.
  CHECK(run_trials(start, MetropolisMove{0.2, 1e300}, 50'000).centres ==
        run_trials(start, MetropolisMove{0.2, infinity}, 50'000).centres);
}

TEST_CASE("a step that adapts until nothing is left of it moves nothing and ends") {
  MetropolisMove move{0.1};
  for (const double factor : {0.5, 0.995}) {
    move.adaptation = StepAdaptation{factor, 1, 1, AcceptanceBase::all_trials, true};
    for (const Sampler sampler : {Sampler::exhaustive, Sampler::rejection_free}) {
      CAPTURE(factor, int(sampler));
      const Packing start = bed();
      const auto loop =
          make_trial_loop(start.container, move, hard_case_key, best_instruction_set(), sampler);
      loop->load(start);
      loop->begin_tap();
      loop->run(300'000);
      CHECK(loop->state().step < 1e-300);
      CHECK(loop->state().step >= 0);
      CHECK(loop->tally().trials == 300'000);
      Packing end = start;
      loop->store(end);
      CHECK(finite(end.centres));
      CHECK(deepest_overlap_brute_force(end).depth <= overlap_bound(end));
      loop->begin_tap();
      CHECK(loop->state().step == 0.1);
      loop->run(1);
    }
  }
}

TEST_CASE("an eta below machine precision stops where <Z> no longer changes, or at the cap") {
  const Packing start = bed();
  const RelaxationProgress capped = relaxed(start, {MeanHeightStop{1e-17, 1}, 50});
  CHECK(capped.status == DynamicsStatus::capped);
  const RelaxationProgress at_rest =
      relaxed({PeriodicBox{4, 4}, {{1, 1, 0.5}}}, {MeanHeightStop{1e-17, 1}, 50});
  CHECK(at_rest.status == DynamicsStatus::settled);
  // |Z' - Z| < 0 never holds.
  const RelaxationProgress never =
      relaxed({PeriodicBox{4, 4}, {{1, 1, 0.5}}}, {MeanHeightStop{0, 1}, 50});
  CHECK(never.status == DynamicsStatus::capped);
}

TEST_CASE("a fraction measured after every single trial") {
  const Packing start = bed();
  const BulkFractionStop rule{0, 1, 50, true, HeightWindow{1, 3}};
  const RelaxationProgress progress = relaxed(start, {rule, 1000}, PolarMove{}, HeightWindow{1, 3});
  // It ends after 50 refusals in a row, or moves outside the window.
  CHECK(progress.status == DynamicsStatus::settled);
  CHECK(progress.trials >= 50);
}

TEST_CASE("caps and intervals whose trials exceed 64 bits do not wrap around") {
  const Packing start{PeriodicBox{4, 4}, {{1, 1, 0.5}, {3, 3, 0.5}, {1, 3, 0.5}}};
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() / 2;
  const auto loop = make_trial_loop(start.container, PolarMove{}, hard_case_key);
  loop->load(start);
  RelaxationProgress progress;
  relax(*loop, {MeanHeightStop{1e-5, most}, most}, {}, progress, 3000);
  CHECK(progress.status == DynamicsStatus::running);
  CHECK(progress.trials == 3000);
}
