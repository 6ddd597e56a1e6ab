#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/bed/cell_grid.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/large_pages.hpp"
#include "engine/monte_carlo/kernel/packed_geometry.hpp"

namespace jostle::inline engine {

/// Verlet lists: for every sphere the others whose origins lie within 1 + skin of its own, the
/// likeliest blockers first. An origin is where a sphere stood when its list was last made; a list
/// holds every sphere that can be touched as long as no sphere is farther than skin / 2 from its
/// origin. A sphere that goes farther gets a new origin and a new list, alone. Sphere i stands in
/// list j if and only if j stands in list i. What a list holds beyond what can be touched, and its
/// order, decides no trial: only how fast it is made.
class NeighbourLists {
 public:
  using Index = std::uint32_t;

  /// Makes all lists of the centres, [n] PackedCentre. `drift` is the mean displacement of a trial
  /// that geometry decides: the neighbours nearest to a sphere so displaced block it most often and
  /// come first.
  template <class Box, class Centres>
  void build(const Box& box, const Centres& centres, double skin, Vec3 drift) {
    const auto n = static_cast<Index>(centres.size());
    skin_ = skin;
    drift_ = drift;
    origins_.assign(centres.begin(), centres.end());
    grid_.build(Boundary(box), 1 + skin, n, [&](Index i) { return unpacked(centres[i]); });
    for (bool all_fit = false; !all_fit; stride_ *= 2) {
      rows_.assign(static_cast<std::size_t>(n) * stride_, 0);
      all_fit = true;
      for (Index i = 0; i < n && all_fit; ++i) all_fit = make_row(box, i);
      if (all_fit) break;
    }
  }

  /// Gives sphere i a new origin and list, takes it out of the lists of its former neighbours and
  /// enters it in those of the new ones. False if a list is full: then all must be built anew.
  template <class Box>
  [[gnu::noinline]] bool renew(const Box& box, Index i, const PackedCentre& centre) {
    const Index* const former = row(i);
    for (Index m = 1; m <= former[0]; ++m) leave(former[m], i);
    origins_[i] = centre;
    grid_.relocate(i, unpacked(centre));
    if (!make_row(box, i)) return false;
    for (const Candidate& neighbour : candidates_) {
      if (!enter(neighbour.sphere, i)) return false;
    }
    return true;
  }

  /// Row i is rows() + i * stride(): its length, then the spheres.
  const Index* rows() const { return rows_.data(); }
  std::size_t stride() const { return stride_; }
  const Index* row(Index i) const { return &rows_[i * stride_]; }
  /// Exchanges the spheres at two places of list i, counted from 0.
  void swap(Index i, Index a, Index b) {
    std::swap(rows_[i * stride_ + 1 + a], rows_[i * stride_ + 1 + b]);
  }
  /// [n] origins; lists are good while no sphere is farther than sqrt(half_skin_squared()) from
  /// its.
  const PackedCentre* origins() const { return origins_.data(); }
  double half_skin_squared() const { return 0.25 * skin_ * skin_; }

  std::size_t bytes() const {
    return grid_.bytes() + sizeof(Index) * rows_.capacity() +
           sizeof(PackedCentre) * origins_.capacity();
  }

 private:
  struct Candidate {
    double key;
    Index sphere;
    bool operator<(const Candidate& other) const {
      return key < other.key || (key == other.key && sphere < other.sphere);
    }
  };

  template <class Box>
  bool make_row(const Box& box, Index i) {
    const double reach = (1 + skin_) * (1 + skin_);
    const Vec3 centre = unpacked(origins_[i]);
    candidates_.clear();
    grid_.for_each_near(centre, [&](Index j) {
      const Vec3 away = separation(box, centre, unpacked(origins_[j]));
      if (j != i && norm_squared(away) < reach) {
        candidates_.push_back({norm_squared(away + drift_), j});
      }
    });
    if (candidates_.size() >= stride_ - stride_ / 4) return false;  // room for newcomers
    std::sort(candidates_.begin(), candidates_.end());
    Index* row = &rows_[i * stride_];
    *row = static_cast<Index>(candidates_.size());
    for (const Candidate& candidate : candidates_) *++row = candidate.sphere;
    return true;
  }

  bool enter(Index i, Index newcomer) {
    Index* const row = &rows_[i * stride_];
    const Index length = *row;
    if (length + 1 >= stride_) return false;
    row[1 + length] = newcomer;
    *row = length + 1;
    return true;
  }

  void leave(Index i, Index leaver) {
    Index* const row = &rows_[i * stride_];
    Index* const last = row + (*row)--;
    *std::find(row + 1, last, leaver) = *last;
  }

  CellGrid grid_;
  double skin_ = 0;
  Vec3 drift_;
  PackedCentres origins_;
  std::size_t stride_ = 16;  // of the rows: a cache line
  std::vector<Index, LargePageAllocator<Index>> rows_;
  std::vector<Candidate> candidates_;
};

}  // namespace jostle::inline engine
