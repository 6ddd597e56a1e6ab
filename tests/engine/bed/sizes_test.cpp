#include "engine/bed/sizes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "engine/bed/boundary.hpp"
#include "engine/bed/packing.hpp"
#include "engine/bed/random.hpp"
#include "engine/bed/slab.hpp"
#include "engine/engines.hpp"

using namespace jostle;

namespace {

std::shared_ptr<const Sizes> sizes_of(const std::vector<double>& diameters) {
  return std::make_shared<const Sizes>(diameters);
}

/// Random centres and diameters up to `ratio` times the smallest; spheres overlap at will.
Packing random_mixture(const Container& container, std::uint32_t n, double smallest, double ratio,
                       RandomStream& random) {
  Packing packing{container, {}};
  std::vector<double> diameters;
  const double height = std::min(9.0, Boundary(container).height);
  for (std::uint32_t i = 0; i < n; ++i) {
    packing.centres.push_back({width_x(container) * random.uniform(),
                               width_y(container) * random.uniform(), height * random.uniform()});
    diameters.push_back(smallest * std::pow(ratio, random.uniform()));
  }
  packing.sizes = sizes_of(diameters);
  return packing;
}

/// Midpoint rule over plane cuts of all spheres.
double fraction_by_cuts(const Packing& packing, HeightWindow window) {
  constexpr int cuts = 20'000;
  double sum = 0;
  for (int k = 0; k < cuts; ++k) {
    const double height = window.low + (window.high - window.low) * (k + 0.5) / cuts;
    for (std::size_t i = 0; i < packing.centres.size(); ++i) {
      const double height_difference = height - packing.centres[i].z, r = packing.radius(i);
      if (height_difference * height_difference < r * r)
        sum += std::numbers::pi * (r * r - height_difference * height_difference);
    }
  }
  return sum / cuts / footprint_area(packing.container);
}

}  // namespace

TEST_CASE("sizes give radius, mass and kind, and their extremes") {
  const std::vector<double> diameters{1, 0.5, 3};
  const Sizes sizes(diameters, {0, 0, 1}, {{"small", 1}, {"large", 2.5}});
  CHECK(sizes.size() == 3);
  CHECK(sizes.radii() == std::vector<double>{0.5, 0.25, 1.5});
  CHECK(sizes.masses() == std::vector<double>{1, 0.125, 67.5});
  CHECK(sizes.kinds()[sizes.kind(2)].name == "large");
  CHECK(sizes.smallest_radius() == 0.25);
  CHECK(sizes.largest_radius() == 1.5);
}

