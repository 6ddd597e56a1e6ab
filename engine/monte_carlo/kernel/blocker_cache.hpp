#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/large_pages.hpp"
#include "engine/monte_carlo/kernel/neighbour_lists.hpp"
#include "engine/monte_carlo/kernel/packed_geometry.hpp"

namespace jostle::inline engine {

/// What rejects most trials of a sphere, in one cache line: where its likeliest blockers stand,
/// seen from it, and its room to floor and sides. In single precision, with margins: a trial that
/// the cache rejects would be rejected in double precision too; one that it lets pass is not
/// decided.
struct alignas(64) BlockerCache {
  static constexpr std::uint32_t size = 4;
  static constexpr float far = 1e9f;

  Lanes x = {far, far, far, far}, y = {}, z = {};  // one blocker a lane, diameters
  Lanes room;                                      // as PackedBox::room gives it
};

/// Whether the cache rejects a step, diameters.
template <class Box>
[[gnu::always_inline]] inline bool certainly_rejects(const BlockerCache& cache, float dx, float dy,
                                                     float dz) {
  // A coordinate errs by less than 1e-6 for steps and blockers within 10 diameters.
  constexpr float touching = 1 - 1e-5f;
  const Lanes x = cache.x - dx, y = cache.y - dy, z = cache.z - dz;
  const auto blocked = x * x + y * y + z * z < touching;
  return any_of_four(blocked) | PackedBox<Box>::leaves(cache.room, dx, dy, dz);
}

/// The caches of all spheres. Lanes 0 to 3 of cache i hold the first four of row i of the lists:
/// where a row or a centre changes, refresh() or follow() bring up to date what shows it.
/// Neighbourhood calls them; nothing else need.
template <class Box>
class BlockerCaches {
 public:
  using Index = NeighbourLists::Index;

  /// All caches anew.
  void build(const PackedBox<Box>& box, const PackedCentres& centres, const NeighbourLists& lists) {
    caches_.resize(centres.size());
    for (Index i = 0; i < centres.size(); ++i) refresh(box, centres, lists, i);
  }

  /// Row i has changed.
  [[gnu::noinline]] void refresh(const PackedBox<Box>& box, const PackedCentres& centres,
                                 const NeighbourLists& lists, Index i) {
    BlockerCache cache;
    const Index* const row = lists.row(i);
    const Index n = std::min(row[0], BlockerCache::size);
    for (Index lane = 0; lane < n; ++lane)
      see(box, centres[i], centres[row[1 + lane]], cache, lane);
    cache.room = box.room(centres[i]);
    caches_[i] = cache;
  }

  /// Sphere i has moved, or entered other rows: its own cache, and those that show it.
  [[gnu::noinline]] void follow(const PackedBox<Box>& box, const PackedCentres& centres,
                                const NeighbourLists& lists, Index i) {
    refresh(box, centres, lists, i);
    const Index* const row = lists.row(i);
    for (Index m = 1; m <= row[0]; ++m) {
      const Index j = row[m];
      const Index* const other = lists.row(j);
      const Index n = std::min(other[0], BlockerCache::size);
      for (Index lane = 0; lane < n; ++lane) {
        if (other[1 + lane] == i) see(box, centres[j], centres[i], caches_[j], lane);
      }
    }
  }

  /// The neighbour at place `place` of row i, counted from 0, blocks more often than was thought.
  [[gnu::noinline]] void promote(const PackedBox<Box>& box, const PackedCentres& centres,
                                 NeighbourLists& lists, Index i, Index place) {
    lists.swap(i, place, place - 1);
    if (place == BlockerCache::size) {
      see(box, centres[i], centres[lists.row(i)[place]], caches_[i], place - 1);
    }
  }

  const BlockerCache* data() const { return caches_.data(); }
  std::size_t bytes() const { return sizeof(BlockerCache) * caches_.capacity(); }

 private:
  [[gnu::always_inline]] static void see(const PackedBox<Box>& box, const PackedCentre& from,
                                         const PackedCentre& to, BlockerCache& cache, Index lane) {
    const Pair lateral = box.lateral(to.xy - from.xy);
    cache.x[lane] = static_cast<float>(lateral[0]);
    cache.y[lane] = static_cast<float>(lateral[1]);
    cache.z[lane] = static_cast<float>(box.vertical(to.z - from.z));
  }

  std::vector<BlockerCache, LargePageAllocator<BlockerCache>> caches_;
};

}  // namespace jostle::inline engine
