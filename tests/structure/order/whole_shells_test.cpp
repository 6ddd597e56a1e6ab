#include "structure/order/whole_shells.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numbers>

#include "engine/bed/boundary.hpp"
#include "engine/starts/starts.hpp"
#include "structure/order/pair_correlation.hpp"
#include "tests/structure/order/shell_volume.hpp"
#include "tests/test_files.hpp"

// Numbers of neighbours in shells that lie whole within the region that centres can reach.
using namespace jostle;

namespace {

/// Simple cubic lattice: along x and y `n` sites from `first` on, as far as they are clear of
/// sides.
Packing cubic_lattice(const Container& container, double spacing, double first, int n,
                      int n_layers) {
  Packing lattice{container, {}};
  const Boundary boundary(container);
  for (int k = 0; k < n_layers; ++k) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const Vec3 r{first + i * spacing, first + j * spacing, 0.5 + k * spacing};
        if (clear_of_boundaries(boundary, r)) lattice.centres.push_back(r);
      }
    }
  }
  return lattice;
}

double neighbours_up_to(const PairCorrelation& pairs, double r) {
  return pairs.running_neighbours().at(static_cast<std::size_t>(std::lround(r / pairs.bin_width)) -
                                       1);
}

/// The number of neighbours between two distances that g stands for at a density.
double neighbours_of_g(const PairCorrelation& pairs, double density, double low, double high) {
  double sum = 0;
  const std::vector<double> g = pairs.g();
  for (std::size_t k = 0; k < g.size(); ++k) {
    if (pairs.r[k] > low && pairs.r[k] < high) sum += g[k] * density * shell_volume(pairs, k);
  }
  return sum;
}

}  // namespace

TEST_CASE("Lattices have the neighbours of their shells in every container") {
  // 6 at a, 12 at 2^(1/2) a, 8 at 3^(1/2) a, 6 at 2 a.
  struct Lattice {
    Container container;
    double spacing, first;
    int n, n_layers;
    double r_max;
  };
  const auto [container, spacing, first, n, n_layers, r_max] = GENERATE(values<Lattice>({
      {WalledBox{7, 7}, 1.2, 1.1, 5, 10, 4},
      {WalledBox{7, 7}, 1.2, 0.5, 6, 10, 2.6},  // at the walls themselves
      {WalledBox{4.6, 4.6}, 1.2, 1.1, 3, 12, 2.6},
      {WalledBox{16, 16}, 1.0, 0.5, 16, 16, 4},
      {PeriodicBox{6, 6}, 1.2, 0.6, 5, 10, 3},
      {PeriodicBox{4.8, 4.8}, 1.2, 0.6, 4, 10, 3},  // half a period is 2 a
      {FullyPeriodicBox{6, 6, 12}, 1.2, 0.6, 5, 10, 3},
      {Plates{6, 7}, 1.2, 1.1, 5, 10, 3},
      {Plates{7.2, 7}, 1.2, 0.5, 6, 10, 3},  // at the plates themselves
      {FullyPeriodicBox{4.8, 4.8, 4.8}, 1.2, 0.6, 4, 4, 2.6},
  }));
  const Packing lattice = cubic_lattice(container, spacing, first, n, n_layers);
  CAPTURE(lattice.centres.size(), first, n);
  const PairCorrelation pairs = pair_correlation(lattice, {.r_max = r_max, .bin_width = 0.02});
  const double beyond = 0.02;
  const auto up_to = [&](double shell) {
    return neighbours_up_to(pairs, std::round((spacing * shell + beyond) / 0.02) * 0.02);
  };
  CHECK(neighbours_up_to(pairs, std::floor((spacing - 0.01) / 0.02) * 0.02) == 0);
  CHECK(up_to(1) == Approx(6).epsilon(0.002));
  CHECK(up_to(std::numbers::sqrt2) == Approx(18).epsilon(0.002));
  if (std::round((spacing * std::numbers::sqrt3 + beyond) / 0.02) * 0.02 > pairs.widest_shell) {
    CHECK(std::isnan(up_to(std::numbers::sqrt3)));
    return;
  }
  CHECK(up_to(std::numbers::sqrt3) == Approx(26).epsilon(0.002));
  // The deepest site of a lattice at the walls has room for 2 a and no more.
  if (first == 0.5 && n == 6) {
    CHECK(std::isnan(up_to(2)));
  } else {
    CHECK(up_to(2) == Approx(32).epsilon(0.005));  // the corners of narrow containers end there
  }
}

