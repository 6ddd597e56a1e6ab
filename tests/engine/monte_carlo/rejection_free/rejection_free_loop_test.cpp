#include <catch2/catch.hpp>

#include "engine/monte_carlo/relaxation.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "engine/taps.hpp"
#include "tests/engine/sample_packings.hpp"

using namespace jostle;

namespace {

const StreamKey key = stream_key(61, 0, 0, Purpose::trials);

std::unique_ptr<TrialLoop> rejection_free_loop(const Packing& packing, const Move& move,
                                               InstructionSet set = best_instruction_set()) {
  auto loop = make_trial_loop(packing.container, move, key, set, Sampler::rejection_free);
  loop->load(packing);
  loop->begin_tap();
  return loop;
}

std::vector<Move> moves() {
  MetropolisMove adaptive{0.3};
  adaptive.adaptation = StepAdaptation{0.97, 7'777, 0.5, AcceptanceBase::all_trials, true};
  return {PolarMove{}, PolarMove{0.2, 0.3, ThetaLaw::exponential}, MetropolisMove{0.1}, adaptive};
}

Packing stored(const TrialLoop& loop, Packing packing) {
  loop.store(packing);
  return packing;
}

}  // namespace

TEST_CASE("rejection-free sampling makes no overlap, and looks at few trials") {
  for (const Container& container : {Container{PeriodicBox{4, 4}}, Container{WalledBox{4, 4}},
                                     Container{Cylinder{5}}, Container{Plates{4, 4}}}) {
    for (const Move& move : moves()) {
      const Packing start = random_packing(container, 60, 12, 5);
      const auto loop = rejection_free_loop(start, move);
      const double previous = loop->mean_height();
      constexpr std::uint64_t trials = 1'000'000;
      loop->run(trials);
      const Packing end = stored(*loop, start);
      CHECK(deepest_overlap_brute_force(end).depth == 0);
      CHECK(loop->sampler_state().active);
      CHECK(loop->state().next_trial == trials);
      CHECK(loop->tally().trials == trials);
      CHECK(loop->tally().candidates > 100);
      CHECK(loop->tally().candidates < trials / 10);
      CHECK(loop->mean_height() == mean_height(end));
      CHECK(loop->mean_height() < 0.8 * previous);
    }
  }
}

TEST_CASE("rejection-free sampling makes no overlap with the far image of a sphere") {
  // Through a side as near as this a step meets an image that was not the nearest before it.
  for (const double width : {2.0000001, 2.05, 2.2}) {
    for (const Container& container :
         {Container{PeriodicBox{width, 4}}, Container{Plates{width, 2}}}) {
      for (const Move& move : {Move{PolarMove{0.4}}, Move{MetropolisMove{0.4}}}) {
        CAPTURE(container.index(), width, move.index());
        Packing packing = random_packing(container, 40, 20, 5);
        const auto loop = rejection_free_loop(packing, move);
        for (int piece = 0; piece < 10; ++piece) {
          loop->run(40'000);
          loop->store(packing);
          REQUIRE(deepest_overlap_brute_force(packing).depth == 0);
        }
        CHECK(loop->tally().candidates > 0);
      }
    }
  }
}

TEST_CASE("rejection-free sampling does not depend on how trials are split over calls") {
  for (const Move& move : moves()) {
    const Packing start = random_packing(PeriodicBox{4, 4}, 60, 12, 6);
    const auto straight = rejection_free_loop(start, move),
               sliced = rejection_free_loop(start, move);
    constexpr std::uint64_t trials = 600'000;
    straight->run(trials);
    for (std::uint64_t done = 0, slice = 1; done < trials; slice = slice * 5 / 3 % 3001 + 1) {
      const std::uint64_t piece = std::min(slice, trials - done);
      sliced->run(piece);
      done += piece;
    }
    REQUIRE(straight->sampler_state().active);
    CHECK(stored(*straight, start).centres == stored(*sliced, start).centres);
    CHECK(straight->state() == sliced->state());
    CHECK(straight->sampler_state() == sliced->sampler_state());
    CHECK(straight->tally().accepted == sliced->tally().accepted);
  }
}

TEST_CASE("rejection-free sampling resumed from its state continues bit for bit") {
  for (const Move& move : moves()) {
    const Packing start = random_packing(Cylinder{5}, 70, 12, 7);
    const auto straight = rejection_free_loop(start, move);
    bool skipped = false;
    for (const std::uint64_t trials : {1'000, 3'333, 100'000, 300'001, 77'777}) {
      straight->run(trials);
      const auto resumed = make_trial_loop(start.container, move, key, best_instruction_set(),
                                           Sampler::rejection_free);
      resumed->load(stored(*straight, start));
      resumed->restore(straight->state(), straight->sampler_state());
      straight->run(50'000);
      resumed->run(50'000);
      CHECK(stored(*straight, start).centres == stored(*resumed, start).centres);
      CHECK(straight->state() == resumed->state());
      CHECK(straight->sampler_state() == resumed->sampler_state());
      skipped = skipped || resumed->tally().candidates > 0;
    }
    CHECK(skipped);
  }
}

TEST_CASE("rejection-free sampling makes the same trajectory on every instruction set") {
  for (const Move& move : moves()) {
    const Packing start = random_packing(WalledBox{5, 4}, 60, 12, 8);
    std::vector<Packing> ends;
    for (const InstructionSet set : instruction_sets()) {
      const auto loop = rejection_free_loop(start, move, set);
      loop->run(500'000);
      CHECK(loop->tally().candidates > 0);
      loop->store(ends.emplace_back(start));
    }
    for (const Packing& end : ends) CHECK(end.centres == ends[0].centres);
  }
}

TEST_CASE("a rejection-free relaxation, cut into slices, takes the same course tap after tap") {
  const Packing start = random_packing(PeriodicBox{4, 4}, 60, 12, 9);
  const Stop stop{MeanHeightStop{1e-4, 50}, 100'000};
  const auto course = [&](std::uint64_t budget) {
    Packing packing = start;
    auto loop = rejection_free_loop(packing, PolarMove{});
    RandomStream random(stream_key(62, 0, 0, Purpose::tap));
    std::vector<double> heights;
    for (int tap = 0; tap < 3; ++tap) {
      RelaxationProgress progress;
      for (int slice = 1; progress.status == DynamicsStatus::running; ++slice) {
        relax(*loop, stop, {}, progress, budget);
        loop->store(packing);
        if (slice % 16 != 0) continue;
        const MoveState move = loop->state();
        const SamplerState sampler = loop->sampler_state();
        loop = rejection_free_loop(packing, PolarMove{});
        loop->restore(move, sampler);
      }
      heights.push_back(static_cast<double>(progress.trials));
      heights.push_back(progress.last_value);
      excite(packing, Dilate{0.02}, random);
      loop->load(packing);
      loop->begin_tap();
      CHECK_FALSE(loop->sampler_state().active);
    }
    return heights;
  };
  const auto whole = course(std::uint64_t{1} << 60);
  CHECK(course(12'345) == whole);
  CHECK(course(1'000) == whole);
}

TEST_CASE("a lone sphere on the floor stays there") {
  const Packing lone{PeriodicBox{4, 4}, {{1, 1, 0.5}}};
  const auto loop = rejection_free_loop(lone, PolarMove{});
  loop->run(1'000'000);
  CHECK(loop->state().next_trial == 1'000'000);
  CHECK(loop->mean_height() == 0.5);
  CHECK(loop->tally().accepted == 0);
}

TEST_CASE("rejection-free sampling is an error where trials may rise") {
  const auto make = [](const Container& container, const Move& move) {
    make_trial_loop(container, move, key, best_instruction_set(), Sampler::rejection_free);
  };
  CHECK_THROWS_WITH(make(FullyPeriodicBox{}, MetropolisMove{}), Catch::Contains("without gravity"));
  CHECK_THROWS_WITH(make(PeriodicBox{}, MetropolisMove{0.1, 3.0}), Catch::Contains("finite beta"));
  MetropolisMove adaptive{0.1};
  adaptive.adaptation = StepAdaptation{};
  adaptive.adaptation->base = AcceptanceBase::not_upward;
  CHECK_THROWS_WITH(make(PeriodicBox{}, adaptive),
                    Catch::Contains("does not see the upward trials"));
}