TEST_CASE("wrong sizes are rejected with what is wrong") {
  const auto fault = [](std::vector<double> diameters, std::vector<std::uint32_t> kinds,
                        std::vector<SphereKind> of_kinds) {
    return sizes_fault(diameters, kinds, of_kinds).value_or("none");
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<SphereKind> kinds{{"a", 1}};
  CHECK(fault({0.2, 2}, {0, 0}, kinds) == "none");
  CHECK(fault({1, 10}, {0, 0}, kinds) == "none");
  CHECK(fault({}, {}, kinds) == "none");
  for (const double bad : {nan, infinite, -1.0, 0.0, 0.199, 10.01})
    CHECK(fault({1, bad}, {0, 0}, kinds).starts_with("sphere 1 has the diameter"));
  CHECK(fault({0.5, 5.01}, {0, 0}, kinds).find("ratio must not exceed 10") != std::string::npos);
  CHECK(fault({1, 1}, {0}, kinds).find("kinds of 1 spheres") != std::string::npos);
  CHECK(fault({1}, {1}, kinds) == "sphere 0 has kind 1, and 1 kinds exist, counted from 0");
  CHECK(fault({1}, {0}, {{"", 1}}).find("has no name") != std::string::npos);
  CHECK(fault({1}, {0}, {{"a", 1}, {"a", 1}}).find("two kinds") != std::string::npos);
  for (const double bad : {nan, 0.0, -1.0, 2000.0})
    CHECK(fault({1}, {0}, {{"a", bad}}).find("density") != std::string::npos);
  CHECK_THROWS_AS(Sizes(std::vector<double>{nan}), std::invalid_argument);
}

TEST_CASE("spheres of several sizes touch where their radii meet") {
  const auto depth = [](const Container& container, std::vector<Vec3> centres,
                        const std::vector<double>& diameters) {
    return deepest_overlap({container, std::move(centres), sizes_of(diameters)}).depth;
  };
  const PeriodicBox box{8, 8};
  CHECK(depth(box, {{1, 1, 1.5}, {3, 1, 1.5}}, {3, 1}) == 0);
  CHECK(depth(box, {{1, 1, 1.5}, {2.75, 1, 1.5}}, {3, 1}) == 0.25);
  CHECK(depth(box, {{0.5, 1, 1.5}, {7, 1, 1.5}}, {3, 1}) == 0.5);
  CHECK(depth(box, {{1, 1, 1.25}}, {3}) == 0.25);
  CHECK(depth(box, {{1, 1, 0.25}}, {0.5}) == 0);
  CHECK(depth(WalledBox{8, 8}, {{6.75, 4, 2}}, {3}) == 0.25);
  CHECK(depth(Cylinder{8}, {{4, 6.75, 2}}, {3}) == 0.25);
  CHECK(depth(Cylinder{8}, {{4, 6.5, 1.5}}, {3}) == 0);
  CHECK(depth(FullyPeriodicBox{8, 8, 8}, {{4, 4, 0.1}}, {3}) == 0);
  CHECK(depth(FullyPeriodicBox{8, 8, 8}, {{4, 4, 0.1}, {4, 4, 6.35}}, {3, 1}) == 0.25);
}

TEST_CASE("cells find the deepest overlap of a mixture, as all pairs do") {
  RandomStream random(stream_key(5, 0, 0, Purpose::sizes));
  for (const Container& container :
       {Container{PeriodicBox{4.1, 9}}, Container{WalledBox{6, 6}}, Container{Cylinder{5}},
        Container{FullyPeriodicBox{4.1, 5, 8}}}) {
    for (const double ratio : {1.0, 1.4, 3.0, 9.9}) {
      for (int repeat = 0; repeat < 20; ++repeat) {
        // Few spheres, so that the deepest is not always one of two that nearly coincide.
        const Packing packing = random_mixture(container, 12, 0.2, ratio, random);
        const Overlap cells = deepest_overlap(packing);
        const Overlap pairs = deepest_overlap_brute_force(packing);
        REQUIRE(cells.depth == pairs.depth);
        REQUIRE(cells.first == pairs.first);
        REQUIRE(cells.second == pairs.second);
      }
    }
  }
}

TEST_CASE("fractions of a mixture are those of its plane cuts") {
  RandomStream random(stream_key(6, 0, 0, Purpose::sizes));
  const Packing packing = random_mixture(WalledBox{9, 8}, 30, 0.3, 9, random);
  for (const HeightWindow window : {HeightWindow{0, 2}, {1, 1.3}, {-1, 14}}) {
    CHECK(solids_fraction(packing, window) ==
          Approx(fraction_by_cuts(packing, window)).epsilon(1e-5));
    // The mean over windows shifted by up to half a taper.
    double mean = 0;
    for (int k = 0; k < 400; ++k) {
      const double shift = 0.8 * ((k + 0.5) / 400 - 0.5);
      mean += solids_fraction(packing, {window.low + shift, window.high + shift}) / 400;
    }
    CHECK(tapered_solids_fraction(packing, window, 0.8) == Approx(mean).epsilon(1e-5));
  }
  CHECK(solids_fraction(packing, {1, 1}) ==
        Approx(solids_fraction(packing, {0.99999, 1.00001})).epsilon(1e-6));
  CHECK(solids_fraction(packing, {-5, 20}) * 25 * 72 ==
        Approx(solid_volume(packing)).epsilon(1e-12));
}

TEST_CASE("heights of a mixture are weighted by volume") {
  Packing packing{PeriodicBox{9, 9}, {{1, 1, 1}, {4, 4, 3}}};
  packing.sizes = sizes_of({2, 1});
  CHECK(mean_height(packing) == Approx((8 * 1 + 3) / 9.0));
  CHECK(bed_height(packing) == 2 * mean_height(packing));
  CHECK(surface_height(packing) == 3.5);
  CHECK(solid_volume(packing) == Approx(9 * sphere_volume));
  CHECK(kind_heights(packing).empty());
  packing.centres.push_back({7, 7, 1});
  packing.sizes = std::make_shared<const Sizes>(
      std::vector<double>{2, 1, 1}, std::vector<std::uint32_t>{2, 0, 2},
      std::vector<SphereKind>{{"a", 1}, {"none", 1}, {"c", 3}});
  CHECK(kind_heights(packing) == std::vector<double>{3, (8 * 1 + 1) / 9.0});
  packing.centres.pop_back();
  packing.sizes = sizes_of({2, 1});
  // A column of equal cuts, half of which are made of many small spheres.
  Packing column{PeriodicBox{4.5, 4.5}, {}};
  std::vector<double> diameters;
  for (int k = 0; k < 1000; ++k) {
    column.centres.push_back({1, 1, 0.005 * (k + 0.5)});
    diameters.push_back(1);
  }
  for (int k = 0; k < 125; ++k) {
    column.centres.push_back({1, 1, 5 + 0.04 * (k + 0.5)});
    diameters.push_back(2);
  }
  column.sizes = sizes_of(diameters);
  const HeightWindow window = resolve(QuantileWindow{0.1, 0.75}, column);
  CHECK(window.low == Approx(1).margin(0.02));
  CHECK(window.high == Approx(7.5).margin(0.02));
}

TEST_CASE("sizes of diameter 1 change nothing") {
  RandomStream random(stream_key(7, 0, 0, Purpose::sizes));
  Packing packing = random_mixture(PeriodicBox{5, 5}, 40, 1, 1, random);
  Packing equal = packing;
  equal.sizes = nullptr;
  const auto close = [](double a, double b) { return std::abs(a - b) <= 1e-12 * std::abs(b); };
  CHECK(close(mean_height(packing), mean_height(equal)));
  CHECK(close(solid_volume(packing), solid_volume(equal)));
  CHECK(surface_height(packing) == surface_height(equal));
  CHECK(deepest_overlap(packing).depth == deepest_overlap(equal).depth);
  for (const QuantileWindow quantiles : {QuantileWindow{0, 1}, {0.2, 0.8}, {0.33, 0.34}}) {
    const HeightWindow a = resolve(quantiles, packing), b = resolve(quantiles, equal);
    CHECK(close(a.low, b.low));
    CHECK(close(a.high, b.high));
    CHECK(close(solids_fraction(packing, b), solids_fraction(equal, b)));
    CHECK(close(tapered_solids_fraction(packing, b, 0.8), tapered_solids_fraction(equal, b, 0.8)));
  }
}
