#include "structure/order/pair_correlation.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "structure/order/neighbours.hpp"

namespace jostle::inline structure {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Heights where centres may be.
HeightWindow centre_heights(const Packing& packing) {
  if (!Boundary(packing.container).floor) return {-infinite, infinite};
  return {sphere_radius, top_height(packing)};
}

// Half of a ball, cut at a distance from its middle.
double half_ball_volume(double radius, double cut) {
  if (cut >= radius) return 2 * std::numbers::pi / 3 * radius * radius * radius;
  cut = std::max(cut, 0.0);
  return std::numbers::pi * cut * (radius * radius - cut * cut / 3);
}

double narrowest_period(const Boundary& boundary) {
  const Vec3 periods = boundary.periods();
  double narrowest = infinite;
  for (const double period : {periods.x, periods.y, periods.z}) {
    if (period > 0) narrowest = std::min(narrowest, period);
  }
  return narrowest;
}

void check(const Packing& packing, const Region& region, double r_max) {
  const Boundary boundary(packing.container);
  if (r_max > 0.5 * narrowest_period(boundary)) {
    throw std::invalid_argument(
        "g(r): r_max is more than half a period of the box, where images repeat: take a smaller "
        "r_max");
  }
  if (boundary.has_walls() && region.from_sides < r_max + sphere_radius) {
    throw std::invalid_argument(
        "g(r): shells of r_max reach the walls: keep the region r_max + 1/2 away from them");
  }
  if (boundary.periodic_z && (region.low < 0 || region.high > boundary.height)) {
    throw std::invalid_argument("g(r): the region must lie within the box: heights 0 to its own");
  }
  if (region.high <= region.low || region.volume(packing.container) <= 0) {
    throw std::invalid_argument(
        "g(r): the region of the central spheres is empty: take a smaller r_max or another region");
  }
}

double number_density(const Packing& packing, const Region& region) {
  const HeightWindow heights = centre_heights(packing);
  const Region slab{std::max(region.low, heights.low + sphere_radius),
                    std::min(region.high, heights.high - sphere_radius), region.from_sides};
  if (slab.high <= slab.low) {
    throw std::invalid_argument("g(r): the region lies outside the heights of the bed");
  }
  const Boundary boundary(packing.container);
  const Region column{-infinite, infinite, region.from_sides};
  double solid = 0;
  for (const Vec3& r : packing.centres) {
    if (!column.contains(packing.container, r)) continue;
    solid += sphere_volume_in_slab(r.z, slab.low, slab.high);
    if (boundary.periodic_z) {
      solid += sphere_volume_in_slab(r.z - boundary.height, slab.low, slab.high) +
               sphere_volume_in_slab(r.z + boundary.height, slab.low, slab.high);
    }
  }
  return solid / (sphere_volume * slab.volume(packing.container));
}

// The constant of the cubic through g at x = (r - 1) / reach, least squares with weights.
class CubicFit {
 public:
  void add(double x, double g, double weight) {
    const std::array<double, 4> powers{1, x, x * x, x * x * x};
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) rows_[a][b] += weight * powers[a] * powers[b];
      rows_[a][4] += weight * powers[a] * g;
    }
  }

  // Elimination from the highest power down; the equations are positive definite.
  double constant() const {
    auto rows = rows_;
    for (std::size_t pivot = 3; pivot > 0; --pivot) {
      for (std::size_t row = 0; row < pivot; ++row) {
        const double factor = rows[row][pivot] / rows[pivot][pivot];
        for (std::size_t k = 0; k < 5; ++k) rows[row][k] -= factor * rows[pivot][k];
      }
    }
    return rows[0][4] / rows[0][0];
  }

 private:
  std::array<std::array<double, 5>, 4> rows_{};
};

}  // namespace

double widest_pairs(const Container& container) {
  constexpr double usual = 4, tenth = 0.1;
  const Boundary boundary(container);
  const double across = std::min(boundary.width_x, boundary.width_y);
  const double widest =
      boundary.has_walls() ? across / 2 - sphere_radius - 0.5 : narrowest_period(boundary) / 2;
  return std::clamp(std::floor(widest / tenth + 1e-9) * tenth, 1.0, usual);
}

