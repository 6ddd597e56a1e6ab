// Measures of structure of spheres of several sizes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "structure/density/profiles.hpp"
#include "structure/measure.hpp"
#include "tests/structure/reference_deposit.hpp"

using namespace jostle;

namespace {

constexpr StreamKey points{7};

const Measurement& part(const std::vector<Measurement>& all, const std::string& name) {
  const auto found = std::ranges::find(all, name, &Measurement::part);
  REQUIRE(found != all.end());
  return *found;
}

const std::vector<double>& values(const Measurement& measurement, const std::string& name) {
  const MeasuredQuantity* quantity = measurement.find(name);
  REQUIRE(quantity != nullptr);
  return quantity->values;
}

/// Spheres of diameters 0.6 and 1.5 on random places without overlaps, a box of 8 x 8 x 10.
Packing two_sizes(std::size_t n = 500) {
  RandomStream random(stream_key(4, 0, 0, Purpose::start));
  Packing packing{PeriodicBox{8, 8}, {}};
  const Boundary boundary(packing.container);
  std::vector<double> diameters;
  std::vector<std::uint32_t> kinds;
  while (packing.centres.size() < n) {
    const std::uint32_t kind = packing.centres.size() < 80 ? 1 : 0;
    const double radius = kind == 1 ? 0.75 : 0.3;
    const Vec3 r{8 * random.uniform(), 8 * random.uniform(),
                 radius + (10 - 2 * radius) * random.uniform()};
    bool free = true;
    for (std::size_t j = 0; j < packing.centres.size() && free; ++j) {
      const double contact = radius + 0.5 * diameters[j];
      free = norm_squared(separation(boundary, r, packing.centres[j])) >= contact * contact;
    }
    if (!free) continue;
    packing.centres.push_back(r);
    diameters.push_back(2 * radius);
    kinds.push_back(kind);
  }
  packing.sizes = std::make_shared<const Sizes>(
      diameters, kinds, std::vector<SphereKind>{{"small", 1}, {"large", 1}});
  return packing;
}

StructureSettings parts_of_mixtures() {
  StructureSettings settings;
  settings.profile.emplace();
  settings.coordination.emplace();
  settings.gaps.emplace();
  return settings;
}

}  // namespace

TEST_CASE("structure: sizes of diameter 1 give the values of equal spheres") {
  const Packing equal = reference_deposit();
  Packing sized = equal;
  sized.sizes = std::make_shared<const Sizes>(std::vector<double>(equal.centres.size(), 1.0));
  const auto expected = measure(equal, parts_of_mixtures(), points);
  const auto found = measure(sized, parts_of_mixtures(), points);
  REQUIRE(found.size() == expected.size());
  std::size_t compared = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    CHECK(found[k].refused.empty());
    for (const MeasuredQuantity& quantity : expected[k].quantities) {
      if (quantity.name == "exponent_from_gap" || quantity.name == "gap_exponent") continue;
      INFO(quantity.name);
      const std::vector<double>& other = values(found[k], std::string(quantity.name));
      REQUIRE(other.size() == quantity.values.size());
      for (std::size_t i = 0; i < other.size(); ++i) {
        if (std::isnan(quantity.values[i])) {
          CHECK(std::isnan(other[i]));
        } else {
          CHECK(other[i] == Approx(quantity.values[i]).epsilon(1e-12).margin(1e-12));
        }
        ++compared;
      }
    }
  }
  CHECK(compared > 300);
}

