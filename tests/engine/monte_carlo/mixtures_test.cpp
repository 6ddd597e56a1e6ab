#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/bed/slab.hpp"
#include "engine/monte_carlo/monte_carlo.hpp"
#include "engine/monte_carlo/plain_loop.hpp"
#include "engine/monte_carlo/relaxation.hpp"
#include "tests/engine/sample_packings.hpp"

// Monte Carlo of spheres of several sizes.
using namespace jostle;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const StreamKey key = stream_key(2026, 0, 0, Purpose::trials);

std::unique_ptr<TrialLoop> loop_for_sizes(const Container& container, const Move& move,
                                          InstructionSet set = best_instruction_set()) {
  return make_trial_loop(container, move, key, set, Sampler::exhaustive, SphereSizes::several);
}

std::vector<Move> moves(double longest) {
  return {PolarMove{0.1 * longest}, PolarMove{longest, 1.0, ThetaLaw::linear},
          MetropolisMove{0.05 * longest, infinity}, MetropolisMove{0.3 * longest, 1.0},
          MetropolisMove{longest, 0.0}};
}

bool possible(const Move& move, const Container& container) {
  return !move_fault(move, container);
}

Packing with_diameters(Packing packing, double diameter) {
  packing.sizes =
      std::make_shared<const Sizes>(std::vector<double>(packing.centres.size(), diameter));
  return packing;
}

Packing packing_after(TrialLoop& loop, Packing packing, std::uint64_t trials) {
  loop.load(packing);
  loop.begin_tap();
  loop.run(trials);
  loop.store(packing);
  return packing;
}

}  // namespace