Region bulk_region(const Packing& packing, double r_max) {
  if (const Boundary boundary(packing.container); boundary.periodic_z) {
    return {0, boundary.height, 0};
  }
  const double floor = sphere_radius, surface = 2 * mean_height(packing);
  const double depth = surface - floor;
  return {floor + std::min(r_max, depth / 4), surface - std::min(r_max, depth / 4),
          r_max + sphere_radius};
}

std::vector<double> PairCorrelation::g() const {
  std::vector<double> values(counts.size());
  for (std::size_t k = 0; k < counts.size(); ++k) {
    values[k] = static_cast<double>(counts[k]) / expected[k];
  }
  return values;
}

PairCorrelation& PairCorrelation::operator+=(const PairCorrelation& other) {
  assert(other.counts.size() == counts.size() && other.bin_width == bin_width);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    counts[k] += other.counts[k];
    expected[k] += other.expected[k];
  }
  const auto own = static_cast<double>(n_centres), others = static_cast<double>(other.n_centres);
  if (other.n_centres > 0) density = (own * density + others * other.density) / (own + others);
  n_centres += other.n_centres;
  return *this;
}

PairCorrelation pair_correlation(const Packing& packing, const PairCorrelationSettings& settings) {
  assert(settings.bin_width > 0 && settings.r_max >= settings.bin_width);
  assert(!packing.centres.empty());
  const Region region = settings.region.value_or(bulk_region(packing, settings.r_max));
  check(packing, region, settings.r_max);
  constexpr double early = 1e-9;
  const auto n_bins = static_cast<std::size_t>(settings.r_max / settings.bin_width + early);
  PairCorrelation pairs;
  pairs.bin_width = settings.bin_width;
  pairs.counts.assign(n_bins + 1, 0);  // and one beyond
  pairs.expected.assign(n_bins, 0);
  pairs.density = number_density(packing, region);
  for (std::size_t k = 0; k < n_bins; ++k) {
    pairs.r.push_back((static_cast<double>(k) + 0.5) * settings.bin_width);
  }

  const HeightWindow heights = centre_heights(packing);
  const NeighbourFinder finder(packing, static_cast<double>(n_bins) * settings.bin_width);
  const double bins_per_length = 1 / settings.bin_width;
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    const Vec3 centre = packing.centres[i];
    if (!region.contains(packing.container, centre)) continue;
    ++pairs.n_centres;
    finder.around(i, [&](std::uint32_t, Vec3, double distance_squared) {
      const double place = std::sqrt(distance_squared) * bins_per_length + early;
      ++pairs.counts[std::min(static_cast<std::size_t>(place), n_bins)];
    });
    double inner = 0;
    for (std::size_t k = 0; k < n_bins; ++k) {
      const double radius = static_cast<double>(k + 1) * settings.bin_width;
      const double ball = half_ball_volume(radius, centre.z - heights.low) +
                          half_ball_volume(radius, heights.high - centre.z);
      pairs.expected[k] += pairs.density * (ball - inner);
      inner = ball;
    }
  }
  pairs.counts.pop_back();
  return pairs;
}

double contact_value(const PairCorrelation& pairs, double reach) {
  CubicFit fit;
  int n_bins = 0;
  for (std::size_t k = 0; k < pairs.r.size(); ++k) {
    const double half = 0.5 * pairs.bin_width, slack = 1e-6 * pairs.bin_width;
    if (pairs.r[k] - half < 1 - slack || pairs.r[k] + half > 1 + reach + slack) continue;
    const double g = static_cast<double>(pairs.counts[k]) / pairs.expected[k];
    fit.add((pairs.r[k] - 1) / reach, g, pairs.expected[k]);
    ++n_bins;
  }
  return n_bins < 4 ? std::numeric_limits<double>::quiet_NaN() : fit.constant();
}

}  // namespace jostle::inline structure
