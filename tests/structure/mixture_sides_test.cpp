// Sides and gaps of spheres of several sizes.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "structure/density/profiles.hpp"
#include "structure/measure.hpp"
#include "structure/order/accessible.hpp"
#include "structure/order/gaps.hpp"
#include "tests/engine/sample_packings.hpp"
#include "tests/structure/reference_deposit.hpp"

using namespace jostle;

namespace {

constexpr StreamKey points{7};

const std::vector<double>& values(const Measurement& measurement, std::string_view name) {
  const MeasuredQuantity* quantity = measurement.find(name);
  REQUIRE(quantity != nullptr);
  return quantity->values;
}

/// 60 spheres of diameters from 0.5 to 2.
Packing graded_packing(const Container& container) {
  return random_mixture(container, graded_diameters(60, 0.5, 4), 6, 31);
}

std::vector<Container> containers_with_sides() {
  return {WalledBox{6, 6}, PeriodicBox{6, 6}, Plates{6, 5}, Cylinder{6}};
}

/// The profiles that sides have in this container, with the place of a point in each.
struct SideProfile {
  Profile profile;
  std::function<double(Vec3)> place;
};

std::vector<SideProfile> side_profiles(const Packing& packing, double bin, HeightWindow window) {
  const Boundary box(packing.container);
  std::vector<SideProfile> all;
  if (box.tube) {
    all.push_back({radial_profile(packing, even_edges(0, box.axis(), bin), window),
                   [box](Vec3 r) { return std::hypot(r.x - box.axis(), r.y - box.axis()); }});
    return all;
  }
  all.push_back({transverse_profile(packing, Axis::x, even_edges(0, box.width_x, bin), window),
                 [](Vec3 r) { return r.x; }});
  all.push_back({transverse_profile(packing, Axis::y, even_edges(0, box.width_y, bin), window),
                 [](Vec3 r) { return r.y; }});
  if (!box.has_walls()) return all;
  const auto from_planes = [box](Vec3 r) {
    double nearest = HUGE_VAL;
    if (box.planes_x()) nearest = std::min({nearest, r.x, box.width_x - r.x});
    if (box.planes_y()) nearest = std::min({nearest, r.y, box.width_y - r.y});
    return nearest;
  };
  const double widest = 0.5 * std::min(box.planes_x() ? box.width_x : HUGE_VAL,
                                       box.planes_y() ? box.width_y : HUGE_VAL);
  all.push_back({wall_profile(packing, even_edges(0, widest, bin), window), from_planes});
  return all;
}

Packing doubled(Packing packing, const Container& container) {
  packing.container = container;
  for (Vec3& r : packing.centres) r = 2 * r;
  packing.sizes = std::make_shared<const Sizes>(std::vector<double>(packing.centres.size(), 2.0));
  return packing;
}

/// n gaps of a g(1 + h) as h^-gamma between low and high, by rejection.
std::vector<double> drawn_gaps(double gamma, double low, double high, int n, RandomStream& random) {
  std::vector<double> gaps;
  const double a = 1 - gamma, start = std::pow(low, a), end = std::pow(high, a);
  while (gaps.size() < static_cast<std::size_t>(n)) {
    const double gap = std::pow(start + random.uniform() * (end - start), 1 / a);
    if (random.uniform() < std::pow((1 + gap) / (1 + high), 2)) gaps.push_back(gap);
  }
  return gaps;
}

struct MeanAndError {
  double mean = 0, error = 0;
};

MeanAndError mean_of(const std::vector<double>& sample) {
  const auto n = static_cast<double>(sample.size());
  MeanAndError found;
  double squares = 0;
  for (const double x : sample) found.mean += x / n;
  for (const double x : sample) squares += (x - found.mean) * (x - found.mean);
  found.error = std::sqrt(squares / (n * (n - 1)));
  return found;
}

/// Points of two sizes that overlap or not, each anywhere between the sides.
Packing gas_of_two_sizes(const Container& container, std::uint64_t seed) {
  constexpr std::size_t n = 700, n_large = 200;
  RandomStream random(stream_key(seed, 0, 0, Purpose::start));
  const Boundary boundary(container);
  Packing packing{container, {}};
  std::vector<double> diameters;
  std::vector<std::uint32_t> kinds;
  while (packing.centres.size() < n) {
    const std::uint32_t kind = packing.centres.size() < n_large ? 1 : 0;
    const double diameter = kind == 1 ? 1.6 : 0.6;
    const Vec3 r{boundary.width_x * random.uniform(), boundary.width_y * random.uniform(),
                 12 * random.uniform()};
    if (!clear_of_boundaries(boundary, r, 0.5 * diameter)) continue;
    packing.centres.push_back(r);
    diameters.push_back(diameter);
    kinds.push_back(kind);
  }
  packing.sizes = std::make_shared<const Sizes>(
      diameters, kinds, std::vector<SphereKind>{{"small", 1}, {"large", 1}});
  return packing;
}

}  // namespace

