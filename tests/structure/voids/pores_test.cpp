#include "structure/voids/pores.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>

#include "engine/bed/geometry.hpp"
#include "structure/measure.hpp"
#include "tests/structure/random_points.hpp"
#include "tests/structure/reference_deposit.hpp"
#include "tests/structure/voids/voronoi_points.hpp"
#include "tests/test_files.hpp"

using namespace jostle;

namespace {

double distance_to(const Packing& packing, Vec3 point, std::uint32_t i) {
  return std::visit(
      [&](const auto& box) {
        return std::sqrt(norm_squared(separation(box, point, packing.centres[i])));
      },
      packing.container);
}

// Equidistant from its owners, and no centre nearer, by brute force.
void check_pores(const Packing& packing, const std::vector<Pore>& all) {
  for (const Pore& pore : all) {
    REQUIRE(pore.owners.size() >= 4);
    const double reach = pore.radius + sphere_radius;
    for (const std::uint32_t i : pore.owners) {
      REQUIRE(distance_to(packing, pore.centre, i) == Approx(reach).epsilon(1e-8));
    }
    for (std::uint32_t i = 0; i < packing.centres.size(); ++i) {
      REQUIRE(distance_to(packing, pore.centre, i) > reach * (1 - 1e-8));
    }
  }
}

std::map<Site, int> count_sites(const std::vector<Pore>& all, double tolerance) {
  std::map<Site, int> counts;
  for (const Pore& pore : all) ++counts[site_of(pore, tolerance)];
  return counts;
}

}  // namespace

TEST_CASE("Pores touch four spheres and hold no centre") {
  const Packing deposit = reference_deposit();
  auto all = pores(deposit, voronoi_cells(deposit));
  check_pores(deposit, {all.begin(), all.begin() + 2000});
  // Cells see one vertex with rounding: it is one pore also where nothing is to be merged.
  CHECK(pores(deposit, voronoi_cells(deposit), 0).size() == all.size());
  const Packing points = poisson_points();
  all = pores(points, voronoi_cells(points));
  check_pores(points, {all.begin(), all.begin() + 2000});
}

TEST_CASE("Pores of a deposit are those of voro++'s own output") {
  // Every vertex of the bulk cells, once per cell: heights and radii, six digits.
  const Packing deposit = reference_deposit();
  const VoronoiCells cells = voronoi_cells(deposit);
  const auto table = rows_of("dep_L32_N4096_s1_voro.csv");
  std::vector<std::pair<double, double>> found, expected;
  for (const auto& row : table) {
    const auto i = static_cast<std::uint32_t>(row[0]);
    if (row[5] == 0) continue;
    for (const VoronoiVertex& vertex : cells.vertices_of(i)) {
      const double reach = std::sqrt(norm_squared(vertex.position - deposit.centres[i]));
      found.emplace_back(2 * vertex.position.z, 2 * reach - 1);
    }
  }
  for (const auto& row : rows_of("dep_L32_N4096_s1_pores.csv")) {
    expected.emplace_back(row[0], row[1]);
  }
  REQUIRE(found.size() == expected.size());
  const auto by_radius = [](const auto& a, const auto& b) { return a.second < b.second; };
  std::ranges::sort(found, by_radius);
  std::ranges::sort(expected, by_radius);
  for (std::size_t k = 0; k < found.size(); ++k) {
    REQUIRE(found[k].second == Approx(expected[k].second).margin(2e-5));
  }
  double found_heights = 0, expected_heights = 0;
  for (const auto& [z, xi] : found) found_heights += z;
  for (const auto& [z, xi] : expected) expected_heights += z;
  CHECK(found_heights == Approx(expected_heights).epsilon(1e-6));
}

TEST_CASE("A deposit has 6.39 pores per sphere, as its vertices require") {
  const Packing deposit = reference_deposit();
  const VoronoiCells cells = voronoi_cells(deposit);
  const auto all = pores(deposit, cells);
  std::size_t corners = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    for (const VoronoiVertex& vertex : cells.vertices_of(i)) corners += !vertex.on_boundary;
  }
  CHECK(static_cast<double>(all.size()) == Approx(static_cast<double>(corners) / 4).epsilon(1e-3));
  const auto inside = pores_in(all, deposit.container, pore_region);
  double spheres = 0;
  for (const Vec3& r : deposit.centres) spheres += r.z >= 1 && r.z <= 10;
  CHECK(static_cast<double>(inside.size()) / spheres == Approx(6.39).epsilon(0.02));
  for (const Pore& pore : inside) CHECK((pore.centre.z >= 1 && pore.centre.z <= 10));
}

