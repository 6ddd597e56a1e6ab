#include "engine/direction_bins.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "engine/elementary.hpp"
#include "engine/theta_table.hpp"
#include "engine/vec3.hpp"

namespace jostle {

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
  const double along = static_cast<double>(bits & rest) / static_cast<double>(rest + 1);
  return table[node] + (table[node + 1] - table[node]) * along;
}

SineCosine azimuth_angle(double sectors) {
  return doubled(doubled(sine_cosine(quarter_pi * (sectors * (2.0 / n_sectors) - 1))));
}

Vec3 along_meridian(SineCosine theta, SineCosine azimuth) {
  return {theta.sine * azimuth.cosine, theta.sine * azimuth.sine, theta.cosine};
}

// The middle of a ring's bins, the direction nearest to its farthest corner, and cos(alpha).
struct BinShape {
  SineCosine theta{0, 1};
  double cos_alpha = -1;
};

BinShape bin_shape(SineCosine inner, SineCosine outer) {
  const SineCosine half_sector = doubled(doubled(sine_cosine(quarter_pi / n_sectors)));
  const Vec3 near = along_meridian(inner, half_sector), far = along_meridian(outer, half_sector);
  constexpr int choices = 64;
  BinShape best;
  for (int k = 0; k <= choices; ++k) {
    const double share = static_cast<double>(k) / choices;
    const double across = share * outer.sine + (1 - share) * inner.sine;
    const double down = share * outer.cosine + (1 - share) * inner.cosine;
    const double norm = std::sqrt(across * across + down * down);
    const SineCosine theta{across / norm, down / norm};
    const Vec3 middle = along_meridian(theta, {0, 1});
    const double cos_alpha = std::min(dot(middle, near), dot(middle, far));
    if (cos_alpha > best.cos_alpha) best = {theta, cos_alpha};
  }
  return best;
}

DirectionBins bins_between(const RingEdges& edges) {
  DirectionBins bins{};
  for (int p = 0; p < n_sectors; ++p) {
    const SineCosine azimuth = azimuth_angle(p + 0.5);
    bins.cosine[p] = static_cast<float>(azimuth.cosine);
    bins.sine[p] = static_cast<float>(azimuth.sine);
  }
  for (int k = 0; k < n_rings; ++k) {
    const bool ascending = edges[k].sine < edges[k + 1].sine;
    const BinShape shape =
        ascending ? bin_shape(edges[k], edges[k + 1]) : bin_shape(edges[k + 1], edges[k]);
    const double sin_alpha = std::sqrt(std::max(0.0, 1 - shape.cos_alpha * shape.cos_alpha));
    bins.across[k] = static_cast<float>(shape.theta.sine * shape.cos_alpha);
    bins.down[k] = static_cast<float>(shape.theta.cosine * shape.cos_alpha);
    bins.spread[k] = static_cast<float>(sin_alpha + 1e-6);
  }
  return bins;
}

// The probability of a direction beyond the rings before k.
constexpr double ring_edge(int k) {
  int parts = 0;
  for (int before = 0; before < k; ++before) parts += ring_parts[before];
  return static_cast<double>(parts) / n_ring_parts;
}

constexpr auto ring_edges = [] {
  std::array<double, n_rings + 1> edges{};
  for (int k = 0; k <= n_rings; ++k) edges[k] = ring_edge(k);
  return edges;
}();

double within_ring(int k, double u) {
  return ring_edges[k] + ring_parts[k] * (1.0 / n_ring_parts) * u;
}

// The least modulus of a cosine or sine, given at both ends of a stretch within one quadrant.
double least_modulus(double a, double b) {
  return std::min(std::abs(a), std::abs(b));
}

}  // namespace

DirectionBins polar_bins(const std::vector<double>& theta_table, double max_step) {
  RingEdges edges;
  for (int k = 0; k <= n_rings; ++k) {
    edges[k] = doubled(sine_cosine(half_theta(theta_table, ring_edge(k))));
  }
  DirectionBins bins = bins_between(edges);
  bins.longest = max_step;
  for (auto& ring : bins.cap) std::fill(std::begin(ring), std::end(ring), whole_weight);
  return bins;
}

DirectionBins cubic_bins(double step) {
  RingEdges edges;
  for (int k = 0; k <= n_rings; ++k) {
    const double cosine = ring_edge(k);
    edges[k] = {std::sqrt(1 - cosine * cosine), cosine};
  }
  DirectionBins bins = bins_between(edges);
  bins.longest = 1.7320508075688773 * step * 1.000001;
  for (int k = 0; k < n_rings; ++k) {
    for (int p = 0; p < n_sectors; ++p) {
      const SineCosine begin = azimuth_angle(p), end = azimuth_angle(p + 1);
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
  return doubled(sine_cosine(half_theta(theta_table, within_ring(ring, u))));
}

SineCosine cubic_angle(int ring, double u) {
  const double cosine = within_ring(ring, u);
  return {std::sqrt(1 - cosine * cosine), cosine};
}

SineCosine sector_begin(int sector) {
  return azimuth_angle(sector);
}

}  // namespace jostle
