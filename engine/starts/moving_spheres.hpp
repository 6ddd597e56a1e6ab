#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bed/cell_grid.hpp"
#include "engine/bed/geometry.hpp"

namespace jostle::inline engine {

/// Centres on the move with Verlet lists, for starts that shuffle spheres until they fit: every
/// sphere's list holds all others that can be within one diameter of it, nearest first. Between two
/// renewals of the lists no sphere may leave its neighbourhood: steps that would are rejected, so
/// that a few spheres flying free do not cost a renewal for all at every moment.
template <class Box>
class MovingSpheres {
 public:
  MovingSpheres(const Box& box, std::vector<Vec3> centres)
      : box_(box), centres_(std::move(centres)) {
    renew();
  }

  const Box& box() const { return box_; }
  const std::vector<Vec3>& centres() const { return centres_; }
  std::span<const std::uint32_t> near(std::uint32_t sphere) const {
    return {entries_.data() + first_[sphere], entries_.data() + first_[sphere + 1]};
  }
  /// The squared distance of sphere `other` from a point.
  double squared_distance(Vec3 r, std::uint32_t other) const {
    return norm_squared(separation(box_, r, centres_[other]));
  }

  /// Whether the lists still hold for a sphere moved to r: within half a skin of where it stood at
  /// the last renewal.
  bool in_reach(std::uint32_t sphere, Vec3 r) const {
    return norm_squared(separation(box_, r, origins_[sphere])) <= 0.25 * skin * skin;
  }
  /// Moves a sphere to r, wrapped and in reach.
  void move(std::uint32_t sphere, Vec3 r) { centres_[sphere] = r; }
  /// Renews the lists.
  void renew() {
    const auto n = static_cast<std::uint32_t>(centres_.size());
    grid_.build(Boundary(box_), cutoff, n, [&](std::uint32_t i) { return centres_[i]; });
    origins_ = centres_;
    first_.resize(n + 1);
    entries_.clear();
    for (std::uint32_t i = 0; i < n; ++i) {
      first_[i] = static_cast<std::uint32_t>(entries_.size());
      found_.clear();
      grid_.for_each_near(centres_[i], [&](std::uint32_t j) {
        const double squared = squared_distance(centres_[i], j);
        if (j != i && squared < cutoff * cutoff) found_.push_back({squared, j});
      });
      std::sort(found_.begin(), found_.end(), [](const Near& a, const Near& b) {
        return a.squared < b.squared || (a.squared == b.squared && a.sphere < b.sphere);
      });
      for (const Near& near : found_) entries_.push_back(near.sphere);
    }
    first_[n] = static_cast<std::uint32_t>(entries_.size());
  }

 private:
  static constexpr double skin = 0.3, cutoff = 1 + skin;  // diameters

  struct Near {
    double squared;
    std::uint32_t sphere;
  };

  Box box_;
  std::vector<Vec3> centres_, origins_;
  CellGrid grid_;
  std::vector<std::uint32_t> first_, entries_;
  std::vector<Near> found_;
};

}  // namespace jostle::inline engine
