#include "structure/voids/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "structure/order/neighbours.hpp"

namespace jostle::inline structure {

namespace {

/// 1, 2, 3, 4, 6, 8, 12, ...: doublings, and halfway between them.
std::vector<std::uint32_t> sizes(std::uint32_t largest) {
  std::vector<std::uint32_t> all = {1, 2};
  for (std::uint32_t n = 2; n <= largest / 2; n *= 2) {
    all.push_back(n + n / 2);
    all.push_back(2 * n);
  }
  if (const std::uint32_t next = all.back() + all.back() / 2; next <= largest) all.push_back(next);
  while (!all.empty() && all.back() > largest) all.pop_back();
  return all;
}

/// A distance that contains a whole cluster, unless the surface is near.
double reach(const VoronoiCells& cells, std::uint32_t largest) {
  double volume = 0, whole = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.cut[i] != 0) continue;
    volume += cells.volumes[i];
    whole += 1;
  }
  if (whole == 0) return 1;
  return 1.5 * std::cbrt(3 * largest * (volume / whole) / (4 * std::numbers::pi)) + 1;
}

/// Sum over clusters of (V - mean V)^2 is v' A' (1 - 1 1'/m) A v with the matrix A of what cells v
/// the m clusters have: with n cells each its mean is the variance of v times m n - sum of c^2 / m,
/// where a cell is in c clusters.
double independent_variance(const std::vector<std::uint32_t>& members, double n) {
  double sum = 0, squares = 0;
  for (const double c : members) {
    sum += c;
    squares += c * c;
  }
  const double clusters = sum / n;
  const double denominator = clusters * clusters * n - squares;
  return denominator > 0 ? denominator / (clusters * (clusters - 1) * n)
                         : std::numeric_limits<double>::quiet_NaN();
}

/// Variance of single cells, each counted as often as clusters have it: what is to be expected of
/// cells drawn as they are.
double variance_of_members(const std::vector<std::uint32_t>& members, const VoronoiCells& cells) {
  double number = 0, squared_numbers = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const double c = members[i];
    number += c;
    squared_numbers += c * c;
    sum += c * cells.volumes[i] / sphere_volume;
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    const double deviation = cells.volumes[i] / sphere_volume - sum / number;
    squares += members[i] * deviation * deviation;
  }
  const double independent = number - squared_numbers / number;
  return independent > 0 ? squares / independent : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

ClusterVolumes cluster_volumes(const Packing& packing, const VoronoiCells& cells,
                               std::uint32_t largest,
                               const std::function<bool(std::uint32_t)>& is_counted) {
  largest = std::min(largest, static_cast<std::uint32_t>(cells.size() / 2));
  ClusterVolumes found{.cells = sizes(largest),
                       .mean = {},
                       .variance = {},
                       .of_members = {},
                       .independent = {},
                       .clusters = {}};
  const std::size_t n_sizes = found.cells.size();
  std::vector<std::vector<double>> volumes(n_sizes);
  std::vector clusters_of(n_sizes, std::vector<std::uint32_t>(cells.size(), 0));
  const NeighbourFinder finder(packing, reach(cells, largest));
  std::vector<std::uint32_t> member_of(cells.size(), 0);  // the last cluster's number
  std::vector<std::pair<double, std::uint32_t>> near;     // distance squared in 1e-9, sphere
  std::uint32_t number = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    if (!is_counted(i)) continue;
    ++number;
    near = {{0, i}};
    // Touching spheres of a pour are equally far but for rounding: their indices decide.
    finder.visit_neighbours(i, [&](std::uint32_t j, Vec3, double squared) {
      near.emplace_back(std::round(squared * 1e9), j);
    });
    const std::size_t n = std::min<std::size_t>(near.size(), largest);
    std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(n));
    double volume = 0;
    std::size_t size = 0;
    for (std::size_t k = 0; k < n && size < n_sizes; ++k) {
      const std::uint32_t j = near[k].second;
      if (cells.cut[j] != 0 || member_of[j] == number) break;
      member_of[j] = number;
      volume += cells.volumes[j] / sphere_volume;
      if (k + 1 != found.cells[size]) continue;
      for (std::size_t member = 0; member <= k; ++member) ++clusters_of[size][near[member].second];
      volumes[size++].push_back(volume);
    }
  }
  for (std::size_t size = 0; size < n_sizes; ++size) {
    const std::vector<double>& of_size = volumes[size];
    const auto n = static_cast<double>(of_size.size());
    double sum = 0, squares = 0;
    for (const double volume : of_size) sum += volume;
    for (const double volume : of_size) squares += (volume - sum / n) * (volume - sum / n);
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    found.mean.push_back(n > 0 ? sum / n : none);
    found.variance.push_back(n > 1 ? squares / (n - 1) : none);
    found.of_members.push_back(variance_of_members(clusters_of[size], cells));
    found.independent.push_back(independent_variance(clusters_of[size], found.cells[size]));
    found.clusters.push_back(of_size.size());
  }
  return found;
}

}  // namespace jostle::inline structure