TEST_CASE("sides of a mixture hold all that is solid, and are what random points find") {
  const HeightWindow window{1, 5};
  for (const Container& container : containers_with_sides()) {
    CAPTURE(container.index());
    const Packing packing = graded_packing(container);
    const Boundary box(container);
    double solid = 0;
    for (std::size_t i = 0; i < packing.centres.size(); ++i)
      solid += sphere_volume_in_slab(packing.centres[i].z, window.low, window.high,
                                     2 * packing.radius(i));
    const auto profiles = side_profiles(packing, 0.5, window);
    std::vector<std::vector<double>> inside, all;
    for (const SideProfile& profile : profiles) {
      double found = 0;
      for (std::size_t k = 0; k < profile.profile.size(); ++k)
        found += profile.profile.values[k] * profile.profile.volumes[k];
      CHECK(found == Approx(solid).epsilon(1e-9));
      inside.emplace_back(profile.profile.size(), 0.0);
      all.emplace_back(profile.profile.size(), 0.0);
    }
    RandomStream random(stream_key(77, 0, 0, Purpose::start));
    for (int k = 0; k < 200'000; ++k) {
      const Vec3 r{box.width_x * random.uniform(), box.width_y * random.uniform(),
                   window.low + (window.high - window.low) * random.uniform()};
      if (!clear_of_boundaries(box, r, 0)) continue;
      bool is_solid = false;
      for (std::size_t i = 0; i < packing.centres.size() && !is_solid; ++i)
        is_solid = norm_squared(separation(box, r, packing.centres[i])) <
                   packing.radius(i) * packing.radius(i);
      for (std::size_t p = 0; p < profiles.size(); ++p) {
        const auto& edges = profiles[p].profile.edges;
        const auto bin = static_cast<std::size_t>(
            std::ranges::upper_bound(edges, profiles[p].place(r)) - edges.begin() - 1);
        if (bin >= all[p].size()) continue;
        all[p][bin] += 1;
        inside[p][bin] += is_solid ? 1 : 0;
      }
    }
    for (std::size_t p = 0; p < profiles.size(); ++p) {
      for (std::size_t k = 0; k < all[p].size(); ++k) {
        const double phi = profiles[p].profile.values[k], n = all[p][k];
        CAPTURE(p, k, n);
        CHECK(inside[p][k] / n ==
              Approx(phi).epsilon(0).margin(4.5 * std::sqrt(phi * (1 - phi) / n) +
                                            1e-3));  // standard errors
      }
    }
  }
}

