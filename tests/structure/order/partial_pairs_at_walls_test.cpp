// Partial pair correlations between sides, against what their definition gives by brute force.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "structure/order/mixtures/partial_correlation.hpp"
#include "tests/structure/order/mixed_points.hpp"

using namespace jostle;

namespace {

constexpr double pi = std::numbers::pi;

/// Half the width, less the radius: what centres may deviate from the middle.
double half_width(double width, double radius) {
  return 0.5 * width - radius;
}

/// Density of displacements d along a direction between planes, by counting all spheres.
double density_along(const Packing& packing, double Vec3::*axis, double width, std::size_t i,
                     std::size_t j, double d) {
  const Sizes& sizes = *packing.sizes;
  const double a = half_width(width, sizes.radius(i)), b = half_width(width, sizes.radius(j));
  const bool is_one_kind = sizes.kind(i) == sizes.kind(j);
  double first = 0, second = 0, n = 0, m = 0, of_one = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const double place =
        (packing.centres[k].*axis - 0.5 * width) / half_width(width, sizes.radius(k));
    const bool leads_in = std::abs(place * a + d) <= b, leads_back = std::abs(place * b - d) <= a;
    if (sizes.kind(k) == sizes.kind(i)) {
      n += 1;
      first += leads_in ? 1 : 0;
      of_one += leads_in && leads_back ? 1 : 0;
    }
    if (sizes.kind(k) == sizes.kind(j)) {
      m += 1;
      second += leads_back ? 1 : 0;
    }
  }
  const double shared = std::min(a, b - d) - std::max(-a, -b - d);
  if (shared < 0.1 * std::min(a, b)) return 0.25 * (first / n / b + second / m / a);
  if (is_one_kind) return (first * second - of_one) / (n * (n - 1)) / shared;
  return first * second / (n * m) / shared;
}

/// Like density_along() for two displacements across a tube, over azimuths.
double density_in_tube(const Packing& packing, double width, std::size_t i, std::size_t j, double d,
                       RandomStream& random) {
  const Sizes& sizes = *packing.sizes;
  const double a = half_width(width, sizes.radius(i)), b = half_width(width, sizes.radius(j));
  const bool is_one_kind = sizes.kind(i) == sizes.kind(j);
  const double turned = 2 * pi * random.uniform();
  std::array<std::array<double, 2>, 16> ways;  // evenly spread displacements of length d
  for (std::size_t way = 0; way < ways.size(); ++way) {
    const double azimuth = turned + 2 * pi * static_cast<double>(way) / ways.size();
    ways[way] = {d * std::cos(azimuth), d * std::sin(azimuth)};
  }
  const auto leads_in = [&](double start, double radius) {
    double n_inside = 0;
    for (const auto& [x, y] : ways)
      n_inside += (start + x) * (start + x) + y * y <= radius * radius ? 1 : 0;
    return n_inside / ways.size();
  };
  double first = 0, second = 0, n = 0, m = 0, of_one = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const Vec3 r = packing.centres[k];
    const double place =
        std::hypot(r.x - 0.5 * width, r.y - 0.5 * width) / half_width(width, sizes.radius(k));
    const double ahead = leads_in(place * a, b), back = leads_in(place * b, a);
    if (sizes.kind(k) == sizes.kind(i)) {
      n += 1;
      first += ahead;
      of_one += ahead * back;
    }
    if (sizes.kind(k) == sizes.kind(j)) {
      m += 1;
      second += back;
    }
  }
  double shared = 0;  // area of both discs, in strips
  constexpr int n_strips = 100;
  for (int k = 0; k < n_strips; ++k) {
    const double y = std::min(a, b) * ((2 * k + 1.0) / n_strips - 1);
    const double at_a = std::sqrt(a * a - y * y), at_b = std::sqrt(b * b - y * y);
    shared += std::max(0.0, std::min(at_a, at_b - d) - std::max(-at_a, -at_b - d)) * 2 *
              std::min(a, b) / n_strips;
  }
  const double least = std::min(a, b);
  if (shared < 0.05 * pi * least * least)
    return 0.5 * (first / n / (pi * b * b) + second / m / (pi * a * a));
  if (is_one_kind) return (first * second - of_one) / (n * (n - 1)) / shared;
  return first * second / (n * m) / shared;
}