TEST_CASE("A lattice in a tube has the neighbours of its shells") {
  for (const double diameter : {6.0, 9.3, 14.0}) {
    const double axis = 0.5 * diameter, first = axis - 1.2 * std::floor((axis - 0.5) / 1.2);
    const Packing lattice = cubic_lattice(Cylinder{diameter}, 1.2, first, 20, 12);
    const PairCorrelation pairs = pair_correlation(lattice, {.r_max = 3});
    CAPTURE(diameter, lattice.centres.size());
    CHECK(neighbours_up_to(pairs, 1.22) == Approx(6).epsilon(0.002));
    CHECK(neighbours_up_to(pairs, 1.72) == Approx(18).epsilon(0.002));
  }
}

TEST_CASE("The lattice between walls that had four neighbours has six") {
  for (const char* name : {"gr_lattice_walls.xyz", "gr_lattice_periodic.xyz"}) {
    std::ifstream file(test_data(name));
    std::string line;
    std::getline(file, line);
    std::getline(file, line);
    const bool walls = line.find("pbc=\"F F F\"") != std::string::npos;
    Packing lattice{walls ? Container{WalledBox{7, 7}} : Container{PeriodicBox{6, 6}}, {}};
    char letter = 0;
    for (Vec3 r; file >> letter >> r.x >> r.y >> r.z;) lattice.centres.push_back(r);
    REQUIRE(lattice.centres.size() == 250);
    for (const double r_max : {1.8, 3.0, 4.0}) {
      CAPTURE(name, r_max);
      const PairCorrelation pairs = pair_correlation(lattice, {.r_max = r_max});
      const double density = 1 / (1.2 * 1.2 * 1.2);
      CHECK(pairs.density == Approx(density).epsilon(0.01));
      CHECK(neighbours_of_g(pairs, density, 1.15, 1.25) == Approx(6).epsilon(0.02));
      CHECK(neighbours_of_g(pairs, density, 1.65, 1.75) == Approx(12).epsilon(0.02));
      CHECK(neighbours_up_to(pairs, 1.22) == Approx(6).epsilon(1e-9));
      CHECK(neighbours_up_to(pairs, 1.72) == Approx(18).epsilon(1e-9));
    }
  }
}

/// Neighbours within r around the spheres at least r inside the accessible region, by all pairs.
struct Counted {
  double mean = 0;
  int n_spheres = 0;
};
Counted counted_inside_tube(const Packing& bed, double diameter, HeightWindow heights, double r) {
  Counted counted;
  const double axis = 0.5 * diameter, surface = 2 * mean_height(bed) - 0.5;
  for (const Vec3& a : bed.centres) {
    const bool central = a.z >= heights.low && a.z <= heights.high;
    const double depth = axis - 0.5 - std::hypot(a.x - axis, a.y - axis);
    if (!central || std::min({depth, a.z - 0.5, surface - a.z}) < r) continue;
    ++counted.n_spheres;
    for (const Vec3& b : bed.centres) {
      if (&a != &b && norm_squared(b - a) < r * r) ++counted.mean;
    }
  }
  counted.mean /= counted.n_spheres;
  return counted;
}

TEST_CASE("Neighbours of beds in tubes are those of spheres away from the wall") {
  const double diameter = 9.3;
  double of_tubes = 0, of_periodic = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    RandomStream random(stream_key(2001, 0, seed, Purpose::start));
    const Packing bed = make_start(SteepestDescentPour{}, Cylinder{diameter}, 500, random);
    const PairCorrelation pairs = pair_correlation(bed, {.r_max = 2});
    const HeightWindow central = bulk_heights(bed, 2);
    // The bins beyond contact hold pairs whose own distance their spheres have room for: a few
    // spheres more than those with room up to the end.
    for (const double r : {1.02, 1.1, 1.5}) {
      CAPTURE(seed, r);
      CHECK(neighbours_up_to(pairs, r) ==
            Approx(counted_inside_tube(bed, diameter, central, r).mean).epsilon(0.03));
    }
    of_tubes += neighbours_up_to(pairs, 1.06) / 4;
    const Packing wide = make_start(SteepestDescentPour{}, PeriodicBox{8, 8}, 700, random);
    of_periodic += neighbours_up_to(pair_correlation(wide, {.r_max = 2}), 1.06) / 4;
  }
  CAPTURE(of_tubes, of_periodic);
  CHECK(std::abs(of_tubes - of_periodic) < 0.2);
}

