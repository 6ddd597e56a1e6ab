#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/direction_bins.hpp"
#include "engine/geometry.hpp"
#include "engine/neighbour_lists.hpp"
#include "engine/packed_geometry.hpp"
#include "engine/skipping_kernels.hpp"
#include "engine/weight_tree.hpp"

namespace jostle {

/// For every sphere and direction bin a length beyond which a step is certainly refused. A function
/// of the centres alone: neither lists nor the order and history of moves change anything.
template <class Box>
class BoundTables {
 public:
  using Index = std::uint32_t;
  using BoundsKernel = std::uint32_t (*)(const DirectionBins&, const Obstacles&, BoundRow&);

  BoundTables(const Box& box, BoundsKernel kernel) : box_(box), packed_box_(box), kernel_(kernel) {}

  /// Builds everything.
  void build(const DirectionBins& bins, std::vector<PackedCentre> centres) {
    bins_ = bins;
    reach_squared_ = reach(bins.longest) * reach(bins.longest);
    centres_ = std::move(centres);
    build_lists();
    rows_.resize(centres_.size());
    std::vector<std::uint32_t> weights(centres_.size());
    for (Index i = 0; i < centres_.size(); ++i) weights[i] = make_row(i);
    tree_.assign(std::move(weights));
  }

  /// Moves sphere j, and brings its bounds and those of its neighbours up to date.
  void move(Index j, const PackedCentre& centre) {
    const PackedCentre old = std::exchange(centres_[j], centre);
    stale_.assign(1, j);
    if (distance_squared(packed_box_, centre, lists_.origins()[j]) > spare * spare) {
      for_each_listed(j, [&](Index i) { stale_.push_back(i); });
      if (!lists_.renew(box_, j, centre)) build_lists();
      for_each_listed(j, [&](Index i) { stale_.push_back(i); });
    } else {
      for_each_listed(j, [&](Index i) {
        if (in_the_way(centres_[i], old) || in_the_way(centres_[i], centre)) stale_.push_back(i);
      });
    }
    for (const Index i : stale_) tree_.set(i, make_row(i));
  }

  const std::vector<PackedCentre>& centres() const { return centres_; }
  const DirectionBins& bins() const { return bins_; }
  const WeightTree& weights() const { return tree_; }
  const BoundRow& row(Index i) const { return rows_[i]; }
  std::uint64_t rows_made() const { return rows_made_; }

  /// Whether another sphere overlaps sphere i placed at `target`, one step away from its centre.
  bool blocked(Index i, const PackedCentre& target, std::uint64_t& tests) const {
    const Index* const row = lists_.rows() + i * lists_.stride();
    for (const Index *j = row + 1, *const last = j + *row; j != last; ++j) {
      ++tests;
      if (distance_squared(packed_box_, target, centres_[*j]) < 1.0) return true;
    }
    return false;
  }

  void prefetch(Index i) const {
    const char* const row = reinterpret_cast<const char*>(&rows_[i]);
    for (std::size_t line = 0; line < sizeof(BoundRow); line += 64) __builtin_prefetch(row + line);
    __builtin_prefetch(&centres_[i]);
    __builtin_prefetch(lists_.rows() + i * lists_.stride());
  }

  std::size_t bytes() const {
    return lists_.bytes() + sizeof(PackedCentre) * centres_.capacity() +
           sizeof(BoundRow) * rows_.capacity() + tree_.bytes();
  }

 private:
  // How far a sphere may be from where its list was made.
  static constexpr double spare = 0.06;
  // Rounding, of float components too.
  static constexpr double margin = 1e-6;

  template <class Visit>
  void for_each_listed(Index i, Visit&& visit) const {
    const Index* const row = lists_.rows() + i * lists_.stride();
    for (const Index *j = row + 1, *const last = j + *row; j != last; ++j) visit(*j);
  }

  // Neighbours higher than that are left out: they hardly ever bound a step that does not rise.
  static constexpr double highest = 0.3;

  // The distance up to which a neighbour is taken into account. A step as long as a sphere is wide
  // may pass it by: then no bound holds.
  static double reach(double longest) {
    return longest < 1.99 ? 1 + std::min(0.5 * longest, 0.3) : 0;
  }

  // Whether the sphere at `other` counts in the table of a sphere at `own`.
  bool in_the_way(const PackedCentre& own, const PackedCentre& other) const {
    return other.z - own.z < highest && distance_squared(packed_box_, other, own) < reach_squared_;
  }

  void build_lists() {
    lists_.build(box_, centres_, bins_.longest + 2 * spare + margin, {0, 0, -0.43 * bins_.longest});
  }

  std::uint32_t make_row(Index i) {
    const PackedCentre& own = centres_[i];
    std::uint32_t n = 0;
    for_each_listed(i, [&](Index j) {
      const PackedCentre& other = centres_[j];
      if (!in_the_way(own, other)) return;
      const Pair away = packed_box_.lateral(other.xy - own.xy);
      const double up = other.z - own.z;
      const Pair squares = away * away;
      obstacles_.x[n] = static_cast<float>(away[0]);
      obstacles_.y[n] = static_cast<float>(away[1]);
      obstacles_.z[n] = static_cast<float>(-up);
      obstacles_.tangent_squared[n] =
          static_cast<float>(squares[0] + squares[1] + up * up - 1 + margin);
      ++n;
    });
    obstacles_.n_spheres = n;
    obstacles_.n_planes = 0;
    add_plane({0, 0, 1}, own.z - sphere_radius + margin);
    add_sides(box_, own);
    ++rows_made_;
    return kernel_(bins_, obstacles_, rows_[i]);
  }

  void add_plane(Vec3 normal, double gap) {
    if (gap > bins_.longest) return;
    const std::uint32_t w = obstacles_.n_planes++;
    obstacles_.plane_x[w] = static_cast<float>(normal.x);
    obstacles_.plane_y[w] = static_cast<float>(normal.y);
    obstacles_.plane_z[w] = static_cast<float>(normal.z);
    obstacles_.gap[w] = static_cast<float>(gap);
  }

  void add_sides(const PeriodicBox&, const PackedCentre&) {}
  void add_sides(const WalledBox& box, const PackedCentre& own) {
    const double beyond = margin - sphere_radius;
    add_plane({-1, 0, 0}, own.xy[0] + beyond);
    add_plane({1, 0, 0}, box.width_x - own.xy[0] + beyond);
    add_plane({0, -1, 0}, own.xy[1] + beyond);
    add_plane({0, 1, 0}, box.width_y - own.xy[1] + beyond);
  }
  // A tube lies within every plane that touches it.
  void add_sides(const Cylinder& tube, const PackedCentre& own) {
    const double axis = 0.5 * tube.diameter;
    const double x = own.xy[0] - axis, y = own.xy[1] - axis;
    const double distance = std::sqrt(x * x + y * y);
    if (distance < 1e-3) return;
    add_plane({x / distance, y / distance, 0}, axis - sphere_radius - distance + margin);
  }

  Box box_;
  PackedBox<Box> packed_box_;
  BoundsKernel kernel_;
  DirectionBins bins_{};
  double reach_squared_ = 0;
  std::vector<PackedCentre> centres_;
  NeighbourLists lists_;
  std::vector<BoundRow> rows_;
  WeightTree tree_;
  Obstacles obstacles_;
  std::vector<Index> stale_;
  std::uint64_t rows_made_ = 0;
};

}  // namespace jostle
