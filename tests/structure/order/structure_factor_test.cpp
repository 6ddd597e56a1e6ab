#include "structure/order/structure_factor.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "close_packings.hpp"
#include "engine/bed/boundary.hpp"

using namespace jostle;

namespace {

constexpr double pi = std::numbers::pi;

struct Mean {
  double n = 0, sum = 0, squares = 0;
  void add(double x) {
    n += 1;
    sum += x;
    squares += x * x;
  }
  double mean() const { return sum / n; }
  double error() const { return std::sqrt((squares / n - mean() * mean()) / (n - 1)); }
};

Packing random_points(const Container& container, double depth, int n, RandomStream& random) {
  const Boundary boundary(container);
  Packing packing{container, {}};
  for (int i = 0; i < n; ++i) {
    packing.centres.push_back({random.uniform() * boundary.width_x,
                               random.uniform() * boundary.width_y, random.uniform() * depth});
  }
  return packing;
}

/// S(k) of the Percus-Yevick hard-sphere fluid: 1/(1 - rho c(k)), with Wertheim's and Thiele's
/// c(r) = -(l1 + 6 eta l2 r + eta l1 r^3 / 2) inside the diameter. Wertheim 1963,
/// doi:10.1103/PhysRevLett.10.321.
double percus_yevick(double eta, double k) {
  const double l1 = std::pow(1 + 2 * eta, 2) / std::pow(1 - eta, 4);
  const double l2 = -std::pow(1 + 0.5 * eta, 2) / std::pow(1 - eta, 4);
  constexpr int n = 2000;  // midpoint rule
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double r = (i + 0.5) / n;
    sum -= r * std::sin(k * r) * (l1 + 6 * eta * l2 * r + 0.5 * eta * l1 * r * r * r) / n;
  }
  return 1 / (1 - 6 * eta / pi * 4 * pi / k * sum);
}

/// Hard spheres in equilibrium: trial by trial, all pairs looked at.
void stir(Packing& packing, int sweeps, double step, RandomStream& random) {
  const Boundary boundary(packing.container);
  auto& centres = packing.centres;
  for (std::size_t trial = 0; trial < static_cast<std::size_t>(sweeps) * centres.size(); ++trial) {
    const std::size_t i = random.integer_below(centres.size());
    const auto shift = [&] { return step * (2 * random.uniform() - 1); };
    const Vec3 moved =
        wrapped(boundary, {centres[i].x + shift(), centres[i].y + shift(), centres[i].z + shift()});
    bool free = true;
    for (std::size_t j = 0; free && j < centres.size(); ++j) {
      free = j == i || norm_squared(separation(boundary, moved, centres[j])) >= 1;
    }
    if (free) centres[i] = moved;
  }
}

}  // namespace

TEST_CASE("S is the sum over spheres, wave vector by wave vector") {
  RandomStream random(stream_key(20261124, 0, 0, Purpose::start));
  const Packing packing = random_points(FullyPeriodicBox{5, 6, 7}, 7, 40, random);
  // The five least: (0, 0, 1), (0, 1, 0), (1, 0, 0), .. one to a bin.
  const double ks[3] = {2 * pi / 5, 2 * pi / 6, 2 * pi / 7};
  const StructureFactor found =
      structure_factor(packing, {.k_max = 1.3, .bin_width = 0.01, .modes = 9}, {});
  for (int axis = 0; axis < 3; ++axis) {
    std::complex<double> sum = 0;
    for (const Vec3& r : packing.centres) {
      const double coordinates[3] = {r.x, r.y, r.z};
      sum += std::polar(1.0, ks[axis] * coordinates[axis]);
    }
    const auto bin = static_cast<std::size_t>(ks[axis] / 0.01);
    CHECK(found.modes[bin] == 1);
    CHECK(found.s[bin] == Approx(std::norm(sum) / 40).epsilon(1e-10));
  }
}

TEST_CASE("S of random points is 1, also within a taper") {
  for (const bool floor : {false, true}) {
    Mean s, s_0, s_0_line;
    for (std::uint64_t r = 0; r < 40; ++r) {
      RandomStream random(stream_key(20261124, 1, r, Purpose::start));
      const Container container =
          floor ? Container(PeriodicBox{8, 9}) : Container(FullyPeriodicBox{8, 9, 10});
      const Packing packing = random_points(container, 10, 400, random);
      const StructureFactor found = structure_factor(packing, {.k_max = 4}, {1, 9, 0});
      double sum = 0, n = 0;
      for (std::size_t b = 0; b < found.s.size(); ++b) {
        if (found.modes[b] == 0) continue;
        sum += found.s[b];
        n += 1;
      }
      s.add(sum / n);
      s_0.add(found.s_0_of_squares);
      s_0_line.add(found.s_0_of_line);
    }
    CHECK(std::abs(s.mean() - 1) < 3 * s.error());
    CHECK(std::abs(s_0.mean() - 1) < 3 * s_0.error());
    CHECK(std::abs(s_0_line.mean() - 1) < 3 * s_0_line.error());
    CHECK(s.error() < 0.03);
  }
}

