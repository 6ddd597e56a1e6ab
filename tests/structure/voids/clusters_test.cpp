#include "structure/voids/clusters.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <set>

#include "engine/bed/boundary.hpp"
#include "engine/bed/random.hpp"
#include "tests/structure/reference_deposit.hpp"
#include "tests/structure/voids/voronoi_points.hpp"

using namespace jostle;

namespace {

struct Statistics {
  double mean = 0, variance = 0;
  std::uint64_t n = 0;
};

/// Every centre and all of its images beside it, sorted by distance, cluster by cluster.
Statistics brute_force(const Packing& packing, const VoronoiCells& cells, std::uint32_t n,
                       std::uint32_t every) {
  const Boundary boundary(packing.container);
  const bool all_round = boundary.periodic_z;
  std::vector<double> volumes;
  for (std::uint32_t i = 0; i < cells.size(); i += every) {
    std::vector<std::pair<double, std::uint32_t>> near;
    for (std::uint32_t j = 0; j < cells.size(); ++j) {
      for (int a = -1; a <= 1; ++a) {
        for (int b = -1; b <= 1; ++b) {
          for (int c = all_round ? -1 : 0; c <= (all_round ? 1 : 0); ++c) {
            const Vec3 way = (packing.centres[j] - packing.centres[i]) +
                             Vec3{a * boundary.width_x, b * boundary.width_y,
                                  all_round ? c * boundary.height : 0};
            near.emplace_back(std::round(norm_squared(way) * 1e9), j);
          }
        }
      }
    }
    std::ranges::sort(near);
    double volume = 0;
    std::set<std::uint32_t> members;
    for (std::uint32_t k = 0; k < n; ++k) {
      if (cells.cut[near[k].second] != 0) break;
      if (!members.insert(near[k].second).second) break;
      volume += cells.volumes[near[k].second] / sphere_volume;
    }
    if (members.size() == n) volumes.push_back(volume);
  }
  Statistics found{0, 0, volumes.size()};
  for (const double volume : volumes) found.mean += volume / static_cast<double>(found.n);
  for (const double volume : volumes) {
    found.variance += std::pow(volume - found.mean, 2) / (static_cast<double>(found.n) - 1);
  }
  return found;
}

void check_twin(const Packing& packing, std::uint32_t every) {
  const VoronoiCells cells = voronoi_cells(packing);
  const ClusterVolumes found =
      cluster_volumes(packing, cells, 24, [&](std::uint32_t i) { return i % every == 0; });
  REQUIRE(found.cells == std::vector<std::uint32_t>{1, 2, 3, 4, 6, 8, 12, 16, 24});
  for (std::size_t k = 0; k < found.cells.size(); k += 2) {
    const Statistics twin = brute_force(packing, cells, found.cells[k], every);
    CAPTURE(found.cells[k]);
    REQUIRE(twin.n > 10);
    CHECK(found.clusters[k] == twin.n);
    CHECK(found.mean[k] == Approx(twin.mean).epsilon(1e-12));
    CHECK(found.variance[k] == Approx(twin.variance).epsilon(1e-10));
  }
}

}  // namespace

TEST_CASE("Clusters of cells are those that a search through all centres and images finds") {
  check_twin(poisson_points(), 40);
  check_twin(reference_deposit(), 40);
}

TEST_CASE("Touching spheres are equally far, whatever the rounding of their places") {
  const auto variances = [](const Packing& packing) {
    return cluster_volumes(packing, voronoi_cells(packing), 24,
                           [](std::uint32_t i) { return i % 40 == 0; })
        .variance;
  };
  const Packing deposit = reference_deposit();
  Packing moved = deposit;
  RandomStream random(stream_key(5, 0, 0, Purpose::resampling));
  for (Vec3& centre : moved.centres) centre.z += 1e-13 * (random.uniform() - 0.5);
  const std::vector<double> of_deposit = variances(deposit), of_moved = variances(moved);
  for (std::size_t k = 0; k < of_deposit.size(); ++k) {
    CAPTURE(k);
    CHECK(of_moved[k] == Approx(of_deposit[k]).epsilon(1e-6));
  }
}

TEST_CASE("The variance of clusters of independent cells grows as their number") {
  const Packing packing = poisson_points();
  VoronoiCells cells = voronoi_cells(packing);
  RandomStream random(stream_key(20129734, 0, 0, Purpose::resampling));
  // Uniform volumes: variance 1/12 of the width squared, here 1 sphere volume squared.
  for (double& volume : cells.volumes)
    volume = sphere_volume * (2 + std::sqrt(12.0) * random.uniform());
  const ClusterVolumes found =
      cluster_volumes(packing, cells, 32, [](std::uint32_t) { return true; });
  for (std::size_t k = 0; k < found.cells.size(); ++k) {
    const double n = found.cells[k];
    // For clusters that share cells about N/n are independent: error (2 n / N)^(1/2).
    const double error = std::sqrt(2 * n / static_cast<double>(cells.size()));
    CAPTURE(n, found.variance[k]);
    CHECK(std::abs(found.variance[k] / n - 1) < 3 * error);
  }
}

