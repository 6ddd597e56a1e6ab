#include "structure/order/pair_correlation.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/bed/boundary.hpp"
#include "engine/bed/slab.hpp"
#include "engine/numbers.hpp"
#include "structure/order/accessible.hpp"
#include "structure/order/height_pairs.hpp"
#include "structure/order/neighbours.hpp"
#include "structure/order/whole_shells.hpp"

namespace jostle::inline structure {
namespace {

constexpr double least_share = 0.25;  // least share of central spheres that can make a displacement

struct Heights {
  HeightWindow centres;     // centres of central spheres
  HeightWindow accessible;  // true for centres that shells reach
  HeightWindow all;         // all centres that may be partners
};

Heights heights_of(const Packing& packing, const PairCorrelationSettings& settings) {
  const HeightWindow centres = settings.heights.value_or(bulk_heights(packing, settings.r_max));
  if (!(centres.low <= centres.high)) {
    throw std::invalid_argument(
        "g(r): the heights of the central spheres are empty: " + std::to_string(centres.low) +
        " to " + std::to_string(centres.high));
  }
  const Boundary boundary(packing.container);
  if (boundary.periodic_z) {
    if (centres.low < 0 || centres.high > boundary.height) {
      throw std::invalid_argument("g(r): the heights must lie within the box: 0 to " +
                                  std::to_string(boundary.height));
    }
    return {centres, {0, boundary.height}, {0, boundary.height}};
  }
  const HeightWindow all = accessible_heights(packing);
  const Heights heights{{std::max(centres.low, all.low), std::min(centres.high, all.high)},
                        {std::max(all.low, centres.low - settings.r_max),
                         std::min(all.high, centres.high + settings.r_max)},
                        all};
  constexpr double least_depth = 1.1;
  if (heights.accessible.high - heights.accessible.low < least_depth) {
    throw std::invalid_argument("g(r): centres lie between the heights " + std::to_string(all.low) +
                                " and " + std::to_string(all.high) +
                                ": too few layers for shells and their density");
  }
  return heights;
}

void require_room(const Packing& packing, const AccessibleFootprint& footprint) {
  constexpr double least_area = 0.01;
  if (footprint.area() >= least_area) return;
  throw std::invalid_argument(
      "g(r): the container is " + std::to_string(width_x(packing.container)) + " x " +
      std::to_string(width_y(packing.container)) + " wide: centres have no room beside each other");
}

/// The accessible footprint: the mean of slabs that grow from the central spheres' heights to
/// half a diameter inside the accessible ones.
double number_density(const Packing& packing, const Heights& heights,
                      const AccessibleFootprint& footprint) {
  const Boundary boundary(packing.container);
  if (boundary.periodic_z) {
    return static_cast<double>(packing.centres.size()) / (footprint.area() * boundary.height);
  }
  const HeightWindow outer{heights.accessible.low + sphere_radius,
                           heights.accessible.high - sphere_radius};
  const HeightWindow inner{std::clamp(heights.centres.low, outer.low, outer.high),
                           std::clamp(heights.centres.high, outer.low, outer.high)};
  constexpr int n_slabs = 32;
  double solid = 0, depth = 0;
  for (int k = 0; k < n_slabs; ++k) {
    const double grown = (k + 0.5) / n_slabs;
    const double low = inner.low + grown * (outer.low - inner.low);
    const double high = inner.high + grown * (outer.high - inner.high);
    depth += high - low;
    for (const Vec3& r : packing.centres) solid += sphere_volume_in_slab(r.z, low, high);
  }
  return solid / (sphere_volume * footprint.area() * depth);
}

std::vector<Vec3> centres_in(const std::vector<Vec3>& centres, HeightWindow heights) {
  std::vector<Vec3> found;
  std::ranges::copy_if(centres, std::back_inserter(found),
                       [&](const Vec3& r) { return r.z >= heights.low && r.z <= heights.high; });
  return found;
}

/// How much of the accessible region displacements can use, and how many pairs an uncorrelated
/// packing has there.
class Displacements {
 public:
  Displacements(const Packing& packing, const Heights& heights, double r_max)
      : footprint_(packing),
        heights_(heights.all),
        central_(centres_in(packing.centres, heights.centres)),
        sampled_(centres_in(packing.centres, heights.accessible)),
        shares_(footprint_, sampled_, r_max) {
    const Boundary boundary(packing.container);
    if (boundary.periodic_z) {
      half_height_ = 0.5 * boundary.height * (1 + 1e-9);
      pairs_per_height_ =
          static_cast<double>(central_.size() * (packing.centres.size() - 1)) / boundary.height;
      return;
    }
    std::vector<double> z, partners;
    for (const Vec3& r : central_) z.push_back(r.z);
    for (const Vec3& r : centres_in(packing.centres, heights.all)) partners.push_back(r.z);
    std::ranges::sort(z);
    upright_ = shares_inside(z, heights.accessible.low, heights.accessible.high, r_max);
    uncorrelated_ = HeightPairs(z, partners, heights.all, r_max);
  }

