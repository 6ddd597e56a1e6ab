#include "ensemble/run.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "bits.hpp"
#include "engine/monte_carlo/state.hpp"
#include "ensemble/parallel.hpp"
#include "ensemble/realization.hpp"
#include "small_plans.hpp"

using namespace jostle;

namespace {

// Two sweep points of unequal cost, four realizations each.
std::vector<Plan> unequal_plans() {
  std::vector<Plan> plans(2, small_plan());
  plans[1].point_id = 5;
  plans[1].n_spheres = 40;
  plans[1].protocol = {{Dilate{}, 15}};
  return plans;
}

std::vector<RealizationId> realizations_of(std::size_t points, std::uint32_t n_realizations) {
  std::vector<RealizationId> ids;
  for (std::uint32_t point = 0; point < points; ++point) {
    for (std::uint32_t index = 0; index < n_realizations; ++index) ids.push_back({point, index});
  }
  return ids;
}

std::map<RealizationId, Bits> bits_of(const MemorySink& sink) {
  std::map<RealizationId, Bits> all;
  for (const auto& [id, record] : sink.records()) all[id] = bits(record);
  return all;
}

Bits bits(const RealizationState& state) {
  Bits all;
  all.add(state);
  return all;
}

struct Ran {
  RunSummary summary;
  std::map<RealizationId, Bits> bits;
};

Ran undisturbed(const std::vector<Plan>& plans, const std::vector<RealizationId>& ids,
                int threads = 1) {
  MemorySink sink;
  Progress progress;
  const RunSummary summary = run_ensemble(plans, ids, {.threads = threads}, sink, progress);
  return {summary, bits_of(sink)};
}

}  // namespace

TEST_CASE("Work is called on as many threads as asked for") {
  for (const int threads : {1, 2, 3, 7}) {
    std::atomic<int> calls{0};
    on_threads(threads, [&] {
      ++calls;
      // Every call waits for the others: they do run at once.
      while (calls < threads) std::this_thread::yield();
    });
    CHECK(calls == threads);
  }
}

TEST_CASE("Records do not depend on the number of threads") {
  const std::vector<Plan> plans = unequal_plans();
  const auto ids = realizations_of(2, 4);
  const Ran single = undisturbed(plans, ids, 1);
  CHECK(single.summary.done == 8);
  REQUIRE(single.bits.size() == 8);
  CHECK(undisturbed(plans, ids, 2).bits == single.bits);
  CHECK(undisturbed(plans, ids, 3).bits == single.bits);
}

TEST_CASE("A run stopped at any call and resumed records what an undisturbed one does") {
  const std::vector<Plan> plans = unequal_plans();
  const auto ids = realizations_of(2, 3);
  const Ran reference = undisturbed(plans, ids);
  RandomStream random(stream_key(11, 0, 0, Purpose::start));

  for (int repeat = 0; repeat < 6; ++repeat) {
    MemorySink sink;
    std::atomic<bool> stop{false};
    std::atomic<std::int64_t> calls_left{0};
    sink.on_call = [&](RealizationId, const char*) {
      if (--calls_left == 0) stop = true;
    };
    const RunOptions options{.threads = 1 + repeat % 3,
                             .checkpoint_every = std::chrono::seconds(repeat < 3 ? 0 : 3600),
                             .units_per_slice = 500,
                             .stop = &stop};
    std::vector<RealizationId> to_do = ids;
    unsigned runs = 0;
    for (; !to_do.empty(); ++runs) {
      stop = false;
      calls_left = 5 + static_cast<std::int64_t>(random.integer_below(repeat < 3 ? 400 : 80));
      Progress progress;
      run_ensemble(plans, to_do, options, sink, progress);
      std::erase_if(to_do, [&](RealizationId id) {
        const auto record = sink.records().find(id);
        return record != sink.records().end() &&
               record->second.outcome->status == RealizationStatus::done;
      });
    }
    CHECK(runs > 1);
    CHECK(bits_of(sink) == reference.bits);
  }
}

TEST_CASE("A stop is honoured within a slice, by every realization") {
  const std::vector<Plan> plans = unequal_plans();
  const auto ids = realizations_of(2, 4);
  std::atomic<bool> stop{false};
  std::atomic<int> calls{0}, calls_after{0}, begun{0};
  MemorySink sink;
  sink.on_call = [&](RealizationId, const char* call) {
    begun += std::string_view(call) == "begin";
    if (stop && std::string_view(call) != "end") ++calls_after;
    if (++calls == 50) stop = true;
  };
  const int threads = GENERATE(1, 3);
  const RunOptions options{.threads = threads,
                           .checkpoint_every = std::chrono::seconds(0),
                           .units_per_slice = 100,
                           .stop = &stop};
  Progress progress;
  const RunSummary summary = run_ensemble(plans, ids, options, sink, progress);

  CHECK(begun < 8);
  CHECK(summary.interrupted > 0);
  CHECK(summary.done + summary.interrupted == static_cast<std::uint64_t>(begun));
  // A slice under way ends in at most append, snapshot and checkpoint; one may just have begun.
  CHECK(calls_after <= 4 * threads);
  for (const auto& [id, record] : sink.records()) {
    REQUIRE(record.outcome);
    if (record.outcome->status == RealizationStatus::done) continue;
    CHECK(record.outcome->status == RealizationStatus::running);
    if (record.state->engine.empty()) continue;  // stopped before it had a start
    CHECK(monte_carlo_state(record.state->engine).progress.trials % plans[id.point].n_spheres == 0);
  }
}

