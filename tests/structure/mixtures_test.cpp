// Measures of structure of spheres of several sizes.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string_view>
#include <voro++/voro++.hh>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "structure/density/profiles.hpp"
#include "structure/measure.hpp"
#include "structure/order/mixtures/partial_correlation.hpp"
#include "structure/voids/voronoi.hpp"
#include "tests/engine/sample_packings.hpp"
#include "tests/structure/reference_deposit.hpp"

using namespace jostle;

namespace {

constexpr StreamKey points{7};

const Measurement& part(const std::vector<Measurement>& all, std::string_view name) {
  const auto found = std::ranges::find(all, name, &Measurement::part);
  REQUIRE(found != all.end());
  return *found;
}

const std::vector<double>& values(const Measurement& measurement, std::string_view name) {
  const MeasuredQuantity* quantity = measurement.find(name);
  REQUIRE(quantity != nullptr);
  return quantity->values;
}

/// Spheres of diameters 0.6 and 1.5 on random places without overlaps, a box of 8 x 8 x 10.
Packing two_sizes(std::size_t n = 500, const Container& container = PeriodicBox{8, 8}) {
  RandomStream random(stream_key(4, 0, 0, Purpose::start));
  Packing packing{container, {}};
  const Boundary boundary(packing.container);
  std::vector<double> diameters;
  std::vector<std::uint32_t> kinds;
  while (packing.centres.size() < n) {
    const std::uint32_t kind = packing.centres.size() < 80 ? 1 : 0;
    const double radius = kind == 1 ? 0.75 : 0.3;
    const Vec3 r{8 * random.uniform(), 8 * random.uniform(),
                 radius + (10 - 2 * radius) * random.uniform()};
    bool free =
        std::visit([&](const auto& box) { return clear_of_boundaries(box, r, radius); }, container);
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
  settings.sides.emplace();
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
      INFO(quantity.name);
      const std::vector<double>& reference = values(found[k], quantity.name);
      REQUIRE(reference.size() == quantity.values.size());
      for (std::size_t i = 0; i < reference.size(); ++i) {
        if (std::isnan(quantity.values[i])) {
          CHECK(std::isnan(reference[i]));
        } else {
          CHECK(reference[i] == Approx(quantity.values[i]).epsilon(1e-12).margin(1e-12));
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
        const Vec3 offset = separation(boundary, packing.centres[i], packing.centres[j]);
        if (i != j && norm_squared(offset) <= reach * reach) ++counts[sizes.kind(i)][sizes.kind(j)];
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
  const std::vector<double>& cut_values = std::get<std::vector<double>>(cuts->values);
  const auto k = static_cast<std::size_t>(
      std::ranges::min_element(cut_values, {}, [](double c) { return std::abs(c - 1.3); }) -
      cut_values.begin());
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
        const double distance = z - packing.centres[i].z, radius = packing.radius(i);
        quadrature +=
            3.14159265358979 * std::max(0.0, radius * radius - distance * distance) / n / 64;
      }
    }
    CHECK(profile.values[k] == Approx(quadrature).epsilon(1e-4).margin(1e-6));
  }
  CHECK(solid == Approx(solid_volume(packing)).epsilon(1e-12));
}

TEST_CASE("structure: parts that require equal spheres are refused by name") {
  for (const Measurement& measured : measure(two_sizes(), all_structure(), points)) {
    INFO(measured.part);
    const bool taken = measured.part == "profile" || measured.part == "sides" ||
                       measured.part == "coordination" || measured.part == "pair_correlation" ||
                       measured.part == "gaps" || measured.part == "voronoi";
    const std::string name(measured.part);
    CHECK(measured.refused == (taken ? ""
                                     : "measures of " + name +
                                           " require equal spheres of diameter 1, and this "
                                           "packing is a mixture"));
  }
}

TEST_CASE("structure: radical cells fill the box and are those of voro++ called apart") {
  const Container container =
      GENERATE(Container{PeriodicBox{8, 8}}, Container{WalledBox{8, 8}}, Container{Plates{8, 8}});
  const Boundary boundary(container);
  const Packing packing = two_sizes(500, container);
  const double lid = surface_height(packing);
  const VoronoiCells cells = voronoi_cells(packing);
  CHECK(cells.inconsistent == 0);
  voro::container_poly twin(0, 8, 0, 8, 0, lid, 6, 6, 6, boundary.periodic_x, boundary.periodic_y,
                            false, 8);
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3 r = packing.centres[i];
    twin.put(static_cast<int>(i), r.x, r.y, r.z, packing.radius(i));
  }
  std::vector<double> volumes(packing.centres.size(), 0);
  voro::voronoicell cell;
  voro::c_loop_all loop(twin);
  if (loop.start()) {
    do {
      if (twin.compute_cell(cell, loop))
        volumes[static_cast<std::size_t>(loop.pid())] = cell.volume();
    } while (loop.inc());
  }
  double sum = 0, solid = 0;
  const std::vector<double> fractions = local_fractions(cells);
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    CHECK(cells.volumes[i] == Approx(volumes[i]).epsilon(1e-9));
    CHECK(fractions[i] < 1);  // a sphere that overlaps none is within its cell
    sum += cells.volumes[i];
    solid += fractions[i] * cells.volumes[i];
  }
  CHECK(sum == Approx(64 * lid).epsilon(1e-10));
  CHECK(solid == Approx(solid_volume(packing)).epsilon(1e-12));
}