  struct Use {
    double even_share = 0;   // share of central spheres with that place in the region, evenly
                             // spread spheres counted along
    double grown_share = 0;  // the share for a region grown beyond floor and surface
    double pairs = 0;        // per volume of displacements, of an uncorrelated packing
  };
  Use operator()(Vec3 way) const {
    if (half_height_ > 0 && std::abs(way.z) > half_height_) return {};
    const double overlap = footprint_.overlap(way.x, way.y);
    if (overlap <= 0) return {};
    const auto n = static_cast<double>(sampled_.size());
    const double share = evened(shares_(way.x, way.y, overlap), n, overlap);
    if (half_height_ > 0) return {share, share, share * pairs_per_height_ / footprint_.area()};
    return {upright_(way.z) * share, uncorrelated_.share(way.z) * share,
            uncorrelated_.density(way.z) * share / footprint_.area()};
  }

  /// The weight of a pair: 1 over the share of central spheres in the grown region, and over the
  /// density of the partners there relative to the mean, as the other spheres give them.
  double weight(Vec3 way, Vec3 start, Vec3 end) const {
    const double overlap = footprint_.overlap(way.x, way.y);
    const double height_weight = half_height_ > 0 ? 1 : uncorrelated_.share(way.z);
    const double n = std::max(0.0, static_cast<double>(sampled_.size()) - 2);
    const double share =
        evened(shares_.without_pair(way.x, way.y, overlap, end.x, end.y), n, overlap);
    const double crowding =
        evened(shares_.without_pair(-way.x, -way.y, overlap, start.x, start.y), n, overlap) /
        overlap;
    return 1 / (std::max(height_weight * share, least_share) * crowding);
  }

  /// True for a displacement that can lead from a centre to another in the region, from side to
  /// side as well; periods admit half of them.
  bool is_possible(Vec3 way) const {
    constexpr double inwards = 1 - 1e-12;  // rounding of centres at opposite sides
    if (half_height_ > 0 && std::abs(way.z) > half_height_) return false;
    return footprint_.overlap(inwards * way.x, inwards * way.y) > 0;
  }

  /// Share of the central spheres that have that place in the region, not evened.
  double share(Vec3 way) const {
    constexpr std::size_t few = 300;
    const double overlap = footprint_.overlap(way.x, way.y);
    if (overlap <= 0) return 0;
    if (half_height_ > 0) {
      return std::abs(way.z) > half_height_ ? 0 : shares_(way.x, way.y, overlap);
    }
    if (central_.size() > few) return upright_(way.z) * shares_(way.x, way.y, overlap);
    constexpr double edge = StepTable::step;
    const auto inside = std::ranges::count_if(central_, [&](const Vec3& r) {
      const double z = r.z + way.z;
      return z >= heights_.low - edge && z <= heights_.high + edge &&
             footprint_.depth(r.x + way.x, r.y + way.y) >= -edge;
    });
    return static_cast<double>(inside) / static_cast<double>(central_.size());
  }