TEST_CASE("sides of a bed of doubled lengths are those of the bed") {
  Packing packing = reference_deposit();
  packing.centres.resize(800);
  const std::pair<Container, Container> of_both_lengths[] = {
      {WalledBox{16, 16}, WalledBox{32, 32}},
      {PeriodicBox{16, 16}, PeriodicBox{32, 32}},
      {Plates{16, 16}, Plates{32, 32}},
      {Cylinder{16}, Cylinder{32}}};
  for (const auto& [container, twice_as_wide] : of_both_lengths) {
    CAPTURE(container.index());
    packing.container = container;
    const Packing large = doubled(packing, twice_as_wide);
    const auto single = side_profiles(packing, 0.4, {0.5, 3});
    const auto two = side_profiles(large, 0.8, {1, 6});
    REQUIRE(single.size() == two.size());
    for (std::size_t p = 0; p < single.size(); ++p) {
      for (std::size_t k = 0; k < single[p].profile.size(); ++k)
        CHECK(two[p].profile.values[k] == Approx(single[p].profile.values[k]).epsilon(1e-12));
    }
    if (Boundary(container).tube) continue;
    const std::vector<double> places{0.1, 3, 8.03}, doubles{0.2, 6, 16.06};
    const auto cuts = transverse_cuts(packing, Axis::x, places, {0.5, 3});
    const auto far = transverse_cuts(large, Axis::x, doubles, {1, 6});
    for (std::size_t k = 0; k < cuts.size(); ++k) CHECK(far[k] == Approx(cuts[k]).epsilon(1e-12));
  }
}

TEST_CASE("structure measures the sides of mixtures") {
  StructureSettings settings;
  settings.sides.emplace();
  settings.sides->bin_width = 0.5;
  settings.sides->heights = HeightWindow{1, 5};
  settings.sides->reach = 2;
  const Packing packing = graded_packing(WalledBox{6, 6});
  const auto all = measure(packing, settings, points);
  REQUIRE(all.size() == 1);
  CHECK(all[0].refused.empty());
  CHECK(values(all[0], "phi_x") ==
        transverse_profile(packing, Axis::x, even_edges(0, 6, 0.5), {1, 5}).values);
  CHECK(values(all[0], "lateral")[0] == lateral_and_central(packing, {1, 5}, 2).lateral);
}

TEST_CASE("exponents of gaps are found for each two kinds") {
  // Pairs far from each other on a lattice, whose gaps follow a law of their kinds.
  constexpr int n_pairs = 1000, n_side = 15;
  constexpr double spacing = 6;
  constexpr std::array<double, 3> gammas{0.1, 0.4, 0.7};
  RandomStream random(stream_key(51, 0, 0, Purpose::start));
  Packing packing{FullyPeriodicBox{n_side * spacing, n_side * spacing, n_side * spacing}, {}};
  std::vector<double> diameters;
  std::vector<std::uint32_t> kinds;
  for (int combined = 0, site = 0; combined < 3; ++combined) {
    for (const double gap : drawn_gaps(gammas[combined], 0.01, 0.2, n_pairs, random)) {
      const double first = combined == 2 ? 2 : 1, second = combined == 0 ? 1 : 2;
      const Vec3 position{spacing * (site % n_side) + 1.5, spacing * (site / n_side % n_side) + 1.5,
                          spacing * (site / (n_side * n_side)) + 1.5};
      packing.centres.push_back(position);
      packing.centres.push_back(position + Vec3{0.5 * (first + second) * (1 + gap), 0, 0});
      diameters.insert(diameters.end(), {first, second});
      kinds.insert(kinds.end(), {first > 1 ? 1u : 0u, second > 1 ? 1u : 0u});
      ++site;
    }
  }
  packing.sizes = std::make_shared<const Sizes>(
      diameters, kinds, std::vector<SphereKind>{{"small", 1}, {"large", 1}});
  StructureSettings settings;
  settings.gaps.emplace();
  const auto all = measure(packing, settings, points);
  const std::vector<double>& found = values(all[0], "gap_exponent_of_pair");
  CHECK(values(all[0], "gaps_of_pair") ==
        std::vector<double>{2 * n_pairs, n_pairs, n_pairs, 2 * n_pairs});
  // The error of the estimate of n gaps, 1 / (n var(ln h))^1/2, is 0.035 to 0.04.
  CHECK(found[0] == Approx(gammas[0]).margin(0.12));
  CHECK(found[1] == Approx(gammas[1]).margin(0.12));
  CHECK(found[2] == Approx(found[1]).epsilon(1e-12));
  CHECK(found[3] == Approx(gammas[2]).margin(0.12));
  CHECK(values(all[0], "gap_exponent")[0] > found[0]);
  CHECK(values(all[0], "gap_exponent")[0] < found[3]);
}

