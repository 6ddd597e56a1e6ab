// Partial pair correlations of poured beds between sides.
#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "engine/starts/starts.hpp"
#include "structure/order/mixtures/partial_correlation.hpp"
#include "structure/order/pair_correlation.hpp"
#include "tests/structure/order/mixed_points.hpp"

using namespace jostle;

TEST_CASE("Equal spheres under two names have the g(r) of equal spheres between sides") {
  const auto container =
      GENERATE(values<Container>({WalledBox{11, 11}, Cylinder{13}, Plates{12, 10}}));
  CAPTURE(container.index());
  constexpr std::uint32_t n = 1000;
  const PairCorrelationSettings settings{
      .r_max = 2, .bin_width = 0.25, .heights = HeightWindow{2.8, 4}};
  std::vector<double> counts(8), expected(8), found(8), of_equal(8);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    RandomStream random(stream_key(1983, 0, seed, Purpose::start));
    Packing bed = make_start(SteepestDescentPour{}, container, n, random);
    const PairCorrelation equal = pair_correlation(bed, settings);
    const auto named = [&](std::uint32_t first) {
      std::vector<std::uint32_t> kinds;
      for (std::uint32_t i = 0; i < n; ++i) kinds.push_back((i % 3 == 0 ? 1 : 0) ^ first);
      bed.sizes = std::make_shared<const Sizes>(std::vector<double>(n, 1.0), kinds,
                                                std::vector<SphereKind>{{"a", 1}, {"b", 1}});
      return partial_correlations(bed, settings);
    };
    const auto all = named(0), swapped = named(1);
    for (std::size_t k = 0; k < 8; ++k) {
      std::uint64_t of_all = 0;
      for (std::size_t pair = 0; pair < 3; ++pair) {
        of_all += all[pair].counts[k];
        expected[k] += all[pair].expected[k];
        CHECK(all[pair].counts[k] == swapped[2 - pair].counts[k]);
        CHECK(all[pair].expected[k] == Approx(swapped[2 - pair].expected[k]).epsilon(1e-12));
      }
      CHECK(of_all == equal.counts[k]);
      counts[k] += static_cast<double>(of_all);
      found[k] += equal.found[k];
      of_equal[k] += equal.expected[k];
    }
  }
  // The correction of equal spheres weighs pairs by their direction, that of mixtures does not.
  for (std::size_t k = 4; k < 8; ++k) {
    CAPTURE(k);
    CHECK(counts[k] / expected[k] == Approx(found[k] / of_equal[k]).epsilon(0.03));
  }
}

TEST_CASE("Beds of two sizes between sides have the partial g(r) of one without", "[statistics]") {
  struct Sides {
    Container container;
    double area;
  };
  constexpr std::size_t n_bins = 6;
  constexpr double bin_width = 0.5;
  using Bins = std::array<std::array<double, n_bins>, 3>;
  const auto pooled = [](const Sides& sides) {
    Bins counts{}, expected{};
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      RandomStream random(stream_key(1984, 0, seed, Purpose::start));
      MixedSizes sizes;
      sizes.add(0, static_cast<int>(3.5 * sides.area), 1);
      sizes.add(1, static_cast<int>(0.6 * sides.area), 1.8);
      const Packing bed =
          make_start(SteepestDescentPour{}, sides.container,
                     {static_cast<std::uint32_t>(sizes.diameters.size()), sizes.sizes()}, random);
      const auto all = partial_correlations(bed, {.r_max = 3, .bin_width = bin_width});
      for (std::size_t pair = 0; pair < 3; ++pair) {
        for (std::size_t k = 0; k < n_bins; ++k) {
          counts[pair][k] += static_cast<double>(all[pair].counts[k]);
          expected[pair][k] += all[pair].expected[k];
        }
      }
    }
    for (std::size_t pair = 0; pair < 3; ++pair) {
      for (std::size_t k = 0; k < n_bins; ++k) counts[pair][k] /= expected[pair][k];
    }
    return counts;
  };
  const Bins periodic = pooled({PeriodicBox{12, 12}, 144});
  for (const Sides& sides :
       {Sides{WalledBox{12, 12}, 132}, Sides{Cylinder{13.5}, 132}, Sides{Plates{12, 11}, 126}}) {
    const Bins g = pooled(sides);
    for (std::size_t pair = 0; pair < 3; ++pair) {
      for (std::size_t k = 2; k < n_bins; ++k) {
        CAPTURE(sides.container.index(), pair, k, periodic[pair][k], g[pair][k]);
        CHECK(g[pair][k] == Approx(periodic[pair][k]).epsilon(0.06));
      }
    }
  }
}