constexpr std::size_t n_bins = 6;
constexpr double bin_width = 0.5;
using Bins = std::array<std::array<double, n_bins>, 3>;

struct BruteForce {
  Bins mean{}, error{};
};

/// Returns the expected pairs, from displacements drawn in the annuli of all pairs.
BruteForce expected_by_brute_force(const Packing& packing, HeightWindow heights) {
  const Boundary boundary(packing.container);
  constexpr int n_drawn = 32;
  RandomStream random(stream_key(2, 0, 0, Purpose::start));
  BruteForce found;
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const double z = packing.centres[i].z;
    if (z < heights.low || z > heights.high) continue;
    for (std::size_t j = 0; j < packing.centres.size(); ++j) {
      if (j == i) continue;
      const double contact = packing.radius(i) + packing.radius(j), h = packing.centres[j].z - z;
      const std::size_t pair = packing.sizes->kind(i) + packing.sizes->kind(j);
      for (std::size_t k = 0; k < n_bins; ++k) {
        const auto square = [&](double x) {
          const double longest = boundary.tube ? boundary.width_x - contact : HUGE_VAL;
          return std::clamp(std::pow(x * contact, 2) - h * h, 0.0, longest * longest);
        };
        const double inner = square(bin_width * static_cast<double>(k)),
                     outer = square(bin_width * static_cast<double>(k + 1));
        if (outer <= inner) continue;
        double sum = 0, squares = 0;
        for (int drawn = 0; drawn < n_drawn; ++drawn) {
          const double d = std::sqrt(inner + (outer - inner) * random.uniform());
          const double turned = 2 * pi * random.uniform();
          const auto density_of_axis = [&](bool planes, double Vec3::*axis, double width,
                                           double step) {
            return planes ? density_along(packing, axis, width, i, j, step) : 1 / width;
          };
          const double value =
              pi * (outer - inner) *
              (boundary.tube ? density_in_tube(packing, boundary.width_x, i, j, d, random)
                             : density_of_axis(boundary.planes_x(), &Vec3::x, boundary.width_x,
                                               d * std::cos(turned)) *
                                   density_of_axis(boundary.planes_y(), &Vec3::y, boundary.width_y,
                                                   d * std::sin(turned)));
          sum += value / n_drawn;
          squares += value * value / n_drawn;
        }
        found.mean[pair][k] += sum;
        found.error[pair][k] += (squares - sum * sum) / (n_drawn - 1);
      }
    }
  }
  for (auto& errors : found.error) {
    for (double& error : errors) error = std::sqrt(error);
  }
  return found;
}

MixedSizes fluid_sizes(bool is_drawn, RandomStream& random) {
  MixedSizes sizes;
  sizes.add(1, 18, 1.7);
  if (is_drawn)
    sizes.add_drawn(0, 42, random);
  else
    sizes.add(0, 42, 0.8);
  return sizes;
}