TEST_CASE("Shells that have no room between the sides count no neighbours") {
  // At least 1/2 from walls, so that a centre in the middle has room for shells up to (width -
  // 1)/2.
  const auto [container, widest] = GENERATE(values<std::pair<Container, double>>({
      {Cylinder{3}, 1},
      {Cylinder{4.6}, 1.8},
      {WalledBox{3, 8}, 1},
      {WalledBox{4.4, 4.4}, 1.7},
  }));
  RandomStream random(stream_key(2001, 0, 0, Purpose::start));
  const Packing bed = make_start(SteepestDescentPour{}, container, 200, random);
  const PairCorrelation pairs = pair_correlation(bed, {.r_max = 2.5});
  CHECK(pairs.widest_shell == Approx(widest));
  const std::vector<double> neighbours = pairs.running_neighbours();
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    const double begin = static_cast<double>(k) * pairs.bin_width;
    CAPTURE(begin, neighbours[k]);
    if (begin > widest + 1e-6) CHECK((std::isnan(neighbours[k]) && pairs.shells[k] == 0));
    CHECK(!std::isinf(neighbours[k]));
  }
  CHECK(neighbours.at(20) == 0);
  CHECK(std::ranges::any_of(pairs.counts, [](std::uint64_t count) { return count > 0; }));
}

TEST_CASE("Neighbours are a sum over distances, each over the spheres whose shell there is whole") {
  const Container container = GENERATE(Container{Cylinder{6}}, Container{PeriodicBox{6, 6}});
  RandomStream random(stream_key(2002, 0, 0, Purpose::start));
  const Packing bed = make_start(SteepestDescentPour{}, container, 400, random);
  const double r_max = 1.8, axis = 3, surface = 2 * mean_height(bed) - 0.5;
  const HeightWindow central = bulk_heights(bed, r_max);
  const PairCorrelation pairs = pair_correlation(bed, {.r_max = r_max});
  const bool tube = std::holds_alternative<Cylinder>(container);
  std::vector<double> rooms(bed.centres.size(), -1.0);
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const Vec3 a = bed.centres[i];
    if (a.z < central.low || a.z > central.high) continue;
    rooms[i] = std::min(a.z - 0.5, surface - a.z);
    if (tube) rooms[i] = std::min(rooms[i], axis - 0.5 - std::hypot(a.x - axis, a.y - axis));
  }
  const auto whole_up_to = [&](double r) {
    return static_cast<double>(
        std::ranges::count_if(rooms, [&](double room) { return room >= r; }));
  };
  const auto distance = [&](Vec3 a, Vec3 b) {
    Vec3 way = b - a;
    if (!tube) way = {std::remainder(way.x, 6), std::remainder(way.y, 6), way.z};
    return std::sqrt(norm_squared(way));
  };
  for (const double r : {1.1, 1.5, 1.8}) {
    CAPTURE(tube, r);
    double sum = 0;
    for (std::size_t i = 0; i < rooms.size(); ++i) {
      for (std::size_t j = 0; j < rooms.size(); ++j) {
        if (i == j || rooms[i] < 0) continue;
        const double d = distance(bed.centres[i], bed.centres[j]);
        if (d < r && d <= rooms[i]) sum += 1 / whole_up_to(d);
      }
    }
    const auto bin = static_cast<std::size_t>(std::lround(r / pairs.bin_width)) - 1;
    CHECK(pairs.shells[bin] == whole_up_to(r));
    CHECK(neighbours_up_to(pairs, r) == Approx(sum).epsilon(1e-9));
  }
}

TEST_CASE("A bed of two layers has no neighbours where no shell is whole") {
  RandomStream random(stream_key(2001, 0, 0, Purpose::start));
  const Packing bed = make_start(SteepestDescentPour{}, Cylinder{9.3}, 120, random);
  const PairCorrelation pairs = pair_correlation(bed, {.r_max = 2});
  CHECK(neighbours_up_to(pairs, 0.3) == 0);
  CHECK(std::isnan(neighbours_up_to(pairs, 1.06)));
}