TEST_CASE("sizes of diameter 1 give the centres of equal spheres, bit for bit") {
  for (const Container& container :
       std::vector<Container>{PeriodicBox{4.3, 5}, WalledBox{4, 4}, Cylinder{4.5},
                              FullyPeriodicBox{4, 4.5, 5}, Plates{4.3, 4}}) {
    const Packing start = random_packing(container, 45, 6, 8);
    std::vector<Move> all = moves(2);
    MetropolisMove adaptive{0.3};
    adaptive.adaptation = StepAdaptation{0.9, 1000, 0.5};
    all.push_back(adaptive);
    for (const Move& move : all) {
      if (!possible(move, container)) continue;
      CAPTURE(container.index(), move.index());
      const auto equal = make_trial_loop(container, move, key);
      const Packing expected = packing_after(*equal, start, 60'000);
      for (const InstructionSet set : instruction_sets()) {
        for (const Packing& forced : {with_diameters(start, 1), start}) {
          const auto loop = loop_for_sizes(container, move, set);
          CHECK(packing_after(*loop, forced, 60'000).centres == expected.centres);
          CHECK(loop->state() == equal->state());
          CHECK(loop->tally().accepted == equal->tally().accepted);
          CHECK(loop->mean_height() == Approx(equal->mean_height()).epsilon(1e-12));
        }
      }
    }
  }
}

TEST_CASE("a mixture makes the trajectory of a plain loop over all spheres, bit for bit") {
  for (const double ratio : {1.4, 3.0, 10.0}) {
    const double smallest = 3 / ratio;
    for (const Container& container :
         std::vector<Container>{PeriodicBox{6.2, 6.4}, WalledBox{3.1, 6}, Cylinder{3.4},
                                Cylinder{6}, FullyPeriodicBox{6.3, 6.5, 7}, Plates{6.2, 4}}) {
      const auto n = static_cast<std::uint32_t>(has_gravity(container) ? 50 : ratio < 2 ? 12 : 25);
      const std::vector<double> diameters = graded_diameters(n, smallest, ratio);
      double cubes = 0;
      for (const double d : diameters) cubes += d * d * d;
      const double height = 8 * cubes * sphere_volume / footprint_area(container);
      const Packing start = random_mixture(container, diameters, height, 8);
      for (const Move& move : moves(2 * smallest)) {
        if (!possible(move, container)) continue;
        CAPTURE(ratio, container.index(), move.index());
        PlainLoop plain(start, move, key);
        const auto loop = loop_for_sizes(container, move);
        loop->load(start);
        Packing fast = start;
        for (const std::uint64_t piece : {1, 255, 257, 1000, 25'000}) {
          loop->run(piece);
          plain.run(piece);
          loop->store(fast);
          REQUIRE(fast.centres == plain.packing().centres);
        }
        CHECK(plain.accepted() > 100);
        CHECK(loop->tally().accepted == plain.accepted());
        CHECK(deepest_overlap_brute_force(fast).depth == 0);
      }
    }
  }
}

TEST_CASE("a mixture keeps to the plain loop where spheres wander behind their caches") {
  for (const Container& container : std::vector<Container>{FullyPeriodicBox{6.1, 6.1, 6.1},
                                                           WalledBox{6.2, 6.3}, Cylinder{6.6}}) {
    CAPTURE(container.index());
    const Packing start = random_mixture(container, graded_diameters(60, 0.9, 3), 10, 14);
    const MetropolisMove move{0.8, has_gravity(container) ? infinity : 0.0};
    PlainLoop plain(start, move, key);
    plain.run(150'000);
    const auto loop = loop_for_sizes(container, move);
    CHECK(packing_after(*loop, start, 150'000).centres == plain.packing().centres);
    if (!has_gravity(container)) CHECK(loop->tally().list_renewals > 100);
    CHECK(loop->tally().accepted * 6 < 150'000);
  }
}

TEST_CASE("all lengths doubled, a mixture has doubled centres, bit for bit") {
  // Lengths: widths, diameters, centres, steps. A sphere's mass is its density times its diameter
  // cubed: m g dz becomes 16 times as much, so that beta is a sixteenth. All are powers of two.
  const auto twice = [](const Container& container) {
    return *container_of(name_of(container), 2.0 * extent(container));
  };
  for (const Container& container :
       std::vector<Container>{PeriodicBox{6.2, 6.4}, WalledBox{4.1, 6}, Cylinder{5},
                              FullyPeriodicBox{6.3, 6.5, 7}, Plates{6.2, 4}}) {
    const std::vector<double> diameters = graded_diameters(40, 0.3, 10);
    const Packing start = random_mixture(container, diameters, 9, 21);
    std::vector<double> doubled_diameters = diameters;
    for (double& d : doubled_diameters) d *= 2;
    Packing doubled{twice(container), {}, std::make_shared<const Sizes>(doubled_diameters)};
    for (const Vec3& r : start.centres) doubled.centres.push_back(2.0 * r);
    const std::vector<Move> small = moves(0.4);
    for (std::size_t k = 0; k < small.size(); ++k) {
      if (!possible(small[k], container)) continue;
      CAPTURE(container.index(), k);
      Move large = moves(0.8)[k];
      if (auto* metropolis = std::get_if<MetropolisMove>(&large)) metropolis->beta /= 16;
      const auto loop = loop_for_sizes(container, small[k]);
      const auto large_loop = loop_for_sizes(doubled.container, large);
      std::vector<Vec3> expected = packing_after(*loop, start, 60'000).centres;
      for (Vec3& r : expected) r = 2.0 * r;
      CHECK(packing_after(*large_loop, doubled, 60'000).centres == expected);
      CHECK(loop->tally().accepted == large_loop->tally().accepted);
    }
  }
}

TEST_CASE("eight spheres of ten diameters move among small ones") {
  std::vector<double> diameters(600, 1.0);
  diameters.insert(diameters.end(), 8, 10.0);
  const Packing start = random_mixture(PeriodicBox{21, 22}, diameters, 40, 5);
  for (const Move& move : {Move{PolarMove{0.4}}, Move{MetropolisMove{0.3, 0.01}}}) {
    const auto loop = loop_for_sizes(start.container, move);
    Packing end = packing_after(*loop, start, 600'000);
    CHECK(deepest_overlap_brute_force(end).depth == 0);
    CHECK(loop->tally().list_renewals > 1000);
    // A loop that begins from this state continues alike.
    const auto resumed = loop_for_sizes(start.container, move);
    resumed->load(end);
    resumed->restore(loop->state());
    Packing a = end, b = end;
    loop->run(50'000);
    resumed->run(50'000);
    loop->store(a);
    resumed->store(b);
    CHECK(a.centres == b.centres);
  }
}

TEST_CASE("two masses in a dilute gas have each its own exponential profile") {
  // By the barometric law heights above the floor are exponential, of mean 1/(beta m).
  constexpr double beta = 0.5, diameter = 0.4, volume = diameter * diameter * diameter;
  constexpr std::uint32_t n = 6;  // spheres of each kind
  std::vector<std::uint32_t> kinds(2 * n, 0);
  std::fill(kinds.begin() + n, kinds.end(), 1);
  Packing packing = random_mixture(PeriodicBox{30, 30}, std::vector<double>(2 * n, diameter), 3, 6);
  packing.sizes = std::make_shared<const Sizes>(
      std::vector<double>(2 * n, diameter), kinds,
      std::vector<SphereKind>{{"light", 1 / volume}, {"heavy", 3 / volume}});
  const auto loop = loop_for_sizes(packing.container, MetropolisMove{0.8, beta});
  loop->load(packing);
  loop->run(100'000);
  constexpr int blocks = 25, samples = 5000;
  struct Profile {
    double mean_height;
    double sum[3] = {}, squares[3] = {};
  };
  Profile profiles[] = {{1 / beta}, {1 / (3 * beta)}};
  for (int block = 0; block < blocks; ++block) {
    double found[2][3] = {};
    for (int sample = 0; sample < samples; ++sample) {
      loop->run(10 * n);
      loop->store(packing);
      for (std::uint32_t i = 0; i < 2 * n; ++i) {
        const double reduced =
            (packing.centres[i].z - 0.5 * diameter) / profiles[kinds[i]].mean_height;
        found[kinds[i]][0] += reduced / (n * samples);
        found[kinds[i]][1] += (reduced > 1) / double(n * samples);
        found[kinds[i]][2] += (reduced > 2) / double(n * samples);
      }
    }
    for (int kind = 0; kind < 2; ++kind) {
      for (int k = 0; k < 3; ++k) {
        profiles[kind].sum[k] += found[kind][k];
        profiles[kind].squares[k] += found[kind][k] * found[kind][k];
      }
    }
  }
  const double expected[] = {1, std::exp(-1), std::exp(-2)};
  for (const Profile& profile : profiles) {
    for (int k = 0; k < 3; ++k) {
      const double mean = profile.sum[k] / blocks;
      const double error = std::sqrt((profile.squares[k] / blocks - mean * mean) / (blocks - 1));
      CAPTURE(profile.mean_height, k, mean, error);
      CHECK(error < 0.02 * expected[k]);
      CHECK(std::abs(mean - expected[k]) <= 3 * error);
    }
  }
}

TEST_CASE("the mean height of a mixture is weighted by volume while it relaxes") {
  const Packing start = random_mixture(PeriodicBox{7, 7}, graded_diameters(40, 0.5, 4), 9, 3);
  const auto loop = loop_for_sizes(start.container, PolarMove{});
  const Packing end = packing_after(*loop, start, 20'000);
  CHECK(loop->mean_height() == mean_height(end));
  CHECK(loop->kind_heights().empty());
  CHECK(loop->solids_fraction({0, 3}) == solids_fraction(end, {0, 3}));
}

TEST_CASE("a relaxation of a mixture continues while any kind still moves") {
  // One light sphere falls through a dilute box onto a floor of heavy ones at rest: its mean height
  // counts for one in a hundred thousand of the volume.
  Packing packing{PeriodicBox{20.5, 20.5}, {{1, 1, 60}}};
  std::vector<double> diameters{1};
  std::vector<std::uint32_t> kinds{0};
  for (int k = 0; k < 4; ++k) {
    packing.centres.push_back({5 + 10.2 * (k % 2), 5 + 10.2 * (k / 2), 5});
    diameters.push_back(10);
    kinds.push_back(1);
  }
  const auto sweeps_to_rest = [&](const std::vector<std::uint32_t>& kind_of) {
    packing.sizes = std::make_shared<const Sizes>(
        diameters, kind_of, std::vector<SphereKind>{{"one", 1}, {"other", 1}});
    const auto loop = loop_for_sizes(packing.container, PolarMove{});
    loop->load(packing);
    RelaxationProgress progress;
    relax(*loop, {MeanHeightStop{1e-3, 100}, 100'000}, {0, 0}, progress, 10'000'000);
    CHECK(progress.status == DynamicsStatus::settled);
    return progress.trials / 5;
  };
  const std::uint64_t by_kind = sweeps_to_rest(kinds);
  CHECK(by_kind > 1000);
  CHECK(sweeps_to_rest({1, 1, 1, 1, 1}) == 100);  // with one kind only the mean counts
}

TEST_CASE("a mixture that is tapped continues bit for bit from what it saved") {
  const Packing start = random_mixture(WalledBox{6, 6}, graded_diameters(60, 0.6, 5), 12, 17);
  const MonteCarlo settings{.relax = {.move = PolarMove{}, .stop = {MeanHeightStop{1e-4, 20}}}};
  const DynamicsStreams streams{stream_key(1, 0, 0, Purpose::trials),
                                stream_key(2, 0, 0, Purpose::trials)};
  const auto straight = make_dynamics(settings, streams);
  straight->load(start);
  straight->settle(GivenPacking{});
  RandomStream random(stream_key(3, 0, 0, Purpose::tap));
  straight->tap(Shake{0.1, 0.1, 3}, random);
  straight->advance(3000);
  Packing middle, end, resumed_end;
  straight->store(middle);
  CHECK(middle.sizes == start.sizes);
  const auto resumed = make_dynamics(settings, streams);
  resumed->load(middle);
  resumed->restore(straight->save());
  for (Dynamics* const dynamics : {straight.get(), resumed.get()})
    while (dynamics->advance(1'000'000) == DynamicsStatus::running) continue;
  straight->store(end);
  resumed->store(resumed_end);
  CHECK(end.centres == resumed_end.centres);
  CHECK(deepest_overlap_brute_force(end).depth <= overlap_bound(end));
  CHECK(mean_height(end) < mean_height(middle));
}

TEST_CASE("a loop made for equal spheres refuses a mixture by name") {
  const Packing mixture = random_mixture(PeriodicBox{6, 6}, {1, 2}, 5, 1);
  for (const Sampler sampler : {Sampler::exhaustive, Sampler::rejection_free}) {
    const auto loop =
        make_trial_loop(mixture.container, PolarMove{}, key, best_instruction_set(), sampler);
    CHECK_THROWS_WITH(loop->load(mixture), Catch::Contains("require equal spheres"));
  }
}