TEST_CASE("gaps of an ideal gas of two sizes have no exponents between sides", "[statistics]") {
  const auto container = GENERATE(values<Container>({WalledBox{5, 5}, Cylinder{5}}));
  const ShellPart part(container);
  std::array<std::vector<double>, 4> exponents, of_equal_partners;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Packing gas = gas_of_two_sizes(container, 500 + seed);
    const NeighbourTable near = neighbours_within_contacts(gas, 1.5);
    std::array<std::vector<double>, 4> gaps, weights, wrong;
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (gas.centres[i].z > 8) continue;
      for (const Neighbour& neighbour : near.neighbours_of(i)) {
        const double scaled = std::sqrt(neighbour.distance_squared);
        const double partner = gas.radius(neighbour.sphere),
                     distance = scaled * (gas.radius(i) + partner);
        const std::size_t pair = 2 * gas.sizes->kind(i) + gas.sizes->kind(neighbour.sphere);
        gaps[pair].push_back(scaled - 1);
        weights[pair].push_back(1 / part(gas.centres[i], distance, partner));
        wrong[pair].push_back(1 / part(gas.centres[i], distance));
      }
    }
    for (std::size_t pair = 0; pair < 4; ++pair) {
      exponents[pair].push_back(gap_exponent(gaps[pair], 0.01, 0.5, weights[pair]));
      of_equal_partners[pair].push_back(gap_exponent(gaps[pair], 0.01, 0.5, wrong[pair]));
    }
  }
  CAPTURE(container.index());
  for (std::size_t pair = 0; pair < 4; ++pair) {
    const MeanAndError found = mean_of(exponents[pair]);
    CAPTURE(pair, found.mean, found.error, mean_of(of_equal_partners[pair]).mean);
    CHECK(std::abs(found.mean) < 3 * found.error);
    CHECK(found.error < 0.04);
  }
}

TEST_CASE("gaps count the more, the less of the shell of a partner's centres sides leave") {
  const Packing packing = graded_packing(Cylinder{6});
  StructureSettings settings;
  settings.region = Region{0, 9, 0};
  settings.gaps.emplace();
  settings.gaps->window = {0.01, 0.5};
  const ShellPart part(packing.container);
  std::vector<double> gaps, weights;
  const NeighbourTable near = neighbours_within_contacts(packing, 1.5);
  double least = 1;
  for (std::size_t i = 0; i < near.size(); ++i) {
    for (const Neighbour& neighbour : near.neighbours_of(i)) {
      const double scaled = std::sqrt(neighbour.distance_squared),
                   partner = packing.radius(neighbour.sphere);
      const double share =
          part(packing.centres[i], scaled * (packing.radius(i) + partner), partner);
      gaps.push_back(scaled - 1);
      weights.push_back(1 / share);
      least = std::min(least, share);
    }
  }
  CHECK(least < 0.5);
  const auto all = measure(packing, settings, points);
  CHECK(values(all[0], "gap_exponent")[0] ==
        Approx(gap_exponent(gaps, 0.01, 0.5, weights)).epsilon(1e-9));
  CHECK(std::abs(values(all[0], "gap_exponent")[0] - gap_exponent(gaps, 0.01, 0.5)) > 0.01);
}

TEST_CASE("partial pairs of kinds whose names join to one are all there") {
  Packing packing = random_mixture(PeriodicBox{8, 8}, graded_diameters(80, 0.8, 1.2), 6, 31);
  std::vector<std::uint32_t> kinds(80);
  for (std::uint32_t i = 0; i < 80; ++i) kinds[i] = i % 4;
  packing.sizes = std::make_shared<const Sizes>(
      diameters_of(*packing.sizes), kinds,
      std::vector<SphereKind>{{"a", 1}, {"b_c", 1}, {"a_b", 1}, {"c", 1}});
  StructureSettings settings;
  settings.pair_correlation.emplace();
  const auto all = measure(packing, settings, points);
  std::set<std::string> names;
  for (const auto& quantity : all.at(0).quantities)
    if (quantity.name.starts_with("g_")) names.insert(quantity.name);
  CHECK(names.size() == 10);
  CHECK(names.contains("g_a_b_c"));
  CHECK(names.contains("g_a_b_c_2"));
}
