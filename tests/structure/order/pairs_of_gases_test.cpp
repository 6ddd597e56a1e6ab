#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "engine/bed/boundary.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/random.hpp"
#include "structure/order/height_pairs.hpp"
#include "structure/order/pair_correlation.hpp"
#include "tests/structure/random_points.hpp"

// g(r) of sets of points whose right g is known: points that do not see each other, in low beds
// with a crowded floor, and hard spheres of which a packing has a few.

using namespace jostle;

namespace {

struct PooledGases {
  std::vector<double> r, g, error;  // [n_bins]; by the jackknife over packings
};

PooledGases pooled_gases(const std::vector<PairCorrelation>& packings) {
  const std::size_t n = packings.size(), n_bins = packings[0].r.size();
  PooledGases pooled{packings[0].r, {}, {}};
  for (std::size_t k = 0; k < n_bins; ++k) {
    double found = 0, expected = 0, sum = 0, squares = 0;
    for (const PairCorrelation& correlation : packings) {
      found += correlation.found[k];
      expected += correlation.expected[k];
    }
    for (const PairCorrelation& correlation : packings) {
      const double left = (found - correlation.found[k]) / (expected - correlation.expected[k]);
      sum += left / static_cast<double>(n);
      squares += left * left / static_cast<double>(n);
    }
    pooled.g.push_back(found / expected);
    pooled.error.push_back(std::sqrt((squares - sum * sum) * static_cast<double>(n - 1)));
  }
  return pooled;
}

/// Centres by height in bins of 0.2 from 0.4 on, of six beds of 400 spheres poured into a tube 9.3
/// wide. Those of the first bin are on the floor.
constexpr double centres_by_height[] = {355, 0,  8,   60, 237, 31, 34, 103, 145, 66,
                                        55,  98, 110, 72, 84,  93, 89, 81,  95,  81,
                                        89,  87, 81,  97, 67,  47, 21, 11,  2,   1};

double poured_height(RandomStream& random) {
  double all = 0;
  for (const double n : centres_by_height) all += n;
  double left = random.uniform() * all;
  std::size_t bin = 0;
  while (left >= centres_by_height[bin]) left -= centres_by_height[bin++];
  return bin == 0 ? 0.5 : 0.4 + 0.2 * (static_cast<double>(bin) + left / centres_by_height[bin]);
}

/// Points at heights of poured beds, anywhere beside each other.
Packing layered_points(const Container& container, unsigned n, std::uint64_t seed) {
  Packing points = random_points(container, 6, n, seed);
  RandomStream random(stream_key(77, 0, seed, Purpose::start));
  for (Vec3& r : points.centres) r.z = poured_height(random);
  return points;
}

/// Hard spheres put in one after another, each where the others leave room.
Packing hard_spheres(const Container& container, double height, unsigned n, std::uint64_t seed) {
  const Packing tried = random_points(container, height, 50 * n, 9000 + seed);
  Packing spheres{container, {}};
  for (const Vec3& r : tried.centres) {
    bool free = spheres.centres.size() < n;
    for (const Vec3& neighbour : spheres.centres) {
      free = free && norm_squared(separation(Boundary(container), r, neighbour)) >= 1;
    }
    if (free) spheres.centres.push_back(r);
  }
  return spheres;
}

struct KnownGas {
  std::string name;
  Container container;
  std::function<Packing(const Container&, std::uint64_t)> points;
  std::uint64_t n_gases;
  double r_max;
};

std::function<Packing(const Container&, std::uint64_t)> layered_gases(unsigned n) {
  return [=](const Container& container, std::uint64_t seed) {
    return layered_points(container, n, seed);
  };
}

}  // namespace

