#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

#include "engine/large_pages.hpp"
#include "engine/monte_carlo/kernel/neighbour_lists.hpp"
#include "engine/monte_carlo/kernel/packed_geometry.hpp"

namespace jostle::inline engine {

/// The bodies that reject most trials of a sphere, in one cache line: positions of its most likely
/// blockers, relative to it, and its room to floor and sides. In single precision, with margins: a
/// trial that the cache rejects would be rejected in double precision too; one that it lets pass is
/// not decided.
struct alignas(64) BlockerCache {
  static constexpr std::uint32_t size = 4;
  static constexpr float far = 1e9f;

  Lanes x = {far, far, far, far}, y = {}, z = {};  // one blocker a lane, diameters
  Lanes room;                                      // in the form of PackedBox::room

  /// How many of the first neighbours have a lane.
  static constexpr std::uint32_t shown() { return size; }
  template <class Box>
  [[gnu::always_inline]] void see_faces(const PackedBox<Box>& box, const PackedCentre& start,
                                        double) {
    room = box.room(start);
  }
  template <class Box>
  [[gnu::always_inline]] void see(const PackedBox<Box>& box, const PackedCentre& start,
                                  const PackedCentre& end, std::uint32_t lane, double) {
    const Pair lateral = box.lateral(end.xy - start.xy);
    x[lane] = static_cast<float>(lateral[0]);
    y[lane] = static_cast<float>(lateral[1]);
    z[lane] = static_cast<float>(box.vertical(end.z - start.z));
  }
};

/// The cache of spheres of several sizes. A step d of a sphere that sees a blocker at b, s being
/// the sum of their radii, overlaps it where |b - d|^2 < s^2, that is where 2 b.d - |d|^2 > c with
/// c = |b|^2 - s^2. A face within reach takes the last lane: as a sphere so large that it is flat.
struct alignas(64) SizedBlockerCache {
  static constexpr std::uint32_t size = 4;

  Lanes x = {}, y = {}, z = {};  // 2 b
  Lanes c = {endless, endless, endless, endless};

  std::uint32_t shown() const {
    const float squared = x[3] * x[3] + y[3] * y[3] + z[3] * z[3];
    return squared > nearest_flat * nearest_flat ? size - 1 : size;
  }
  /// `longest`: no step is longer.
  template <class Box>
  [[gnu::always_inline]] void see_faces(const PackedBox<Box, SeveralSizes>& box,
                                        const PackedCentre& start, double longest) {
    const FaceAhead face = box.nearest_face(start);
    if (!(face.room < longest)) return;
    const Vec3 twice = (2 * flat) * face.normal;
    set(size - 1, twice, 2 * flat * (face.room + margin * (std::max(face.room, 0.0) + longest)));
  }
  template <class Box>
  [[gnu::always_inline]] void see(const PackedBox<Box, SeveralSizes>& box,
                                  const PackedCentre& start, const PackedCentre& end,
                                  std::uint32_t lane, double longest) {
    const Pair lateral = box.lateral(end.xy - start.xy);
    const Vec3 b{lateral[0], lateral[1], box.vertical(end.z - start.z)};
    const double squared = norm_squared(b), touching = SeveralSizes::touching_squared(start, end);
    set(lane, 2.0 * b, squared - touching + 2 * margin * (squared + longest * longest));
  }

 private:
  static constexpr float endless = std::numeric_limits<float>::infinity();
  // The radius of a face, and more than any coordinate of a sphere can be: diameters.
  static constexpr double flat = 0x1p20;
  static constexpr float nearest_flat = 0x1p18f;
  // Roundings of 2 b.d - |d|^2 and c come to less than 6 x 2^-24 (|b| + |d|)^2.
  static constexpr double margin = 1e-6;

