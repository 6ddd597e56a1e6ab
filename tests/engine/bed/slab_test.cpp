#include "engine/bed/slab.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/engine/sample_packings.hpp"

using namespace jostle;

namespace {

// Midpoint rule over plane cuts: discs of area pi (R^2 - (z - z_c)^2).
double volume_by_cuts(double z, double low, double high) {
  constexpr int cuts = 200'000;
  double sum = 0;
  for (int k = 0; k < cuts; ++k) {
    const double height = low + (high - low) * (k + 0.5) / cuts - z;
    if (height * height < 0.25) sum += std::numbers::pi * (0.25 - height * height);
  }
  return sum * (high - low) / cuts;
}

}  // namespace

TEST_CASE("the volume of a sphere in a slab is the integral of its plane cuts") {
  for (const double z : {0.5, 0.7, 1.9, 2.0, 2.3, 5.0}) {
    for (const HeightWindow window : {HeightWindow{0, 2}, {0, 0.5}, {1.8, 2.1}, {0.6, 7}}) {
      CHECK(sphere_volume_in_slab(z, window.low, window.high) ==
            Approx(volume_by_cuts(z, window.low, window.high)).margin(1e-9));
    }
  }
}

TEST_CASE("slabs that share a plane add up to the spheres' volume") {
  const Packing packing = random_packing(WalledBox{4, 5}, 30, 8, 1);
  double volume = 0;
  for (double low = 0; low < 10; low += 0.37) {
    volume += 0.37 * 20 * solids_fraction(packing, {low, low + 0.37});
  }
  CHECK(volume == Approx(30 * sphere_volume).epsilon(1e-12));
}

TEST_CASE("one hexagonal layer fills 0.6046 of its height") {
  // Its area fraction times the mean section: (pi / (2 sqrt 3)) (2 / 3).
  Packing layer{PeriodicBox{4, 4 * std::sqrt(3.0) / 2}, {}};
  for (int row = 0; row < 4; ++row) {
    for (int k = 0; k < 4; ++k) {
      layer.centres.push_back({std::fmod(k + 0.5 * row, 4.0), row * std::sqrt(3.0) / 2, 0.5});
    }
  }
  CHECK(solids_fraction(layer, {0, 1}) == Approx(0.6045997880780726).epsilon(1e-12));
}

TEST_CASE("a fully periodic box holds all of every sphere, those on its ends too") {
  const Packing packing{FullyPeriodicBox{3, 3, 4}, {{1, 1, 0.1}, {2, 2, 3.8}, {1, 2.5, 2}}};
  CHECK(solids_fraction(packing, {0, 4}) == Approx(3 * sphere_volume / 36).epsilon(1e-14));
}

TEST_CASE("a cylinder's fraction uses its round footprint") {
  const Packing packing{Cylinder{3}, {{1.5, 1.5, 0.5}}};
  CHECK(solids_fraction(packing, {0, 1}) ==
        Approx(sphere_volume / (std::numbers::pi * 2.25)).epsilon(1e-14));
}

TEST_CASE("a window without depth gives the area fraction of its plane cut") {
  const Packing layer{PeriodicBox{4, 4}, {{1, 1, 0.5}, {3, 3, 0.5}, {1, 3, 0.7}}};
  const double cut = std::numbers::pi * (0.25 + 0.25 + 0.25 - 0.04) / 16;
  const HeightWindow window = resolve(QuantileWindow{0, 0.5}, layer);
  CHECK(window == HeightWindow{0.5, 0.5});
  CHECK(solids_fraction(layer, window) == Approx(cut).epsilon(1e-14));
  // To either side of the depth below which the middle stands for the slab.
  for (const double depth : {1e-16, 1e-9, 0.99e-5, 1.01e-5}) {
    CAPTURE(depth);
    const HeightWindow thin{0.5 - depth / 2, 0.5 + depth / 2};
    CHECK(solids_fraction(layer, thin) == Approx(cut).margin(2e-10).epsilon(0));
  }
}