TEST_CASE("Spheres around four random points follow the Gamma law") {
  // Circumspheres of Poisson Delaunay tetrahedra: volume times intensity is Gamma(3), mean and
  // variance 3 (Miles); within 3 standard errors, 27 000 pores counted as 4000 independent ones.
  const Packing points = poisson_points();
  const auto all = pores(points, voronoi_cells(points));
  const auto n = static_cast<double>(all.size());
  CHECK(n / 4000 == Approx(27.07091492870224 / 4).epsilon(0.01));
  double mean = 0, square = 0, fourth = 0;
  std::vector<double> volumes;
  for (const Pore& pore : all) {
    volumes.push_back(8 * sphere_volume * std::pow(pore.radius + sphere_radius, 3));
    mean += volumes.back() / n;
  }
  for (const double v : volumes) {
    square += (v - mean) * (v - mean) / n;
    fourth += std::pow(v - mean, 4) / n;
  }
  CHECK(std::abs(mean - 3) <= 3 * std::sqrt(square / 4000));
  CHECK(std::abs(square - 3) <= 3 * std::sqrt((fourth - square * square) / 4000));
}

TEST_CASE("Pores of close-packed crystals are their sites") {
  for (const Packing& crystal : {fcc_points(), hcp_points()}) {
    for (const double noise : {0.0, 1e-15, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3}) {
      CAPTURE(noise);
      const Packing packing = with_noise(crystal, noise);
      const auto all = pores(packing, voronoi_cells(packing), 1e-6 + 60 * noise);
      const auto sites = count_sites(all, 1e-9 + 10 * noise);
      // Two tetrahedral sites and an octahedral one per sphere.
      CHECK(sites.at(Site::tetrahedral) == 1000);
      CHECK(sites.at(Site::octahedral) == 500);
      CHECK(sites.count(Site::irregular) == 0);
      for (const Pore& pore : all) {
        CHECK(pore.owners.size() == (site_of(pore, 0.05) == Site::octahedral ? 6 : 4));
      }
    }
  }
}

TEST_CASE("Distributions of pores agree with one another") {
  const Packing deposit = reference_deposit();
  const auto inside =
      pores_in(pores(deposit, voronoi_cells(deposit)), deposit.container, pore_region);
  const double width = 0.01;
  const PoreDistribution density = pore_distribution(inside, width, 3);
  double count = 0, by_volume = 0, mean_volume = 0;
  for (std::size_t b = 0; b < density.xi.size(); ++b) {
    const double xi = density.xi[b];
    count += density.rho_xi[b] * width;
    by_volume += density.rho_v[b] * 3 * xi * xi * width;
    mean_volume += density.rho_xi[b] * width * xi * xi * xi;
    CHECK(density.v_rho_v[b] == Approx(xi * xi * xi * density.rho_v[b]).margin(1e-12));
  }
  CHECK(count == Approx(static_cast<double>(inside.size())).epsilon(1e-12));
  CHECK(by_volume == Approx(count).epsilon(1e-12));
  CHECK(mean_volume / count == Approx(mean_pore_volume(inside)).epsilon(0.01));
}

