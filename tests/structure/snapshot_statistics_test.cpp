#include "structure/snapshot_statistics.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "random_points.hpp"
#include "reference_deposit.hpp"

using namespace jostle;

namespace {

// All pairs, and all images near enough to matter, spelt out.
std::vector<unsigned> by_brute_force(const Packing& packing, double cut) {
  const bool periodic = std::holds_alternative<PeriodicBox>(packing.container);
  const auto* full = std::get_if<FullyPeriodicBox>(&packing.container);
  const int along_y = periodic || full != nullptr ? 3 : 0, vertical = full != nullptr ? 3 : 0;
  const int along_x = std::holds_alternative<Plates>(packing.container) ? 3 : along_y;
  const double a = width_x(packing.container), b = width_y(packing.container);
  const double c = full != nullptr ? full->height : 0;
  std::vector<unsigned> numbers;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    unsigned number = 0;
    for (std::size_t j = 0; j < packing.centres.size(); ++j) {
      const Vec3 way = packing.centres[j] - packing.centres[i];
      for (int u = -along_x; u <= along_x; ++u) {
        for (int v = -along_y; v <= along_y; ++v) {
          for (int w = -vertical; w <= vertical; ++w) {
            if (i == j && u == 0 && v == 0 && w == 0) continue;
            number += norm_squared(way + Vec3{u * a, v * b, w * c}) <= cut * cut;
          }
        }
      }
    }
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace

TEST_CASE("Coordination by cells is coordination over all pairs and images") {
  const auto [container, height] = GENERATE(table<Container, double>({
      {PeriodicBox{8, 6.5}, 5},
      {PeriodicBox{2.02, 3.1}, 9},
      {PeriodicBox{40, 40}, 2},
      {WalledBox{5, 7}, 5},
      {WalledBox{1.05, 4}, 9},
      {Cylinder{6}, 5},
      {Plates{6, 3}, 6},
      {Cylinder{1.2}, 20},
      {FullyPeriodicBox{6, 5, 4}, 4},
      {FullyPeriodicBox{2.02, 2.3, 3.3}, 3.3},
  }));
  const double cut = GENERATE(1.05, 0.4, 2.1);
  const Packing packing = random_points(container, height, 200);
  CHECK(coordination_numbers(packing, cut) == by_brute_force(packing, cut));
}

TEST_CASE("Spheres astride the seam are neighbours, and an image beyond the cut is none") {
  const Packing packing{PeriodicBox{5, 5}, {{0, 2, 1}, {4.0, 2, 1}, {3.9, 2, 3}}};
  CHECK(coordination_numbers(packing, 1.05) == std::vector<unsigned>{1, 1, 0});
  CHECK(coordination(packing, 1.05) == Approx(2.0 / 3));
}

TEST_CASE("Coordination against the cut is that at each cut, over all or in a region") {
  const Packing packing = random_points(WalledBox{8, 6}, 9, 400);
  const std::vector<double> cuts{0.5, 1.05, 1.2, 2.5};
  const CoordinationCurve all = coordination_curve(packing, cuts);
  CHECK(all.n_spheres == 400);
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    CHECK(all.coordination[k] == coordination(packing, cuts[k]));
  }
  const Region region{2, 7, 1.5};
  const CoordinationCurve inside = coordination_curve(packing, cuts, region);
  const std::vector<unsigned> numbers = coordination_numbers(packing, 1.2);
  unsigned spheres = 0, neighbours = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!region.contains(packing.container, packing.centres[i])) continue;
    ++spheres;
    neighbours += numbers[i];
  }
  CHECK(inside.n_spheres == spheres);
  CHECK(inside.coordination[2] == static_cast<double>(neighbours) / spheres);
  CHECK(std::isnan(coordination_curve(packing, cuts, Region{20, 30}).coordination[0]));
}

TEST_CASE("The neighbour histogram counts spheres by their number of neighbours") {
  const std::vector<unsigned> numbers{6, 0, 2, 6, 6};
  CHECK(neighbour_histogram(numbers) == std::vector<std::uint64_t>{1, 0, 1, 0, 0, 0, 3});
  CHECK(neighbour_histogram({}).empty());
}

TEST_CASE("The reference deposit has the neighbours that its maker counted") {
  const Packing deposit = reference_deposit();
  const auto reference = reference_measurements();
  const double bottom = reference.at("zwin").at(0).get<double>() * sphere_radius;
  const double top = reference.at("zwin").at(1).get<double>() * sphere_radius;
  const std::vector<unsigned> numbers = coordination_numbers(deposit, 1.05);
  unsigned spheres = 0, neighbours = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double z = deposit.centres[i].z;
    if (z < bottom || z > top) continue;
    ++spheres;
    neighbours += numbers[i];
  }
  CHECK(spheres == reference.at("n_in"));
  // Margin: half a unit of the last digit printed.
  CHECK(static_cast<double>(neighbours) / spheres ==
        Approx(reference.at("neigh_within_1.05d").get<double>()).margin(0.5e-4).epsilon(0));
}

TEST_CASE("The height histogram counts centres in half-open bins up to the highest") {
  const Packing packing{PeriodicBox{5, 5}, {{1, 1, 0.5}, {3, 1, 0.5}, {1, 3, 0.74}, {3, 3, 1.25}}};
  CHECK(height_histogram(packing, 0.25) == std::vector<double>{0, 0, 0.75, 0, 0, 0.25});

  const std::vector<double> deposit = height_histogram(reference_deposit(), 0.1);
  CHECK(std::accumulate(deposit.begin(), deposit.end(), 0.0) == Approx(1));
  // Every sphere on the floor is in the bin from 0.5 d.
  CHECK(deposit[5] * 4096 >= reference_measurements().at("floor_spheres").get<double>());
  CHECK(deposit[4] == 0);

  CHECK_THROWS_AS(height_histogram({PeriodicBox{5, 5}, {{1, 1, 2e8}}}, 0.1), std::invalid_argument);
}

TEST_CASE("A height histogram has at most 100,000 bins, or 100 for each sphere") {
  const auto column = [](std::size_t n, double spacing) {
    Packing packing{PeriodicBox{5, 5}, {}};
    for (std::size_t i = 0; i < n; ++i)
      packing.centres.push_back({1, 1, (static_cast<double>(i) + 0.5) * spacing});
    return packing;
  };
  CHECK(n_height_bins(column(1, 19990), 0.1) == 99951);
  CHECK_THROWS_AS(n_height_bins(column(1, 20010), 0.1), std::invalid_argument);
  CHECK(n_height_bins(column(20000, 1), 0.1) == 199996);  // a single file fills its bins
  CHECK_THROWS_AS(n_height_bins(column(20000, 11), 0.1), std::invalid_argument);
  CHECK_FALSE(has_height_bins(column(80, 1000), 0.1));
  CHECK(has_height_bins(column(80, 1000), 1));
  CHECK_THROWS_WITH(height_histogram(column(80, 1000), 0.1),
                    Catch::Contains("80 spheres with centres up to 79500") &&
                        Catch::Contains("more than 100000 bins"));
}