  const AccessibleFootprint& footprint() const { return footprint_; }

 private:
  /// Shares of few spheres scatter: some that are evenly spread are counted along.
  static double evened(double share, double n, double overlap) {
    constexpr double evenly_spread = 20;
    return (n * share + evenly_spread * overlap) / (n + evenly_spread);
  }

  AccessibleFootprint footprint_;
  HeightWindow heights_;
  std::vector<Vec3> central_, sampled_;
  FootprintShares shares_;
  StepTable upright_;
  HeightPairs uncorrelated_;
  double half_height_ = 0,
         pairs_per_height_ = 0;  // half the height of a box that is periodic upwards
};

double shell_volume(double low, double high) {
  return 4 * std::numbers::pi / 3 * (high * high * high - low * low * low);
}

struct Shell {
  double sampled = 0;   // part of it, in [0, 1]
  double expected = 0;  // pairs of an uncorrelated packing, weighted as those found
};

Shell shell_of(const Displacements& displacements, const std::vector<Vec3>& directions, double low,
               double high) {
  constexpr double thickest = 0.05;
  const int n = static_cast<int>(std::ceil((high - low) / thickest - 1e-9));
  Shell cut;
  for (int k = 0; k < n; ++k) {
    const double inner = low + (high - low) * k / n, outer = low + (high - low) * (k + 1) / n;
    const double volume = shell_volume(inner, outer) / static_cast<double>(directions.size());
    for (const Vec3& direction : directions) {
      const Displacements::Use use = displacements(0.5 * (inner + outer) * direction);
      cut.sampled += volume * std::min(1.0, use.even_share / least_share);
      cut.expected += volume * use.pairs / std::max(use.grown_share, least_share);
    }
  }
  cut.sampled /= shell_volume(low, high);
  return cut;
}

void count_pairs(const Packing& packing, const Heights& heights, const Displacements& displacements,
                 const WholeShells& whole, PairCorrelation& pairs) {
  constexpr double early = 1e-9, edge = 1e-9;
  const std::size_t n_bins = pairs.r.size();
  const NeighbourFinder finder(packing, static_cast<double>(n_bins) * pairs.bin_width);
  const double bins_per_length = 1 / pairs.bin_width;
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    const Vec3 start = packing.centres[i];
    if (start.z < heights.centres.low || start.z > heights.centres.high) continue;
    ++pairs.n_centres;
    const double room = whole.room(start);
    finder.visit_neighbours(i, [&](std::uint32_t j, Vec3 way, double distance_squared) {
      const double height = packing.centres[j].z;
      if (j == i || height < heights.all.low - edge || height > heights.all.high + edge) return;
      const double distance = std::sqrt(distance_squared);
      const auto bin = static_cast<std::size_t>(distance * bins_per_length + early);
      if (bin >= n_bins) return;
      if (!displacements.is_possible(way)) return;
      ++pairs.counts[bin];
      const double share = displacements.share(way);
      if (share <= 0) return;
      const double high = static_cast<double>(bin + 1) * pairs.bin_width;
      if (whole.exceeds_half_period(high)) {
        pairs.neighbours[bin] += 1 / std::max(share, least_share);
      } else if (distance <= room) {
        pairs.neighbours[bin] +=
            static_cast<double>(whole.count(high)) / static_cast<double>(whole.count(distance));
      }
      pairs.found[bin] += displacements.weight(way, start, packing.centres[j]);
    });
  }
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
  const double widest = narrowest_period(Boundary(container)) / 2;
  return std::min(std::floor(widest / tenth + 1e-9) * tenth, usual);
}

HeightWindow bulk_heights(const Packing& packing, double r_max) {
  if (const Boundary boundary(packing.container); boundary.periodic_z) {
    return {0, boundary.height};
  }
  const double floor = sphere_radius, surface = 2 * mean_height(packing);
  const double cut = std::min(r_max, (surface - floor) / 4);
  const HeightWindow bulk{floor + cut, surface - cut};
  return centres_in(packing.centres, bulk).empty() ? HeightWindow{floor, surface} : bulk;
}

std::vector<double> PairCorrelation::g() const {
  std::vector<double> values(counts.size());
  for (std::size_t k = 0; k < counts.size(); ++k) values[k] = found[k] / expected[k];
  return values;
}

std::vector<double> PairCorrelation::running_neighbours() const {
  std::vector<double> values(counts.size());
  double sum = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    sum += shells[k] > 0 ? neighbours[k] / shells[k] : not_a_number;
    values[k] = sum;
  }
  return values;
}