  void set(std::uint32_t lane, Vec3 twice, double least) {
    x[lane] = static_cast<float>(twice.x);
    y[lane] = static_cast<float>(twice.y);
    z[lane] = static_cast<float>(twice.z);
    c[lane] = static_cast<float>(least);
  }
};

template <class Spheres>
using BlockerCacheOf = std::conditional_t<Spheres::several, SizedBlockerCache, BlockerCache>;

/// True if the cache rejects a step, diameters.
template <class Box>
[[gnu::always_inline]] inline bool certainly_rejects(const BlockerCache& cache, float dx, float dy,
                                                     float dz) {
  // A coordinate errs by less than 1e-6 for steps and blockers within 10 diameters.
  constexpr float touching = 1 - 1e-5f;
  const Lanes x = cache.x - dx, y = cache.y - dy, z = cache.z - dz;
  const auto blocked = x * x + y * y + z * z < touching;
  return any_of_four(blocked) | PackedBox<Box>::leaves(cache.room, dx, dy, dz);
}
template <class Box>
[[gnu::always_inline]] inline bool certainly_rejects(const SizedBlockerCache& cache, float dx,
                                                     float dy, float dz) {
  const Lanes ahead = cache.x * dx + cache.y * dy + cache.z * dz;
  return any_of_four(ahead - (dx * dx + dy * dy + dz * dz) > cache.c);
}

/// The caches of all spheres. The lanes of cache i hold the first of row i of the lists:
/// where a row or a centre changes, refresh() or follow() bring up to date what shows it.
/// Neighbourhood calls them; nothing else need.
template <class Box, class Spheres = EqualSpheres>
class BlockerCaches {
 public:
  using Index = std::uint32_t;
  using Cache = BlockerCacheOf<Spheres>;
  using Lists = NeighbourListsOf<Spheres>;
  using Sides = PackedBox<Box, Spheres>;

  /// All caches anew, for steps up to `longest`.
  void build(const Sides& box, const PackedCentres& centres, const Lists& lists, double longest) {
    longest_ = longest;
    caches_.resize(centres.size());
    for (Index i = 0; i < centres.size(); ++i) refresh(box, centres, lists, i);
  }

  /// Row i has changed.
  [[gnu::noinline]] void refresh(const Sides& box, const PackedCentres& centres, const Lists& lists,
                                 Index i) {
    Cache cache;
    cache.see_faces(box, centres[i], longest_);
    const Index* const row = lists.row(i);
    const Index n = std::min(row[0], cache.shown());
    for (Index lane = 0; lane < n; ++lane)
      cache.see(box, centres[i], centres[row[1 + lane]], lane, longest_);
    caches_[i] = cache;
  }

  /// Sphere i has moved, or entered other rows: its own cache, and those that show it.
  [[gnu::noinline]] void follow(const Sides& box, const PackedCentres& centres, const Lists& lists,
                                Index i) {
    refresh(box, centres, lists, i);
    const Index* const row = lists.row(i);
    for (Index m = 1; m <= row[0]; ++m) {
      const Index j = row[m];
      const Index lane = lane_of(i, lists.row(j));
      if (lane < Cache::size && lane < caches_[j].shown())
        caches_[j].see(box, centres[j], centres[i], lane, longest_);
    }
  }

  /// The neighbour at place `place` of row i, counted from 0, blocks more often than was thought.
  [[gnu::noinline]] void promote(const Sides& box, const PackedCentres& centres, Lists& lists,
                                 Index i, Index place) {
    lists.swap(i, place, place - 1);
    if (place == caches_[i].shown()) {
      caches_[i].see(box, centres[i], centres[lists.row(i)[place]], place - 1, longest_);
    }
  }

  const Cache* data() const { return caches_.data(); }
  std::size_t bytes() const { return sizeof(Cache) * caches_.capacity(); }

 private:
  using FourIndices = Index __attribute__((vector_size(16)));

  // The place of sphere i in a row that holds it, or Cache::size where it is not among the first. A
  // row has more room than a cache. Entries behind the end of a short row are not found, because
  // the row itself has sphere i before them.
  [[gnu::always_inline]] static Index lane_of(Index i, const Index* row) {
    FourIndices first;
    std::memcpy(&first, row + 1, sizeof first);  // a row may begin anywhere
    const unsigned lanes = bits_of_four((FourMask)(first == i));
    return static_cast<Index>(std::countr_zero(lanes | 1u << Cache::size));
  }

  double longest_ = 0;
  std::vector<Cache, LargePageAllocator<Cache>> caches_;
};

}  // namespace jostle::inline engine