TEST_CASE("a sphere as wide as its tube fills it at its equator, and no more") {
  for (const double z : {0.5, 0.7, 1.3, 12.45}) {
    const Packing packing{Cylinder{1}, {{0.5, 0.5, z}}};
    for (const double depth : {0.0, 1e-6, 1e-5, 1e-4}) {
      const HeightWindow window{z - 0.5 * depth, z + 0.5 * depth};
      CHECK(solids_fraction(packing, window) <= 1);
      CHECK(solids_fraction(packing, window) == Approx(1).epsilon(1e-8));
      CHECK(tapered_solids_fraction(packing, window, 1e-4) <= 1);
    }
  }
  const Packing twice{Cylinder{1}, {{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}};
  CHECK(solids_fraction(twice, {0.5, 0.5}) == Approx(2));  // an overlap is not hidden
}

TEST_CASE("a tapered window is the mean of windows shifted through its taper") {
  const Packing packing = random_packing(WalledBox{4, 5}, 60, 8, 1);
  struct Case {
    HeightWindow window;
    double taper;
  };
  // Deeper than its taper, less deep, of no depth, and one that reaches below floor and above the
  // bed.
  for (const auto& [window, taper] :
       {Case{{2, 6}, 0.8165}, {{2, 6}, 0.01}, {{3, 3.5}, 2}, {{4, 4}, 1.5}, {{0.2, 12}, 3}}) {
    constexpr int shifts = 20'000;
    double sum = 0;
    for (int k = 0; k < shifts; ++k) {
      const double shift = taper * ((k + 0.5) / shifts - 0.5);
      sum += solids_fraction(packing, {window.low + shift, window.high + shift});
    }
    CAPTURE(window.low, window.high, taper);
    CHECK(tapered_solids_fraction(packing, window, taper) == Approx(sum / shifts).epsilon(1e-7));
  }
  CHECK(tapered_solids_fraction(packing, {2, 6}, 0) == solids_fraction(packing, {2, 6}));
  CHECK(tapered_solids_fraction(packing, {2, 6}, 1e-9) ==
        Approx(solids_fraction(packing, {2, 6})).epsilon(1e-8));
}

TEST_CASE("a window tapered over one layer spacing finds a crystal close-packed wherever it cuts") {
  const double spacing = std::sqrt(2.0 / 3), close_packed = std::numbers::pi / std::sqrt(18.0);
  Packing crystal{PeriodicBox{4, 4 * std::sqrt(3.0) / 2}, {}};
  for (int layer = 0; layer < 12; ++layer) {
    for (int row = 0; row < 4; ++row) {
      for (int k = 0; k < 4; ++k) {  // a layer at a height between horizontal windows
        crystal.centres.push_back(
            {std::fmod(k + 0.5 * row, 4.0), row * std::sqrt(3.0) / 2, 0.5 + layer * spacing});
      }
    }
  }
  double most = 0;
  for (double low = 1.5; low < 2.4; low += 0.05) {
    for (const double depth : {3.0, 4.3, 5.1}) {
      const HeightWindow window{low, low + depth};
      CHECK(tapered_solids_fraction(crystal, window, spacing) ==
            Approx(close_packed).epsilon(1e-12));
      most = std::max(most, solids_fraction(crystal, window));
    }
  }
  CHECK(most > close_packed + 0.01);  // result with sharp edges
}

TEST_CASE("quantile windows interpolate order statistics") {
  Packing packing{PeriodicBox{4, 4}, {}};
  for (const double z : {5.0, 1.0, 3.0, 2.0, 4.0}) packing.centres.push_back({0, 0, z});
  CHECK(resolve(QuantileWindow{0.2, 0.8}, packing) == HeightWindow{1.8, 4.2});
  CHECK(resolve(QuantileWindow{0, 1}, packing) == HeightWindow{1, 5});
  CHECK(resolve(HeightWindow{3, 4}, packing) == HeightWindow{3, 4});
}
