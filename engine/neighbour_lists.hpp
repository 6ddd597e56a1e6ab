#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/cell_grid.hpp"
#include "engine/geometry.hpp"
#include "engine/packed_geometry.hpp"

namespace jostle {

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
  void build(const Box& box, const std::vector<PackedCentre>& centres, double skin, Vec3 drift) {
    const auto n = static_cast<Index>(centres.size());
    const double reach = (1 + skin) * (1 + skin);
    grid_.build(Container{box}, 1 + skin, n, [&](Index i) { return unpacked(centres[i]); });
    half_skin_squared_ = 0.25 * skin * skin;
    origins_ = centres;
    first_.resize(n + 1);
    entries_.clear();
    for (Index i = 0; i < n; ++i) {
      first_[i] = static_cast<Index>(entries_.size());
      candidates_.clear();
      const Vec3 centre = unpacked(centres[i]);
      grid_.for_each_near(centre, [&](Index j) {
        if (j == i) return;
        const Vec3 away = separation(box, centre, unpacked(centres[j]));
        if (norm_squared(away) < reach) candidates_.push_back({norm_squared(away + drift), j});
      });
      std::sort(candidates_.begin(), candidates_.end());
      for (const Candidate& candidate : candidates_) entries_.push_back(candidate.sphere);
    }
    first_[n] = static_cast<Index>(entries_.size());
  }

  /// The list of sphere i is entries()[first()[i]] .. entries()[first()[i + 1] - 1].
  const Index* first() const { return first_.data(); }
  const Index* entries() const { return entries_.data(); }
  double mean_length() const {
    return first_.size() < 2 ? 0 : static_cast<double>(entries_.size()) / (first_.size() - 1.0);
  }

  /// Where spheres stood at the build, [n]; a sphere farther than sqrt(half_skin_squared()) from
  /// there has left the region for which the lists were built.
  const PackedCentre* origins() const { return origins_.data(); }
  double half_skin_squared() const { return half_skin_squared_; }

  std::size_t bytes() const {
    return grid_.bytes() + sizeof(Index) * (first_.capacity() + entries_.capacity()) +
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

  CellGrid grid_;
  std::vector<Index> first_, entries_;
  std::vector<PackedCentre> origins_;
  std::vector<Candidate> candidates_;
  double half_skin_squared_ = 0;
};

}  // namespace jostle
