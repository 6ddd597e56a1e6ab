// Partial pair correlations of spheres that do not see each other, between sides.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "structure/order/mixtures/partial_correlation.hpp"
#include "tests/structure/order/mixed_points.hpp"

using namespace jostle;

namespace {

struct Gas {
  std::string name;
  Container container;
  double second;  // diameter of the second kind; that of the first is 1 or drawn
  bool is_drawn;
  double x_max;
  std::optional<HeightWindow> heights = std::nullopt;
};

/// The bins of g of pooled packings, with their errors by the jackknife over packings.
struct PooledBin {
  std::size_t pair = 0, bin = 0;
  double g = 0, error = 0;
};

std::vector<PooledBin> pooled_bins(const std::vector<std::vector<PartialCorrelation>>& packings) {
  constexpr double fewest = 50;  // pairs, for errors that are normal
  const auto n = static_cast<double>(packings.size());
  std::vector<PooledBin> bins;
  for (std::size_t pair = 0; pair < 3; ++pair) {
    for (std::size_t k = 0; k < packings[0][pair].x.size(); ++k) {
      double found = 0, expected = 0, sum = 0, squares = 0;
      for (const auto& all : packings) {
        found += static_cast<double>(all[pair].counts[k]);
        expected += all[pair].expected[k];
      }
      if (expected < fewest) continue;
      for (const auto& all : packings) {
        const double left =
            (found - static_cast<double>(all[pair].counts[k])) / (expected - all[pair].expected[k]);
        sum += left / n;
        squares += left * left / n;
      }
      bins.push_back({pair, k, found / expected, std::sqrt((squares - sum * sum) * (n - 1))});
    }
  }
  return bins;
}

/// Packings of gases with n_first and n_second spheres, measured.
std::vector<std::vector<PartialCorrelation>> gases(const Gas& gas, int n_gases, int n_first,
                                                   int n_second) {
  std::vector<std::vector<PartialCorrelation>> packings;
  RandomStream random(stream_key(1976, 0, 0, Purpose::start));
  if (gas.is_drawn) n_gases /= 3;  // they take longer
  for (int i = 0; i < n_gases; ++i) {
    MixedSizes sizes;
    if (gas.is_drawn)
      sizes.add_drawn(0, n_first, random);
    else
      sizes.add(0, n_first, 1);
    sizes.add(1, n_second, gas.second);
    packings.push_back(
        partial_correlations(mixed_points(gas.container, sizes, 9, random),
                             {.r_max = gas.x_max, .bin_width = 0.25, .heights = gas.heights}));
  }
  return packings;
}

const std::vector<Gas> all_gases{
    {"walls, 1 and 2", WalledBox{9, 8}, 2, false, 3},
    {"walls, 1 and 3", WalledBox{9, 8}, 3, false, 3},
    {"walls, drawn", WalledBox{9, 8}, 1.5, true, 3},
    {"near walls, 1 and 2", WalledBox{3.5, 4}, 2, false, 3},
    {"thin window between walls", WalledBox{7, 7}, 2, false, 3, HeightWindow{4, 5}},
    {"tube, 1 and 2", Cylinder{9}, 2, false, 3},
    {"tube, 1 and 3", Cylinder{9}, 3, false, 3},
    {"tube, drawn", Cylinder{9}, 1.5, true, 3},
    {"narrow tube, 1 and 2", Cylinder{3.5}, 2, false, 3},
    {"window on the floor of a tube", Cylinder{7}, 2, false, 3, HeightWindow{0, 2}},
    {"plates, 1 and 2", Plates{12.5, 6}, 2, false, 3},
    {"plates, 1 and 3", Plates{18.5, 6}, 3, false, 3},
    {"plates, drawn", Plates{12.5, 5}, 1.5, true, 3},
    {"near plates, drawn", Plates{12.5, 2.1}, 1.5, true, 3},
};

/// Deviations of g from 1 in standard errors, over all gases.
struct Deviations {
  double n = 0, sum = 0, squares = 0, beyond_three = 0;
};

Deviations deviations(int n_gases, int n_first, int n_second) {
  Deviations all;
  for (const Gas& gas : all_gases) {
    for (const PooledBin& bin : pooled_bins(gases(gas, n_gases, n_first, n_second))) {
      const double deviation = (bin.g - 1) / bin.error;
      CAPTURE(gas.name, bin.pair, bin.bin, bin.g, bin.error);
      CHECK(std::abs(deviation) <= 4);
      all.n += 1;
      all.sum += deviation;
      all.squares += deviation * deviation;
      all.beyond_three += std::abs(deviation) > 3 ? 1 : 0;
    }
  }
  return all;
}

/// g(r) of gases of so many spheres of two sizes.
void check_gases(int n_gases, unsigned n_first, unsigned n_second) {
  // About 450 bins: 4 standard errors for each, 3 for all but one in a hundred.
  const Deviations found = deviations(n_gases, n_first, n_second);
  CAPTURE(n_first, found.n, found.sum / found.n, found.squares / found.n, found.beyond_three);
  CHECK(found.n > 350);
  CHECK(found.beyond_three <= 0.01 * found.n);
  CHECK(found.squares / found.n < 1.25);
  // Bins of one gas are correlated: 3 standard errors of a tenth of them.
  CHECK(std::abs(found.sum / found.n) < 3 / std::sqrt(0.1 * found.n));
}

}  // namespace

TEST_CASE("partial g(r) of ideal gases is 1 between walls, in tubes and between plates",
          "[statistics]") {
  check_gases(25, 200, 100);
}

TEST_CASE("partial g(r) of gases of few spheres is 1 between walls, in tubes and between plates",
          "[slow]") {
  check_gases(150, 25, 15);
}