TEST_CASE("structure: the face of two spheres of other sizes is where their tangents are equal") {
  // Radii of 1 and 0.4 in a periodic box of 10; centres 3 apart on x.
  Packing packing{FullyPeriodicBox{10, 10, 10}, {{2, 5, 5}, {5, 5, 5}}};
  packing.sizes = std::make_shared<const Sizes>(std::vector<double>{2, 0.8});
  const VoronoiCells cells = voronoi_cells(packing);
  const auto plane = [](double distance) {
    return (distance * distance + 1 - 0.16) / (2 * distance);
  };
  CHECK(cells.volumes[0] == Approx(100 * (plane(3) + plane(7))).epsilon(1e-12));
  CHECK(cells.volumes[0] + cells.volumes[1] == Approx(1000).epsilon(1e-12));
  CHECK(free_volumes(cells)[1] ==
        Approx(cells.volumes[1] / (std::numbers::pi / 6 * 0.512) - 1).epsilon(1e-12));
}

TEST_CASE("structure: cells by kind are those of the single cells") {
  const Packing packing = two_sizes();
  StructureSettings settings;
  settings.region = Region{2, 8, 0};
  settings.voronoi.emplace();
  const auto all = measure(packing, settings, points);
  const Measurement& voronoi = part(all, "voronoi");
  CHECK(voronoi.find("k") == nullptr);  // defined for equal spheres
  double density = 0;
  for (const double value : values(voronoi, "free_volume_density")) density += value;
  CHECK(values(voronoi, "free_volume_beyond")[0] == 0);
  CHECK(density * settings.voronoi->bin_width == Approx(1).epsilon(1e-12));
  const VoronoiCells cells = voronoi_cells(packing);
  double volumes[2] = {}, counts[2] = {};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double z = packing.centres[i].z;
    if (cells.cut[i] || z < 2 || z > 8) continue;
    volumes[packing.sizes->kind(i)] += cells.volumes[i];
    counts[packing.sizes->kind(i)] += 1;
  }
  CHECK(values(voronoi, "cells_of_kind") == std::vector<double>{counts[0], counts[1]});
  CHECK(counts[1] > 10);
  for (int kind : {0, 1})
    CHECK(values(voronoi, "mean_volume_of_kind")[kind] ==
          Approx(volumes[kind] / counts[kind]).epsilon(1e-12));
}

TEST_CASE("structure: partial pairs are those of all pairs, and what is expected is an integral") {
  const Packing packing = two_sizes();
  const Boundary boundary(packing.container);
  const PairCorrelationSettings settings{.r_max = 2, .bin_width = 0.25, .heights = {{3, 7}}};
  const auto all = partial_correlations(packing, settings);
  REQUIRE(all.size() == 3);
  std::array<std::array<double, 8>, 3> counts{}, expected{};
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3 start = packing.centres[i];
    if (start.z < 3 || start.z > 7) continue;
    for (std::size_t j = 0; j < packing.centres.size(); ++j) {
      if (j == i) continue;
      const std::size_t kinds = packing.sizes->kind(i) + packing.sizes->kind(j);
      const double contact = packing.radius(i) + packing.radius(j);
      const double distance =
          std::sqrt(norm_squared(separation(boundary, start, packing.centres[j])));
      const auto bin = static_cast<std::size_t>(distance / contact / 0.25);
      if (bin < 8) counts[kinds][bin] += 1;
      const double h = packing.centres[j].z - start.z;
      for (std::size_t k = 0; k < 8; ++k) {
        const auto disc = [&](double x) {
          return std::max(0.0, x * x * contact * contact - h * h) * std::numbers::pi / 64;
        };
        expected[kinds][k] += disc(0.25 * (k + 1)) - disc(0.25 * k);
      }
    }
  }
  for (std::size_t kinds = 0; kinds < 3; ++kinds) {
    CHECK(all[kinds].first + all[kinds].second == kinds);
    for (std::size_t k = 0; k < 8; ++k) {
      CHECK(static_cast<double>(all[kinds].counts[k]) == counts[kinds][k]);
      CHECK(all[kinds].expected[k] == Approx(expected[kinds][k]).epsilon(1e-10));
    }
    CHECK(all[kinds].g()[2] == 0);   // below contact
    CHECK(all[kinds].g()[7] > 0.7);  // about 1 beyond
    CHECK(all[kinds].g()[7] < 1.3);
  }
  CHECK(counts[2][4] > 20);
}

