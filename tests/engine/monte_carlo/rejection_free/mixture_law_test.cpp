#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "engine/monte_carlo/relaxation.hpp"
#include "engine/monte_carlo/trial_loop.hpp"
#include "tests/engine/sample_packings.hpp"

// Both samplers relax mixtures by one law: heights by kind, sweeps and packing fraction of beds
// that each relaxes from one start.
using namespace jostle;

namespace {

struct Comparison {
  std::string quantity;
  std::vector<double> differences;  // [bed], between both samplers
};

// The share of random choices of signs whose sum is at least as far from 0: exact for differences
// that are symmetric about 0 (Fisher's randomization test).
double sign_flip_probability(const std::vector<double>& differences) {
  RandomStream random(stream_key(91, 0, 0, Purpose::start));
  double observed = 0;
  for (const double d : differences) observed += d;
  constexpr int choices = 20'000;
  int as_far = 1;
  for (int k = 0; k < choices; ++k) {
    double sum = 0;
    for (const double d : differences) sum += random.integer_below(2) == 0 ? d : -d;
    as_far += std::abs(sum) >= std::abs(observed) * (1 - 1e-12);
  }
  return as_far / (choices + 1.0);
}

// Holm's step-down procedure: the least p-value of k tests is compared with level / k, the next
// with level / (k - 1), and so on.
void check_all_by_holm(const std::vector<Comparison>& comparisons, double level) {
  std::vector<std::pair<double, std::string>> tests;
  for (const Comparison& comparison : comparisons)
    tests.emplace_back(sign_flip_probability(comparison.differences), comparison.quantity);
  std::ranges::sort(tests);
  for (std::size_t k = 0; k < tests.size(); ++k) {
    CAPTURE(tests[k].second, tests[k].first, k, tests.size());
    CHECK(tests[k].first > level / static_cast<double>(tests.size() - k));
  }
}

struct Outcome {
  double sweeps, fraction;
  std::vector<double> heights;
};

Outcome relaxed(const Packing& start, const Move& move, Sampler sampler, std::uint64_t bed,
                double eta) {
  const StreamKey key = stream_key(92, static_cast<std::uint64_t>(sampler), bed, Purpose::trials);
  const auto loop = make_trial_loop(start.container, move, key, best_instruction_set(), sampler,
                                    SphereSizes::several);
  loop->load(start);
  loop->begin_tap();
  RelaxationProgress progress;
  relax(*loop, {MeanHeightStop{eta, 50}, 1'000'000}, {}, progress, std::uint64_t{1} << 60);
  REQUIRE(progress.status == DynamicsStatus::settled);
  if (sampler == Sampler::rejection_free) REQUIRE(loop->tally().candidates > 0);
  return {static_cast<double>(progress.trials), loop->solids_fraction({0, 3}),
          loop->kind_heights()};
}

// Small spheres of diameter 1 and large ones, as many as fill a volume.
Packing two_kinds(double ratio, int n_small, int n_large, std::uint64_t seed) {
  std::vector<double> diameters(n_small, 1.0);
  diameters.insert(diameters.end(), n_large, ratio);
  std::vector<std::uint32_t> kinds(n_small, 0);
  kinds.insert(kinds.end(), n_large, 1);
  const double volume = sphere_volume * (n_small + n_large * ratio * ratio * ratio);
  const double width = 2.05 * ratio + 2.2, height = 8 * volume / (width * width);
  Packing packing = random_mixture(PeriodicBox{width, width}, diameters, height, seed);
  packing.sizes = std::make_shared<const Sizes>(
      diameters, kinds, std::vector<SphereKind>{{"small", 1}, {"large", 1}});
  return packing;
}

void check_law(double size, int beds, double eta) {
  std::vector<Comparison> comparisons;
  const std::pair<double, int> ratios[] = {{1.4, 20}, {3.0, 6}, {10.0, 2}};
  for (const auto& [ratio, n_large] : ratios) {
    for (const Move& move : {Move{PolarMove{}}, Move{MetropolisMove{0.1}}}) {
      const std::string name =
          "ratio " + std::to_string(ratio) + ", move " + std::to_string(move.index()) + ": ";
      Comparison sweeps{name + "sweeps", {}}, fraction{name + "fraction", {}};
      Comparison heights[] = {{name + "small", {}}, {name + "large", {}}};
      for (int bed = 0; bed < beds; ++bed) {
        const auto seed = static_cast<std::uint64_t>(bed);
        const int n_small = static_cast<int>(size * (ratio < 5 ? 60 : 300));
        const Packing start = two_kinds(ratio, n_small, static_cast<int>(size * n_large), seed);
        const Outcome all = relaxed(start, move, Sampler::exhaustive, seed, eta);
        const Outcome few = relaxed(start, move, Sampler::rejection_free, seed, eta);
        sweeps.differences.push_back(few.sweeps - all.sweeps);
        fraction.differences.push_back(few.fraction - all.fraction);
        for (std::size_t kind = 0; kind < 2; ++kind)
          heights[kind].differences.push_back(few.heights[kind] - all.heights[kind]);
      }
      comparisons.insert(comparisons.end(), {sweeps, fraction, heights[0], heights[1]});
    }
  }
  check_all_by_holm(comparisons, 0.05);
}

}  // namespace

TEST_CASE("both samplers have one law in mixtures: small beds", "[statistics]") {
  check_law(1, 20, 1e-4);
}

TEST_CASE("both samplers have one law in mixtures: beds of hundreds of spheres", "[nightly]") {
  check_law(4, 20, 1e-5);
}