TEST_CASE("Cells dealt out anew have the variance that is given for independent ones", "[slow]") {
  // The whole of a closed box, and an open region of some 190 cells.
  const Packing closed = poisson_points(), bed = reference_deposit();
  const auto is_counted = [](std::uint32_t) { return true; };
  const auto inside = [&](std::uint32_t i) {
    const Vec3 r = bed.centres[i];
    return r.z > 3 && r.z < 8.6 && r.x < 5.6 && r.y < 5.6;
  };
  RandomStream random(stream_key(20261125, 4, 0, Purpose::resampling));
  const auto check = [&](const Packing& packing,
                         const std::function<bool(std::uint32_t)>& centre_counts) {
    VoronoiCells cells = voronoi_cells(packing);
    std::vector<std::uint32_t> whole;
    for (std::uint32_t i = 0; i < cells.size(); ++i)
      if (cells.cut[i] == 0) whole.push_back(i);
    double sum = 0, squares = 0;  // sum of all distributed volumes, in sphere volumes
    for (const std::uint32_t i : whole) sum += cells.volumes[i] / sphere_volume;
    const double mean = sum / static_cast<double>(whole.size());
    for (const std::uint32_t i : whole)
      squares += std::pow(cells.volumes[i] / sphere_volume - mean, 2);
    const double variance = squares / (static_cast<double>(whole.size()) - 1);
    constexpr int deals = 100;
    std::vector<double> sums, sums_of_squares;
    std::vector<double> expected;
    for (int deal = 0; deal < deals; ++deal) {
      for (std::size_t k = whole.size(); k > 1; --k)
        std::swap(cells.volumes[whole[k - 1]], cells.volumes[whole[random.integer_below(k)]]);
      const ClusterVolumes found = cluster_volumes(packing, cells, 48, centre_counts);
      expected = found.independent;
      sums.resize(expected.size());
      sums_of_squares.resize(expected.size());
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const double ratio = found.variance[k] / found.cells[k] / variance;
        sums[k] += ratio;
        sums_of_squares[k] += ratio * ratio;
      }
    }
    CHECK(expected[0] == Approx(1));
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const double ratio = sums[k] / deals;
      const double error = std::sqrt((sums_of_squares[k] / deals - ratio * ratio) / (deals - 1));
      CAPTURE(k, ratio, error, expected[k]);
      CHECK(std::abs(ratio - expected[k]) <= 3 * error + 1e-12);
    }
    return expected;
  };
  const std::vector<double> box = check(closed, is_counted);
  // n = 32: some n/N less than 1, or more where clusters crowd.
  CHECK(box[9] == Approx(1 - 32.0 / static_cast<double>(closed.centres.size())).margin(0.03));
  const std::vector<double> open = check(bed, inside);
  CHECK(open[7] < 0.97);  // the share in 16 cells
}

TEST_CASE("Clusters are compared with their cells") {
  // Independent cells that vary more, the lower they are: clusters of many keep off the floor.
  const Packing bed = reference_deposit();
  VoronoiCells cells = voronoi_cells(bed);
  RandomStream random(stream_key(41, 0, 0, Purpose::resampling));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double spread = bed.centres[i].z < 2.5 ? 1 : 0.2;
    cells.volumes[i] = sphere_volume * (2 + spread * (random.uniform() - 0.5));
  }
  const ClusterVolumes found = cluster_volumes(bed, cells, 64, [&](std::uint32_t i) {
    return bed.centres[i].z > 1 && bed.centres[i].z < 6;
  });
  for (std::size_t k = 0; k < found.cells.size(); ++k) {
    const double n = found.cells[k];
    const double relative = found.variance[k] / n / found.independent[k] / found.of_members[k];
    CAPTURE(n, relative);
    CHECK(std::abs(relative - 1) < 4 * std::sqrt(2 * n / static_cast<double>(found.clusters[k])));
    if (n == 1) CHECK(relative == Approx(1).epsilon(1e-9));
  }
  // Against all single cells, clusters of 64 would seem to hold together.
  CHECK(found.of_members.back() < 0.7 * found.variance.front());
}

TEST_CASE("Clusters stop at half of all spheres") {
  const Packing packing = poisson_points();
  const VoronoiCells cells = voronoi_cells(packing);
  const ClusterVolumes found =
      cluster_volumes(packing, cells, 1'000'000, [](std::uint32_t i) { return i < 3; });
  CHECK(found.cells.back() <= cells.size() / 2);
  CHECK(found.cells.back() > cells.size() / 4);
}
