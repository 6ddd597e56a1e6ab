#include "structure/order/gaps.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "close_packings.hpp"
#include "structure/measure.hpp"
#include "structure/order/accessible.hpp"
#include "tests/structure/random_points.hpp"
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
        const Vec3 offset = separation(boundary, packing.centres[i], packing.centres[j]);
        contacts += std::sqrt(norm_squared(offset)) <= 1 + tolerance ? 1 : 0;
      }
      if (contacts < least) rattler[i] = changed = true;
    }
  }
  return rattler;
}

/// n gaps of a g(1 + h) that falls as h^-gamma between low and high: drawn from that law, and kept
/// in proportion to the area (1 + h)^2 of their shell.
std::vector<double> drawn_gaps(double gamma, double low, double high, int n, RandomStream& random) {
  std::vector<double> gaps;
  const double a = 1 - gamma, lower = std::pow(low, a), upper = std::pow(high, a);
  while (gaps.size() < static_cast<std::size_t>(n)) {
    const double gap = std::pow(lower + random.uniform() * (upper - lower), 1 / a);
    if (random.uniform() < std::pow((1 + gap) / (1 + high), 2)) gaps.push_back(gap);
  }
  return gaps;
}

/// For jammed spheres in mean field, Charbonneau et al. 2014, doi:10.1038/ncomms4725.
constexpr double jammed = 0.41269;

/// A box of `n` touching spheres in a chain that rests on the floor, each on the one before: one
/// contact at the end, two within.
Packing chain(int n) {
  Packing packing{PeriodicBox{20, 20}, {}};
  for (int i = 0; i < n; ++i) packing.centres.push_back({10, 10, 0.5 + i});
  return packing;
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

TEST_CASE("The exponent of g is found from gaps that its shells hold") {
  RandomStream random(stream_key(20261124, 5, 0, Purpose::resampling));
  constexpr std::pair<double, double> windows[] = {{0.01, 0.2}, {0.001, 0.2}, {1e-5, 0.01}};
  for (const auto& [low, high] : windows) {
    double sum = 0, squares = 0;
    constexpr int samples = 200, n = 1000;
    for (int s = 0; s < samples; ++s) {
      const double gamma = gap_exponent(drawn_gaps(jammed, low, high, n, random), low, high);
      sum += gamma;
      squares += gamma * gamma;
    }
    const double mean = sum / samples;
    const double error = std::sqrt((squares / samples - mean * mean) / (samples - 1));
    CAPTURE(low, high, mean, error);
    CHECK(std::abs(mean - jammed) < 3 * error);
    CHECK(error < 0.005);  // a density of gaps as h^-gamma reads 0.12 less from 0.01 to 0.2
  }
  CHECK(gap_exponent(drawn_gaps(1.5, 0.001, 0.1, 20000, random), 0.001, 0.1) ==
        Approx(1.5).margin(0.03).epsilon(0));
  CHECK(gap_exponent(drawn_gaps(-3, 0.01, 1, 20000, random), 0.01, 1) ==
        Approx(-3).margin(0.15).epsilon(0));
  CHECK(std::isnan(gap_exponent(drawn_gaps(0.4, 0.001, 0.1, 9, random), 0.001, 0.1)));
  // All of one size, as in a crystal, have no law.
  for (const double size : {0.01, 0.1, 0.2 - 1e-15, 0.2}) {
    CHECK(std::isnan(gap_exponent(std::vector<double>(20, size), 0.01, 0.2)));
  }
}

TEST_CASE("Intervals of the mean exponent hold the truth", "[statistics]") {
  RandomStream random(stream_key(20261124, 6, 0, Purpose::resampling));
  struct Level {
    int packings;
    double t_68, t_95;  // Student's, of packings - 1 degrees of freedom
  };
  constexpr Level levels[] = {{3, 1.3210, 4.3027}, {4, 1.1969, 3.1824}, {10, 1.0585, 2.2622}};
  constexpr int ensembles = 1500, n = 300;
  for (const auto& [packings, t_68, t_95] : levels) {
    int in_68 = 0, in_95 = 0;
    for (int e = 0; e < ensembles; ++e) {
      double sum = 0, squares = 0;
      for (int r = 0; r < packings; ++r) {
        const double gamma = gap_exponent(drawn_gaps(jammed, 0.01, 0.2, n, random), 0.01, 0.2);
        sum += gamma - jammed;
        squares += (gamma - jammed) * (gamma - jammed);
      }
      const double deviation = std::abs(sum / packings);
      const double error = std::sqrt((squares / packings - deviation * deviation) / (packings - 1));
      in_68 += deviation <= t_68 * error ? 1 : 0;
      in_95 += deviation <= t_95 * error ? 1 : 0;
    }
    std::printf("exponent of gaps, %2d packings: %.1f %% in 68.3 %%, %.1f %% in 95 %%\n", packings,
                100.0 * in_68 / ensembles, 100.0 * in_95 / ensembles);
    CHECK(in_68 >= 0.64 * ensembles);
    CHECK(in_68 <= 0.72 * ensembles);
    CHECK(in_95 >= 0.93 * ensembles);
    CHECK(in_95 <= 0.97 * ensembles);
  }
  std::fflush(stdout);
}

TEST_CASE("Spheres that rest on three are no rattlers under gravity") {
  CHECK(least_contacts_of(PeriodicBox{8, 8}) == 3);
  CHECK(least_contacts_of(WalledBox{8, 8}) == 3);
  CHECK(least_contacts_of(FullyPeriodicBox{8, 8, 8}) == 4);
  StructureSettings settings;
  settings.gaps.emplace();
  const Packing deposit = reference_deposit();
  const auto found = measure(deposit, settings, StreamKey{}).at(0);
  CHECK(found.find("rattlers")->values[0] == 0);
  CHECK(found.find("backbone_contacts")->values[0] == found.find("contacts")->values[0]);
  CHECK(found.notes.at(0).second.starts_with("3 "));
  settings.gaps->least_contacts = 4;
  const auto peeled = measure(deposit, settings, StreamKey{}).at(0);
  CHECK(peeled.find("rattlers")->values[0] > 0.05);
  // A chain has no backbone at all.
  settings.gaps->least_contacts.reset();
  settings.region = Region{0.5, 10, 0};
  const auto none = measure(chain(10), settings, StreamKey{}).at(0);
  CHECK(std::isnan(none.find("rattlers")->values[0]));
  CHECK(std::isnan(none.find("backbone_contacts")->values[0]));
}

TEST_CASE("The fraction of rattlers at a tolerance is that of its curve at the same gap") {
  StructureSettings settings;
  settings.gaps.emplace();
  settings.gaps->least_contacts = 4;
  settings.gaps->tolerance = std::pow(10, -2.4);
  const auto found = measure(reference_deposit(), settings, StreamKey{}).at(0);
  const auto& gaps = std::get<std::vector<double>>(found.places[0].values);
  const MeasuredQuantity& curve = *found.find("rattlers_of_gap");
  const auto place = std::ranges::min_element(
      gaps, {}, [&](double gap) { return std::abs(gap - settings.gaps->tolerance); });
  REQUIRE(*place == Approx(settings.gaps->tolerance).epsilon(1e-9));
  CHECK(curve.values[static_cast<std::size_t>(place - gaps.begin())] ==
        found.find("rattlers")->values[0]);
  CHECK(curve.with_packings);
  // No gap gives a chain a backbone: it has no fraction of rattlers at any.
  settings.gaps->least_contacts.reset();
  settings.region = Region{0.5, 10, 0};
  const auto none = measure(chain(10), settings, StreamKey{}).at(0);
  for (const double value : none.find("rattlers_of_gap")->values) CHECK(std::isnan(value));
  for (const double value : none.find("backbone_z_of_gap")->values) CHECK(std::isnan(value));
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
    for (const Neighbour& neighbour : near.neighbours_of(i))
      neighbours += neighbour.distance_squared <= 1.21 ? 1 : 0;
  }
  const auto& gaps = std::get<std::vector<double>>(parts[0].places[0].values);
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    if (std::abs(gaps[k] - 0.1) < 1e-9)
      CHECK(parts[0].find("z_of_gap")->values[k] == Approx(neighbours / spheres));
  }
}