TEST_CASE("Points that do not see each other have g = 1 in low and crowded beds", "[slow]") {
  const auto gas = GENERATE(values<KnownGas>({
      {"layered, tube", Cylinder{9.3}, layered_gases(400), 24, 4},
      {"layered, walls", WalledBox{9, 8}, layered_gases(400), 24, 4},
      {"layered, plates", Plates{9, 8}, layered_gases(400), 24, 4},
      {"layered, periodic", PeriodicBox{8, 8}, layered_gases(400), 24, 4},
  }));
  std::vector<PairCorrelation> all;
  for (std::uint64_t seed = 0; seed < gas.n_gases; ++seed) {
    const Packing points = gas.points(gas.container, seed);
    try {
      all.push_back(pair_correlation(points, {.r_max = gas.r_max, .bin_width = 0.5}));
    } catch (const std::invalid_argument&) {
      // Few points may lie in a single layer.
    }
  }
  REQUIRE(all.size() > 0.5 * static_cast<double>(gas.n_gases));
  const PooledGases found = pooled_gases(all);
  for (std::size_t k = 1; k < found.g.size(); ++k) {
    CAPTURE(gas.name, found.r[k], found.g[k], found.error[k]);
    CHECK(std::abs(found.g[k] - 1) <= 4 * found.error[k]);
    if (gas.name.starts_with("layered") && k > 1) CHECK(found.error[k] < 0.012);
  }
}

TEST_CASE("Few hard spheres have the g of pairs counted by brute force", "[statistics]") {
  const auto container = GENERATE(values<Container>({PeriodicBox{7, 7}, WalledBox{7, 7}}));
  const auto n = GENERATE(5U, 40U);
  const std::uint64_t n_gases = n == 5 ? 600 : 60;
  constexpr double height = 7.5, bin_width = 0.5;
  constexpr std::size_t n_bins = 7;
  std::vector<Packing> gases;
  std::vector<PairCorrelation> measured;
  for (std::uint64_t seed = 0; seed < n_gases; ++seed) {
    gases.push_back(hard_spheres(container, height, n, seed));
    REQUIRE(gases.back().centres.size() == n);
    try {
      measured.push_back(
          pair_correlation(gases.back(), {.r_max = n_bins * bin_width, .bin_width = bin_width}));
    } catch (const std::invalid_argument&) {
    }
  }
  // Pairs within gases over those of a sphere of one gas and one of another.
  std::vector<double> own_pairs(n_bins, 0.0), across(n_bins, 0.0);
  const auto count = [&](const Packing& first, const Packing& second, std::vector<double>& bins) {
    for (const Vec3& a : first.centres) {
      for (const Vec3& b : second.centres) {
        const auto bin = static_cast<std::size_t>(
            std::sqrt(norm_squared(separation(Boundary(container), a, b))) / bin_width);
        if (&a != &b && bin < n_bins) bins[bin] += 1;
      }
    }
  };
  constexpr std::size_t n_others = 10;
  for (std::size_t i = 0; i < gases.size(); ++i) {
    count(gases[i], gases[i], own_pairs);
    for (std::size_t k = 1; k <= n_others; ++k) {
      count(gases[i], gases[(i + k) % gases.size()], across);
    }
  }
  const PooledGases found = pooled_gases(measured);
  CHECK(found.g[1] == 0);
  for (std::size_t k = 2; k < n_bins; ++k) {
    const double pairs = n * (n - 1.0) / n / n * across[k] / n_others, truth = own_pairs[k] / pairs;
    const double error = std::hypot(found.error[k], 2 * std::sqrt(own_pairs[k] / 2) / pairs);
    CAPTURE(n, found.r[k], found.g[k], found.error[k], truth);
    CHECK(std::abs(found.g[k] - truth) <= 3 * error);
  }
}

TEST_CASE("Pairs of heights are as many as spheres and others") {
  const std::vector<double> heights = {0.5, 0.5, 0.7, 1.3, 2.2, 2.4, 3.1};
  const HeightPairs pairs(heights, heights, {0.5, 3.1}, 6);
  double sum = 0;
  for (int k = -600; k < 600; ++k) sum += 0.01 * pairs.density(0.01 * (k + 0.5));
  CHECK(sum == Approx(7 * 6).epsilon(1e-3));
  CHECK(pairs.share(0) == Approx(1));
  CHECK(pairs.share(2) == Approx(5.0 / 7).margin(0.15));
}