TEST_CASE("structure: partial pairs of equal spheres in a periodic box are g(r)") {
  RandomStream random(stream_key(9, 0, 0, Purpose::start));
  Packing packing{FullyPeriodicBox{9, 9, 9}, {}};
  for (int i = 0; i < 600; ++i)
    packing.centres.push_back({9 * random.uniform(), 9 * random.uniform(), 9 * random.uniform()});
  const PairCorrelationSettings settings{.r_max = 4, .bin_width = 0.1};
  const PairCorrelation equal = pair_correlation(packing, settings);
  std::vector<std::uint32_t> kinds(600, 0);
  std::fill(kinds.begin() + 200, kinds.end(), 1);
  packing.sizes = std::make_shared<const Sizes>(std::vector<double>(600, 1.0), kinds,
                                                std::vector<SphereKind>{{"a", 1}, {"b", 1}});
  const auto all = partial_correlations(packing, settings);
  REQUIRE(all.size() == 3);
  for (std::size_t k = 0; k < equal.r.size(); ++k) {
    std::uint64_t counts = 0;
    double expected = 0;
    for (const PartialCorrelation& pairs : all) {
      counts += pairs.counts[k];
      expected += pairs.expected[k];
    }
    CHECK(counts == equal.counts[k]);
    CHECK(expected == Approx(equal.expected[k]).epsilon(1e-3));
  }
}

TEST_CASE("structure: partial pairs refuse half periods and many kinds by name") {
  Packing packing = two_sizes();
  using Catch::Contains;
  CHECK_THROWS_WITH(partial_correlations(packing, {.r_max = 2.7}),
                    Contains("r_max must not exceed half a period, 4.0"));
  CHECK(widest_partial_pairs(packing) == Approx(2.6));
  packing = two_sizes(500);
  std::vector<std::uint32_t> kinds(500);
  std::vector<SphereKind> names;
  for (std::uint32_t i = 0; i < 500; ++i) kinds[i] = i % 9;
  for (int k = 0; k < 9; ++k) names.push_back({"kind_" + std::to_string(k), 1});
  packing.sizes = std::make_shared<const Sizes>(diameters_of(*packing.sizes), kinds, names);
  CHECK_THROWS_WITH(partial_correlations(packing, {.r_max = 2}), Contains("9 kinds"));
}

TEST_CASE("structure measures partial pairs between walls") {
  const Packing packing = random_mixture(WalledBox{6, 6}, graded_diameters(60, 0.5, 4), 6, 31);
  StructureSettings settings;
  settings.pair_correlation.emplace();
  settings.pair_correlation->bin_width = 0.25;
  const auto all = measure(packing, settings, points);
  REQUIRE(all.size() == 1);
  CHECK(all[0].refused.empty());
  const PairCorrelationSettings reach{.r_max = 4, .bin_width = 0.25};
  const auto pairs = partial_correlations(packing, reach);
  const std::vector<double>& g = values(all[0], "g_spheres_spheres");
  CHECK(g.size() == 16);
  CHECK(g[5] == pairs[0].g()[5]);
  CHECK(g[5] > 0.5);
  const HeightWindow heights = central_heights(packing, reach);
  double centres = 0;
  for (const Vec3& r : packing.centres) centres += r.z >= heights.low && r.z <= heights.high;
  CHECK(values(all[0], "centres_of_kind") == std::vector<double>{centres});
  CHECK(centres > 5);
  CHECK(values(all[0], "packings") == std::vector<double>{1});
}
