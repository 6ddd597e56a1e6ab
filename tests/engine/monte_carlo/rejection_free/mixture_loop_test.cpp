#include <catch2/catch.hpp>

#include "engine/bed/slab.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "tests/engine/sample_packings.hpp"

// Rejection-free sampling of spheres of several sizes.
using namespace jostle;

namespace {

const StreamKey key = stream_key(64, 0, 0, Purpose::trials);

std::unique_ptr<TrialLoop> skipping_loop(const Packing& packing, const Move& move,
                                         SphereSizes sizes = SphereSizes::several,
                                         InstructionSet set = best_instruction_set()) {
  auto loop = make_trial_loop(packing.container, move, key, set, Sampler::rejection_free, sizes);
  loop->load(packing);
  loop->begin_tap();
  return loop;
}

std::vector<Move> moves(double step) {
  MetropolisMove adaptive{2 * step};
  adaptive.adaptation = StepAdaptation{0.97, 7'777, 0.5, AcceptanceBase::all_trials, true};
  return {PolarMove{step}, PolarMove{2 * step, 0.3, ThetaLaw::exponential}, MetropolisMove{step},
          adaptive};
}

std::vector<Container> containers() {
  return {PeriodicBox{4.2, 4.4}, WalledBox{4, 4}, Cylinder{4.5}, Plates{4.2, 4}};
}

Packing stored(const TrialLoop& loop, Packing packing) {
  loop.store(packing);
  return packing;
}

Packing mixed_packing(const Container& container, double ratio, double largest) {
  const std::vector<double> diameters = graded_diameters(60, largest / ratio, ratio);
  double cubes = 0;
  for (const double d : diameters) cubes += d * d * d;
  return random_mixture(container, diameters, 8 * cubes * sphere_volume / footprint_area(container),
                        8);
}

}  // namespace

TEST_CASE("skipping with sizes of diameter 1 gives the centres of equal spheres, bit for bit") {
  for (const Container& container : containers()) {
    const Packing start = random_packing(container, 60, 12, 5);
    Packing sized = start;
    sized.sizes = std::make_shared<const Sizes>(std::vector<double>(60, 1.0));
    for (const Move& move : moves(0.1)) {
      CAPTURE(container.index(), move.index());
      const auto equal = skipping_loop(start, move, SphereSizes::equal);
      equal->run(400'000);
      REQUIRE(equal->tally().candidates > 100);
      for (const InstructionSet set : instruction_sets()) {
        for (const Packing& forced : {sized, start}) {
          const auto loop = skipping_loop(forced, move, SphereSizes::several, set);
          loop->run(400'000);
          CHECK(stored(*loop, start).centres == stored(*equal, start).centres);
          CHECK(loop->state() == equal->state());
          CHECK(loop->sampler_state() == equal->sampler_state());
          CHECK(loop->tally().candidates == equal->tally().candidates);
          CHECK(loop->mean_height() == Approx(equal->mean_height()).epsilon(1e-12));
        }
      }
    }
  }
}

TEST_CASE("skipping makes no overlap in a mixture, is resumed, and is alike on every machine") {
  for (const double ratio : {1.4, 3.0, 10.0}) {
    for (const Container& container : containers()) {
      const Packing start = mixed_packing(container, ratio, 2);
      for (const Move& move : moves(0.1 * 2 / ratio)) {
        CAPTURE(ratio, container.index(), move.index());
        const auto loop = skipping_loop(start, move);
        loop->run(300'000);
        const Packing middle = stored(*loop, start);
        CHECK(deepest_overlap_brute_force(middle).depth == 0);
        CHECK(loop->mean_height() == mean_height(middle));
        const auto resumed = make_trial_loop(container, move, key, InstructionSet::baseline,
                                             Sampler::rejection_free, SphereSizes::several);
        resumed->load(middle);
        resumed->restore(loop->state(), loop->sampler_state());
        for (TrialLoop* const trial_loop : {loop.get(), resumed.get()}) trial_loop->run(100'000);
        CHECK(loop->tally().candidates > 50);
        CHECK(loop->tally().candidates < loop->tally().trials / 8);
        CHECK(stored(*loop, start).centres == stored(*resumed, start).centres);
        CHECK(loop->state() == resumed->state());
        CHECK(loop->sampler_state() == resumed->sampler_state());
        const Packing end = stored(*loop, start);
        CHECK(deepest_overlap_brute_force(end).depth == 0);
        for (const InstructionSet set : instruction_sets()) {
          const auto whole = skipping_loop(start, move, SphereSizes::several, set);
          whole->run(400'000);
          CHECK(stored(*whole, start).centres == end.centres);
        }
      }
    }
  }
}

TEST_CASE("eight spheres of ten diameters are skipped among small ones, and resumed") {
  std::vector<double> diameters(600, 1.0);
  diameters.insert(diameters.end(), 8, 10.0);
  const Packing start = random_mixture(PeriodicBox{21, 22}, diameters, 40, 5);
  for (const Move& move : {Move{PolarMove{0.4}}, Move{MetropolisMove{0.3}}}) {
    const auto loop = skipping_loop(start, move);
    loop->run(1'200'000);
    Packing a = stored(*loop, start);
    CHECK(deepest_overlap_brute_force(a).depth == 0);
    REQUIRE(loop->sampler_state().active);
    const auto resumed = skipping_loop(a, move);
    resumed->restore(loop->state(), loop->sampler_state());
    for (TrialLoop* const trial_loop : {loop.get(), resumed.get()}) trial_loop->run(300'000);
    CHECK(loop->tally().candidates > 100);
    a = stored(*loop, start);
    CHECK(a.centres == stored(*resumed, start).centres);
    CHECK(deepest_overlap_brute_force(a).depth == 0);
  }
}

TEST_CASE("heights of the kinds of a mixture are those of its packing while it is skipped") {
  const Packing plain = mixed_packing(PeriodicBox{4.2, 4.4}, 3, 2);
  std::vector<double> diameters = diameters_of(*plain.sizes);
  std::vector<std::uint32_t> kinds;
  for (const double d : diameters) kinds.push_back(d > 1);
  Packing start = plain;
  start.sizes = std::make_shared<const Sizes>(diameters, kinds,
                                              std::vector<SphereKind>{{"small", 1}, {"large", 2}});
  const auto loop = skipping_loop(start, PolarMove{0.06});
  loop->run(300'000);
  REQUIRE(loop->sampler_state().active);
  const Packing end = stored(*loop, start);
  CHECK(loop->kind_heights() == kind_heights(end));
  CHECK(loop->solids_fraction({0, 3}) == solids_fraction(end, {0, 3}));
  loop->begin_tap();
  CHECK(stored(*loop, start).centres == end.centres);
  CHECK(loop->kind_heights() == kind_heights(end));
}
