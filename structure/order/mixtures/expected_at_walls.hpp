#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/bed/packing.hpp"
#include "engine/bed/window.hpp"
#include "structure/order/mixtures/footprint_pairs.hpp"

namespace jostle::inline structure {

/// Radii of one kind at which expected pairs are computed: each radius of at most ten, or ten even
/// ones, between which cubics interpolate.
class SizeNodes {
 public:
  /// A radius as a sum of weights times nodes.
  struct Weights {
    std::size_t first = 0, size = 1;
    std::array<double, 4> of_node{1, 0, 0, 0};
  };

  SizeNodes() = default;
  explicit SizeNodes(std::vector<double> radii);
  const std::vector<double>& radii() const { return radii_; }
  Weights weights(double radius) const;

 private:
  std::vector<double> radii_;  // ascending
  bool is_interpolated_ = false;
};

/// Pairs of an uncorrelated mixture between walls or in a tube, in bins of x = r / s_ij.
///
/// Every sphere keeps its height and its radius and is anywhere in the region that its own radius
/// leaves, as densely as its kind is there (FootprintPairs). For an ideal gas, in which each sphere
/// is evenly spread over its own region, the expected numbers are those of the pairs counted, for
/// any number of spheres, radii and heights.
class ExpectedAtWalls {
 public:
  /// `near`: heights of the spheres whose places across the container count.
  ExpectedAtWalls(const Packing& packing, HeightWindow near, std::size_t n_bins, double bin_width);

  /// Spheres i and j, one of them central, whose centres are `height` apart in height.
  void add(std::size_t i, std::size_t j, double height);
  /// Expected pairs of kinds a <= b, [n_bins].
  std::vector<double> bins(std::uint32_t a, std::uint32_t b) const;

 private:
  struct Kind {
    SizeNodes nodes{};
    RelativePlaces places{};
  };
  /// Differences in height of pairs of two nodes, at even steps from 0 in sums of radii.
  using Heights = std::vector<double>;

  std::size_t place(std::uint32_t a, std::uint32_t b) const { return a * kinds_.size() + b; }
  void add_expected(const Kind& first, const Kind& second, double first_radius,
                    double second_radius, const Heights& heights,
                    std::vector<double>& expected) const;

  Boundary boundary_;
  const Sizes& sizes_;
  std::size_t n_bins_;
  double bin_width_, height_step_;
  std::size_t n_heights_;
  std::vector<Kind> kinds_;
  std::vector<SizeNodes::Weights> weights_;    // [n_spheres]
  std::vector<std::vector<Heights>> heights_;  // [n_kinds^2][nodes of first x nodes of second]
};

}  // namespace jostle::inline structure
