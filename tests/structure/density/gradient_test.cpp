#include "structure/density/gradient.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/bed/random.hpp"
#include "tests/structure/reference_deposit.hpp"

using namespace jostle;

namespace {

// Spheres through each other, their number per height falling as 1 - slope z up to `height`. Away
// from the ends the fraction falls as their number does.
Packing thinning_packing(double slope, double height) {
  constexpr int n = 200'000;
  Packing packing{PeriodicBox{100, 100}, {}};
  const double below_top = height - 0.5 * slope * height * height;
  for (int i = 0; i < n; ++i) {
    const double lower_height = below_top * (i + 0.5) / n;
    packing.centres.push_back({50, 50, (1 - std::sqrt(1 - 2 * slope * lower_height)) / slope});
  }
  return packing;
}

Profile line(double at_floor, double slope, double noise, RandomStream& random) {
  Profile profile{even_edges(0, 15, 0.25), {}, {}};
  for (std::size_t k = 0; k + 1 < profile.edges.size(); ++k) {
    profile.volumes.push_back(0.25);
    profile.values.push_back(at_floor + slope * profile.middle(k) +
                             noise * (2 * random.uniform() - 1));
  }
  return profile;
}

}  // namespace

TEST_CASE("A packing that thins out upwards has the gradient it was made with") {
  const double slope = 0.01, height = 20;
  const Packing packing = thinning_packing(slope, height);
  const double floor_fraction =
      200'000 * sphere_volume / (1e4 * (height - 0.5 * slope * height * height));
  for (const double width : {0.1, 0.25, 0.33}) {
    const Profile profile = vertical_profile(packing, height_edges(packing, width));
    const Gradient found = gradient(profile, gradient_range(packing.container));
    CHECK(found.reason.empty());
    // A unit of z/R is half a diameter. The number is even to one part in 200 000.
    CHECK(found.alpha == Approx(floor_fraction * slope / 2).epsilon(1e-5));
    CHECK(found.error < 1e-5 * found.alpha);
    // From 2.5 to 13 diameters.
    CHECK(std::abs(static_cast<double>(found.points) - 10.5 / width) <= 1);
  }
}

TEST_CASE("The error of a gradient is the spread of gradients under noise") {
  RandomStream random(stream_key(61, 0, 0, Purpose::resampling));
  const GradientRange range{.smoothing = 0};
  constexpr int profiles = 2000;
  double chi_squared = 0, dof = 0;
  for (int i = 0; i < profiles; ++i) {
    const Gradient found = gradient(line(0.6, -0.004, 0.01, random), range);
    const double deviation = (found.alpha - 0.002) / found.error;
    chi_squared += deviation * deviation / profiles;
    dof = static_cast<double>(found.points) - 2;
  }
  // Student's t: variance dof / (dof - 2), of whose square the variance is about 2.
  CHECK(std::abs(chi_squared - dof / (dof - 2)) <= 3 * std::sqrt(2.5 / profiles));
}

TEST_CASE("Smoothing is the mean over the boxcar") {
  RandomStream random(stream_key(62, 0, 0, Purpose::resampling));
  const Profile rough = line(0.6, 0, 0.05, random);
  const Profile smooth = smoothed(rough, 1);
  // Over bins of 0.25: three whole ones and two halves.
  for (std::size_t k = 2; k + 2 < rough.size(); ++k) {
    const double mean = (0.5 * rough.values[k - 2] + rough.values[k - 1] + rough.values[k] +
                         rough.values[k + 1] + 0.5 * rough.values[k + 2]) /
                        4;
    CHECK(smooth.values[k] == Approx(mean).epsilon(1e-12));
  }
  // Cut short at the end, to two bins and a half.
  const double first = (rough.values[0] + rough.values[1] + 0.5 * rough.values[2]) / 2.5;
  CHECK(smooth.values[0] == Approx(first).epsilon(1e-12));
  // Above the top there is nothing.
  const std::size_t last = rough.size() - 1;
  const double last_mean =
      (rough.values[last] + rough.values[last - 1] + 0.5 * rough.values[last - 2]) / 4;
  CHECK(smooth.values[last] == Approx(last_mean).epsilon(1e-12));
  // A straight line stays one, wherever the boxcar fits.
  const Profile straight = line(0.6, -0.01, 0, random);
  const Profile smoothed_profile = smoothed(straight, 1.3);
  for (std::size_t k = 4; k + 4 < smoothed_profile.size(); ++k) {
    CHECK(smoothed_profile.values[k] == Approx(straight.values[k]).epsilon(1e-12));
  }
}

TEST_CASE("The gradient of a pour is taken within it") {
  const Packing deposit = reference_deposit();
  const Profile profile = vertical_profile(deposit, height_edges(deposit, 0.1));
  const GradientRange range = gradient_range(deposit.container);
  CHECK(range.high == 13);
  CHECK(gradient_range(WalledBox{}).high == 11);
  const Gradient found = gradient(profile, range);
  CHECK(found.points == 105);
  // The pour is even: over 21 R it changes by less than 0.021.
  CHECK(std::abs(found.alpha) < 0.001);
  CHECK(found.error > 0);
  // Half as high, the points end with the packing, and the surface is no gradient.
  Packing lower{deposit.container, {}};
  for (const Vec3& centre : deposit.centres) {
    if (centre.z < 7) lower.centres.push_back(centre);
  }
  const Gradient of_lower = gradient(vertical_profile(lower, height_edges(lower, 0.1)), range);
  CHECK(of_lower.points > 30);
  CHECK(of_lower.points < 50);
  CHECK(std::abs(of_lower.alpha) < 0.004);
}

TEST_CASE("A packing too low has no gradient, with a reason") {
  const Packing layer{PeriodicBox{4, 4}, {{1, 1, 0.5}, {3, 3, 0.5}}};
  const Gradient none =
      gradient(vertical_profile(layer, height_edges(layer, 0.1)), gradient_range(layer.container));
  CHECK(std::isnan(none.alpha));
  CHECK(std::isnan(none.error));
  CHECK(none.points == 0);
  CHECK_THAT(none.reason, Catch::Contains("0 bins") && Catch::Contains("5.0 R and 26.0 R") &&
                              Catch::Contains("1.8 R"));
  // Bins too wide.
  const Packing deposit = reference_deposit();
  const Gradient coarse = gradient(vertical_profile(deposit, height_edges(deposit, 6)), {});
  CHECK(std::isnan(coarse.alpha));
  CHECK(coarse.points < 3);
  // Nothing at all.
  CHECK(std::isnan(
      gradient(vertical_profile({PeriodicBox{4, 4}, {}}, even_edges(0, 20, 0.1)), {}).alpha));
}