TEST_CASE("The chance of a void in a deposit is near Gotoh's") {
  const Packing deposit = reference_deposit();
  const std::vector<double> sigma = {0, 0.3, 0.7, 1, 1.2, 1.4, 1.6};
  const StreamKey key = stream_key(9, 0, 0, Purpose::resampling);
  const Region slab{4, 9};
  const auto exact = void_probability(deposit, slab, sigma, 200'000, key);
  CHECK(exact.probability[0] == 1);
  const double phi = 1 - exact.probability[3];
  CHECK(exact.probability[1] == Approx(1 - phi * 0.027).margin(2e-3));
  // A deposit is no fluid, but the paper finds its voids near the theory's.
  CHECK(exact.probability[4] == Approx(gotoh_void_probability(phi, 1.2)).margin(0.03));
}

TEST_CASE("Gotoh's chance of a void is that of the table") {
  std::ifstream file(test_data("voronoi/pore_P0.csv"));
  int compared = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.front() == '#' || line.front() == 'p') continue;
    double phi = 0, sigma = 0, expected = 0;
    char comma = 0;
    std::istringstream(line) >> phi >> comma >> sigma >> comma >> expected;
    CAPTURE(phi, sigma);
    CHECK(gotoh_void_probability(phi, sigma) == Approx(expected).epsilon(1e-4).margin(1e-12));
    ++compared;
  }
  CHECK(compared > 100);
}

TEST_CASE("Regions keep away from walls") {
  const Region region{1, 10, 2};
  CHECK(region.volume(WalledBox{16, 16}) == 9 * 12 * 12);
  CHECK(region.volume(PeriodicBox{16, 16}) == 9 * 256);
  CHECK(region.volume(Cylinder{10}) == Approx(9 * 28.274333882308138));
  CHECK_FALSE(region.contains(WalledBox{16, 16}, {1.9, 8, 5}));
  CHECK(region.contains(PeriodicBox{16, 16}, {1.9, 8, 5}));
  CHECK_FALSE(region.contains(Cylinder{10}, {5, 8.1, 5}));
  CHECK(region.contains(Cylinder{10}, {5, 7.9, 5}));
}

