#pragma once

#include <xmmintrin.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/monte_carlo/kernel/large_pages.hpp"
#include "engine/monte_carlo/kernel/neighbour_lists.hpp"
#include "engine/monte_carlo/kernel/packed_geometry.hpp"

namespace jostle {

/// What shuts most trials of a sphere out, in one cache line: where its likeliest blockers stand,
/// seen from it, and its room to floor and sides. In single precision, with margins: a trial that a
/// shield refuses would be refused in double precision too; one that it lets pass is not decided.
struct alignas(64) Shield {
  static constexpr std::uint32_t size = 4;
  static constexpr float far = 1e9f;

  Lanes x = {far, far, far, far}, y = {}, z = {};  // one blocker a lane, diameters
  Lanes room;                                      // as PackedBox::room gives it
};

/// The shields of all spheres. Lanes 0 to 3 of shield i hold the first four of row i of the lists,
/// and follow them: that i stands in row j wherever j stands in a shield of i is what renew()
/// keeps.
template <class Box>
class Shields {
 public:
  using Index = NeighbourLists::Index;

  /// Shields of all spheres anew.
  void build(const PackedBox<Box>& box, const PackedCentres& centres, const NeighbourLists& lists) {
    shields_.resize(centres.size());
    for (Index i = 0; i < centres.size(); ++i) refresh(box, centres, lists, i);
  }

  /// Sphere i has moved.
  [[gnu::noinline]] void follow(const PackedBox<Box>& box, const PackedCentres& centres,
                                const NeighbourLists& lists, Index i) {
    refresh(box, centres, lists, i);
    const Index* const row = lists.row(i);
    for (Index m = 1; m <= row[0]; ++m) {
      const Index j = row[m];
      const Index* const other = lists.row(j);
      const Index n = std::min(other[0], Shield::size);
      for (Index lane = 0; lane < n; ++lane) {
        if (other[1 + lane] == i) see(box, centres[j], centres[i], shields_[j], lane);
      }
    }
  }

  /// Sphere i is about to get a new list.
  void before_renewal(const NeighbourLists& lists, Index i) {
    const Index* const row = lists.row(i);
    former_.assign(row + 1, row + 1 + row[0]);
  }
  /// It has got it; follow() is still to be called.
  [[gnu::noinline]] void after_renewal(const PackedBox<Box>& box, const PackedCentres& centres,
                                       const NeighbourLists& lists) {
    for (const Index j : former_) refresh(box, centres, lists, j);
  }

  /// The neighbour at place `place` of row i, counted from 0, blocks more often than was thought.
  [[gnu::noinline]] void promote(const PackedBox<Box>& box, const PackedCentres& centres,
                                 NeighbourLists& lists, Index i, Index place) {
    lists.swap(i, place, place - 1);
    if (place == Shield::size) {
      see(box, centres[i], centres[lists.row(i)[place]], shields_[i], place - 1);
    }
  }

  const Shield* data() const { return shields_.data(); }
  std::size_t bytes() const { return sizeof(Shield) * shields_.capacity(); }

 private:
  [[gnu::noinline]] void refresh(const PackedBox<Box>& box, const PackedCentres& centres,
                                 const NeighbourLists& lists, Index i) {
    Shield shield;
    const Index* const row = lists.row(i);
    const Index n = std::min(row[0], Shield::size);
    for (Index lane = 0; lane < n; ++lane)
      see(box, centres[i], centres[row[1 + lane]], shield, lane);
    shield.room = box.room(centres[i]);
    shields_[i] = shield;
  }

  [[gnu::always_inline]] static void see(const PackedBox<Box>& box, const PackedCentre& from,
                                         const PackedCentre& to, Shield& shield, Index lane) {
    const Pair lateral = box.lateral(to.xy - from.xy);
    shield.x[lane] = static_cast<float>(lateral[0]);
    shield.y[lane] = static_cast<float>(lateral[1]);
    shield.z[lane] = static_cast<float>(box.vertical(to.z - from.z));
  }

  std::vector<Shield, LargePageAllocator<Shield>> shields_;
  std::vector<Index> former_;  // neighbours of the sphere whose list is being renewed
};

/// Whether the shield refuses a step, diameters.
template <class Box>
[[gnu::always_inline]] inline bool shuts(const Shield& shield, float dx, float dy, float dz) {
  // A coordinate errs by less than 1e-6 for steps and blockers within 10 diameters.
  constexpr float touching = 1 - 1e-5f;
  const Lanes x = shield.x - dx, y = shield.y - dy, z = shield.z - dz;
  const auto blocked = x * x + y * y + z * z < touching;
  return (_mm_movemask_ps((__m128)blocked) != 0) | PackedBox<Box>::leaves(shield.room, dx, dy, dz);
}

}  // namespace jostle
