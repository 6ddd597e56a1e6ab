#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/bed/geometry.hpp"
#include "engine/monte_carlo/kernel/neighbour_lists.hpp"
#include "engine/monte_carlo/kernel/packed_geometry.hpp"
#include "engine/monte_carlo/rejection_free/rejection_free_kernels.hpp"
#include "engine/monte_carlo/rejection_free/weight_tree.hpp"

namespace jostle::inline engine {

/// For every sphere and direction bin a length beyond which a step is certainly rejected. A
/// function of the centres alone: neither lists nor the order and history of moves change anything.
template <class Box, class Directions>
class BoundTables {
 public:
  using Index = std::uint32_t;
  using Bins = typename Directions::Bins;
  using Row = BoundRow<Directions::n_sectors>;

  BoundTables(const Box& box, BoundsKernel<Directions::n_sectors> kernel)
      : box_(box), packed_box_(box), kernel_(kernel) {}

  /// Builds everything.
  void build(const Bins& bins, std::vector<PackedCentre> centres) {
    bins_ = bins;
    reach_squared_ = reach(bins.longest) * reach(bins.longest);
    centres_ = std::move(centres);
    build_lists();
    rows_.resize(centres_.size());
    std::vector<std::uint32_t> weights(centres_.size());
    obstacles_.resize(1);
    for (Index i = 0; i < centres_.size(); ++i) {
      look_around(i, obstacles_[0]);
      weights[i] = make_row(i, obstacles_[0]);
    }
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
      stale_.resize(1 + lists_.stride());
      std::size_t n = 1;
      for_each_listed(j, [&](Index i) {
        stale_[n] = i;
        n += seen_from(centres_[i], old).in_the_way(reach_squared_) |
             seen_from(centres_[i], centre).in_the_way(reach_squared_);
      });
      stale_.resize(n);
    }
    // What was just written is read faster a little later.
    if (obstacles_.size() < stale_.size()) obstacles_.resize(stale_.size());
    for (std::size_t k = 0; k < stale_.size(); ++k) look_around(stale_[k], obstacles_[k]);
    for (std::size_t k = 0; k < stale_.size(); ++k) {
      tree_.set(stale_[k], make_row(stale_[k], obstacles_[k]));
    }
  }

  const std::vector<PackedCentre>& centres() const { return centres_; }
  const Bins& bins() const { return bins_; }
  const WeightTree& weights() const { return tree_; }
  const Row& row(Index i) const { return rows_[i]; }
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
    for (std::size_t line = 0; line < sizeof(Row); line += 64) __builtin_prefetch(row + line);
    __builtin_prefetch(&centres_[i]);
    __builtin_prefetch(lists_.rows() + i * lists_.stride());
  }

  std::size_t bytes() const {
    return lists_.bytes() + sizeof(PackedCentre) * centres_.capacity() +
           sizeof(Row) * rows_.capacity() + tree_.bytes();
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

  // The distance up to which a neighbour is taken into account. A step as long as a sphere is wide
  // may pass it by: then no bound holds.
  static double reach(double longest) {
    return longest < 1.99 ? 1 + std::min(Directions::obstacle_reach * longest, 0.3) : 0;
  }

  // Another centre as seen from a sphere's own. All say in the same arithmetic what is in the way.
  struct Seen {
    Pair away;
    double up, squared;
    bool in_the_way(double reach_squared) const {
      return (up < Directions::highest_obstacle) &
             (squared < reach_squared);  // no branch: it could not be guessed
    }
  };
  Seen seen_from(const PackedCentre& own, const PackedCentre& other) const {
    const Pair away = packed_box_.lateral(other.xy - own.xy);
    const double up = other.z - own.z;
    const Pair squares = away * away;
    return {away, up, squares[0] + squares[1] + up * up};
  }

  void build_lists() {
    lists_.build(box_, centres_, bins_.longest + 2 * spare + margin, {0, 0, -0.43 * bins_.longest});
  }

  // Notes what is in the way of sphere i.
  void look_around(Index i, Obstacles& seen) const {
    const PackedCentre& own = centres_[i];
    std::uint32_t n = 0;
    for_each_listed(i, [&](Index j) {
      const Seen other = seen_from(own, centres_[j]);
      seen.x[n] = static_cast<float>(other.away[0]);
      seen.y[n] = static_cast<float>(other.away[1]);
      seen.z[n] = static_cast<float>(-other.up);
      seen.tangent_squared[n] = static_cast<float>(other.squared - 1 + margin);
      n += other.in_the_way(reach_squared_);
    });
    assert(n < Obstacles::most_spheres);
    seen.n_spheres = n;
    seen.n_planes = 0;
    add_plane(seen, {0, 0, 1}, own.z - sphere_radius + margin);
    add_sides(seen, box_, own);
  }

  std::uint32_t make_row(Index i, const Obstacles& seen) {
    ++rows_made_;
    return kernel_(bins_, seen, rows_[i]);
  }

  void add_plane(Obstacles& seen, Vec3 normal, double gap) const {
    if (gap > bins_.longest) return;
    const std::uint32_t w = seen.n_planes++;
    seen.plane_x[w] = static_cast<float>(normal.x);
    seen.plane_y[w] = static_cast<float>(normal.y);
    seen.plane_z[w] = static_cast<float>(normal.z);
    seen.gap[w] = static_cast<float>(gap);
  }

  void add_sides(Obstacles&, const PeriodicBox&, const PackedCentre&) const {}
  void add_sides(Obstacles& seen, const WalledBox& box, const PackedCentre& own) const {
    const double beyond = margin - sphere_radius;
    add_plane(seen, {-1, 0, 0}, own.xy[0] + beyond);
    add_plane(seen, {1, 0, 0}, box.width_x - own.xy[0] + beyond);
    add_plane(seen, {0, -1, 0}, own.xy[1] + beyond);
    add_plane(seen, {0, 1, 0}, box.width_y - own.xy[1] + beyond);
  }
  // A tube lies within every plane that touches it.
  void add_sides(Obstacles& seen, const Cylinder& tube, const PackedCentre& own) const {
    const double axis = 0.5 * tube.diameter;
    const double x = own.xy[0] - axis, y = own.xy[1] - axis;
    const double distance = std::sqrt(x * x + y * y);
    if (distance < 1e-3) return;
    add_plane(seen, {x / distance, y / distance, 0}, axis - sphere_radius - distance + margin);
  }

  Box box_;
  PackedBox<Box> packed_box_;
  BoundsKernel<Directions::n_sectors> kernel_;
  Bins bins_{};
  double reach_squared_ = 0;
  std::vector<PackedCentre> centres_;
  NeighbourLists lists_;
  std::vector<Row> rows_;
  WeightTree tree_;
  std::vector<Obstacles> obstacles_;  // of the stale spheres
  std::vector<Index> stale_;
  std::uint64_t rows_made_ = 0;
};

}  // namespace jostle::inline engine
