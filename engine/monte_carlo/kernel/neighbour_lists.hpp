#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "engine/bed/cells/cell_grid.hpp"
#include "engine/bed/cells/sized_grid.hpp"
#include "engine/bed/geometry.hpp"
#include "engine/monte_carlo/kernel/list_rows.hpp"
#include "engine/monte_carlo/kernel/packed_centre.hpp"

namespace jostle::inline engine {

/// Verlet lists: for every sphere the others whose origins lie within the sum of both radii + skin
/// of its own, the likeliest blockers first. An origin is the position of a sphere when its list
/// was last made; a list holds every sphere that can be touched as long as no sphere is farther
/// than skin / 2 from its origin. A sphere that goes farther gets a new origin and a new list,
/// alone. Sphere i is in list j if and only if j is in list i. Entries of a list that cannot be
/// touched, and its order, decide no trial: only how fast it is made.
template <class Spheres>
class NeighbourListsOf {
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
    const auto position = [&](Index i) { return unpacked(centres[i]); };
    if constexpr (Spheres::several) {
      grid_.build(Boundary(box), skin, n, position, [&](Index i) { return centres[i].radius; });
    } else {
      grid_.build(Boundary(box), 1 + skin, n, position);
    }
    rows_.make_all(n, [&](Index i) { return make_row(box, i); });
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

  using Rows = std::conditional_t<Spheres::several, OffsetRows, StridedRows>;

  /// Row i: its length, then the spheres.
  const Index* row(Index i) const { return rows_[i]; }
  typename Rows::Place rows_place() const { return rows_.place(); }
  /// Row i of equal spheres is rows() + i * stride().
  const Index* rows() const { return rows_.place().first; }
  std::size_t stride() const requires(!Spheres::several) { return rows_.place().stride; }
  /// Exchanges the spheres at two places of list i, counted from 0.
  void swap(Index i, Index a, Index b) {
    Index* const row = rows_[i];
    std::swap(row[1 + a], row[1 + b]);
  }
  /// [n] origins; lists are good while no sphere is farther than sqrt(half_skin_squared()) from
  /// its.
  const PackedCentre* origins() const { return origins_.data(); }
  double half_skin_squared() const { return 0.25 * skin_ * skin_; }

  std::size_t bytes() const {
    return grid_.bytes() + rows_.bytes() + sizeof(PackedCentre) * origins_.capacity();
  }

 private:
  struct Candidate {
    double key;
    Index sphere;
    bool operator<(const Candidate& rhs) const {
      return key < rhs.key || (key == rhs.key && sphere < rhs.sphere);
    }
  };

  template <class Box>
  bool make_row(const Box& box, Index i) {
    const Vec3 centre = unpacked(origins_[i]);
    candidates_.clear();
    if constexpr (Spheres::several) {
      const double radius = origins_[i].radius;
      grid_.for_each_near(centre, radius, [&](Index j) {
        const double touching = radius + origins_[j].radius;
        consider(box, i, j, touching + skin_, touching);
      });
    } else {
      grid_.for_each_near(centre, [&](Index j) { consider(box, i, j, 1 + skin_, 1); });
    }
    if (!rows_.holds(i, candidates_.size())) return false;
    std::sort(candidates_.begin(), candidates_.end());
    Index* row = rows_[i];
    *row = static_cast<Index>(candidates_.size());
    for (const Candidate& candidate : candidates_) *++row = candidate.sphere;
    return true;
  }

  // The nearest come first: with several sizes by the distance over the sum of radii.
  template <class Box>
  [[gnu::always_inline]] void consider(const Box& box, Index i, Index j, double reach,
                                       double touching) {
    const Vec3 displacement = separation(box, unpacked(origins_[i]), unpacked(origins_[j]));
    if (j == i || !(norm_squared(displacement) < reach * reach)) return;
    double key = norm_squared(displacement + drift_);
    if constexpr (Spheres::several) key /= touching * touching;
    candidates_.push_back({key, j});
  }

  bool enter(Index i, Index newcomer) {
    const Index length = *rows_[i];
    if (length + 1 >= rows_.room(i) && !rows_.enlarge(i)) return false;
    Index* const row = rows_[i];
    row[1 + length] = newcomer;
    *row = length + 1;
    return true;
  }

  void leave(Index i, Index leaver) {
    Index* const row = rows_[i];
    Index* const last = row + (*row)--;
    *std::find(row + 1, last, leaver) = *last;
  }

  std::conditional_t<Spheres::several, SizedGrid, CellGrid> grid_;
  double skin_ = 0;
  Vec3 drift_;
  PackedCentres origins_;
  Rows rows_;
  std::vector<Candidate> candidates_;
};

using NeighbourLists = NeighbourListsOf<EqualSpheres>;

}  // namespace jostle::inline engine