TEST_CASE("Wave vectors that the taper cannot resolve are left out") {
  RandomStream random(stream_key(20261125, 3, 0, Purpose::start));
  const Packing bed = random_points(PeriodicBox{20, 20}, 8, 1600, random);
  constexpr double depth = 6, least = 2 * pi / depth;  // 1.047; the sides' least is 0.314
  const StructureFactor found =
      structure_factor(bed, {.k_max = 4, .bin_width = 0.1, .modes = 1'000'000}, {1, 7, 0});
  for (std::size_t b = 0; b < 10; ++b) CHECK(found.modes[b] == 0);
  CHECK(found.fitted_from >= least * (1 - 1e-9));
  CHECK(found.fitted_from < 1.1 * least);
  std::uint64_t modes = 0;
  for (std::size_t b = 0; b < 30; ++b) modes += found.modes[b];
  CHECK(found.fitted_modes == modes);
  // Without a taper every wave vector counts.
  Packing box = bed;
  box.container = FullyPeriodicBox{20, 20, 8};
  const StructureFactor whole =
      structure_factor(box, {.k_max = 4, .bin_width = 0.1, .modes = 1'000'000}, {0, 8, 0});
  CHECK(whole.fitted_from == Approx(2 * pi / 20));
  CHECK(whole.modes[3] > 0);
  // A region so shallow that it resolves nothing up to fit_to.
  const StructureFactor shallow = structure_factor(bed, {.k_max = 8, .fit_to = 3}, {3, 5, 0});
  CHECK(shallow.fitted_modes == 0);
  CHECK(std::isnan(shallow.fitted_from));
  CHECK(std::isnan(shallow.s_0_of_line));
}

TEST_CASE("A crystal has Bragg peaks and nothing else") {
  const Packing crystal = stacked_layers("ABCABCABCABC");
  const StructureFactor lower_factor =
      structure_factor(crystal, {.k_max = 7.2, .bin_width = 0.1, .modes = 1'000'000}, {0.5, 9, 0});
  for (std::size_t b = 0; b < 70; ++b) {
    if (lower_factor.modes[b] > 0) CHECK(lower_factor.s[b] == Approx(0).margin(1e-20));
  }
  CHECK(lower_factor.s_0_of_squares == Approx(0).margin(1e-20));
  // The first peak of fcc lies beyond, at 2 pi sqrt(3) over the cell's edge sqrt(2).
  const StructureFactor beyond =
      structure_factor(crystal, {.k_max = 8, .bin_width = 0.5, .modes = 1'000'000}, {0.5, 9, 0});
  CHECK(beyond.s[15] > 1);  // 7.5 to 8, and the peak is at 7.695
}

TEST_CASE("S of a hard-sphere fluid is Percus and Yevick's", "[statistics]") {
  // For eta = 0.15 their S is within a percent of the exact one.
  constexpr double eta = 0.15, width = 8;
  const int n = static_cast<int>(eta * width * width * width * 6 / pi);
  std::vector<Mean> s(24);
  Mean s_0;
  for (std::uint64_t r = 0; r < 12; ++r) {
    RandomStream random(stream_key(20261124, 2, r, Purpose::start));
    Packing packing{FullyPeriodicBox{width, width, width}, {}};
    for (int i = 0; i < n; ++i) {  // index in a cubic lattice
      const int site = i * 343 / n;
      packing.centres.push_back(
          {site % 7 * width / 7, site / 7 % 7 * width / 7, site / 49 * width / 7});
    }
    stir(packing, 300, 0.5, random);
    for (int sample = 0; sample < 4; ++sample) {
      stir(packing, 40, 0.5, random);
      const StructureFactor found =
          structure_factor(packing, {.k_max = 12, .bin_width = 0.5}, {0, width, 0});
      for (std::size_t b = 0; b < 24; ++b) s[b].add(found.s[b]);
      s_0.add(found.s_0_of_squares);
    }
  }
  int outside = 0;
  for (std::size_t b = 2; b < 24; ++b) {
    const double expected = percus_yevick(eta, 0.25 + 0.5 * static_cast<double>(b));
    // The bin's width and the theory take 1 % each.
    const double allowed = 3 * s[b].error() * 1.5 + 0.02 * expected;
    outside += std::abs(s[b].mean() - expected) > allowed ? 1 : 0;
  }
  CHECK(outside == 0);
  // Its compressibility, (1 - eta)^4/(1 + 2 eta)^2.
  const double limit = std::pow(1 - eta, 4) / std::pow(1 + 2 * eta, 2);
  CHECK(percus_yevick(eta, 1e-3) == Approx(limit).epsilon(1e-3));
  CHECK(std::abs(s_0.mean() - limit) < 3 * s_0.error() * 1.5 + 0.03 * limit);
}

TEST_CASE("Walls have no wave vectors") {
  const Packing packing{WalledBox{8, 8}, {{4, 4, 0.5}}};
  CHECK_THROWS_WITH(structure_factor(packing, {}, {0, 5, 0}), Catch::Contains("has walls"));
}
