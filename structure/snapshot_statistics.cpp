#include "structure/snapshot_statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "structure/order/neighbours.hpp"

namespace jostle::inline structure {

std::vector<unsigned> coordination_numbers(const Packing& packing, double cut) {
  const NeighbourFinder finder(packing, packing.sizes ? cut * 2 * packing.largest_radius() : cut);
  std::vector<unsigned> numbers(finder.size(), 0);
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    finder.visit_neighbours(i, [&](std::uint32_t j, Vec3, double distance_squared) {
      const double reach = cut * (packing.radius(i) + packing.radius(j));
      if (!packing.sizes || distance_squared <= reach * reach) ++numbers[i];
    });
  }
  return numbers;
}

double coordination(const Packing& packing, double cut) {
  assert(!packing.centres.empty());
  std::uint64_t neighbours = 0;
  for (const unsigned number : coordination_numbers(packing, cut)) neighbours += number;
  return static_cast<double>(neighbours) / static_cast<double>(packing.centres.size());
}

CoordinationCurve coordination_curve(const Packing& packing, std::span<const double> cuts,
                                     const std::optional<Region>& region) {
  assert(!cuts.empty() && std::is_sorted(cuts.begin(), cuts.end()));
  std::vector<double> squares;
  for (const double cut : cuts) squares.push_back(cut * cut);
  std::vector<std::uint64_t> gained(cuts.size(), 0);  // from one cut to the next
  const NeighbourFinder finder(packing, reach_of_cut(packing, cuts.back()));
  CoordinationCurve curve{{cuts.begin(), cuts.end()}, {}, 0};
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    if (region && !region->contains(packing.container, packing.centres[i])) continue;
    ++curve.n_spheres;
    finder.visit_neighbours(i, [&](std::uint32_t j, Vec3, double distance_squared) {
      const double scaled = distance_squared / contact_squared(packing, i, j);
      const auto found = std::lower_bound(squares.begin(), squares.end(), scaled);
      if (found == squares.end()) return;  // beyond all cuts: a pair of small spheres
      ++gained[static_cast<std::size_t>(found - squares.begin())];
    });
  }
  std::uint64_t neighbours = 0;
  for (const std::uint64_t gain : gained) {
    neighbours += gain;
    curve.coordination.push_back(static_cast<double>(neighbours) /
                                 static_cast<double>(curve.n_spheres));
  }
  return curve;
}

namespace {

/// A larger number of bins would be nearly all empty: the spheres have left each other.
double most_height_bins(const Packing& packing) {
  constexpr double bins_of_a_sphere = 100, always_taken = 1e5;
  return std::max(always_taken, bins_of_a_sphere * static_cast<double>(packing.centres.size()));
}

}  // namespace

std::vector<std::uint64_t> neighbour_histogram(std::span<const unsigned> numbers) {
  std::vector<std::uint64_t> spheres;
  for (const unsigned number : numbers) {
    if (number >= spheres.size()) spheres.resize(number + 1, 0);
    ++spheres[number];
  }
  return spheres;
}

bool has_height_bins(const Packing& packing, double bin_width) {
  return top_height(packing) / bin_width < most_height_bins(packing);
}

void require_height_bins(const Packing& packing, double bin_width) {
  n_height_bins(packing, bin_width);
}

std::size_t n_height_bins(const Packing& packing, double bin_width) {
  assert(bin_width > 0 && !packing.centres.empty());
  const double top = top_height(packing);
  if (top / bin_width < most_height_bins(packing))
    return static_cast<std::size_t>(top / bin_width) + 1;
  throw std::invalid_argument(
      std::to_string(packing.centres.size()) + " spheres with centres up to " +
      std::to_string(top) + " diameters make more than " +
      std::to_string(static_cast<std::uint64_t>(most_height_bins(packing))) + " bins of " +
      std::to_string(bin_width) +
      " by height, nearly all of them empty: use wider bins, and look for a sphere far above "
      "the bed");
}

std::vector<double> height_histogram(const Packing& packing, double bin_width) {
  const auto bin = [&](double z) { return static_cast<std::size_t>(z / bin_width); };
  std::vector<std::uint64_t> counts(n_height_bins(packing, bin_width), 0);
  for (const Vec3& centre : packing.centres) ++counts[bin(centre.z)];
  std::vector<double> fractions;
  fractions.reserve(counts.size());
  for (const std::uint64_t count : counts) {
    fractions.push_back(static_cast<double>(count) / static_cast<double>(packing.centres.size()));
  }
  return fractions;
}

}  // namespace jostle::inline structure
