#include "engine/trial_loop.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "engine/elementary.hpp"
#include "engine/geometry.hpp"
#include "engine/proposals.hpp"
#include "engine/theta_table.hpp"
#include "sample_packings.hpp"

using namespace jostle;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const StreamKey key = stream_key(2026, 0, 0, Purpose::trials);

// One trial at a time against all spheres: no lists, no cells. It shares the proposals with the
// trial loop and nothing else.
class PlainLoop {
 public:
  PlainLoop(Packing packing, const Move& move) : packing_(std::move(packing)), move_(move) {
    if (const auto* polar = std::get_if<PolarMove>(&move_)) table_ = make_theta_table(*polar);
    step_ = std::visit([](const auto& m) { return m.max_step; }, move_);
  }

  void trial(std::uint64_t number) {
    const auto n = static_cast<std::uint32_t>(packing_.centres.size());
    const std::uint64_t first = number - number % ProposalBatch::size;
    const BatchOrigin origin{static_cast<std::uint64_t>(key), first, n};
    const auto t = number - first;
    if (t == 0 || !started_) {
      if (std::holds_alternative<PolarMove>(move_)) {
        baseline::proposal_kernels().polar(origin, table_.data(), step_, *batch_);
      } else {
        baseline::proposal_kernels().metropolis(origin, *batch_);
      }
      started_ = true;
    }
    Vec3 step{batch_->dx[t], batch_->dy[t], batch_->dz[t]};
    if (!std::holds_alternative<PolarMove>(move_)) step = step_ * step;
    accepted += passes(number, batch_->sphere[t], step);
  }

  const Packing& packing() const { return packing_; }
  std::uint64_t accepted = 0;

 private:
  bool passes(std::uint64_t number, std::uint32_t i, Vec3 step) {
    return std::visit(
        [&](const auto& box) {
          const Vec3 target = wrapped(box, packing_.centres[i] + step);
          if (!clear_of_boundaries(box, target)) return false;
          for (std::size_t j = 0; j < packing_.centres.size(); ++j) {
            if (j != i && overlaps(box, target, packing_.centres[j])) return false;
          }
          const auto* metropolis = std::get_if<MetropolisMove>(&move_);
          if (metropolis && has_gravity(packing_.container) && step.z > 0) {
            if (metropolis->beta == infinity) return false;
            const double u = (philox_block(key, number, 1)[0] + 0.5) * 0x1p-32;
            if (!(u < exponential(-(metropolis->beta * step.z)))) return false;
          }
          packing_.centres[i] = target;
          return true;
        },
        packing_.container);
  }

  Packing packing_;
  Move move_;
  double step_;
  std::vector<double> table_;
  std::unique_ptr<ProposalBatch> batch_ = std::make_unique<ProposalBatch>();
  bool started_ = false;
};

std::vector<Move> moves() {
  return {PolarMove{},
          PolarMove{0.5, 0.4, ThetaLaw::exponential},
          PolarMove{2.0, 1.0, ThetaLaw::linear},
          MetropolisMove{0.1},
          MetropolisMove{0.4, 1.0},
          MetropolisMove{2.0, 0.0}};
}

}  // namespace

namespace {

// The trials cut into pieces; returns how many were compared.
std::uint64_t compare_with_plain_loop(const Packing& start, const Move& move,
                                      const std::vector<std::uint64_t>& pieces) {
  PlainLoop plain(start, move);
  const auto loop = make_trial_loop(start.container, move, key);
  loop->load(start);
  Packing fast = start;
  std::uint64_t done = 0;
  for (const std::uint64_t piece : pieces) {
    loop->run(piece);
    for (std::uint64_t k = 0; k < piece; ++k) plain.trial(done++);
    loop->store(fast);
    REQUIRE(fast.centres == plain.packing().centres);
  }
  CHECK(plain.accepted > 100);
  CHECK(loop->tally().accepted == plain.accepted);
  CHECK(loop->tally().trials == done);
  CHECK(loop->state().next_trial == done);
  CHECK(deepest_overlap_brute_force(fast).depth == 0);
  return done;
}

// Every container x move.
std::uint64_t compare_with_plain_loop(std::uint32_t n_spheres,
                                      const std::vector<std::uint64_t>& pieces) {
  const std::vector<Container> containers = {
      PeriodicBox{2.2, 2.05}, PeriodicBox{4.3, 5}, WalledBox{1.2, 6},          WalledBox{4, 4},
      Cylinder{1.4},          Cylinder{4.5},       FullyPeriodicBox{4, 4.5, 5}};
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

TEST_CASE("the trial loop keeps to the plain loop where spheres wander behind their shields") {
  // Accepted often enough that lists are renewed, rarely enough that trials are held against
  // shields first.
  for (const Container& container : std::vector<Container>{FullyPeriodicBox{4.1, 4.1, 4.1},
                                                           WalledBox{4.2, 4.3}, Cylinder{4.6}}) {
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
    for (const InstructionSet set :
         {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
      if (set > best_instruction_set()) continue;
      const auto loop = make_trial_loop(start.container, move, key, set);
      loop->load(start);
      loop->run(100'000);
      loop->store(ends.emplace_back(start));
    }
    for (const Packing& end : ends) CHECK(end.centres == ends[0].centres);
  }
}

TEST_CASE("a loop restored from its state goes on bit for bit") {
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

TEST_CASE("the published rule shrinks the step on a fixed schedule in the cold") {
  // Half of all trials rise and are refused, so fewer than half are ever accepted.
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
  // of which the floor refuses some.
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
                    Catch::Contains("use the Metropolis move"));
}
