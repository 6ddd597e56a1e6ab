#include "engine/monte_carlo/rejection_free/direction_bins.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "engine/bed/elementary.hpp"
#include "engine/bed/vec3.hpp"
#include "engine/monte_carlo/theta_table.hpp"

namespace jostle::inline engine {

namespace {

constexpr double quarter_pi = 0.78539816339744830962;

// Angle from the downward vertical.
using RingEdges = std::array<SineCosine, n_rings + 1>;

// theta / 2 against the probability of a larger angle, as the proposals interpolate it.
double half_theta(const std::vector<double>& table, double probability) {
  const double v = std::max(probability, 0x1p-33);
  if (v >= 1) return table.back();
  constexpr std::uint64_t rest = (std::uint64_t{1} << theta_table::shift) - 1;
  const auto bits = std::bit_cast<std::uint64_t>(v);
  const std::size_t node = (bits >> theta_table::shift) - theta_table::first;
  const double share_along = static_cast<double>(bits & rest) / static_cast<double>(rest + 1);
  return table[node] + (table[node + 1] - table[node]) * share_along;
}

SineCosine azimuth_angle(double share) {
  return doubled(doubled(sine_cosine(quarter_pi * (2 * share - 1))));
}

Vec3 along_meridian(SineCosine theta, SineCosine azimuth) {
  return {theta.sine * azimuth.cosine, theta.sine * azimuth.sine, theta.cosine};
}

// The shares of the rings and the probability of a direction beyond the rings before each.
struct RingShares {
  std::array<int, n_rings> parts;
  std::array<double, n_rings + 1> edges{};

  constexpr explicit RingShares(const std::array<int, n_rings>& ring_parts) : parts(ring_parts) {
    int sum = 0;
    for (int k = 0; k < n_rings; ++k) {
      sum += parts[k];
      edges[k + 1] = static_cast<double>(sum) / n_ring_parts;
    }
  }
  constexpr double interpolated(int k, double u) const {
    return edges[k] + (edges[k + 1] - edges[k]) * u;
  }
};

// Few polar steps are nearly horizontal, but their bounds are the loosest.
constexpr RingShares polar_rings({1, 3, 6, 10, 16, 24, 32, 36});
constexpr RingShares cubic_rings({8, 8, 12, 16, 16, 20, 28, 20});
static_assert(polar_rings.edges[n_rings] == 1 && cubic_rings.edges[n_rings] == 1);

// The middle of a ring's bins, the direction nearest to its farthest corner, and cos(alpha).
struct BinShape {
  SineCosine theta{0, 1};
  double cos_alpha = -1;
};

BinShape bin_shape(SineCosine inner, SineCosine outer, SineCosine half_sector) {
  const Vec3 near = along_meridian(inner, half_sector), far = along_meridian(outer, half_sector);
  constexpr int choices = 64;
  BinShape best;
  for (int k = 0; k <= choices; ++k) {
    const double share = static_cast<double>(k) / choices;
    const double across = share * outer.sine + (1 - share) * inner.sine;
    const double vertical = share * outer.cosine + (1 - share) * inner.cosine;
    const double norm = std::sqrt(across * across + vertical * vertical);
    const SineCosine theta{across / norm, vertical / norm};
    const Vec3 middle = along_meridian(theta, {0, 1});
    const double cos_alpha = std::min(dot(middle, near), dot(middle, far));
    if (cos_alpha > best.cos_alpha) best = {theta, cos_alpha};
  }
  return best;
}

template <int n_sectors>
DirectionBins<n_sectors> bins_between(const RingEdges& edges, const RingShares& rings) {
  const SineCosine half_sector = doubled(doubled(sine_cosine(quarter_pi / n_sectors)));
  DirectionBins<n_sectors> bins{};
  std::ranges::copy(rings.parts, bins.parts);
  for (int p = 0; p < n_sectors; ++p) {
    const SineCosine azimuth = azimuth_angle((p + 0.5) / n_sectors);
    bins.cosine[p] = static_cast<float>(azimuth.cosine);
    bins.sine[p] = static_cast<float>(azimuth.sine);
  }
  for (int k = 0; k < n_rings; ++k) {
    const bool ascending = edges[k].sine < edges[k + 1].sine;
    const BinShape shape = ascending ? bin_shape(edges[k], edges[k + 1], half_sector)
                                     : bin_shape(edges[k + 1], edges[k], half_sector);
    const double sin_alpha = std::sqrt(std::max(0.0, 1 - shape.cos_alpha * shape.cos_alpha));
    bins.across[k] = static_cast<float>(shape.theta.sine * shape.cos_alpha);
    bins.vertical[k] = static_cast<float>(shape.theta.cosine * shape.cos_alpha);
    bins.spread[k] = static_cast<float>(sin_alpha + 1e-6);
  }
  return bins;
}

// The least modulus of a cosine or sine, given at both ends of a stretch within one quadrant.
double least_modulus(double a, double b) {
  return std::min(std::abs(a), std::abs(b));
}

}  // namespace

DirectionBins<polar_sectors> polar_bins(const std::vector<double>& theta_table, double max_step) {
  RingEdges edges;
  for (int k = 0; k <= n_rings; ++k) {
    edges[k] = doubled(sine_cosine(half_theta(theta_table, polar_rings.edges[k])));
  }
  auto bins = bins_between<polar_sectors>(edges, polar_rings);
  bins.longest = max_step;
  for (auto& ring : bins.cap) std::fill(std::begin(ring), std::end(ring), whole_weight);
  return bins;
}

DirectionBins<cubic_sectors> cubic_bins(double step) {
  RingEdges edges;
  for (int k = 0; k <= n_rings; ++k) {
    const double cosine = cubic_rings.edges[k];
    edges[k] = {std::sqrt(1 - cosine * cosine), cosine};
  }
  auto bins = bins_between<cubic_sectors>(edges, cubic_rings);
  bins.longest = 1.7320508075688773 * step * 1.000001;
  for (int k = 0; k < n_rings; ++k) {
    for (int p = 0; p < cubic_sectors; ++p) {
      const SineCosine begin = sector_begin(p, cubic_sectors);
      const SineCosine end = sector_begin(p + 1, cubic_sectors);
      const double x = edges[k + 1].sine * least_modulus(begin.cosine, end.cosine);
      const double y = edges[k + 1].sine * least_modulus(begin.sine, end.sine);
      const double reach = step / std::max({x, y, edges[k].cosine});
      const double ratio = std::min(1.0, 1.000001 * reach / bins.longest);
      bins.cap[k][p] = static_cast<std::int32_t>(std::ceil(ratio * ratio * ratio * whole_weight));
    }
  }
  return bins;
}

SineCosine polar_angle(const std::vector<double>& theta_table, int ring, double u) {
  return doubled(sine_cosine(half_theta(theta_table, polar_rings.interpolated(ring, u))));
}

SineCosine cubic_angle(int ring, double u) {
  const double cosine = cubic_rings.interpolated(ring, u);
  return {std::sqrt(1 - cosine * cosine), cosine};
}

SineCosine sector_begin(int sector, int n_sectors) {
  return azimuth_angle(static_cast<double>(sector) / n_sectors);
}

}  // namespace jostle::inline engine
