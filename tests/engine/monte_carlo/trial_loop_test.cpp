#include "engine/monte_carlo/trial_loop.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/monte_carlo/plain_loop.hpp"
#include "tests/engine/sample_packings.hpp"

using namespace jostle;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const StreamKey key = stream_key(2026, 0, 0, Purpose::trials);

std::vector<Move> moves() {
  return {PolarMove{},
          PolarMove{0.5, 0.4, ThetaLaw::exponential},
          PolarMove{2.0, 1.0, ThetaLaw::linear},
          MetropolisMove{0.1},
          MetropolisMove{0.4, 1.0},
          MetropolisMove{2.0, 0.0}};
}

// The trials cut into pieces; returns how many were compared.
std::uint64_t compare_with_plain_loop(const Packing& start, const Move& move,
                                      const std::vector<std::uint64_t>& pieces) {
  PlainLoop plain(start, move, key);
  const auto loop = make_trial_loop(start.container, move, key);
  loop->load(start);
  Packing fast = start;
  std::uint64_t done = 0;
  for (const std::uint64_t piece : pieces) {
    loop->run(piece);
    plain.run(piece);
    done += piece;
    loop->store(fast);
    REQUIRE(fast.centres == plain.packing().centres);
  }
  CHECK(plain.accepted() > 100);
  CHECK(loop->tally().accepted == plain.accepted());
  CHECK(loop->tally().trials == done);
  CHECK(loop->state().next_trial == done);
  CHECK(deepest_overlap_brute_force(fast).depth == 0);
  return done;
}

// Every container x move.
std::uint64_t compare_with_plain_loop(std::uint32_t n_spheres,
                                      const std::vector<std::uint64_t>& pieces) {
  const std::vector<Container> containers = {
      PeriodicBox{2.2, 2.05}, PeriodicBox{4.3, 5}, WalledBox{1.2, 6},           WalledBox{4, 4},
      Cylinder{1.4},          Cylinder{4.5},       FullyPeriodicBox{4, 4.5, 5}, Plates{4.3, 3},
      Plates{2.05, 1.2}};
  std::uint64_t compared = 0;
  for (const Container& container : containers) {
    for (const Move& move : moves()) {
      if (!has_gravity(container) && std::holds_alternative<PolarMove>(move)) continue;
      CAPTURE(container.index(), width_x(container), move.index());
      const double depth = 1 + 4 * n_spheres / footprint_area(container);
      const Packing start = random_packing(container, n_spheres, depth, 8);
      compared += compare_with_plain_loop(start, move, pieces);
    }
  }
  return compared;
}

}  // namespace