TEST_CASE("Shells in a fully periodic box are whole, for partners of every size") {
  const ShellPart part(FullyPeriodicBox{5, 5, 5});
  for (const double partner : {0.3, 0.5, 0.65, 2.0}) CHECK(part({1, 2, 3}, 1.2, partner) == 1);
}

TEST_CASE("Gaps of an ideal gas have no exponent, also where sides cut the shells",
          "[statistics]") {
  // Shells between gaps of 0.01 and 0.5 around the centres nearest to floor and sides.
  const auto container =
      GENERATE(values<Container>({WalledBox{5, 5}, Cylinder{5}, WalledBox{9, 4}, Plates{6, 4}}));
  constexpr int n_gases = 30;
  const ShellPart part(container);
  std::vector<double> exponents, unweighted;
  for (std::uint64_t seed = 0; seed < n_gases; ++seed) {
    const Packing gas = random_points(container, 12, 500, 900 + seed);
    const NeighbourTable near = neighbours_within(gas, 1.5);
    std::vector<double> gaps, weights;
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (gas.centres[i].z > 9) continue;
      for (const Neighbour& neighbour : near.neighbours_of(i)) {
        const double distance = std::sqrt(neighbour.distance_squared);
        gaps.push_back(distance - 1);
        weights.push_back(1 / part(gas.centres[i], distance));
      }
    }
    exponents.push_back(gap_exponent(gaps, 0.01, 0.5, weights));
    unweighted.push_back(gap_exponent(gaps, 0.01, 0.5));
  }
  double mean = 0, squares = 0, n_without = 0;
  for (const double x : exponents) mean += x / n_gases;
  for (const double x : exponents) squares += (x - mean) * (x - mean);
  for (const double x : unweighted) n_without += x / n_gases;
  const double error = std::sqrt(squares / (n_gases * (n_gases - 1.0)));
  CAPTURE(mean, error, n_without);
  CHECK(n_without > 5 * error);  // shells that grow out of the container
  CHECK(std::abs(mean) < 3 * error);
}