TEST_CASE("The chance of a void is exact for small spheres in every container") {
  // Against 20 000 random points of the region, by brute force: within 3 standard errors.
  for (const Container& container :
       {Container{WalledBox{4.5, 5}}, Container{Cylinder{5}}, Container{Plates{4.5, 5}},
        Container{PeriodicBox{4.5, 5}}, Container{FullyPeriodicBox{4.5, 5, 6.5}}}) {
    Packing packing{container, {}};
    for (int i = 0; i < 4 * 4 * 5; ++i) {
      const Vec3 r{0.55 + 1.03 * (i % 4), 0.6 + 1.1 * (i / 4 % 4), 0.5 + 1.2 * (i / 16)};
      if (!std::holds_alternative<Cylinder>(container) ||
          norm_squared(r - Vec3{2.5, 2.5, r.z}) < 4) {
        packing.centres.push_back(r);
      }
    }
    const Region region{1.1, 4.3, 0.7};
    const std::vector<double> sigma = {0.4, 0.9, 1};
    const VoidProbability exact = void_probability(packing, region, sigma, 100, StreamKey{7});
    constexpr int n_points = 20'000;
    RandomStream random(StreamKey{20'262});
    std::vector<int> empty(sigma.size(), 0);
    for (int p = 0; p < n_points;) {
      const Vec3 r{4.5 * random.uniform(), 5 * random.uniform(), 5 * random.uniform()};
      if (!region.contains(container, r)) continue;
      ++p;
      double nearest = 100;
      for (std::uint32_t i = 0; i < packing.centres.size(); ++i) {
        nearest = std::min(nearest, distance_to(packing, r, i));
      }
      for (std::size_t s = 0; s < sigma.size(); ++s) {
        empty[s] += nearest >= sigma[s] * sphere_radius ? 1 : 0;
      }
    }
    for (std::size_t s = 0; s < sigma.size(); ++s) {
      const double p = exact.probability[s];
      CHECK(exact.error[s] == 0);
      CHECK(std::abs(empty[s] / double{n_points} - p) < 3 * std::sqrt(p * (1 - p) / n_points));
    }
  }
}

namespace {

// P0 of a region (of each gas's bulk, if none is given): the mean over realizations of gases of `n`
// points, and its error.
std::pair<std::vector<double>, std::vector<double>> voids_of_gases(
    const Container& container, double height, unsigned n,
    const std::optional<Region>& given = std::nullopt) {
  constexpr int gases = 500;
  const std::vector<double> sigma = {1.05, 1.2, 1.5, 1.8};
  std::vector<double> sum(sigma.size(), 0), squares = sum;
  for (int g = 0; g < gases; ++g) {
    const Packing gas = random_points(container, height, n, 300 + static_cast<std::uint64_t>(g));
    const Region region = given ? *given : bulk_of(gas);
    const auto found = void_probability(gas, region, sigma, 1000, StreamKey{9}).probability;
    for (std::size_t s = 0; s < sigma.size(); ++s) {
      sum[s] += found[s] / gases;
      squares[s] += found[s] * found[s] / gases;
    }
  }
  for (std::size_t s = 0; s < sigma.size(); ++s) {
    squares[s] = std::sqrt((squares[s] - sum[s] * sum[s]) / (gases - 1));
  }
  return {sum, squares};
}

}  // namespace

TEST_CASE("A random gas has the void probability of its density at walls, floor and surface too") {
  // P0 = (1 - 4/3 pi (sigma R)^3 / V)^n for n points in the volume V that centres may have.
  struct Case {
    Container container;
    double volume;
  };
  constexpr double height = 10.5;
  constexpr unsigned n = 120;
  for (const Case& gas :
       {Case{WalledBox{5, 5}, 4 * 4 * 10}, Case{WalledBox{4.2, 6}, 3.2 * 5 * 10},
        Case{Cylinder{5}, std::numbers::pi * 4 * 10}, Case{PeriodicBox{5, 5}, 5 * 5 * 10}}) {
    const double sigma[] = {1.05, 1.2, 1.5, 1.8};
    const auto expected = [&](std::size_t s) {
      const double part = 8 * sphere_volume * std::pow(sigma[s] * sphere_radius, 3) / gas.volume;
      return std::pow(1 - part, n);
    };
    CAPTURE(width_x(gas.container));
    // Far below the surface nothing but floor and walls cuts spheres: no bias at all.
    const auto [low, error] = voids_of_gases(gas.container, height, n, Region{0.5, 7, 0.5});
    for (std::size_t s = 0; s < low.size(); ++s) {
      CAPTURE(sigma[s]);
      CHECK(std::abs(low[s] - expected(s)) < 3 * error[s]);
    }
    // The bulk ends at heights found by 2<Z>, which scatters with few points: 1 % of bias is left.
    const auto [bulk, its_error] = voids_of_gases(gas.container, height, n);
    for (std::size_t s = 0; s < bulk.size(); ++s) {
      CAPTURE(sigma[s]);
      CHECK(std::abs(bulk[s] - expected(s)) < 3 * its_error[s] + 0.01 * expected(s));
    }
  }
}

TEST_CASE("A lattice between walls and in a tube has the void probability of the lattice") {
  // Simple cubic of spacing 1.2 against one with periodic sides, on the same random points.
  const auto lattice = [](const Container& container, double first) {
    Packing packing{container, {}};
    for (int i = 0; i < 5 * 5 * 8; ++i) {
      packing.centres.push_back(
          {first + 1.2 * (i % 5), first + 1.2 * (i / 5 % 5), 0.5 + 1.2 * (i / 25)});
    }
    return packing;
  };
  const std::vector<double> sigma = {1.1, 1.3, 1.6};
  const auto pores_of = [&](const Packing& packing) {
    return void_probability(packing, {1, 7.8, 1}, sigma, 60'000, StreamKey{3});
  };
  const VoidProbability periodic = pores_of(lattice(PeriodicBox{6, 6}, 0.6));
  for (const Packing& packing : {lattice(WalledBox{5.8, 5.8}, 0.5), lattice(Cylinder{7.8}, 1.5)}) {
    const VoidProbability found = pores_of(packing);
    for (std::size_t s = 0; s < sigma.size(); ++s) {
      CAPTURE(sigma[s]);
      CHECK(found.probability[s] == Approx(periodic.probability[s]).margin(0.03));
    }
  }
  // No sphere of 2.5 R, whose centre is at most 1.7 high, keeps clear of the floor.
  const VoidProbability none = void_probability(lattice(WalledBox{5.8, 5.8}, 0.5), {1, 1.7, 1},
                                                std::vector{1.0, 2.5}, 1000, StreamKey{3});
  CHECK(none.probability[0] < 1);
  CHECK(std::isnan(none.probability[1]));
}