TEST_CASE("structure: neighbours by kinds are those of all pairs, and N_i n_ij = N_j n_ji") {
  const Packing packing = two_sizes();
  StructureSettings settings = parts_of_mixtures();
  settings.coordination->cut = 1.3;
  settings.gaps->tolerance = 0.1;
  settings.region = Region{0, 10, 0};
  const auto all = measure(packing, settings, points);
  const Boundary boundary(packing.container);
  const Sizes& sizes = *packing.sizes;
  for (const auto& [name, ending, cut] : {std::tuple{"coordination", "n_c_of_pair", 1.3},
                                          std::tuple{"gaps", "contacts_of_pair", 1.1}}) {
    double counts[2][2] = {}, spheres[2] = {};
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      spheres[sizes.kind(i)] += 1;
      for (std::size_t j = 0; j < sizes.size(); ++j) {
        const double reach = cut * (sizes.radius(i) + sizes.radius(j));
        const Vec3 apart = separation(boundary, packing.centres[i], packing.centres[j]);
        if (i != j && norm_squared(apart) <= reach * reach) ++counts[sizes.kind(i)][sizes.kind(j)];
      }
    }
    const Measurement& measured = part(all, name);
    const auto names = std::ranges::find(measured.places, "pair", &Places::name);
    REQUIRE(names != measured.places.end());
    CHECK(std::get<std::vector<std::string>>(names->values) ==
          std::vector<std::string>{"small-small", "small-large", "large-small", "large-large"});
    CHECK(values(measured, "spheres_of_kind") == std::vector<double>{spheres[0], spheres[1]});
    const std::vector<double>& n = values(measured, std::string(ending) + "_all");
    REQUIRE(n.size() == 4);
    for (int i : {0, 1}) {
      for (int j : {0, 1}) CHECK(n[2 * i + j] == Approx(counts[i][j] / spheres[i]).epsilon(1e-12));
    }
    CHECK(counts[0][1] > 50);
    CHECK(spheres[0] * n[1] == Approx(spheres[1] * n[2]).epsilon(1e-14));
    CHECK(values(measured, ending) == n);  // all spheres lie in the region
  }
  const Measurement& coordination = part(all, "coordination");
  const std::vector<double>& n = values(coordination, "n_c_of_pair");
  CHECK((420 * (n[0] + n[1]) + 80 * (n[2] + n[3])) / 500 ==
        Approx(values(coordination, "n_c")[0]).epsilon(1e-12));
  const auto cuts = std::ranges::find(coordination.places, "cut", &Places::name);
  const std::vector<double>& at = std::get<std::vector<double>>(cuts->values);
  const auto k = static_cast<std::size_t>(
      std::ranges::min_element(at, {}, [](double c) { return std::abs(c - 1.3); }) - at.begin());
  CHECK(values(coordination, "n_c_of_cut")[k] == Approx(values(coordination, "n_c")[0]));
}

TEST_CASE("structure: contacts with the floor are relative to a sphere's diameter") {
  Packing packing{PeriodicBox{8, 8}, {{2, 2, 0.75 + 0.13}, {6, 6, 0.3 + 0.07}, {2, 6, 0.3 + 0.05}}};
  packing.sizes = std::make_shared<const Sizes>(
      std::vector<double>{1.5, 0.6, 0.6}, std::vector<std::uint32_t>{0, 1, 1},
      std::vector<SphereKind>{{"large", 1}, {"small", 1}});
  StructureSettings settings;
  settings.region = Region{0, 2, 0};
  settings.gaps.emplace();
  settings.gaps->tolerance = 0.1;  // gaps up to 0.15 below the large sphere, 0.06 below small ones
  settings.gaps->least_contacts = 1;
  const auto all = measure(packing, settings, points);
  const Measurement& gaps = part(all, "gaps");
  CHECK(values(gaps, "contacts")[0] == Approx(2.0 / 3));
  CHECK(values(gaps, "rattlers_of_kind") == std::vector<double>{0, 0.5});
}

TEST_CASE("structure: the profile of a mixture cuts each sphere by its own radius") {
  const Packing packing = two_sizes();
  const auto edges = height_edges(packing, 0.25);
  CHECK(edges.back() >= surface_height(packing));
  const Profile profile = vertical_profile(packing, edges);
  double solid = 0;
  for (std::size_t k = 0; k < profile.size(); ++k) {
    solid += profile.values[k] * profile.volumes[k];
    CHECK(profile.values[k] ==
          Approx(solids_fraction(packing, {edges[k], edges[k + 1]})).epsilon(1e-10).margin(1e-12));
    double quadrature = 0;  // integral over the area of plane cuts
    constexpr int n = 400;
    for (int step = 0; step < n; ++step) {
      const double z = edges[k] + (step + 0.5) / n * (edges[k + 1] - edges[k]);
      for (std::size_t i = 0; i < packing.centres.size(); ++i) {
        const double apart = z - packing.centres[i].z, radius = packing.radius(i);
        quadrature += 3.14159265358979 * std::max(0.0, radius * radius - apart * apart) / n / 64;
      }
    }
    CHECK(profile.values[k] == Approx(quadrature).epsilon(1e-4).margin(1e-6));
  }
  CHECK(solid == Approx(solid_volume(packing)).epsilon(1e-12));
}

TEST_CASE("structure: parts that require equal spheres are refused by name") {
  for (const Measurement& measured : measure(two_sizes(), all_structure(), points)) {
    INFO(measured.part);
    const bool taken =
        measured.part == "profile" || measured.part == "coordination" || measured.part == "gaps";
    const std::string name(measured.part);
    CHECK(measured.refused == (taken ? ""
                                     : "measures of " + name +
                                           " require equal spheres of diameter 1, and this "
                                           "packing is a mixture"));
  }
}
