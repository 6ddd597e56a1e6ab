#include "structure/order/mixtures/expected_at_walls.hpp"

#include <algorithm>
#include <cmath>

namespace jostle::inline structure {
namespace {

constexpr std::size_t n_even_nodes = 10;

std::size_t first_of_four(double place) {
  const auto first = static_cast<std::size_t>(std::max(0.0, std::floor(place) - 1));
  return std::min(first, n_even_nodes - 4);
}

}  // namespace

SizeNodes::SizeNodes(std::vector<double> radii) : radii_(std::move(radii)) {
  std::ranges::sort(radii_);
  radii_.erase(std::ranges::unique(radii_).begin(), radii_.end());
  if (radii_.size() <= n_even_nodes) return;
  is_interpolated_ = true;
  const double low = radii_.front(), high = radii_.back();
  radii_.clear();
  for (std::size_t k = 0; k < n_even_nodes; ++k)
    radii_.push_back(low + (high - low) * static_cast<double>(k) / (n_even_nodes - 1));
}

SizeNodes::Weights SizeNodes::weights(double radius) const {
  if (!is_interpolated_)
    return {static_cast<std::size_t>(std::ranges::lower_bound(radii_, radius) - radii_.begin())};
  const double step = (radii_.back() - radii_.front()) / (n_even_nodes - 1);
  const double place = (radius - radii_.front()) / step;
  Weights weights{first_of_four(place), 4, {1, 1, 1, 1}};
  // Lagrange's polynomials.
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t m = 0; m < 4; ++m) {
      if (m == k) continue;
      const auto node = static_cast<double>(weights.first + m);
      weights.of_node[k] *= (place - node) / (static_cast<double>(k) - static_cast<double>(m));
    }
  }
  return weights;
}

ExpectedAtWalls::ExpectedAtWalls(const Packing& packing, HeightWindow near, std::size_t n_bins,
                                 double bin_width)
    : boundary_(packing.container),
      sizes_(*packing.sizes),
      n_bins_(n_bins),
      bin_width_(bin_width),
      height_step_(std::clamp(bin_width / 4, 0.002, 0.005)),
      kinds_(sizes_.kinds().size()),
      heights_(kinds_.size() * kinds_.size()) {
  n_heights_ = static_cast<std::size_t>(static_cast<double>(n_bins) * bin_width / height_step_) + 2;
  std::vector<std::vector<double>> radii(kinds_.size());
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    radii[sizes_.kind(i)].push_back(sizes_.radius(i));
    const double z = packing.centres[i].z;
    if (z >= near.low && z <= near.high)
      kinds_[sizes_.kind(i)].places.add(boundary_, packing.centres[i], sizes_.radius(i));
  }
  for (std::size_t a = 0; a < kinds_.size(); ++a) {
    kinds_[a].places.finish();
    kinds_[a].nodes = SizeNodes(std::move(radii[a]));
  }
  for (std::size_t i = 0; i < sizes_.size(); ++i)
    weights_.push_back(kinds_[sizes_.kind(i)].nodes.weights(sizes_.radius(i)));
}

void ExpectedAtWalls::add(std::size_t i, std::size_t j, double height) {
  if (sizes_.kind(i) > sizes_.kind(j)) std::swap(i, j);
  const Kind &first = kinds_[sizes_.kind(i)], &second = kinds_[sizes_.kind(j)];
  const std::vector<double>&radii = first.nodes.radii(), &other_radii = second.nodes.radii();
  std::vector<Heights>& all = heights_[place(sizes_.kind(i), sizes_.kind(j))];
  if (all.empty()) all.resize(radii.size() * other_radii.size());
  const SizeNodes::Weights &of_first = weights_[i], &of_second = weights_[j];
  for (std::size_t p = 0; p < of_first.size; ++p) {
    for (std::size_t q = 0; q < of_second.size; ++q) {
      std::size_t m = of_first.first + p, n = of_second.first + q;
      if (&first == &second && m > n) std::swap(m, n);
      const double bin = std::abs(height) / ((radii[m] + other_radii[n]) * height_step_);
      const auto step = static_cast<std::size_t>(bin);
      if (step + 1 >= n_heights_) continue;
      Heights& heights = all[m * other_radii.size() + n];
      if (heights.empty()) heights.assign(n_heights_, 0.0);
      const double weight = of_first.of_node[p] * of_second.of_node[q];
      const double part = bin - static_cast<double>(step);
      heights[step] += weight * (1 - part);
      heights[step + 1] += weight * part;
    }
  }
}

void ExpectedAtWalls::add_expected(const Kind& first, const Kind& second, double first_radius,
                                   double second_radius, const Heights& heights,
                                   std::vector<double>& expected) const {
  const double contact = first_radius + second_radius;
  const double farthest = static_cast<double>(n_bins_) * bin_width_ * contact;
  const FootprintPairs across(boundary_, {first.places, OpenWidths(boundary_, first_radius)},
                              {second.places, OpenWidths(boundary_, second_radius)}, farthest);
  for (std::size_t m = 0; m < heights.size(); ++m) {
    if (heights[m] == 0) continue;
    const double height = static_cast<double>(m) * height_step_;
    double last = 0;
    const auto begin = static_cast<std::size_t>(height / bin_width_);
    for (std::size_t k = begin; k < n_bins_; ++k) {
      const double end = static_cast<double>(k + 1) * bin_width_;
      const double up_to = across.probability(contact * contact * (end * end - height * height));
      expected[k] += heights[m] * (up_to - last);
      last = up_to;
    }
  }
}

std::vector<double> ExpectedAtWalls::bins(std::uint32_t a, std::uint32_t b) const {
  std::vector<double> expected(n_bins_, 0.0);
  const std::vector<Heights>& all = heights_[place(a, b)];
  if (all.empty()) return expected;
  const std::vector<double>&radii = kinds_[a].nodes.radii(), &other_radii = kinds_[b].nodes.radii();
  for (std::size_t m = 0; m < radii.size(); ++m) {
    for (std::size_t n = 0; n < other_radii.size(); ++n) {
      const Heights& heights = all[m * other_radii.size() + n];
      if (!heights.empty())
        add_expected(kinds_[a], kinds_[b], radii[m], other_radii[n], heights, expected);
    }
  }
  // Cubics may leave a trace below 0 where a bin has almost nothing.
  for (double& pairs : expected) pairs = std::max(pairs, 0.0);
  return expected;
}

}  // namespace jostle::inline structure
