#include <algorithm>

#include "tests/hard_cases/cases.hpp"

using namespace jostle;

namespace {

/// Deepest overlap of pairs by sorting along z: all pairs less than one diameter apart in height,
/// without any cells.
double deepest_pair_by_height(const Packing& packing) {
  std::vector<Vec3> sorted = packing.centres;
  std::ranges::sort(sorted, {}, &Vec3::z);
  double deepest = 0;
  std::visit(
      [&](const auto& box) {
        for (std::size_t i = 0; i < sorted.size(); ++i) {
          for (std::size_t j = i + 1; j < sorted.size() && sorted[j].z - sorted[i].z < 1; ++j) {
            const double squared = norm_squared(separation(box, sorted[i], sorted[j]));
            deepest = std::max(deepest, 1 - std::sqrt(squared));
          }
        }
      },
      packing.container);
  return deepest;
}

std::vector<Container> least_containers() {
  const double least = std::nextafter(least_periodic_width, 3.0);
  return {PeriodicBox{least, least}, PeriodicBox{least, 7}, WalledBox{1, 1},
          WalledBox{1, 5},           Cylinder{1},           Plates{least, 1}};
}

}  // namespace

TEST_CASE("one and two spheres in boxes of the least legal width") {
  for (const Container& container : least_containers()) {
    REQUIRE_FALSE(width_fault(container));
    for (const std::uint32_t n : {1, 2, 3, 20}) {
      for (const Move& move :
           {Move{PolarMove{}}, Move{PolarMove{2.0, 1e3}}, Move{MetropolisMove{2.0, 1e-6}}}) {
        CAPTURE(container.index(), n, move.index());
        RandomStream random(stream_key(n, 0, 0, Purpose::start));
        const Packing start = make_start(SteepestDescentPour{}, container, n, random);
        run_trials(start, move, 10'000);
        if (move.index() == 0) run_trials(start, move, 10'000, Sampler::rejection_free);
      }
    }
  }
}

TEST_CASE("taps in boxes of the least legal width leave no overlap") {
  for (const Container& container : least_containers()) {
    for (const Tap& tap : {Tap{Dilate{0.1}}, Tap{Lift{1.0}}, Tap{Shake{0.1, 0.4, 5}}}) {
      CAPTURE(container.index(), width_x(container), tap.index());
      Plan plan;
      plan.seed = 5;
      plan.container = container;
      plan.n_spheres = 12;
      plan.start = SteepestDescentPour{};
      plan.protocol = {{tap, 20}};
      monte_carlo(plan).relax.stop = {.rule = MeanHeightStop{.eta = 1e-4, .every_sweeps = 10},
                                      .max_sweeps = 500};
      plan.observables = {MeanHeight{}, BottomFraction{}};
      run_plan_twice(plan);
    }
  }
}

TEST_CASE("coordinates on a seam, at -5e-17 and at the width are one place") {
  const PeriodicBox box{3, 5};
  for (const double x : {0.0, -5e-17, 3.0, -0.0, std::nextafter(3.0, 0.0)}) {
    const double place = wrap_coordinate(x, box.width_x);
    CHECK(place >= 0);
    CHECK(place < box.width_x);
    // A sphere there, and one that touches it across the seam from either side.
    const Packing given{box, {{x, 1, 0.5}, {2, 1, 0.5}, {1, 1, 0.5}, {1.5, 2.5, 0.5}}};
    const auto centres = std::make_shared<const std::vector<Vec3>>(given.centres);
    RandomStream unused(stream_key(1, 0, 0, Purpose::start));
    const Packing start = make_start(GivenPacking{centres}, box, 4, unused);
    for (const Vec3& r : start.centres) {
      CHECK(r.x >= 0);
      CHECK(r.x < box.width_x);
    }
    run_trials(start, PolarMove{}, 20'000);
    run_trials(start, MetropolisMove{0.5, 1.0}, 20'000);
    run_trials(start, PolarMove{}, 20'000, Sampler::rejection_free);
  }
}

TEST_CASE("a column 100 000 diameters high is tapped without overlap", "[statistics]") {
  RandomStream random(stream_key(6, 0, 0, Purpose::start));
  const Container tube = Cylinder{1.8};
  Packing column = make_start(SteepestDescentPour{}, tube, 180'000, random);
  REQUIRE(top_height(column) > 1e5);
  CHECK(deepest_pair_by_height(column) <= overlap_bound(column));
  for (const Tap& tap : {Tap{Dilate{1e-4}}, Tap{Lift{0.25}}}) {
    excite(column, tap, random);
    const double after_tap = deepest_pair_by_height(column);
    CHECK(after_tap <= overlap_bound(column));
    for (const Move& move : {Move{PolarMove{}}, Move{MetropolisMove{}}}) {
      const auto loop = make_trial_loop(tube, move, hard_case_key);
      loop->load(column);
      loop->run(4'000'000);
      const double previous = mean_height(column);
      loop->store(column);
      CHECK(finite(column.centres));
      CHECK(mean_height(column) <= previous);
      CHECK(deepest_pair_by_height(column) <= after_tap);
    }
  }
}

TEST_CASE("a few spheres 100 000 diameters up fall like others", "[statistics]") {
  const PeriodicBox box{3, 3};
  Packing high{box, {{1, 1, 1e5}, {1, 1, 1e5 + 1}, {2.5, 1, 1e5}}};
  for (const Sampler sampler : {Sampler::exhaustive, Sampler::rejection_free}) {
    const Packing end = run_trials(high, PolarMove{2.0}, 2'000'000, sampler);
    CHECK(top_height(end) < 2.6);  // three on a floor of 3 x 3, at most one on another
  }
}

TEST_CASE("a million spheres are tapped, trial by trial without overlap", "[statistics]") {
  RandomStream random(stream_key(7, 0, 0, Purpose::start));
  const PeriodicBox box{100, 100};
  Packing bed = make_start(Crystal{Lattice::fcc, false}, box, 1'000'000, random);
  excite(bed, Dilate{0.02}, random);
  std::vector<Packing> ends;
  for (int repeat = 0; repeat < 2; ++repeat) {
    const auto loop = make_trial_loop(box, PolarMove{}, hard_case_key);
    loop->load(bed);
    loop->run(4'000'000);
    CHECK(loop->tally().accepted > 1000);
    CHECK(loop->bytes() < 300e6);
    loop->store(ends.emplace_back(bed));
  }
  CHECK(ends[0].centres == ends[1].centres);
  CHECK(finite(ends[0].centres));
  CHECK(deepest_overlap(ends[0]).depth <= overlap_bound(ends[0]));
  // The cells that found this are no witness of their own: some spheres against all others.
  const double bound = overlap_bound(ends[0]);
  for (int chosen = 0; chosen < 200; ++chosen) {
    const std::uint64_t i = random.integer_below(1'000'000);
    double nearest = 2;
    for (std::size_t j = 0; j < ends[0].centres.size(); ++j) {
      if (j == i) continue;
      const Vec3 displacement = separation(box, ends[0].centres[i], ends[0].centres[j]);
      nearest = std::min(nearest, norm_squared(displacement));
    }
    CHECK(std::sqrt(nearest) >= 1 - bound);
  }
}