TEST_CASE("the trial loop makes the trajectory of a plain loop over all spheres, bit for bit") {
  compare_with_plain_loop(40, {1, 255, 256, 257, 1000, 7, 30'000});
}

TEST_CASE("the trial loop keeps to the plain loop where hardly any trial is accepted") {
  const Container container = FullyPeriodicBox{3.9, 3.9, 3.9};
  const Packing start = random_packing(container, 38, 0, 8);
  compare_with_plain_loop(start, MetropolisMove{1.9}, {1000, 255, 200'000});
}

TEST_CASE("the trial loop keeps to the plain loop where spheres wander behind their caches") {
  // Accepted often enough that lists are renewed, rarely enough that trials are first tested
  // against blocker caches.
  for (const Container& container : std::vector<Container>{
           FullyPeriodicBox{4.1, 4.1, 4.1}, WalledBox{4.2, 4.3}, Cylinder{4.6}, Plates{4.2, 4.3}}) {
    CAPTURE(container.index());
    const Packing start = random_packing(container, 45, 6, 14);
    const MetropolisMove move{0.5, has_gravity(container) ? infinity : 0.0};
    const auto loop = make_trial_loop(container, move, key);
    loop->load(start);
    loop->run(200'000);
    if (!has_gravity(container)) CHECK(loop->tally().list_renewals > 100);
    CHECK(loop->tally().accepted * 6 < 200'000);
    compare_with_plain_loop(start, move, {200'000});
  }
}

TEST_CASE("the trial loop keeps to the plain loop over ten million trials", "[statistics]") {
  CHECK(compare_with_plain_loop(40, {100'000, 165'001}) >= 10'000'000);
}

TEST_CASE("every instruction set makes the same trajectory") {
  const Packing start = random_packing(PeriodicBox{6, 6}, 100, 10, 12);
  for (const Move& move : moves()) {
    std::vector<Packing> ends;
    for (const InstructionSet set : instruction_sets()) {
      const auto loop = make_trial_loop(start.container, move, key, set);
      loop->load(start);
      loop->run(100'000);
      loop->store(ends.emplace_back(start));
    }
    for (const Packing& end : ends) CHECK(end.centres == ends[0].centres);
  }
}

TEST_CASE("a loop restored from its state continues bit for bit") {
  MetropolisMove adaptive{0.3};
  adaptive.adaptation = StepAdaptation{0.9, 1000, 0.5, AcceptanceBase::not_upward, true};
  for (const Move& move : {Move{PolarMove{}}, Move{MetropolisMove{0.3, 2.0}}, Move{adaptive}}) {
    const Packing start = random_packing(Cylinder{6}, 80, 10, 13);
    const auto straight = make_trial_loop(start.container, move, key);
    straight->load(start);
    straight->begin_tap();
    straight->run(12'345);
    Packing middle = start;
    straight->store(middle);
    const MoveState state = straight->state();
    straight->run(54'321);

    const auto resumed = make_trial_loop(start.container, move, key);
    resumed->load(middle);
    resumed->restore(state);
    resumed->run(54'321);
    Packing a = start, b = start;
    straight->store(a);
    resumed->store(b);
    CHECK(a.centres == b.centres);
    CHECK(straight->state() == resumed->state());
  }
}

TEST_CASE("the published rule shrinks the step on a fixed schedule at zero temperature") {
  // Half of all trials rise and are rejected, so fewer than half are ever accepted.
  MetropolisMove move{0.1};
  move.adaptation = StepAdaptation{};
  const auto loop = make_trial_loop(PeriodicBox{5, 5}, move, key);
  loop->load(random_packing(PeriodicBox{5, 5}, 20, 60, 3));
  loop->begin_tap();
  loop->run(1'000'000);
  CHECK(loop->state().step == Approx(0.1 * std::pow(0.995, 100)).epsilon(1e-12));
  loop->begin_tap();
  CHECK(loop->state().step == 0.1);
}

TEST_CASE("counted over trials that do not rise, a dilute gas keeps its step") {
  MetropolisMove move{0.1};
  move.adaptation = StepAdaptation{0.995, 1000, 0.5, AcceptanceBase::not_upward, false};
  const auto loop = make_trial_loop(PeriodicBox{5, 5}, move, key);
  loop->load(random_packing(PeriodicBox{5, 5}, 5, 1000, 3));
  loop->begin_tap();
  loop->run(10'000);
  CHECK(loop->state().step == 0.1);
}

TEST_CASE("counted over trials that do not rise, accepted rises do not count") {
  // In equilibrium as many rises as falls are accepted: both together outnumber the falling trials,
  // of which the floor rejects some.
  MetropolisMove move{1.0, 1.0};
  move.adaptation = StepAdaptation{0.9, 1000, 1, AcceptanceBase::not_upward, false};
  const auto loop = make_trial_loop(PeriodicBox{5, 5}, move, key);
  loop->load({PeriodicBox{5, 5}, {{1, 1, 0.5}}});
  loop->run(5'000);
  CHECK(loop->state().step == Approx(std::pow(0.9, 5)).epsilon(1e-12));
}

TEST_CASE("steps of any size leave no overlap") {
  const Packing start = random_packing(WalledBox{5, 5}, 50, 10, 21);
  for (const double step : {1e-9, 1e-3, 0.9, 2.0}) {
    for (const Move& move : {Move{PolarMove{step}}, Move{MetropolisMove{step, 1.0}}}) {
      const auto loop = make_trial_loop(start.container, move, key);
      loop->load(start);
      loop->run(50'000);
      Packing end = start;
      loop->store(end);
      CHECK(deepest_overlap_brute_force(end).depth == 0);
    }
  }
}

TEST_CASE("without gravity the polar move is refused") {
  CHECK_THROWS_WITH(make_trial_loop(FullyPeriodicBox{}, PolarMove{}, key),
                    Catch::Contains("use \"metropolis\""));
}