/// Volume of the shells around the central spheres that centres of each kind may reach, times the
/// density of the kind there, by random points. Centres lie up to `height` above the least.
Bins brief_normalisation(const Packing& packing, HeightWindow heights, double height,
                         RandomStream& random) {
  constexpr int n_drawn = 60;
  const Boundary boundary(packing.container);
  Bins expected{};
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const Vec3 centre = packing.centres[i];
    if (centre.z < heights.low || centre.z > heights.high) continue;
    for (const std::size_t j : {std::size_t{0}, packing.centres.size() - 1}) {
      const double radius = packing.radius(j), contact = packing.radius(i) + radius;
      double n = 0;
      for (std::size_t k = 0; k < packing.centres.size(); ++k)
        n += k != i && packing.sizes->kind(k) == packing.sizes->kind(j) ? 1 : 0;
      const double region = footprint_area(boundary, radius) * height;
      for (std::size_t k = 0; k < n_bins; ++k) {
        const double low = contact * bin_width * static_cast<double>(k),
                     high = low + contact * bin_width;
        const double volume = 4 * pi / 3 * (std::pow(high, 3) - std::pow(low, 3));
        for (int drawn = 0; drawn < n_drawn; ++drawn) {
          const double r = std::cbrt(std::pow(low, 3) +
                                     (std::pow(high, 3) - std::pow(low, 3)) * random.uniform());
          const double slope = 2 * random.uniform() - 1, turned = 2 * pi * random.uniform(),
                       across = std::sqrt(1 - slope * slope);
          const Vec3 point =
              centre + r * Vec3{across * std::cos(turned), across * std::sin(turned), slope};
          if (point.z < radius || point.z > radius + height ||
              !in_footprint(boundary, point, radius))
            continue;
          expected[packing.sizes->kind(i) + packing.sizes->kind(j)][k] +=
              n * volume / (n_drawn * region);
        }
      }
    }
  }
  return expected;
}

}  // namespace

TEST_CASE("Expected partial pairs between sides are an integral over all pairs", "[statistics]") {
  const auto container = GENERATE(values<Container>(
      {WalledBox{7, 6}, WalledBox{3, 9}, Cylinder{7}, Cylinder{4}, Plates{11, 5}}));
  const bool is_drawn = GENERATE(false, true);
  CAPTURE(container.index(), width_x(container), is_drawn);
  RandomStream random(stream_key(3, 0, 0, Purpose::start));
  Packing packing = mixed_points(container, fluid_sizes(is_drawn, random), 14, random);
  // Crowded at the sides: more so than evenly spread spheres by a power of the place.
  const Boundary boundary(container);
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    Vec3& r = packing.centres[i];
    const auto crowd = [&](double& place, double width) {
      const double half = half_width(width, packing.radius(i)), from = (place - 0.5 * width) / half;
      place = 0.5 * width + half * (from < 0 ? -1 : 1) * std::pow(std::abs(from), 0.6);
    };
    if (boundary.planes_x()) crowd(r.x, boundary.width_x);
    if (boundary.planes_y()) crowd(r.y, boundary.width_y);
  }
  const HeightWindow heights{2, 11};
  const auto all =
      partial_correlations(packing, {.r_max = 3, .bin_width = bin_width, .heights = heights});
  // All spheres are as near to the window as the largest distance.
  const BruteForce found = expected_by_brute_force(packing, {heights.low, heights.high});
  REQUIRE(all.size() == 3);
  for (std::size_t pair = 0; pair < 3; ++pair) {
    for (std::size_t k = 0; k < n_bins; ++k) {
      CAPTURE(pair, k, found.mean[pair][k], found.error[pair][k]);
      CHECK(std::abs(all[pair].expected[k] - found.mean[pair][k]) <=
            4 * found.error[pair][k] + 2e-3 * found.mean[pair][k]);
      CHECK(found.error[pair][k] < 0.05 * found.mean[pair][k]);
    }
  }
}

