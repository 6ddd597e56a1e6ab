#include "structure/order/mixtures/partial_correlation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/bed/boundary.hpp"
#include "structure/order/mixtures/expected_at_walls.hpp"
#include "structure/order/neighbours.hpp"
#include "structure/order/whole_shells.hpp"

namespace jostle::inline structure {
namespace {

/// Adds what is expected of pairs into the bins of one pair of kinds.
class ExpectedPairs {
 public:
  ExpectedPairs(std::size_t n_bins, double bin_width) : width_(bin_width), bins_(n_bins, 0.0) {}

  /// Centres `height` apart; `weight` over the area of the footprint.
  void add_annuli(double contact, double height, double weight) {
    const double begin = std::abs(height) / contact;  // in sums of radii
    const auto first = static_cast<std::size_t>(begin / width_);
    if (first >= bins_.size()) return;
    const double area = std::numbers::pi * contact * contact * weight;
    const double end = static_cast<double>(first + 1) * width_;
    bins_[first] += area * (end * end - begin * begin);
    if (whole_from_.empty()) whole_from_.assign(bins_.size() + 1, 0.0);
    whole_from_[first + 1] += area;
  }
  /// `weight` over the volume of the box.
  void add_shells(double contact, double weight) {
    shells_ += weight * contact * contact * contact;
  }

  std::vector<double> bins() && {
    double area = 0;
    for (std::size_t k = 0; k < bins_.size(); ++k) {
      const double low = static_cast<double>(k) * width_, high = low + width_;
      if (!whole_from_.empty()) area += whole_from_[k];
      bins_[k] += area * (high * high - low * low);
      bins_[k] += 4 * std::numbers::pi / 3 * shells_ * (high * high * high - low * low * low);
    }
    return std::move(bins_);
  }

 private:
  double width_, shells_ = 0;
  std::vector<double> bins_, whole_from_;
};

/// The place of a pair of kinds in the list of all.
std::size_t place_of(std::uint32_t a, std::uint32_t b, std::size_t n_kinds) {
  const std::size_t low = std::min(a, b), high = std::max(a, b);
  return low * n_kinds - low * (low + 1) / 2 + high;
}

/// Calls `visit(i, j)` for every central sphere i and every other sphere j.
template <class Visit>
void visit_central_pairs(const Packing& packing, HeightWindow heights, Visit visit) {
  for (std::size_t i = 0; i < packing.centres.size(); ++i) {
    const double height = packing.centres[i].z;
    if (height < heights.low || height > heights.high) continue;
    for (std::size_t j = 0; j < packing.centres.size(); ++j) {
      if (j != i) visit(i, j);
    }
  }
}

void expect_between_periods(const Packing& packing, HeightWindow heights, double bin_width,
                            std::vector<PartialCorrelation>& all) {
  const Sizes& sizes = *packing.sizes;
  const Boundary boundary(packing.container);
  const double area = boundary.width_x * boundary.width_y;
  std::vector<ExpectedPairs> expected(all.size(),
                                      ExpectedPairs(all.front().counts.size(), bin_width));
  visit_central_pairs(packing, heights, [&](std::size_t i, std::size_t j) {
    ExpectedPairs& target = expected[place_of(sizes.kind(i), sizes.kind(j), sizes.kinds().size())];
    const double contact = sizes.radius(i) + sizes.radius(j);
    if (boundary.periodic_z)
      target.add_shells(contact, 1 / (area * boundary.height));
    else
      target.add_annuli(contact, packing.centres[j].z - packing.centres[i].z, 1 / area);
  });
  for (std::size_t k = 0; k < all.size(); ++k) all[k].expected = std::move(expected[k]).bins();
}

void expect_at_walls(const Packing& packing, HeightWindow heights, double farthest,
                     double bin_width, std::vector<PartialCorrelation>& all) {
  ExpectedAtWalls expected(packing, {heights.low - farthest, heights.high + farthest},
                           all.front().counts.size(), bin_width);
  visit_central_pairs(packing, heights, [&](std::size_t i, std::size_t j) {
    const double height = packing.centres[j].z - packing.centres[i].z;
    if (std::abs(height) <= farthest) expected.add(i, j, height);
  });
  for (PartialCorrelation& pairs : all) pairs.expected = expected.bins(pairs.first, pairs.second);
}

}  // namespace

std::vector<double> PartialCorrelation::g() const {
  std::vector<double> values(counts.size());
  for (std::size_t k = 0; k < counts.size(); ++k)
    values[k] = static_cast<double>(counts[k]) / expected[k];
  return values;
}

HeightWindow central_heights(const Packing& packing, const PairCorrelationSettings& settings) {
  const double farthest = settings.r_max * 2 * packing.largest_radius();
  return settings.heights.value_or(bulk_heights(packing, farthest));
}

std::vector<PartialCorrelation> partial_correlations(const Packing& packing,
                                                     const PairCorrelationSettings& settings) {
  assert(packing.sizes && settings.bin_width > 0 && !packing.centres.empty());
  constexpr double early = 1e-9;
  const Sizes& sizes = *packing.sizes;
  const Boundary boundary(packing.container);
  if (const auto fault = partial_pairs_fault(packing.container, 2 * sizes.largest_radius(),
                                             sizes.kinds().size(), settings.r_max))
    throw std::invalid_argument(*fault);
  const double farthest = settings.r_max * 2 * sizes.largest_radius();
  const HeightWindow heights = central_heights(packing, settings);
  const auto n_bins = static_cast<std::size_t>(settings.r_max / settings.bin_width + 1e-9);
  const std::size_t n_kinds = sizes.kinds().size();
  std::vector<PartialCorrelation> all;
  for (std::uint32_t a = 0; a < n_kinds; ++a) {
    for (std::uint32_t b = a; b < n_kinds; ++b) {
      PartialCorrelation pairs{.first = a, .second = b};
      pairs.counts.assign(n_bins, 0);
      for (std::size_t k = 0; k < n_bins; ++k)
        pairs.x.push_back((static_cast<double>(k) + 0.5) * settings.bin_width);
      all.push_back(std::move(pairs));
    }
  }
  const NeighbourFinder finder(packing, farthest);
  for (std::uint32_t i = 0; i < finder.size(); ++i) {
    const double height = packing.centres[i].z;
    if (height < heights.low || height > heights.high) continue;
    finder.visit_neighbours(i, [&](std::uint32_t j, Vec3, double distance_squared) {
      if (j == i) return;
      const double x = std::sqrt(distance_squared / contact_squared(packing, i, j));
      const auto bin = static_cast<std::size_t>(x / settings.bin_width + early);
      if (bin < n_bins) ++all[place_of(sizes.kind(i), sizes.kind(j), n_kinds)].counts[bin];
    });
  }
  if (boundary.has_walls())
    expect_at_walls(packing, heights, farthest, settings.bin_width, all);
  else
    expect_between_periods(packing, heights, settings.bin_width, all);
  return all;
}

double contact_value(const PartialCorrelation& pairs, double bin_width, double reach) {
  PairCorrelation as_equal;
  as_equal.bin_width = bin_width;
  as_equal.r = pairs.x;
  as_equal.found.assign(pairs.counts.begin(), pairs.counts.end());
  as_equal.expected = pairs.expected;
  return contact_value(as_equal, reach);
}

}  // namespace jostle::inline structure