PairCorrelation& PairCorrelation::operator+=(const PairCorrelation& rhs) {
  assert(rhs.counts.size() == counts.size() && rhs.bin_width == bin_width);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    counts[k] += rhs.counts[k];
    neighbours[k] += rhs.neighbours[k];
    found[k] += rhs.found[k];
    expected[k] += rhs.expected[k];
    shells[k] += rhs.shells[k];
  }
  const auto own = static_cast<double>(n_centres), n_others = static_cast<double>(rhs.n_centres);
  if (rhs.n_centres > 0) density = (own * density + n_others * rhs.density) / (own + n_others);
  n_centres += rhs.n_centres;
  return *this;
}

PairCorrelation pair_correlation(const Packing& packing, const PairCorrelationSettings& settings) {
  assert(settings.bin_width > 0 && settings.r_max >= settings.bin_width);
  assert(!packing.centres.empty());
  const Heights heights = heights_of(packing, settings);
  const auto n_bins = static_cast<std::size_t>(settings.r_max / settings.bin_width + 1e-9);
  const Displacements displacements(packing, heights, settings.r_max + settings.bin_width);
  require_room(packing, displacements.footprint());
  PairCorrelation pairs;
  pairs.bin_width = settings.bin_width;
  pairs.density = number_density(packing, heights, displacements.footprint());
  pairs.counts.assign(n_bins, 0);
  pairs.neighbours.assign(n_bins, 0);
  pairs.found.assign(n_bins, 0);
  for (std::size_t k = 0; k < n_bins; ++k) {
    pairs.r.push_back((static_cast<double>(k) + 0.5) * settings.bin_width);
  }
  const WholeShells whole(packing, displacements.footprint(), heights.centres, heights.all);
  pairs.widest_shell = whole.widest();
  count_pairs(packing, heights, displacements, whole, pairs);
  const std::vector<Vec3> all_directions = even_directions(2000);
  for (std::size_t k = 0; k < n_bins; ++k) {
    const double low = static_cast<double>(k) * settings.bin_width, high = low + settings.bin_width;
    const Shell cut =
        pairs.n_centres > 0 ? shell_of(displacements, all_directions, low, high) : Shell{};
    if (whole.exceeds_sides(high)) {
      pairs.shells.push_back(0);
    } else if (!whole.exceeds_half_period(high)) {
      pairs.shells.push_back(static_cast<double>(whole.count(high)));
    } else {
      const double centres =
          whole.count_upright(high) > 0 ? static_cast<double>(pairs.n_centres) : 0;
      pairs.shells.push_back(centres * cut.sampled);
    }
    pairs.expected.push_back(cut.expected);
  }
  return pairs;
}

double contact_value(const PairCorrelation& pairs, double reach) {
  CubicFit fit;
  int n_bins = 0;
  for (std::size_t k = 0; k < pairs.r.size(); ++k) {
    const double half = 0.5 * pairs.bin_width, slack = 1e-6 * pairs.bin_width;
    if (pairs.r[k] - half < 1 - slack || pairs.r[k] + half > 1 + reach + slack) continue;
    const double g = pairs.found[k] / pairs.expected[k];
    fit.add((pairs.r[k] - 1) / reach, g, pairs.expected[k]);
    ++n_bins;
  }
  return n_bins < 4 ? std::numeric_limits<double>::quiet_NaN() : fit.constant();
}

}  // namespace jostle::inline structure
