#include "tests/hard_cases/cases.hpp"

using namespace jostle;

namespace {

/// The crystal with every distance longer by the gap.
Packing opened(Packing packing, double gap) {
  auto& box = std::get<PeriodicBox>(packing.container);
  box.width_x *= 1 + gap;
  box.width_y *= 1 + gap;
  for (Vec3& r : packing.centres) {
    r = wrapped(box, {r.x * (1 + gap), r.y * (1 + gap), r.z * (1 + gap)});
  }
  return packing;
}

/// A cube scaled until the nearest two spheres touch, to 1e-13 diameters.
Packing shrunk_to_touch(Packing packing) {
  auto& box = std::get<FullyPeriodicBox>(packing.container);
  double nearest = 4;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      nearest =
          std::min(nearest, norm_squared(separation(box, packing.centres[i], packing.centres[j])));
    }
  }
  const double factor = (1 + 1e-13) / std::sqrt(nearest);
  box = {box.width_x * factor, box.width_y * factor, box.height * factor};
  for (Vec3& r : packing.centres) r = wrapped(box, factor * r);
  return packing;
}

std::vector<Move> moves() {
  return {PolarMove{}, PolarMove{1e-9}, MetropolisMove{}, MetropolisMove{0.1, 1e3},
          MetropolisMove{2.0, 1.0}};
}

bool is_cold(const Move& move) {
  const auto* metropolis = std::get_if<MetropolisMove>(&move);
  return !metropolis || std::isinf(metropolis->beta);
}

}  // namespace

TEST_CASE("perfect crystals and ones with a gap of a few ulp hold every kind of move") {
  for (const Lattice lattice : {Lattice::hcp, Lattice::fcc}) {
    for (const double gap : {0.0, 1e-15, 1e-12}) {
      const Packing crystal = opened(close_packed(lattice, 5), gap);
      REQUIRE(deepest_overlap_brute_force(crystal).depth <= overlap_bound(crystal));
      for (const Move& move : moves()) {
        CAPTURE(int(lattice), gap, move.index());
        const Packing end = run_trials(crystal, move, 50'000);
        if (!is_cold(move)) continue;
        CHECK(top_height(end) <= top_height(crystal));
        run_trials(crystal, move, 50'000, Sampler::rejection_free);
      }
    }
  }
}

TEST_CASE("a crystal cannot settle: it stays within its gap") {
  const Packing crystal = opened(close_packed(Lattice::hcp, 5), 1e-12);
  const Packing end = run_trials(crystal, PolarMove{1e-11}, 500'000);
  CHECK(mean_height(end) <= mean_height(crystal));
  CHECK(mean_height(end) >= mean_height(close_packed(Lattice::hcp, 5)) - 1e-12);
}

TEST_CASE("a disordered packing pressed from 0.60 to 0.64 keeps every sphere apart",
          "[statistics]") {
  constexpr std::uint32_t n = 200;
  const double side = std::cbrt(n * sphere_volume / 0.60);
  RandomStream random(stream_key(3, 0, 0, Purpose::start));
  Packing packing = make_start(Grow{}, FullyPeriodicBox{side, side, side}, n, random);
  // Shaken a little, then shrunk until the nearest two touch, again and again; with steps of
  // which three in ten are accepted.
  constexpr std::uint64_t trials = 20'000;
  double step = 0.05;
  for (std::uint64_t press = 0; press < 2000; ++press) {
    const auto loop = make_trial_loop(packing.container, MetropolisMove{step}, hard_case_key);
    loop->restore({.next_trial = press * trials, .step = step});
    loop->load(packing);
    loop->run(trials);
    loop->store(packing);
    step = std::min(0.05, step * (loop->tally().accepted < 3 * trials / 10 ? 0.97 : 1.03));
    REQUIRE(finite(packing.centres));
    REQUIRE(deepest_overlap_brute_force(packing).depth <= 1e-12);
    packing = shrunk_to_touch(packing);
  }
  CHECK(n * sphere_volume / std::pow(width_x(packing.container), 3) > 0.64);
  for (const double longest : {1e-9, 1e-3, 0.5, 2.0}) {
    CAPTURE(longest);
    run_trials(packing, MetropolisMove{longest, 0.0}, 200'000);
  }
}

TEST_CASE("a crystal tapped 10 000 times never overlaps", "[slow]") {
  for (const Sampler sampler : {Sampler::exhaustive, Sampler::rejection_free}) {
    for (const Tap& tap : {Tap{Dilate{0.02}}, Tap{Lift{0.25}}}) {
      Plan plan;
      plan.seed = 20260102;
      plan.container = PeriodicBox{4, 3.4641016151377544};
      plan.n_spheres = 80;
      plan.start = Crystal{};
      plan.protocol = {{tap, 10'000}};
      monte_carlo(plan).relax.stop = {.rule = SweepsStop{.sweeps = 30}};
      monte_carlo(plan).relax.sampler = sampler;
      plan.observables = {MeanHeight{}, BottomFraction{}};
      const RecordedRealization record = run_plan(plan, 100);
      for (const TapRow& row : record.rows) {
        REQUIRE(std::isfinite(row.observables[0]));
        REQUIRE(row.observables[0] < 2 * record.rows[0].observables[0]);
        REQUIRE(row.observables[1] > 0);
        REQUIRE(row.observables[1] <= 0.7405);  // Kepler's bound, pi / sqrt(18)
      }
    }
  }
}

TEST_CASE("1e9 trials in a jammed bed make no overlap", "[nightly]") {
  RandomStream random(stream_key(4, 0, 0, Purpose::start));
  Packing bed = make_start(SteepestDescentPour{}, PeriodicBox{8, 8}, 1000, random);
  for (const Move& move : {Move{PolarMove{}}, Move{MetropolisMove{}}}) {
    const auto loop = make_trial_loop(bed.container, move, hard_case_key);
    loop->load(bed);
    double previous = mean_height(bed);
    for (int tenth = 0; tenth < 10; ++tenth) {
      loop->run(100'000'000);
      Packing now = bed;
      loop->store(now);
      REQUIRE(finite(now.centres));
      CHECK(deepest_overlap_brute_force(now).depth <= overlap_bound(now));
      CHECK(mean_height(now) <= previous);
      previous = mean_height(now);
    }
  }
}
