#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/cell_grid.hpp"
#include "engine/geometry.hpp"

namespace jostle {

/// A position padded to half a cache line.
struct alignas(32) PaddedVec3 {
  double x, y, z, unused;
};

inline Vec3 unpadded(const PaddedVec3& p) {
  return {p.x, p.y, p.z};
}

/// Verlet lists: for every sphere the others within 1 + skin of it, the likeliest blockers first.
/// A list holds every sphere that can be touched as long as no sphere has moved farther than
/// skin / 2 from where it stood at the last build. What a list holds beyond that, and its order,
/// decides no trial: only how fast it is made.
class NeighbourLists {
 public:
  using Index = std::uint32_t;

  /// Rebuilds all lists. `drift` is the mean displacement of a trial that geometry decides: the
  /// neighbours nearest to a sphere so displaced block it most often and come first.
  template <class Box>
  void build(const Box& box, const std::vector<PaddedVec3>& centres, double skin, Vec3 drift) {
    const auto n = static_cast<Index>(centres.size());
    const double reach = (1 + skin) * (1 + skin);
    grid_.build(Container{box}, 1 + skin, n, [&](Index i) { return unpadded(centres[i]); });
    half_skin_squared_ = 0.25 * skin * skin;
    origins_ = centres;
    first_.resize(n + 1);
    entries_.clear();
    for (Index i = 0; i < n; ++i) {
      first_[i] = static_cast<Index>(entries_.size());
      candidates_.clear();
      const Vec3 centre = unpadded(centres[i]);
      grid_.for_each_near(centre, [&](Index j) {
        if (j == i) return;
        const Vec3 away = separation(box, centre, unpadded(centres[j]));
        if (norm_squared(away) < reach) candidates_.push_back({norm_squared(away + drift), j});
      });
      std::sort(candidates_.begin(), candidates_.end());
      for (const Candidate& candidate : candidates_) entries_.push_back(candidate.sphere);
    }
    first_[n] = static_cast<Index>(entries_.size());
  }

  const Index* begin(Index i) const { return entries_.data() + first_[i]; }
  const Index* end(Index i) const { return entries_.data() + first_[i + 1]; }
  const Index* row_address(Index i) const { return first_.data() + i; }
  double mean_length() const {
    return first_.size() < 2 ? 0 : static_cast<double>(entries_.size()) / (first_.size() - 1.0);
  }

  /// Whether a sphere at r has left the region for which its list was built.
  template <class Box>
  bool outgrown(const Box& box, Index i, Vec3 r) const {
    return norm_squared(separation(box, r, unpadded(origins_[i]))) > half_skin_squared_;
  }

  std::size_t bytes() const {
    return grid_.bytes() + sizeof(Index) * (first_.capacity() + entries_.capacity()) +
           sizeof(PaddedVec3) * origins_.capacity();
  }

 private:
  struct Candidate {
    double key;
    Index sphere;
    bool operator<(const Candidate& other) const {
      return key < other.key || (key == other.key && sphere < other.sphere);
    }
  };

  CellGrid grid_;
  std::vector<Index> first_, entries_;
  std::vector<PaddedVec3> origins_;
  std::vector<Candidate> candidates_;
  double half_skin_squared_ = 0;
};

}  // namespace jostle