TEST_CASE("A start under way is given up at a stop and made anew") {
  std::vector<Plan> plans(3, small_plan());
  plans[1].container = WalledBox{4.5, 4.2};
  plans[1].start = FittedPour{};
  plans[2].container = FullyPeriodicBox{4, 4.5, 5};
  plans[2].start = Grow{};
  monte_carlo(plans[2]).relax.move = MetropolisMove{.max_step = 0.2, .adaptation = {}};
  monte_carlo(plans[2]).relax.stop = {.rule = SweepsStop{.sweeps = 60}};
  plans[2].protocol = {{Lift{.gamma = 0}, 5}};
  plans[2].observables = {};
  for (const Plan& plan : plans) {
    int asked = 0;
    const auto stop = [&] { return ++asked == 3; };
    Realization realization(plan, 0), undisturbed(plan, 0);
    const Slice stopped = realization.advance(1'000'000, stop);
    CHECK_FALSE(stopped.row);
    CHECK(stopped.effort.units == 0);
    CHECK(realization.state().rows == 0);
    CHECK_FALSE(realization.state().relaxing);
    realization.advance(1'000'000, stop);
    undisturbed.advance(1'000'000);
    CHECK(bits(realization.state()) == bits(undisturbed.state()));
  }
}

TEST_CASE("A realization that fails is recorded with its reason and the rest go on") {
  std::vector<Plan> plans = unequal_plans();
  plans.push_back(small_plan());
  plans[2].start = Crystal{};
  plans[2].container = PeriodicBox{4.1, 4.3};
  plans.push_back(small_plan());
  plans[3].container = FullyPeriodicBox{5, 5, 6};
  plans[3].start = Grow{};
  monte_carlo(plans[3]).relax.move = PolarMove{};
  MemorySink sink;
  Progress progress;
  const RunSummary summary =
      run_ensemble(plans, realizations_of(4, 2), {.threads = 2}, sink, progress);
  CHECK(summary.done == 4);
  CHECK(summary.failed == 4);
  CHECK(summary.interrupted == 0);
  CHECK(progress.realizations_failed == 4);
  CHECK(progress.realizations_running == 0);
  for (const auto& [id, record] : sink.records()) {
    const bool sound = id.point < 2;
    CHECK(record.outcome->status == (sound ? RealizationStatus::done : RealizationStatus::failed));
    CHECK(record.outcome->reason.empty() == sound);
    if (!sound) CHECK(record.state->centres.empty());
  }
}

TEST_CASE("A sink that throws ends the run, and what it stored can be resumed") {
  const std::vector<Plan> plans = unequal_plans();
  const auto ids = realizations_of(2, 3);
  const std::string fatal_call = GENERATE("begin", "append", "snapshot", "checkpoint", "end");
  const int threads = GENERATE(1, 3);
  CAPTURE(fatal_call, threads);

  MemorySink sink;
  std::atomic<int> until_failure{2};
  std::atomic<bool> failed{false};
  std::atomic<int> appended_after{0};
  sink.on_call = [&](RealizationId, const char* call) {
    if (failed && std::string_view(call) == "append") ++appended_after;
    if (call == fatal_call && --until_failure == 0) {
      failed = true;
      throw std::runtime_error("no space left");
    }
  };
  const RunOptions options{
      .threads = threads, .checkpoint_every = std::chrono::seconds(0), .units_per_slice = 500};
  Progress progress;
  CHECK_THROWS_WITH(run_ensemble(plans, ids, options, sink, progress), "no space left");
  CHECK(appended_after <= 2 * threads);
  CHECK(progress.realizations_running == 0);

  CHECK(run_ensemble(plans, ids, options, sink, progress).done == ids.size());
  CHECK(bits_of(sink) == undisturbed(plans, ids).bits);
}

TEST_CASE("No more realizations are alive than threads, and progress counts the work") {
  const std::vector<Plan> plans = unequal_plans();
  const auto ids = realizations_of(2, 4);
  std::atomic<int> alive{0}, most{0};
  MemorySink sink;
  sink.on_call = [&](RealizationId, const char* call) {
    if (std::string_view(call) == "begin") {
      const int now = ++alive;
      for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
      }
    }
    if (std::string_view(call) == "end") --alive;
  };
  Progress progress;
  run_ensemble(plans, ids, {.threads = 3, .checkpoint_every = std::chrono::seconds(0)}, sink,
               progress);
  CHECK(most <= 3);

  std::uint64_t trials = 0, tests = 0;
  for (const auto& [id, record] : sink.records()) {
    trials += record.outcome->work.effort.units;
    tests += record.outcome->work.effort.pair_tests;
    CHECK(record.outcome->work.effort.units ==
          monte_carlo_state(record.state->engine).move.next_trial);
    CHECK(record.outcome->work.start_seconds > 0);
    CHECK(record.outcome->work.start_seconds < record.outcome->work.seconds);
    REQUIRE(record.checkpoints > 0);
    CHECK(record.work.seconds > record.work.start_seconds);
    CHECK(record.work.seconds < record.outcome->work.seconds);
    CHECK(record.work.start_seconds == record.outcome->work.start_seconds);
    CHECK(record.work.effort.units > 0);
    CHECK(record.work.effort.units < record.outcome->work.effort.units);
  }
  CHECK(progress.units_done == trials);
  CHECK(progress.pair_tests == tests);
  CHECK(progress.taps_done == 4 * 5 + 4 * 15);
  CHECK(progress.realizations_done == 8);
  CHECK(progress.realizations_running == 0);
}
