#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bed/cells/sized_grid.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/bed/packing.hpp"

namespace jostle::inline engine {

/// Centres on the move with Verlet lists, for starts that shuffle spheres until they fit: every
/// sphere's list holds all others that can come to touch it, nearest first. Between two
/// renewals of the lists no sphere may leave its neighbourhood: steps that would are rejected, so
/// that a few spheres flying free do not cost a renewal for all at every moment.
template <class Box>
class MovingSpheres {
 public:
  /// The sizes are those of `packing`.
  MovingSpheres(const Box& box, Packing packing)
      : box_(box), packing_(std::move(packing)), skin_(relative_skin * shortest_diameter()) {
    renew();
  }

  const Box& box() const { return box_; }
  const std::vector<Vec3>& centres() const { return packing_.centres; }
  double diameter(std::uint32_t sphere) const { return 2 * packing_.radius(sphere); }
  double shortest_diameter() const { return 2 * packing_.smallest_radius(); }
  std::span<const std::uint32_t> near(std::uint32_t sphere) const {
    return {entries_.data() + first_[sphere], entries_.data() + first_[sphere + 1]};
  }
  /// The squared distance of sphere `neighbour` from a point.
  double squared_distance(Vec3 r, std::uint32_t neighbour) const {
    return norm_squared(separation(box_, r, centres()[neighbour]));
  }

  /// True if the lists still hold for a sphere moved to r: within half a skin of its position at
  /// the last renewal.
  bool in_reach(std::uint32_t sphere, Vec3 r) const {
    return norm_squared(separation(box_, r, origins_[sphere])) <= 0.25 * skin_ * skin_;
  }
  /// Moves a sphere to r, wrapped and in reach.
  void move(std::uint32_t sphere, Vec3 r) { packing_.centres[sphere] = r; }
  /// Renews the lists.
  void renew() {
    const auto n = static_cast<std::uint32_t>(centres().size());
    grid_.build(
        Boundary(box_), skin_, n, [&](std::uint32_t i) { return centres()[i]; },
        [&](std::uint32_t i) { return packing_.radius(i); });
    origins_ = centres();
    first_.resize(n + 1);
    entries_.clear();
    for (std::uint32_t i = 0; i < n; ++i) {
      first_[i] = static_cast<std::uint32_t>(entries_.size());
      found_.clear();
      const double radius = packing_.radius(i);
      grid_.for_each_near(centres()[i], radius, [&](std::uint32_t j) {
        const double squared = squared_distance(centres()[i], j);
        const double cutoff = radius + packing_.radius(j) + skin_;
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
  static constexpr double relative_skin = 0.3;  // skin relative to the smallest diameter

  struct Near {
    double squared;
    std::uint32_t sphere;
  };

  Box box_;
  Packing packing_;
  double skin_;
  std::vector<Vec3> origins_;
  SizedGrid grid_;
  std::vector<std::uint32_t> first_, entries_;
  std::vector<Near> found_;
};

}  // namespace jostle::inline engine