TEST_CASE("partial g(r) of a fluid between sides is that of shells integrated by random points",
          "[statistics]") {
  const auto container =
      GENERATE(values<Container>({WalledBox{12, 12}, Cylinder{13}, Plates{12, 10}}));
  CAPTURE(container.index());
  constexpr double height = 9;
  const HeightWindow heights{2, 8};
  RandomStream random(stream_key(4, 0, 0, Purpose::start));
  Bins counts{}, expected{}, brute_force{};
  for (int i = 0; i < 200; ++i) {
    MixedSizes sizes;
    sizes.add(1, 20, 1.6);  // few: hard spheres then crowd nowhere
    sizes.add(0, 60, 0.8);
    const Packing packing = mixed_points(container, sizes, height, random, true);
    const Bins by_points = brief_normalisation(packing, heights, height, random);
    const auto all =
        partial_correlations(packing, {.r_max = 3, .bin_width = bin_width, .heights = heights});
    for (std::size_t pair = 0; pair < 3; ++pair) {
      for (std::size_t k = 0; k < n_bins; ++k) {
        counts[pair][k] += static_cast<double>(all[pair].counts[k]);
        expected[pair][k] += all[pair].expected[k];
        brute_force[pair][k] += by_points[pair][k];
      }
    }
  }
  for (std::size_t pair = 0; pair < 3; ++pair) {
    for (std::size_t k = 2; k < n_bins; ++k) {
      CAPTURE(pair, k, counts[pair][k]);
      CHECK(counts[pair][k] / expected[pair][k] ==
            Approx(counts[pair][k] / brute_force[pair][k]).epsilon(0.04));
    }
    CHECK(counts[pair][0] == 0);  // hard
    CHECK(counts[pair][5] / expected[pair][5] == Approx(1).epsilon(0.1));
  }
}

TEST_CASE("A lattice of two kinds between walls has its neighbours") {
  // CsCl: large spheres at the corners of cubes, small ones in their middles, n of each row
  // between walls that the large ones touch.
  constexpr int n = 8, n_layers = 12;
  constexpr double cell = 1.5, large = 1.3, small = 0.9;
  const auto lattice = [&](const Container& container) {
    const int n_middle = Boundary(container).has_walls() ? n - 1 : n;
    Packing packing{container, {}};
    MixedSizes sizes;
    for (int layer = 0; layer < n_layers; ++layer) {
      for (int i = 0; i < n * n; ++i) {
        const Vec3 corner{0.5 * large + cell * (i % n), 0.5 * large + cell * (i / n),
                          0.5 * large + cell * layer};
        packing.centres.push_back(corner);
        sizes.add(0, 1, large);
        if (i % n >= n_middle || i / n >= n_middle || layer == n_layers - 1) continue;
        packing.centres.push_back(corner + 0.5 * cell * Vec3{1, 1, 1});
        sizes.add(1, 1, small);
      }
    }
    packing.sizes = sizes.sizes();
    return packing;
  };
  const double width = large + cell * (n - 1);
  const Packing packing = lattice(WalledBox{width, width});
  const auto all = partial_correlations(
      packing, {.r_max = 2, .bin_width = 0.04, .heights = HeightWindow{-1, 100}});
  const auto count = [&](std::size_t pair, double distance) {
    const double x = pair == 0   ? distance / large
                     : pair == 1 ? 2 * distance / (large + small)
                                 : distance / small;
    return static_cast<double>(all[pair].counts[static_cast<std::size_t>(x / 0.04)]);
  };
  constexpr double n_small = (n - 1) * (n - 1) * (n_layers - 1);
  CHECK(count(1, cell * std::sqrt(0.75)) == 2 * 8 * n_small);
  CHECK(count(0, cell) == 2 * (2 * n * (n - 1) * n_layers + n * n * (n_layers - 1)));
  CHECK(count(2, cell) ==
        2 * (2 * (n - 1) * (n - 2) * (n_layers - 1) + (n - 1) * (n - 1) * (n_layers - 2)));
  // In the middle of the heights g is that of the lattice between periodic sides.
  const PairCorrelationSettings middle{
      .r_max = 2, .bin_width = 0.04, .heights = HeightWindow{5, 12}};
  const auto bulk = partial_correlations(packing, middle);
  const auto periodic = partial_correlations(lattice(PeriodicBox{n * cell, n * cell}), middle);
  for (std::size_t pair = 0; pair < 3; ++pair) {
    for (std::size_t k = 0; k < 50; ++k) {
      if (periodic[pair].expected[k] == 0) continue;  // no layers so near each other
      CAPTURE(pair, k);
      CHECK(bulk[pair].g()[k] == Approx(periodic[pair].g()[k]).epsilon(0.07));
    }
  }
}
