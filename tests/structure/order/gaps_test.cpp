#include "structure/order/gaps.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "close_packings.hpp"
#include "structure/measure.hpp"
#include "tests/structure/reference_deposit.hpp"

using namespace jostle;

namespace {

/// Rattlers by going over all pairs again and again.
std::vector<bool> rattlers_of_all_pairs(const Packing& packing, double tolerance, unsigned least) {
  const Boundary boundary(packing.container);
  std::vector<bool> rattler(packing.centres.size(), false);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < rattler.size(); ++i) {
      if (rattler[i]) continue;
      unsigned contacts = packing.centres[i].z <= 0.5 + tolerance ? 1 : 0;
      for (std::size_t j = 0; j < rattler.size(); ++j) {
        if (i == j || rattler[j]) continue;
        const Vec3 apart = separation(boundary, packing.centres[i], packing.centres[j]);
        contacts += std::sqrt(norm_squared(apart)) <= 1 + tolerance ? 1 : 0;
      }
      if (contacts < least) rattler[i] = changed = true;
    }
  }
  return rattler;
}

/// n gaps whose density falls as h^-gamma between low and high.
std::vector<double> drawn_gaps(double gamma, double low, double high, int n, std::uint64_t seed) {
  RandomStream random(stream_key(seed, 5, 0, Purpose::resampling));
  std::vector<double> gaps;
  const double a = 1 - gamma;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform();
    gaps.push_back(std::pow(std::pow(low, a) + u * (std::pow(high, a) - std::pow(low, a)), 1 / a));
  }
  return gaps;
}

}  // namespace

TEST_CASE("A close packing has twelve contacts inside, and no rattler") {
  const Packing crystal = stacked_layers("ABCABC");
  const Backbone found = backbone(crystal, neighbours_within(crystal, 1.1), 1e-9, 4);
  for (std::size_t i = 0; i < crystal.centres.size(); ++i) {
    const bool top = i >= 5 * 144;  // the floor's layer: 6 + 3 and the floor
    CHECK(found.contacts[i] == (top ? 9u : i < 144 ? 10u : 12u));
    CHECK_FALSE(found.rattler[i]);
  }
}

TEST_CASE("Rattlers are those that all pairs, gone over again and again, leave") {
  Packing packing = reference_deposit();
  packing.centres.resize(1500);
  for (const double tolerance : {1e-6, 0.01, 0.05}) {
    const auto near = neighbours_within(packing, 1.2);
    CHECK(backbone(packing, near, tolerance, 4).rattler ==
          rattlers_of_all_pairs(packing, tolerance, 4));
  }
}

TEST_CASE("The exponent of gaps is found where it is known") {
  double sum = 0, squares = 0;
  constexpr int samples = 100, n = 400;
  for (int s = 0; s < samples; ++s) {
    const double gamma = gap_exponent(drawn_gaps(0.41, 0.001, 0.1, n, 20261124 + s), 0.001, 0.1);
    sum += gamma;
    squares += gamma * gamma;
  }
  const double mean = sum / samples;
  const double error = std::sqrt((squares / samples - mean * mean) / (samples - 1));
  CHECK(std::abs(mean - 0.41) < 3 * error);
  CHECK(error * std::sqrt(samples) < 0.06);  // of one sample

  CHECK(gap_exponent(drawn_gaps(1.5, 0.001, 0.1, 20000, 7), 0.001, 0.1) ==
        Approx(1.5).margin(0.03).epsilon(0));
  CHECK(std::isnan(gap_exponent(drawn_gaps(0.4, 0.001, 0.1, 9, 7), 0.001, 0.1)));
}

TEST_CASE("The part gaps counts contacts against the gap, and the region alone") {
  StructureSettings settings;
  settings.gaps.emplace();
  const Packing packing = reference_deposit();
  const auto parts = measure(packing, settings, StreamKey{});
  REQUIRE(parts.at(0).refused.empty());
  // Every sphere of that deposit rests on three others, so has six contacts on average.
  CHECK(parts[0].find("contacts")->values[0] == Approx(6).margin(0.1).epsilon(0));
  const Region region = bulk_of(packing);
  const auto near = neighbours_within(packing, 1.5);
  double neighbours = 0, spheres = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (!region.contains(packing.container, packing.centres[i])) continue;
    spheres += 1;
    for (const Neighbour& one : near.of(i)) neighbours += one.distance_squared <= 1.21 ? 1 : 0;
  }
  const auto& gaps = std::get<std::vector<double>>(parts[0].places[0].values);
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    if (std::abs(gaps[k] - 0.1) < 1e-9)
      CHECK(parts[0].find("z_of_gap")->values[k] == Approx(neighbours / spheres));
  }
}
